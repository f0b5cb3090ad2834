//! `sweep` and `collect` as a user meets them: points, folders, what is skipped, what fails, and the table of all.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A chain so short that all spins turn together: the barrier is N K less what the hard axis leaves as it is.
const CONFIG: &str = r#"{
  "material": {"name": "toy", "moment": "2 mu_B", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
  ]},
  "lattice": {"chain": {"sites": 4}},
  "energy": [{"zeeman": {"B": ["0 T", "0 T", "0 T"]}}],
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}},
  "output": {"formats": ["csv"], "plots": []}
}"#;

const SWEEP: &str = r#"{
  "config": "chain.json",
  "grid": {
    "lattice.chain.sites": [3, 4],
    "material.energy[1].anisotropy.K": {"from": "0.1 meV", "to": "0.3 meV", "points": 3}
  }
}"#;

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

/// A folder with the config and a sweep of it.
fn folder(sweep: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chain.json"), CONFIG).unwrap();
    fs::write(folder.path().join("many.json"), sweep).unwrap();
    folder
}

fn text(folder: &Path, file: &str) -> String {
    fs::read_to_string(folder.join(file)).unwrap_or_else(|e| panic!("{file}: {e}"))
}

/// The cells of the table, the head first.
fn table(folder: &Path) -> Vec<Vec<String>> {
    text(folder, "results/many/barriers.csv").lines().map(|line| line.split(',').map(String::from).collect()).collect()
}

#[test]
fn a_sweep_runs_every_point_and_collects_them_and_what_is_done_is_not_run_again() {
    let folder = folder(SWEEP);
    let (code, out, said) = spinneb(folder.path(), &["sweep", "many.json", "--jobs", "2", "--json"]);
    assert_eq!(code, Some(0), "{said}");
    let lines: Vec<Value> = out.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines.len(), 6);
    for (k, line) in lines.iter().enumerate() {
        let (sites, mev) = ([3, 4][k / 3], [0.1, 0.2, 0.3][k % 3]);
        assert_eq!((&line["index"], &line["values"]["lattice.chain.sites"]), (&k.into(), &sites.into()));
        assert!((line["barrier_meV"]["forward"].as_f64().unwrap() - sites as f64 * mev).abs() < 1e-9, "{line}");
        assert_eq!(line["certified"], true);
        let directory = format!("results/many/sites_{sites}__K_{mev}meV");
        assert_eq!(line["directory"], directory.as_str());
        assert!(folder.path().join(&directory).join("summary.json").is_file());
    }
    let rows = table(folder.path());
    let head = [
        "index",
        "sites",
        "K_meV",
        "barrier_forward_meV",
        "barrier_backward_meV",
        "certified",
        "converged",
        "saddles",
        "negative_modes",
        "state",
        "directory",
    ];
    assert_eq!(rows[0], head);
    assert_eq!(rows.len(), 7);
    assert_eq!((rows[4][0].as_str(), rows[4][1].as_str(), rows[4][2].as_str()), ("3", "4", "0.1"));
    assert_eq!(rows[4][5..], ["true", "true", "1", "1", "certified", "sites_4__K_0.1meV"]);
    let svg = text(folder.path(), "results/many/barriers.svg");
    assert!(svg.starts_with("<svg") && svg.contains("K (meV)") && svg.contains("sites = 3"), "{svg}");
    assert!(fs::metadata(folder.path().join("results/many/barriers.png")).unwrap().len() > 1000);

    let summary = folder.path().join("results/many/sites_3__K_0.1meV/summary.json");
    let before = fs::metadata(&summary).unwrap().modified().unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "many.json"]);
    assert_eq!(code, Some(0));
    assert!(said.contains("many: 6 of 6 points are done already"), "{said}");
    assert_eq!(fs::metadata(&summary).unwrap().modified().unwrap(), before);

    // more values: the points that are there keep their folders
    fs::write(folder.path().join("many.json"), SWEEP.replace("[3, 4]", "[2, 3, 4]")).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "many.json"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(said.contains("6 of 9 points are done already") && said.contains("3 of 3: sites_2__K_"), "{said}");
    assert_eq!(table(folder.path()).len(), 10);
    assert_eq!(fs::metadata(&summary).unwrap().modified().unwrap(), before);
}

