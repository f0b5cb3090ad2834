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
    assert_eq!(code, Some(0), "{said}");
    assert_eq!(out.lines().count(), 1, "{out}");
    assert!(out.starts_with("short: barrier 2.000000 meV forward, 2.000000 meV backward, certified; "), "{out}");
    assert!(out.ends_with("; results in results/short\n") && !said.contains("barrier"), "{out}{said}");
    let summary = folder.path().join("results/short/summary.json");
    let first = fs::read(&summary).unwrap();
    // the line is all there is with --quiet, and the same where the result is there already
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--quiet"]), (Some(0), out, "".into()));
    let (code, out, said) = spinneb(folder.path(), &["run", "short.json", "--json"]);
    assert_eq!((code, out.lines().count()), (Some(0), 1));
    assert!(said.starts_with("short: results/short holds the finished result of this config already"), "{said}");
    let line: Value = serde_json::from_str(&out).unwrap();
    assert!((line["barrier_meV"]["forward"].as_f64().unwrap() - 2.0).abs() < 1e-9);
    assert_eq!((&line["name"], &line["exit_code"]), (&"short".into(), &0.into()));
    assert_eq!((&line["directory"], &line["converged"]), (&"results/short".into(), &true.into()));
    let stored: Value = serde_json::from_slice(&first).unwrap();
    assert_eq!((&line["warnings"], line.get("stop_code")), (&stored["warnings"], stored.get("stop_code")));
    assert_eq!(fs::read(&summary).unwrap(), first);
    assert_eq!(spinneb(folder.path(), &["run", "short.json", "--resume"]).0, Some(0));
    assert_eq!(fs::read(&summary).unwrap(), first);
}

#[test]
fn ends_that_fall_from_maxima_by_a_quarter_turn_are_told_once_each_and_in_the_line() {
    let folder = folder(&["short"]);
    let hard = ["run", "short.json", "--set", "material.energy[1].anisotropy.K=\"-0.5 meV\"", "--json"];
    let (code, out, said) = spinneb(folder.path(), &hard);
    assert_eq!(code, Some(0), "{said}");
    let line: Value = serde_json::from_str(&out).unwrap();
    for end in ["initial", "final"] {
        let of_end = |w: &&Value| w.as_str().unwrap().starts_with(&format!("the {end} state"));
        let own: Vec<&Value> = line["warnings"].as_array().unwrap().iter().filter(of_end).collect();
        let [told] = own[..] else { panic!("{own:?}") };
        let told = told.as_str().unwrap();
        assert!(told.contains("where it is no minimum") && told.contains("a spin turned by 90 degrees"), "{told}");
    }
    let (_, out, _) = spinneb(folder.path(), &["run", hard[1], hard[2], hard[3], "--quiet"]);
    assert!(out.contains("the initial state relaxed far from where it was put (a spin turned by 90°)"), "{out}");
}

#[test]
fn a_command_that_there_is_not_is_told_the_one_that_was_meant() {
    let folder = folder(&[]);
    let (code, _, said) = spinneb(folder.path(), &["rnu", "short.json"]);
    assert!(code == Some(2) && said.contains("'run'"), "{said}");
}

#[test]
#[cfg(target_os = "linux")]
fn a_standard_output_that_cannot_be_written_is_an_error_that_names_it() {
    let folder = folder(&[]);
    for arguments in [&["--help"][..], &["--version"], &["run", "--help"], &["list", "terms"]] {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
        let done = command.current_dir(folder.path()).args(arguments).stdout(full).output().unwrap();
        let said = String::from_utf8(done.stderr).unwrap();
        assert_eq!(done.status.code(), Some(1), "{arguments:?}: {said}");
        assert!(said.starts_with("error: the standard output cannot be written: No space left"), "{said}");
    }
}

#[test]
fn the_result_of_another_file_is_replaced_only_by_force() {
    let folder = folder(&["short", "other"]);
    let into = ["--out", "out", "--quiet"];
    assert_eq!(spinneb(folder.path(), &[&["run", "short.json"][..], &into].concat()).0, Some(0));
    let other = [&["run", "other.json", "--set", "lattice.chain.sites=5"][..], &into].concat();
    let (code, _, said) = spinneb(folder.path(), &other);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: out: holds a result of another config; use --force"), "{said}");
    assert_eq!(spinneb(folder.path(), &[&other[..], &["--force"]].concat()).0, Some(0));
    assert!(!folder.path().join("out.1").exists());
}

