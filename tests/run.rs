//! `run` as a user meets it: where results go, what is refused, what is printed.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const CONFIG: &str = r#"{
  "material": {"name": "toy", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
  ]},
  "lattice": {"chain": {"sites": 4}},
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}},
  "output": {"formats": ["csv"], "plots": []}
}"#;

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

/// A folder with the configs of these names.
fn folder(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        fs::write(folder.path().join(format!("{name}.json")), CONFIG).unwrap();
    }
    folder
}

#[test]
fn results_go_to_results_name_and_a_finished_one_is_left_as_it_is() {
    let folder = folder(&["short"]);
    let (code, out, said) = spinneb(folder.path(), &["run", "short.json"]);
    assert_eq!((code, out.as_str()), (Some(0), ""), "{said}");
    assert!(
        said.lines()
            .last()
            .unwrap()
            .starts_with("short: barrier 2.000000 meV forward, 2.000000 meV backward, certified; ")
    );
    let summary = folder.path().join("results/short/summary.json");
    let first = fs::read(&summary).unwrap();
    let (code, out, said) = spinneb(folder.path(), &["run", "short.json", "--json"]);
    assert_eq!(code, Some(0));
    assert!(said.starts_with("short: results/short holds the finished result of this config already"), "{said}");
    let line: Value = serde_json::from_str(&out).unwrap();
    assert!((line["barrier_meV"]["forward"].as_f64().unwrap() - 2.0).abs() < 1e-9);
    assert_eq!((&line["name"], &line["exit_code"]), (&"short".into(), &0.into()));
    assert_eq!((&line["directory"], &line["converged"]), (&"results/short".into(), &true.into()));
    assert_eq!(fs::read(&summary).unwrap(), first);
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--resume"]).0, Some(0));
    assert_eq!(fs::read(&summary).unwrap(), first);
}

#[test]
fn another_result_is_replaced_only_by_force() {
    let folder = folder(&["short"]);
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--quiet"]).0, Some(0));
    let longer = ["run", "short.json", "--set", "lattice.chain.sites=5", "--quiet"];
    let (code, _, said) = spinneb(folder.path(), &longer);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: results/short: holds a result of another config; use --force"), "{said}");
    assert_eq!(spinneb(folder.path(), &[&longer[..], &["--force"]].concat()), (Some(0), "".into(), "".into()));
}

#[test]
fn a_config_as_written_beside_its_results_is_the_same_run() {
    let folder = folder(&["short"]);
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--set", "path.images=7", "--quiet"]).0, Some(0));
    fs::copy(folder.path().join("results/short/config.json"), folder.path().join("copy.json")).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["run", "copy.json"]);
    assert_eq!(code, Some(0));
    assert!(said.contains("holds the finished result of this config already"), "{said}");
}

#[test]
fn several_configs_each_have_a_folder_a_line_and_the_worst_code() {
    let folder = folder(&["one", "two"]);
    let no_path = CONFIG.replace("[0, 0, -1]", "[0.1, 0, 1]");
    fs::write(folder.path().join("two.json"), no_path).unwrap();
    let (code, out, said) = spinneb(folder.path(), &["run", "one.json", "two.json", "--out", "all", "--json"]);
    assert_eq!(code, Some(3), "{said}");
    let codes: Vec<i64> =
        out.lines().map(|l| serde_json::from_str::<Value>(l).unwrap()["exit_code"].as_i64().unwrap()).collect();
    assert_eq!(codes, [0, 3]);
    for name in ["one", "two"] {
        assert!(folder.path().join("all").join(name).join("summary.json").is_file());
    }
}

#[test]
fn nothing_runs_unless_all_configs_are_right_and_have_folders_of_their_own() {
    let folder = folder(&["one", "two"]);
    fs::write(folder.path().join("two.json"), CONFIG.replace("final", "finall")).unwrap();
    let (code, _, said) = spinneb(folder.path(), &["run", "one.json", "two.json", "none.json"]);
    assert_eq!(code, Some(2));
    assert_eq!(said.lines().count(), 2, "{said}");
    assert!(said.starts_with("error: two.json: line 8, column 3: finall: unknown key"), "{said}");
    assert!(said.contains("\nerror: none.json: "), "{said}");
    let (code, _, said) = spinneb(folder.path(), &["run", "one.json", "one.json"]);
    assert_eq!(code, Some(2));
    assert!(said.contains("both named \"one\""), "{said}");
    assert!(!folder.path().join("results").exists());
}

