//! `spinneb landscape`: all minima and saddles of small problems, their graph, and how long states live.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::Instant;

const LANDSCAPE: &str = r#""landscape": {"temperatures": ["1 K", "2 K"],
    "groups": {"up": {"axis": [0, 0, 1], "from": 0.5}, "down": {"axis": [0, 0, 1], "to": -0.5}}}"#;

fn material(more: &str) -> String {
    format!(
        r#"{{"name": "toy", "moment": "2 mu_B", "energy": [{{"exchange": {{"J": ["2 meV"]}}}},
            {{"anisotropy": {{"K": "0.5 meV", "axis": [0, 0, 1]}}}}, {{"anisotropy": {{"K": "-0.2 meV", "axis": [1, 0, 0]}}}}{more}]}}"#
    )
}

/// Two hard axes, so that the two turns of a wall differ from those of the other: sites in a row.
fn chain(sites: usize) -> String {
    format!(r#"{{"material": {}, "lattice": {{"chain": {{"sites": {sites}}}}}, {LANDSCAPE}}}"#, material(""))
}

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

fn folder(config: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chain.json"), config).unwrap();
    folder
}

fn json(path: &Path) -> Value {
    serde_json::from_slice(&fs::read(path).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// `landscape.json` of a config, with its folder.
fn landscape(config: &str, arguments: &[&str]) -> (Value, tempfile::TempDir) {
    let folder = folder(config);
    let all: Vec<&str> =
        ["landscape", "chain.json", "--out", "found"].into_iter().chain(arguments.iter().copied()).collect();
    let (code, out, said) = spinneb(folder.path(), &all);
    assert_eq!(code, Some(0), "{out}{said}");
    let document = json(&folder.path().join("found/landscape.json"));
    (document, folder)
}

fn kinds(document: &Value, of: &str) -> Vec<(f64, u64)> {
    let entry = |e: &Value| (number(&e["above_lowest_meV"]), e["multiplicity"].as_u64().unwrap());
    document[of].as_array().unwrap().iter().map(entry).collect()
}

#[test]
fn a_spin_with_two_axes_has_two_minima_and_two_saddles() {
    let (document, folder) = landscape(&chain(1), &[]);
    let minima = kinds(&document, "minima");
    let saddles = kinds(&document, "saddles");
    assert_eq!((minima, saddles.len(), saddles[0].1), (vec![(0.0, 2)], 1, 2), "{document}");
    // over ±y: K
    assert!((saddles[0].0 - 0.5).abs() < 1e-14, "{saddles:?}");
    assert_eq!(document["saddles"][0]["minima"], serde_json::json!([0, 0]));
    for (file, rows) in [("minima.csv", 2), ("saddles.csv", 2), ("lifetimes.csv", 8), ("min.data", 1), ("ts.data", 1)] {
        let text = fs::read_to_string(folder.path().join("found").join(file)).unwrap();
        let head = usize::from(file.ends_with("csv"));
        assert!(text.lines().count() - head >= rows, "{file}: {text}");
    }
    for file in [
        "landscape.npz",
        "landscape.graphml",
        "disconnectivity.svg",
        "disconnectivity.png",
        "network.svg",
        "network.png",
        "lifetimes.svg",
        "report.html",
    ] {
        assert!(fs::metadata(folder.path().join("found").join(file)).unwrap().len() > 200, "{file}");
    }
}

#[test]
fn groups_that_hold_the_same_minima_are_said() {
    let overlapping = chain(1).replace("\"to\": -0.5", "\"to\": 1");
    let (document, folder) = landscape(&overlapping, &["--force"]);
    let told = "the groups down and up hold 1 minimum in common: a state that is in both";
    let told_too = "the groups up and down hold 1 minimum in common: a state that is in both";
    let warnings = [&document, &json(&folder.path().join("found/summary.json"))].map(|of| of["warnings"].to_string());
    assert!(warnings.iter().all(|said| said.contains(told) || said.contains(told_too)), "{warnings:?}");
}

#[test]
fn lifetimes_between_up_and_down_are_those_of_a_run_between_them() {
    for sites in [1, 8] {
        // below the wall through the harder axis, whose descents end on the other wall's ridge and go on to either side
        let window = ["--set", r#"landscape.energy_window="3 meV""#];
        let (document, folder) = landscape(&chain(sites), &window);
        let ends = [
            r#"initial={"uniform": {"direction": [0, 0, 1]}}"#,
            r#"final={"uniform": {"direction": [0, 0, -1]}}"#,
            r#"rates={"temperatures": ["1 K", "2 K"]}"#,
        ];
        let set: Vec<&str> = ends.iter().flat_map(|end| ["--set", end]).collect();
        let arguments: Vec<&str> = ["run", "chain.json", "--out", "run"].into_iter().chain(set).collect();
        let (code, _, said) = spinneb(folder.path(), &arguments);
        assert_eq!(code, Some(0), "{said}");
        let summary = json(&folder.path().join("run/summary.json"));
        let entries = document["lifetimes"].as_array().unwrap();
        for (k, kelvin) in [1.0, 2.0].into_iter().enumerate() {
            let run = &summary["rates"][0]["temperatures"][k];
            assert_eq!(number(&run["temperature_K"]), kelvin);
            let own = entries
                .iter()
                .find(|e| e["from"] == "up" && e["to"] == "down" && number(&e["temperature_K"]) == kelvin);
            let own = own.unwrap();
            let within = [own, run].map(|of| number(&of["known_within_factor"]));
            assert!((within[0] / within[1] - 1.0).abs() < 1e-4, "{sites} {kelvin} K: {within:?}");
            for theory in ["htst", "langer"] {
                let expected = 1.0 / number(&run[format!("{theory}_rate_per_s")]);
                let found = number(&own[format!("{theory}_time_s")]);
                assert!((found / expected - 1.0).abs() < 1e-9, "{sites} {theory} {kelvin} K: {found} {expected}");
            }
        }
    }
}

#[test]
fn min_data_and_ts_data_say_the_rates() {
    let field = r#", {"zeeman": {"B": ["0 T", "0 T", "0.4 T"]}}"#;
    let config = chain(1).replace(&material(""), &material(field));
    let (document, folder) = landscape(&config, &[]);
    let table = |file: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.path().join("found").join(file)).unwrap();
        text.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect()
    };
    let (minima, saddles) = (table("min.data"), table("ts.data"));
    assert_eq!((minima.len(), saddles.len()), (2, 2));
    let beta = 1.0 / (8.617333262e-2 * 1.0);
    let rate = |from: usize| -> f64 {
        let over = |s: &Vec<f64>| ((minima[from][1] - s[1]) / 2.0 - beta * (s[0] - minima[from][0])).exp();
        saddles.iter().map(over).sum::<f64>() / (2.0 * std::f64::consts::PI)
    };
    let entries = document["lifetimes"].as_array().unwrap();
    for (from, state) in [("up", 0), ("down", 1)] {
        let row = entries.iter().find(|e| e["from"] == from && e["to"].is_null() && number(&e["temperature_K"]) == 1.0);
        let expected = number(&row.unwrap()["langer_time_s"]);
        assert!((expected * rate(state) - 1.0).abs() < 1e-9, "{from}: {expected} {}", 1.0 / rate(state));
    }
}

#[test]
fn states_above_the_window_are_left_out() {
    let field = r#", {"zeeman": {"B": ["0 T", "0 T", "0.4 T"]}}"#;
    let config = chain(1).replace(&material(""), &material(field));
    // down lies 2 μB 0.4 T · 2 above up
    let (whole, _folder) = landscape(&config, &[]);
    assert_eq!(kinds(&whole, "minima").len(), 2);
    let (below, _folder) = landscape(&config, &["--set", r#"landscape.energy_window="0.05 meV""#]);
    assert_eq!((kinds(&below, "minima"), kinds(&below, "saddles").len()), (vec![(0.0, 1)], 0));
}

#[test]
fn threads_do_not_matter_and_a_finished_result_stays() {
    let (_, folder) = landscape(&chain(5), &["--threads", "1", "--effort", "quick"]);
    let arguments = ["landscape", "chain.json", "--out", "other", "--threads", "2", "--effort", "quick"];
    let (code, _, said) = spinneb(folder.path(), &arguments);
    assert_eq!(code, Some(0), "{said}");
    for file in ["landscape.json", "minima.csv", "saddles.csv", "lifetimes.csv", "landscape.npz", "ts.data"] {
        let read = |dir: &str| fs::read(folder.path().join(dir).join(file)).unwrap();
        assert!(read("found") == read("other"), "{file}");
    }
    let (code, out, said) = spinneb(folder.path(), &arguments);
    assert!(code == Some(0) && said.contains("holds the finished result") && out.contains("minima of"), "{said}");
    fs::write(folder.path().join("other/minima.csv"), "mine").unwrap();
    let (code, _, said) = spinneb(folder.path(), &arguments);
    assert!(code == Some(2) && said.contains("minima.csv"), "{code:?} {said}");
    assert_eq!(fs::read_to_string(folder.path().join("other/minima.csv")).unwrap(), "mine");
}

#[test]
fn killed_searches_go_on_to_the_same_bytes() {
    let config = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/landscapes/pinned_walls.json");
    let folder = tempfile::tempdir().unwrap();
    let read = |name: &str| -> BTreeMap<_, _> {
        let files = fs::read_dir(folder.path().join(name)).unwrap().map(|file| file.unwrap().path());
        files.map(|file| (file.file_name().unwrap().to_os_string(), fs::read(file).unwrap())).collect()
    };
    let started = |out: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
        command.current_dir(folder.path()).arg("landscape").arg(&config).args(["--out", out, "--quiet", "--resume"]);
        command.args(["--checkpoint-every", "1 ms"]).stdout(Stdio::null()).spawn().unwrap()
    };
    let begun = Instant::now();
    assert!(started("whole").wait().unwrap().success());
    let (whole, takes) = (read("whole"), begun.elapsed());
    let mut killed = 0;
    // each killed a little later than the one before
    for k in 1.. {
        let mut child = started("killed");
        sleep(takes * k / 16);
        match child.try_wait().unwrap() {
            Some(status) => {
                assert!(status.success());
                break;
            }
            None => child.kill().and_then(|()| child.wait()).map(|_| killed += 1).unwrap(),
        }
    }
    assert!(killed > 2, "{killed} kills in {takes:?}");
    let killed = read("killed");
    assert_eq!(killed.keys().collect::<Vec<_>>(), whole.keys().collect::<Vec<_>>());
    whole.iter().for_each(|(name, bytes)| assert!(*bytes == killed[name], "{name:?}"));
}

/// A square film in which a skyrmion and a stripe rest; no passes lead from the stripe below the window.
fn film(sites: usize) -> String {
    let groups = r#"{"none": {"charge": 0}, "one": {"charge": -1}, "seven": {"charge": -7}}"#;
    format!(
        r#"{{"material": {{"name": "toy", "moment": "2 mu_B", "energy": [{{"exchange": {{"J": ["10 meV"]}}}},
            {{"dmi": {{"D": "3.6 meV", "kind": "interfacial"}}}}, {{"anisotropy": {{"K": "1.5 meV", "axis": [0, 0, 1]}}}}]}},
            "lattice": {{"square": {{"cells": [{sites}, {sites}], "periodic": true}}}},
            "energy": [{{"zeeman": {{"B": ["0 T", "0 T", "3 T"]}}}}], "landscape": {{"effort": "quick", "energy_window": "100 meV",
            "temperatures": ["10 K", "30 K"], "states": [{{"skyrmion": {{"radius": 3}}}}], "groups": {groups}}}}}"#
    )
}