#[test]
fn an_edited_config_is_run_again_and_its_earlier_result_is_kept() {
    let folder = folder(&["short"]);
    let sites = |place: &str| {
        let read = |file: &str| fs::read_to_string(folder.path().join(place).join(file)).unwrap();
        let config: Value = serde_json::from_str(&read("config.json")).unwrap();
        let summary: Value = serde_json::from_str(&read("summary.json")).unwrap();
        (config["lattice"]["chain"]["sites"].as_u64().unwrap(), summary["manifest"]["earlier_of"].clone())
    };
    assert_eq!(spinneb(folder.path(), &["run", "short.json"]).0, Some(0));
    fs::write(folder.path().join("results/short/notes.txt"), "mine").unwrap();
    for (n, before) in [(5, 4), (6, 5)] {
        fs::write(folder.path().join("short.json"), CONFIG.replace("\"sites\": 4", &format!("\"sites\": {n}")))
            .unwrap();
        let (code, _, said) = spinneb(folder.path(), &["run", "short.json"]);
        assert_eq!(code, Some(0), "{said}");
        let gave_way = if before == 4 { "" } else { ", in the place of a still earlier one" };
        assert!(said.contains(&format!("short: the earlier result is kept in results/short.1{gave_way}\n")), "{said}");
        assert_eq!(sites("results/short"), (n, Value::Null));
        assert_eq!(sites("results/short.1"), (before, "short".into()));
    }
    assert_eq!(fs::read_to_string(folder.path().join("results/short/notes.txt")).unwrap(), "mine");
    assert!(!folder.path().join("results/short.1/notes.txt").exists());
    // somebody else's folder of that name is not touched, and nothing runs
    fs::remove_dir_all(folder.path().join("results/short.1")).unwrap();
    fs::create_dir(folder.path().join("results/short.1")).unwrap();
    fs::write(folder.path().join("results/short.1/thesis.tex"), "mine").unwrap();
    let again = ["run", "short.json", "--set", "path.images=7"];
    let (code, out, said) = spinneb(folder.path(), &again);
    assert_eq!((code, out.as_str()), (Some(2), ""));
    assert!(
        said.starts_with("error: results/short.1: is not the earlier result of short that a run keeps; "),
        "{said}"
    );
    assert_eq!(sites("results/short").0, 6);
}