#[test]
fn ends_that_relax_to_one_minimum_are_no_path() {
    let folder = folder(&["short"]);
    let (code, out, said) =
        spinneb(folder.path(), &["run", "short.json", "--json", "--set", "final.uniform.direction=[0.1,0,1]"]);
    assert_eq!(code, Some(3), "{said}");
    assert_eq!(serde_json::from_str::<Value>(&out).unwrap()["barrier_meV"], Value::Null);
    assert!(said.contains("the same minimum"), "{said}");
}

#[test]
fn lists_come_from_the_registries_and_say_what_parses() {
    let folder = folder(&[]);
    for (what, word) in [
        ("terms", "anisotropy"),
        ("states", "domain_wall"),
        ("guesses", "sweep"),
        ("optimisers", "implicit"),
        ("formats", "csv"),
        ("materials", "permalloy"),
    ] {
        let (code, out, _) = spinneb(folder.path(), &["list", what]);
        assert_eq!(code, Some(0));
        assert!(out.contains(word), "{out}");
        assert!(spinneb(folder.path(), &["list"]).1.contains(&format!("{what}\n")));
    }
}

#[test]
fn threads_do_not_change_a_result() {
    let folder = folder(&["short"]);
    let bytes = |threads: &str| {
        let out = format!("out{threads}");
        assert_eq!(
            spinneb(folder.path(), &["run", "short.json", "--threads", threads, "--out", &out, "-q"]).0,
            Some(0)
        );
        fs::read(folder.path().join(out).join("path.csv")).unwrap()
    };
    assert_eq!(bytes("1"), bytes("2"));
}

#[test]
fn more_threads_than_cores_can_be_of_use_to_are_refused() {
    let folder = folder(&["short"]);
    let cores = std::thread::available_parallelism().unwrap().get();
    let many = (16 * cores + 1).to_string();
    for command in [["run", "short.json"], ["relax", "short.json"]] {
        let (code, _, said) = spinneb(folder.path(), &[&command[..], &["--threads", &many]].concat());
        assert_eq!(code, Some(2), "{said}");
        let most = 16 * cores;
        let words = format!(
            "error: --threads: found {many}, but this machine has {cores} cores: at most 16 threads a core, {most} in all"
        );
        assert!(said.starts_with(&words), "{said}");
    }
    assert!(!folder.path().join("results").exists());
    let most = (16 * cores).to_string();
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--threads", &most]).0, Some(0));
}

#[test]
#[cfg(unix)]
fn a_pipe_or_a_device_in_the_place_of_a_file_is_refused_at_once() {
    let folder = folder(&[]);
    assert!(Command::new("mkfifo").arg(folder.path().join("pipe")).status().unwrap().success());
    fs::write(
        folder.path().join("material.json"),
        CONFIG
            .replace("\"material\": {\"name\": \"toy\", \"energy\": [", "\"material\": \"./pipe\", \"energy\": [")
            .replace("  ]},\n  \"lattice\"", "  ],\n  \"lattice\""),
    )
    .unwrap();
    let spins = |path: &str| {
        CONFIG.replace(r#"{"uniform": {"direction": [0, 0, 1]}}"#, &format!(r#"{{"file": {{"path": "{path}"}}}}"#))
    };
    fs::write(folder.path().join("spins.json"), spins("pipe")).unwrap();
    fs::write(folder.path().join("device.json"), spins("/dev/zero")).unwrap();
    for (config, place, found) in [
        ("pipe", "pipe", "pipe or a device"),
        ("material.json", "material", "pipe or a device"),
        ("spins.json", "initial.file.path", "pipe or a device"),
        ("device.json", "initial.file.path", "pipe or a device"),
        (".", ".", "folder"),
    ] {
        let (code, _, said) = spinneb(folder.path(), &["run", config]);
        assert!(matches!(code, Some(1 | 2)), "{said}");
        assert!(
            said.contains(&format!("{place}: ")) && said.contains(&format!("it is a {found}, not a file")),
            "{said}"
        );
    }
}