#[test]
fn where_translations_make_too_many_states_one_stands_for_all_its_places() {
    let (document, folder) = landscape(&film(16), &[]);
    let minima = kinds(&document, "minima");
    assert_eq!(document["symmetry_order"], 2048);
    assert_eq!((minima.len(), minima[0], minima[1].1), (3, (0.0, 1), 256), "{document}");
    assert_eq!(
        (&document["minima"][1]["places"], &document["minima"][1]["states"]),
        (&256.into(), &serde_json::json!([1, 1]))
    );
    let places = |file: &str| -> Vec<String> {
        let text = fs::read_to_string(folder.path().join("found").join(file)).unwrap();
        text.lines().map(|line| line.rsplit(',').next().unwrap().to_string()).collect()
    };
    assert_eq!(places("minima.csv"), ["places", "1", "256", "16", "16"]);
    assert_eq!(places("saddles.csv")[0], "places");
    // what PyGT makes of its files: out of the film without a skyrmion to any of the places
    let table = |file: &str| -> Vec<Vec<f64>> {
        let text = fs::read_to_string(folder.path().join("found").join(file)).unwrap();
        text.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect()
    };
    let (lowest, beta) = (&table("min.data")[0], 1.0 / (8.617333262e-2 * 10.0));
    let over = |s: &&Vec<f64>| s[3..5].contains(&1.0) && s[3] != s[4];
    let rate =
        |s: &Vec<f64>| ((lowest[1] - s[1]) / 2.0 - beta * (s[0] - lowest[0])).exp() / (2.0 * std::f64::consts::PI);
    let rate: f64 = table("ts.data").iter().filter(over).map(rate).sum();
    let row = document["lifetimes"].as_array().unwrap().iter().find(|l| l["from"] == "none" && l["to"].is_null());
    assert!((number(&row.unwrap()["langer_time_s"]) * rate - 1.0).abs() < 1e-9, "{row:?} {rate}");
}