#[test]
fn single_points_by_their_index_are_the_same_results_as_a_local_sweep() {
    let [local, array] = [folder(SWEEP), folder(SWEEP)];
    assert_eq!(spinneb(local.path(), &["sweep", "many.json", "--quiet"]), (Some(0), "".into(), "".into()));
    let (code, count, _) = spinneb(array.path(), &["sweep", "many.json", "--count"]);
    assert_eq!((code, count.as_str()), (Some(0), "6\n"));
    for k in ["5", "0", "3"] {
        let (code, out, said) = spinneb(array.path(), &["sweep", "many.json", "--index", k, "--quiet", "--json"]);
        assert_eq!((code, said.as_str()), (Some(0), ""));
        assert_eq!(serde_json::from_str::<Value>(&out).unwrap()["exit_code"], 0);
    }
    let (code, out, _) = spinneb(array.path(), &["sweep", "many.json", "--list"]);
    assert_eq!(code, Some(0));
    let states: Vec<&str> = out.lines().skip(1).map(|line| line.split_whitespace().nth(4).unwrap()).collect();
    assert_eq!(states, ["certified", "missing", "missing", "certified", "missing", "certified"]);
    assert!(out.starts_with("index  sites  K        state"), "{out}");
    // what is missing is said, and is in the table without numbers
    let (code, _, said) = spinneb(array.path(), &["collect", "many.json"]);
    assert_eq!(code, Some(3));
    assert!(said.contains("many: 6 points: 3 certified, 3 missing\nmany: missing: 1, 2, 4\n"), "{said}");
    assert_eq!(table(array.path())[2][3..], ["", "", "", "", "", "", "missing", "sites_3__K_0.2meV"]);
    // those from one to another, of which the table is not made; what is done is not run again
    let (code, out, said) = spinneb(array.path(), &["sweep", "many.json", "--index", "1-3", "--jobs", "2", "--json"]);
    assert_eq!((code, out.lines().count()), (Some(0), 3), "{said}");
    assert!(said.contains("many: 1 of 3 points are done already"), "{said}");
    assert_eq!(table(array.path())[2][9], "missing");
    assert_eq!(spinneb(array.path(), &["sweep", "many.json", "--index", "4", "-q"]).0, Some(0));
    for (wrong, said) in [("3-1", "smaller number first"), ("1-6", "there is no point 6"), ("a-2", "a point's number")]
    {
        let (code, _, told) = spinneb(array.path(), &["sweep", "many.json", "--index", wrong]);
        assert!(code == Some(2) && told.contains(said), "{told}");
    }
    let (code, _, told) = spinneb(array.path(), &["sweep", "many.json", "--index", "3", "--jobs", "2"]);
    assert!(code == Some(2) && told.contains("--index names one"), "{told}");
    // by the folder alone
    fs::remove_file(array.path().join("many.json")).unwrap();
    assert_eq!(spinneb(array.path(), &["collect", "results/many"]).0, Some(0));
    for file in ["barriers.csv", "barriers.svg", "points.json"] {
        let place = format!("results/many/{file}");
        assert_eq!(text(local.path(), &place), text(array.path(), &place), "{file}");
    }
    let (code, _, said) = spinneb(local.path(), &["sweep", "many.json", "--index", "6"]);
    assert_eq!((code, said.as_str()), (Some(2), "error: there is no point 6: many.json has the points 0 to 5\n"));
}

#[test]
fn a_point_that_fails_and_one_without_a_proof_are_told_and_do_not_stop_the_others() {
    // one evaluation of the band is not enough for a wall; and a folder that is a file takes no result
    let folder = folder(&SWEEP.replace("\"lattice.chain.sites\": [3, 4]", "\"neb.max_evaluations\": [1, 20000]"));
    let long = CONFIG.replace("\"sites\": 4", "\"sites\": 40");
    fs::write(
        folder.path().join("chain.json"),
        long.replace(
            "\"initial\"",
            "\"saddle\": {\"refine\": false, \"certify\": false}, \"neb\": {\"climb\": false}, \"initial\"",
        ),
    )
    .unwrap();
    fs::create_dir_all(folder.path().join("results/many")).unwrap();
    fs::write(folder.path().join("results/many/max_evaluations_1__K_0.2meV"), "a file").unwrap();
    let (code, out, said) = spinneb(folder.path(), &["sweep", "many.json", "--json"]);
    assert_eq!(code, Some(2), "{said}");
    let states: Vec<Value> = out.lines().map(|l| serde_json::from_str::<Value>(l).unwrap()["state"].clone()).collect();
    assert_eq!(
        states,
        ["not certified", "missing", "not certified", "not certified", "not certified", "not certified"]
    );
    assert!(said.contains("error: point 1, max_evaluations_1__K_0.2meV: ") && said.contains("is a file"), "{said}");
    assert!(said.contains("point 0, max_evaluations_1__K_0.1meV: not certified: "), "{said}");
    assert!(said.contains("many: 6 points: 5 not certified, 1 missing\n"), "{said}");
    // the doubtful ones are drawn as rings, and said to be
    assert!(text(folder.path(), "results/many/barriers.svg").contains("not certified"));
}