#[test]
fn a_config_from_standard_input_is_run_and_its_result_has_no_source() {
    use std::io::Write;
    use std::process::Stdio;
    let folder = folder(&[]);
    let run = |config: &str, arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
        command.current_dir(folder.path()).args(["run", "-"]).args(arguments);
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(config.as_bytes()).unwrap();
        let done = child.wait_with_output().unwrap();
        let [out, said] = [done.stdout, done.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        (done.status.code(), out, said)
    };
    let (code, out, said) = run(CONFIG, &["--quiet"]);
    assert_eq!((code, said.as_str()), (Some(0), ""));
    assert!(out.starts_with("stdin: barrier 2.000000 meV forward"), "{out}");
    let summary = fs::read(folder.path().join("results/stdin/summary.json")).unwrap();
    assert_eq!(serde_json::from_slice::<Value>(&summary).unwrap()["manifest"]["source"], Value::Null);
    // another one is another config, for all that is known
    let (code, _, said) = run(&CONFIG.replace("\"sites\": 4", "\"sites\": 5"), &[]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: results/stdin: holds a result of another config"), "{said}");
    let (code, _, said) = run(&CONFIG.replace("final", "finall"), &[]);
    assert_eq!(code, Some(2));
    assert!(said.starts_with("error: stdin:8:3: finall: unknown key"), "{said}");
    // what it names is looked for in the working directory
    fs::write(folder.path().join("start.csv"), "0,0,1\n0,0,1\n0,0,1\n0,0,1\n").unwrap();
    let from_file = CONFIG.replace(r#"{"uniform": {"direction": [0, 0, 1]}}"#, r#"{"file": {"path": "start.csv"}}"#);
    assert_eq!(run(&from_file, &["--out", "named"]).0, Some(0));
}

#[test]
fn files_of_the_user_are_neither_replaced_nor_taken_away() {
    let folder = folder(&[]);
    let here = folder.path();
    // a config and spins of one's own where the result is to go, with the names of its files
    fs::create_dir(here.join("inputs")).unwrap();
    fs::write(here.join("inputs/start.csv"), "0,0,1\n0,0,1\n0,0,1\n0,0,1\n").unwrap();
    let config =
        CONFIG.replace(r#"{"uniform": {"direction": [0, 0, 1]}}"#, r#"{"file": {"path": "inputs/start.csv"}}"#);
    fs::write(here.join("config.json"), &config).unwrap();
    fs::write(here.join("wall.json"), &config).unwrap();
    fs::write(here.join("path.csv"), "mine").unwrap();
    let (code, _, said) = spinneb(here, &["run", "wall.json", "--out", "."]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("path.csv: is there, was not written by an earlier run"), "{said}");
    fs::remove_file(here.join("path.csv")).unwrap();
    for force in [&[][..], &["--force"]] {
        let (code, _, said) = spinneb(here, &[&["run", "config.json", "--out", "."], force].concat());
        assert_eq!(code, Some(2), "{said}");
        assert!(said.contains("config.json: "), "{said}");
    }
    fs::remove_file(here.join("config.json")).unwrap();
    let run = ["run", "wall.json", "--out", ".", "--quiet"];
    assert_eq!(spinneb(here, &run).0, Some(0));
    // one more run into the same folder, which 0.1.0 emptied of all inputs
    assert_eq!(spinneb(here, &[&run[..], &["--set", "path.images=7", "--force"]].concat()).0, Some(0));
    assert_eq!(fs::read_to_string(here.join("wall.json")).unwrap(), config);
    assert!(here.join("inputs/start.csv").is_file() && here.join("inputs/initial.npy").is_file());
    // the spins of a result are not replaced by a run that starts from them
    fs::write(here.join("next.json"), config.replace("start.csv", "initial.npy")).unwrap();
    let (code, _, said) =
        spinneb(here, &["run", "next.json", "--out", ".", "--set", "final.uniform.direction=[0,1,-1]", "--force"]);
    assert_eq!(code, Some(0), "the very same spins: {said}");
}

#[test]
#[cfg(unix)]
fn a_checkpoint_or_a_lock_that_is_a_link_or_no_checkpoint_stops_a_run_before_its_work() {
    let folder = folder(&["short"]);
    let (home, out) = (folder.path().join("home"), folder.path().join("results/short"));
    fs::create_dir_all(&out).unwrap();
    fs::create_dir(&home).unwrap();
    let precious = ["journal", "snapshot", ".spinneb-unfinished-abcdef"].map(|name| home.join(name));
    precious.iter().for_each(|file| fs::write(file, "mine").unwrap());
    for (link, target) in [("checkpoint", &home), (".spinneb.lock", &precious[0]), ("inputs", &home)] {
        std::os::unix::fs::symlink(target, out.join(link)).unwrap();
        for force in [&[][..], &["--force"]] {
            let (code, _, said) = spinneb(folder.path(), &[&["run", "short.json"], force].concat());
            // no file of this config goes to inputs
            assert_eq!(code, Some(if link == "inputs" { 0 } else { 2 }), "{said}");
        }
        fs::remove_file(out.join(link)).unwrap();
    }
    fs::remove_dir_all(&out).unwrap();
    fs::create_dir_all(out.join("checkpoint")).unwrap();
    fs::write(out.join("checkpoint/journal"), "mine").unwrap();
    let (code, _, said) = spinneb(folder.path(), &["run", "short.json"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("checkpoint/journal: is there and is no checkpoint"), "{said}");
    for file in precious.iter().chain([&out.join("checkpoint/journal")]) {
        assert_eq!(fs::read_to_string(file).unwrap(), "mine");
    }
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
    assert!(said.starts_with("error: two.json:8:3: finall: unknown key"), "{said}");
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
        ("pipe", "pipe", "pipe or a device, not a file; to read the standard input, give - in its place"),
        ("material.json", "material", "pipe or a device"),
        ("spins.json", "initial.file.path", "pipe or a device"),
        ("device.json", "initial.file.path", "pipe or a device"),
        (".", ".", "folder"),
    ] {
        let (code, _, said) = spinneb(folder.path(), &["run", config]);
        assert!(matches!(code, Some(1 | 2)), "{said}");
        assert!(said.contains(&format!("{place}: ")) && said.contains(&format!("it is a {found}")), "{said}");
    }
}