#[test]
fn what_no_passes_join_has_no_part_in_times_and_empty_groups_are_named() {
    let (document, _folder) = landscape(&film(12), &[]);
    let warned =
        |words: &str| document["warnings"].as_array().unwrap().iter().any(|w| w.as_str().unwrap().contains(words));
    assert!(warned("join 24 minima with the lowest of their group"), "{}", document["warnings"]);
    assert!(warned("no minimum that was found is of the group \"seven\""), "{}", document["warnings"]);
    for row in document["lifetimes"].as_array().unwrap() {
        assert!(row["reason"].is_null() && number(&row["langer_time_s"]) > 0.0, "{row}");
    }
}

#[test]
fn what_a_landscape_cannot_be_is_said_with_its_place() {
    for (set, words) in [
        (r#"landscape.energy_window="0 meV""#, "landscape.energy_window"),
        (r#"landscape.energy_window=20"#, "landscape.energy_window"),
        (r#"landscape.groups={"up": {"axis": [0, 0, 1], "from": 0.5, "to": 0.2}}"#, "landscape.groups.up"),
        (r#"landscape.effrt="quick""#, "effort"),
        (r#"landscape.groups={"all": {}}"#, "landscape.groups.all: a group takes an axis"),
        (
            r#"landscape.groups={"both": {"axis": [0, 0, 1], "charge": 0}}"#,
            "landscape.groups.both: a group takes an axis",
        ),
        (r#"landscape.groups={"one": {"charge": -1}}"#, "landscape.groups.one.charge: found a charge, but only films"),
        (r#"landscape.states=[{"file": {"path": "nowhere.ovf"}}]"#, "landscape.states[0].file"),
    ] {
        let folder = folder(&chain(3));
        let (code, _, said) = spinneb(folder.path(), &["landscape", "chain.json", "--set", set]);
        assert!(code == Some(2) && said.contains(words), "{set}: {code:?} {said}");
        assert!(!folder.path().join("results").exists(), "{set}");
    }
}

#[test]
fn other_commands_say_what_a_landscape_is_for() {
    let (_, folder) = landscape(&chain(3), &["--effort", "quick"]);
    let run = |arguments: &[&str]| spinneb(folder.path(), arguments);
    let (code, out, said) = run(&["check", "chain.json"]);
    assert!(code == Some(0) && out.contains("chain.json: valid for `spinneb landscape`"), "{out}{said}");
    assert!(out.contains("groups") && out.contains("down, up") && out.contains("at 2 temperatures"), "{out}");
    let (code, _, said) = run(&["run", "chain.json"]);
    assert!(code == Some(2) && said.contains("`spinneb landscape` takes a config without it"), "{said}");
    let (code, _, said) = run(&["plot", "found"]);
    assert!(code == Some(2) && said.contains("the result of a landscape, not of a path"), "{said}");
    // with both ends it is a run's config, and what is wrong for that is told
    let ends = ["initial", "final"].map(|end| format!(r#"{end}={{"uniform": {{"direction": [0, 0, 1]}}}}"#));
    let wrong = r#"path={"images": 1}"#;
    let set: Vec<&str> = ends.iter().map(String::as_str).chain([wrong]).flat_map(|set| ["--set", set]).collect();
    let (code, out, said) = run(&[&["check", "chain.json"], &set[..]].concat());
    assert!(code == Some(2) && out.is_empty() && said.contains("path.images"), "{code:?} {out}{said}");
}

#[test]
fn a_saddle_without_a_rate_has_no_part_in_times_that_others_give() {
    // at 60 K a wall along the film wanders over a third of its length
    let film = r#"{"material": {"name": "toy", "moment": "2 mu_B", "energy": [{"exchange": {"J": ["10 meV"]}},
        {"dmi": {"D": "5 meV", "kind": "interfacial"}}, {"anisotropy": {"K": "3 meV", "axis": [0, 0, 1]}}]},
        "lattice": {"square": {"cells": [18, 9]}}, "landscape": {"energy_window": "60 meV", "temperatures": ["60 K"],
        "groups": {"up": {"axis": [0, 0, 1], "from": 0.5}, "down": {"axis": [0, 0, 1], "to": -0.5}}}}"#;
    let (document, _folder) = landscape(film, &[]);
    let warnings: Vec<&str> = document["warnings"].as_array().unwrap().iter().map(|w| w.as_str().unwrap()).collect();
    assert!(warnings.iter().any(|w| w.contains("have no rate by langer and no part in its times")), "{warnings:?}");
    let rates = document["saddles"].as_array().unwrap().iter().map(|s| s["rates"][0]["langer_prefactor_Hz"].is_null());
    let without = rates.clone().filter(|refused| *refused).count();
    assert!(without > 0 && without < rates.count(), "{document}");
    let over =
        document["lifetimes"].as_array().unwrap().iter().find(|l| l["from"] == "up" && l["to"] == "down").unwrap();
    assert!(number(&over["langer_time_s"]) > 0.0 && over["reason"].is_null(), "{over}");
}

#[test]
fn what_random_starts_reached_says_what_may_be_missing() {
    let (document, _folder) = landscape(&chain(5), &[]);
    let starts = &document["search"]["random_starts"];
    let count = |key: &str| starts[key].as_u64().unwrap_or_else(|| panic!("{key}: {starts}"));
    assert!(count("reached_a_minimum") == 32 && count("kinds_reached") >= 1, "{starts}");
    assert!(number(&starts["estimated_kinds"]) >= count("kinds_reached") as f64, "{starts}");
    assert_eq!(number(&starts["chance_of_another_kind"]), count("reached_once") as f64 / 32.0);
}

#[test]
fn every_shipped_landscape_comes_to_its_stop() {
    let configs = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/landscapes")).unwrap();
    let expected = [("island", (3, 14)), ("pinned_walls", (11, 42))];
    for config in configs.map(|entry| entry.unwrap().path()) {
        let folder = tempfile::tempdir().unwrap();
        let (code, out, said) = spinneb(folder.path(), &["landscape", config.to_str().unwrap(), "--out", "found"]);
        assert_eq!(code, Some(0), "{out}{said}");
        let document = json(&folder.path().join("found/landscape.json"));
        let minima = kinds(&document, "minima");
        let all: u64 = minima.iter().map(|kind| kind.1).sum();
        let states = document["minima"].as_array().unwrap().last().unwrap()["states"][1].as_u64().unwrap() + 1;
        assert_eq!(all, states, "{document}");
        let name = document["name"].as_str().unwrap();
        if let Some((_, counts)) = expected.iter().find(|(own, _)| *own == name) {
            assert_eq!((minima.len() as u64, all), *counts, "{document}");
        }
        let timed = document["lifetimes"].as_array().unwrap().iter().all(|row| row["reason"].is_null());
        assert!(timed, "{}", document["lifetimes"]);
        // a wall slips out of the weak sites beside the ends
        let shallow =
            document["warnings"].as_array().unwrap().iter().all(|words| words.as_str().unwrap().contains("k_BT"));
        assert!(shallow, "{document}");
    }
}