#[test]
fn results_of_another_config_are_refused_before_anything_runs_and_replaced_only_by_force() {
    let folder = folder(SWEEP);
    assert_eq!(spinneb(folder.path(), &["sweep", "many.json", "--index", "0", "-q"]).0, Some(0));
    fs::write(folder.path().join("chain.json"), CONFIG.replace("10 meV", "11 meV")).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "many.json"]);
    assert_eq!(code, Some(2));
    assert!(
        said.starts_with(
            "error: 1 of 6 points have a folder with a damaged result or one of another config or version, "
        ),
        "{said}"
    );
    assert!(!folder.path().join("results/many/sites_3__K_0.2meV").exists());
    let (code, _, said) = spinneb(folder.path(), &["collect", "many.json"]);
    assert_eq!(code, Some(3));
    assert!(said.contains("5 missing, 1 another result") && said.contains("nothing is collected"), "{said}");
    assert!(!folder.path().join("results/many/barriers.csv").exists());
    assert_eq!(spinneb(folder.path(), &["sweep", "many.json", "--force", "-q"]).0, Some(0));
    assert_eq!(spinneb(folder.path(), &["collect", "results/many", "-q"]), (Some(0), "".into(), "".into()));
}

#[test]
fn what_is_wrong_with_any_point_is_said_once_and_nothing_runs() {
    let folder = folder(
        &SWEEP.replace("\"0.1 meV\"", "\"0.1 T\"").replace("\"0.3 meV\"", "\"0.3 T\"").replace("[3, 4]", "[3, 4, 0]"),
    );
    for arguments in [&["sweep", "many.json"][..], &["sweep", "many.json", "--list"], &["collect", "many.json"]] {
        let (code, out, said) = spinneb(folder.path(), arguments);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{said}");
        let place = "many.json:5:40: grid[\"material.energy[1].anisotropy.K\"]: with \"0.1 T\", chain.json: ";
        assert_eq!(said.matches(place).count(), 1, "{said}");
        assert_eq!(said.lines().count(), 3, "{said}");
    }
    // what only the physics shows
    fs::write(folder.path().join("many.json"), SWEEP.replace("[3, 4]", "[3, 0]")).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "many.json"]);
    assert_eq!(code, Some(2));
    assert!(
        said.contains("error: many.json:4:32: grid[\"lattice.chain.sites\"][1]: chain.json: lattice.chain"),
        "{said}"
    );
    assert!(!folder.path().join("results").exists());
    for (arguments, words) in [
        (["collect", "."], "is not the folder of a sweep's results: there is no points.json"),
        (["sweep", "chain.json"], "chain.json:1:1: .: this is a config, not a sweep: "),
    ] {
        let (code, _, said) = spinneb(folder.path(), &arguments);
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn values_that_are_no_numbers_and_prefactors_have_their_columns() {
    let folder = folder(
        r#"{
          "config": "chain.json",
          "set": {"rates": {"temperatures": ["3 K"], "damping": 0.2}},
          "zip": {
            "energy[0].zeeman.B": [["0 T", "0 T", "0 T"], ["0 T", "0 T", "-100 mT"]],
            "material.energy[1].anisotropy.K": ["0.5 meV", "600 ueV"]
          }
        }"#,
    );
    let (code, _, said) = spinneb(folder.path(), &["sweep", "many.json"]);
    assert_eq!(code, Some(0), "{said}");
    let text = text(folder.path(), "results/many/barriers.csv");
    let lines: Vec<&str> = text.lines().collect();
    assert!(lines[0].starts_with("index,B,K_meV,barrier_forward_meV,barrier_backward_meV,"), "{text}");
    assert!(
        lines[0].contains(
            ",htst_prefactor_forward_Hz,htst_prefactor_backward_Hz,langer_prefactor_forward_Hz,langer_prefactor_backward_Hz,state,"
        ),
        "{text}"
    );
    assert!(lines[2].starts_with(r#"1,"[""0 T"",""0 T"",""-100 mT""]",0.6,"#), "{text}");
    // Langer's prefactors of both directions are there; undirected turns have no rate by transition-state theory
    let behind: Vec<&str> = lines[1].rsplit(',').collect();
    assert!(behind[2].parse::<f64>().unwrap() > 1e6 && behind[3].parse::<f64>().unwrap() > 1e6, "{text}");
    assert_eq!((behind[4], behind[5]), ("", ""));
}

#[test]
fn a_nucleus_that_slides_over_the_lattice_at_hardly_any_cost_is_certified_where_it_once_was_not() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = tempfile::tempdir().unwrap();
    for (k, b) in [(0.13f64, 1.5f64), (0.4, 1.8), (0.55, 1.2)] {
        let sets = [
            format!("material.energy[1].anisotropy.K=\"{k} meV\""),
            format!("energy[0].zeeman.B[2]=\"-{b} T\""),
            "output={\"formats\": [], \"plots\": []}".to_string(),
        ];
        let place = out.path().join(k.to_string());
        let mut arguments =
            vec!["run", "configs/ring_nucleus.json", "--json", "--quiet", "--out", place.to_str().unwrap()];
        sets.iter().for_each(|set| arguments.extend(["--set", set]));
        let (code, line, said) = spinneb(root, &arguments);
        assert_eq!(code, Some(0), "K = {k} meV, {said}");
        let barrier = serde_json::from_str::<Value>(&line).unwrap()["barrier_meV"]["forward"].as_f64().unwrap();
        // Braun's formula less the lattice's first correction, a 24th of (spacing/width)² at most but for a little
        let h = 2.0 * 5.7883817982e-2 * b / (2.0 * k);
        let tanh = (1.0 - h).sqrt();
        let braun = 4.0 * (20.0 * k).sqrt() * (tanh - tanh.atanh() * h);
        let deviation = barrier / braun - 1.0;
        assert!(-0.046 * 2.0 * k / 10.0 < deviation && deviation < 0.0, "{k}: {deviation}");
    }
}

/// The processes that work at a point of the sweep in this folder and have had so many hundredths of a second of a processor.
#[cfg(target_os = "linux")]
fn at_work(folder: &Path, at_least: u64) -> usize {
    let of = |entry: fs::DirEntry| {
        let line = fs::read(entry.path().join("cmdline")).ok()?;
        let here = fs::read_link(entry.path().join("cwd")).ok()?;
        let point = line.split(|b| *b == 0).any(|word| word == b"--index");
        let stat = fs::read_to_string(entry.path().join("stat")).ok()?;
        let had: u64 = stat.rsplit(')').next()?.split_whitespace().nth(11)?.parse().ok()?;
        // who has ended and was not asked for its code has no working directory
        (point && here == folder.canonicalize().ok()? && had >= at_least).then_some(())
    };
    fs::read_dir("/proc").unwrap().flatten().filter_map(of).count()
}

#[test]
#[cfg(target_os = "linux")]
fn a_sweep_that_is_killed_or_terminated_leaves_no_points_at_work_and_they_go_on_afterwards() {
    use std::time::{Duration, Instant};
    let folder = folder(
        r#"{"config": "chain.json", "grid": {"lattice.chain.sites": [2000, 2001]},
            "set": {"neb": {"optimiser": {"velocity_projection": {}}, "tolerance": 1e-300, "max_evaluations": 2000000}}}"#,
    );
    let wait = |what: &str, is_so: &dyn Fn() -> bool| {
        let started = Instant::now();
        while !is_so() {
            assert!(started.elapsed() < Duration::from_secs(60), "waited for {what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    for signal in ["KILL", "TERM"] {
        let mut sweep = Command::new(env!("CARGO_BIN_EXE_spinneb"));
        sweep
            .current_dir(folder.path())
            .args(["sweep", "many.json", "--jobs", "2"])
            .stderr(std::process::Stdio::piped());
        let sweep = sweep.spawn().unwrap();
        // by then a point is long past its beginning, however busy the machine
        wait("two points at work", &|| at_work(folder.path(), 30) == 2);
        assert!(Command::new("kill").args(["-s", signal, &sweep.id().to_string()]).status().unwrap().success());
        let ended = sweep.wait_with_output().unwrap();
        let said = String::from_utf8(ended.stderr).unwrap();
        let told = said.contains("many: terminated; what is done is kept, and the same command goes on from there");
        assert_eq!(
            (told, ended.status.code()),
            if signal == "TERM" { (true, Some(143)) } else { (false, None) },
            "{said}"
        );
        wait("none at work", &|| at_work(folder.path(), 0) == 0);
    }
    for sites in ["2000", "2001"] {
        let point = folder.path().join("results/many").join(format!("sites_{sites}"));
        assert!(point.join("partial.json").is_file() && point.join("checkpoint/journal").is_file(), "{sites}");
    }
}

#[test]
fn a_sweep_with_rates_has_a_table_and_a_map_of_lifetimes_over_its_key_and_temperature() {
    let folder = tempfile::tempdir().unwrap();
    let config = r#"{"material": {"name": "one", "moment": "2 mu_B", "energy": [{"anisotropy": {"K": "4 meV", "axis": [0, 0, 1]}},
        {"anisotropy": {"K": "-2 meV", "axis": [1, 0, 0]}}]}, "lattice": {"chain": {"sites": 1}},
        "energy": [{"zeeman": {"B": ["0 T", "0 T", "0 T"]}}], "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}}, "rates": {"temperatures": ["2 K", "4 K", "45 K"], "damping": 0.5}}"#;
    fs::write(folder.path().join("one.json"), config).unwrap();
    let sweep = r#"{"config": "one.json", "set": {"output": {"formats": ["csv"], "plots": []}},
        "grid": {"energy[0].zeeman.B[2]": {"from": "0 T", "to": "-20 T", "points": 3}}}"#;
    fs::write(folder.path().join("life.json"), sweep).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "life.json"]);
    assert!(code == Some(0) && said.contains("lifetimes.csv, lifetime_map.svg, lifetime_map.png too"), "{said}");
    let table = text(folder.path(), "results/life/lifetimes.csv");
    let rows: Vec<Vec<&str>> = table.lines().map(|line| line.split(',').collect()).collect();
    let column =
        |name: &str| rows[0].iter().position(|head| *head == name).unwrap_or_else(|| panic!("{name}: {table}"));
    // three points, two directions, three temperatures
    assert_eq!(rows.len(), 1 + 18, "{table}");
    for row in &rows[1..] {
        let number = |name: &str| row[column(name)].parse::<f64>().ok();
        let kelvin = number("temperature_K").unwrap();
        // one spin of 4 meV, less in a field: at 45 K there is less than k_BT of it in the way it goes
        let [time, log] = ["escape_lifetime_s", "log10_escape_lifetime_s"].map(number);
        assert_eq!(time.is_some(), number("barrier_over_kT").unwrap() >= 1.0, "{row:?}");
        assert!(time.is_none_or(|t| (t.log10() - log.unwrap()).abs() < 1e-9 && kelvin > 0.0), "{row:?}");
    }
    let map = text(folder.path(), "results/life/lifetime_map.svg");
    for words in ["Mean first passage (s)", "Temperature (K)", "\nB\n", "\nz\n", "Grey: no lifetime"] {
        assert!(map.contains(words), "{words}");
    }
    // two keys make no map
    let two = sweep.replace("\"grid\": {", r#""grid": {"rates.damping": [0.1, 0.5], "#);
    assert_ne!(two, sweep);
    fs::write(folder.path().join("two.json"), two).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["sweep", "two.json"]);
    assert!(code == Some(0) && said.contains("lifetimes.csv too"), "{said}");
    assert!(!folder.path().join("results/two/lifetime_map.svg").exists());
    // what was collected is known and replaced
    assert_eq!(spinneb(folder.path(), &["collect", "life.json", "-q"]).0, Some(0));
    fs::write(folder.path().join("results/life/lifetimes.csv"), "mine").unwrap();
    let (code, _, said) = spinneb(folder.path(), &["collect", "life.json"]);
    assert!(code == Some(2) && said.contains("lifetimes.csv"), "{code:?} {said}");
}
