//! The README tells the truth: its commands, configs, files, keys and numbers are those of the program.

use serde_json::Value;
use spinneb::output::canvas::{Colour, diverging};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn text(file: &str) -> String {
    fs::read_to_string(root().join(file)).unwrap_or_else(|e| panic!("{file}: {e}")).replace("\r\n", "\n")
}

fn json(file: &Path) -> Value {
    serde_json::from_slice(&fs::read(file).unwrap()).unwrap()
}

/// The fenced blocks of the README in this language.
fn blocks(language: &str) -> Vec<String> {
    let readme = text("README.md");
    let mut parts = readme.split("```");
    parts.next();
    let mut found = Vec::new();
    while let (Some(block), Some(_)) = (parts.next(), parts.next()) {
        let (tag, content) = block.split_once('\n').unwrap();
        assert!(
            ["sh", "json", "rust", "text", "python"].contains(&tag),
            "a block is tagged {tag:?}: rustdoc would compile it"
        );
        if tag == language {
            found.push(content.to_string());
        }
    }
    found
}

/// The cells of the README's tables, a row each, under this heading; headings and rules of the tables included.
fn rows(heading: &str) -> Vec<Vec<String>> {
    let readme = text("README.md");
    let (_, section) =
        readme.split_once(&format!("\n## {heading}\n")).unwrap_or_else(|| panic!("no section {heading}"));
    let section = section.split("\n## ").next().unwrap();
    let cells = |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect();
    section.lines().filter(|line| line.starts_with('|')).map(cells).collect()
}

/// What stands in `backticks`.
fn quoted(words: &str) -> Vec<String> {
    words.split('`').skip(1).step_by(2).map(String::from).collect()
}

/// Runs the program in the folder of the crate; its exit code and what it said.
fn spinneb(arguments: &[&str]) -> (Option<i32>, String) {
    let done = Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(root()).args(arguments).output().unwrap();
    (done.status.code(), String::from_utf8(done.stderr).unwrap())
}

/// Runs a config into a folder.
fn run(config: &Path, out: &Path) {
    let (code, said) = spinneb(&["run", config.to_str().unwrap(), "--out", out.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{said}");
}

/// All keys of objects in a JSON value.
fn keys(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(members) => members.iter().for_each(|(key, value)| {
            found.insert(key.clone());
            keys(value, found);
        }),
        Value::Array(values) => values.iter().for_each(|value| keys(value, found)),
        _ => {}
    }
}

#[test]
fn the_two_commands_are_those_of_the_gate() {
    let blocks = blocks("sh");
    let commands: Vec<&str> = blocks[0].lines().collect();
    assert_eq!(commands, ["cargo run --release -- run configs/wall_nucleation.json", "cargo test --release"]);
    let gate = text(".ci/run");
    for command in commands {
        let is_it = |line: &str| line.strip_prefix("stage ").is_some_and(|l| l.trim_end_matches(" --force") == command);
        assert!(gate.lines().any(is_it), "{command} is no stage of .ci/run");
    }
}

#[test]
fn the_table_of_configs_has_every_shipped_config_and_its_barriers() {
    let mut listed = BTreeMap::new();
    for row in rows("The shipped configs").into_iter().skip(2) {
        let name = quoted(&row[0]).remove(0);
        assert_eq!(row[0], format!("[`{name}`](configs/{name}.json)"));
        assert!(row[2].len() > 60, "{name}: a purpose is a paragraph");
        listed.insert(name, row[1].clone());
    }
    let files = fs::read_dir(root().join("configs")).unwrap().map(|e| e.unwrap().path());
    let shipped: BTreeSet<String> = files
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_string())
        .collect();
    assert_eq!(listed.keys().cloned().collect::<BTreeSet<_>>(), shipped);
    let temporary = tempfile::tempdir().unwrap();
    for (name, stated) in listed {
        let out = temporary.path().join(&name);
        let config = root().join("configs").join(format!("{name}.json"));
        let (config, folder) = (config.to_str().unwrap(), out.to_str().unwrap());
        let (code, said) = spinneb(&["run", config, "--out", folder, "--set", "output.plots=[]"]);
        assert_eq!(code, Some(0), "{said}");
        let barrier = &json(&out.join("summary.json"))["barrier_meV"];
        let [forward, backward] = ["forward", "backward"].map(|way| barrier[way].as_f64().unwrap());
        assert_eq!(stated, format!("{forward:.6} / {backward:.6}"), "{name}");
    }
}

#[test]
fn the_json_blocks_are_a_config_that_checks_and_runs_and_its_material() {
    let blocks = blocks("json");
    assert_eq!(blocks.len(), 2);
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path();
    fs::create_dir(folder.join("materials")).unwrap();
    let (config, material) = (folder.join("explained.json"), folder.join("materials/toy.json"));
    fs::write(&config, &blocks[0]).unwrap();
    fs::write(&material, &blocks[1]).unwrap();
    assert_eq!(json(&material), json(&root().join("configs/materials/toy.json")));
    let (code, said) = spinneb(&["check", config.to_str().unwrap()]);
    assert_eq!(code, Some(0), "{said}");
    run(&config, &folder.join("out"));
    run(&root().join("configs/wall_depinning.json"), &folder.join("shipped"));
    let barrier = |result: &str| json(&folder.join(result).join("summary.json"))["barrier_meV"].clone();
    assert_eq!(barrier("out"), barrier("shipped"));
    let explained = json(&config);
    let told: Vec<String> = rows("A config, line by line").iter().flat_map(|row| quoted(&row[0])).collect();
    assert_eq!(explained.as_object().unwrap().keys().collect::<BTreeSet<_>>(), told.iter().collect());
}

#[test]
fn a_run_writes_the_files_the_keys_and_the_barrier_that_are_told() {
    let temporary = tempfile::tempdir().unwrap();
    let out = temporary.path().join("wall_nucleation");
    run(&root().join("configs/wall_nucleation.json"), &out);
    let tables = rows("Results");
    let first = |from: &str| tables.iter().position(|row| row[0] == from).unwrap_or_else(|| panic!("no table {from}"));
    let (files, keys_from, codes) = (first("file"), first("key"), first("exit code"));

    let told: BTreeSet<String> = tables[files..keys_from].iter().flat_map(|row| quoted(&row[0])).collect();
    let written = fs::read_dir(&out).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(told, written);

    let summary = json(&out.join("summary.json"));
    let told: BTreeSet<String> = tables[keys_from..codes].iter().flat_map(|row| quoted(&row[0])).collect();
    assert_eq!(told, summary.as_object().unwrap().keys().cloned().collect());
    let inner: BTreeSet<String> = tables[keys_from..codes].iter().flat_map(|row| quoted(&row.join(" "))).collect();
    let mut all = BTreeSet::new();
    let mut without = summary.clone();
    // the keys of this one are names of files
    without["manifest"]["files"].take();
    keys(&without, &mut all);
    assert_eq!(all.difference(&inner).collect::<Vec<_>>(), Vec::<&String>::new(), "keys the README does not explain");

    let readme = text("README.md");
    let forward = |summary: &Value| summary["barrier_meV"]["forward"].as_f64().unwrap();
    for digits in [6, 9] {
        let number = format!("{:.digits$} meV", forward(&summary));
        assert!(readme.contains(&number), "the README does not say {number}");
    }
    let stored = json(&root().join("results/gallery/wall_nucleation/summary.json"));
    assert!((forward(&stored) - forward(&summary)).abs() < 1e-9, "the result in the gallery is another one");
    assert_eq!((&stored["config_sha256"], &stored["version"]), (&summary["config_sha256"], &summary["version"]));
    assert_eq!(stored["certified"], summary["certified"]);
}

#[test]
fn what_is_linked_exists_and_the_rust_version_is_that_of_the_package() {
    let readme = text("README.md");
    let links = readme.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
    for link in links.filter(|link| !link.starts_with("https://")) {
        assert!(root().join(link).is_file(), "{link}");
    }
    let version = env!("CARGO_PKG_RUST_VERSION");
    assert_eq!(readme.matches(&format!("{version} or later")).count(), 2, "{version}");
    assert_eq!(readme.matches(" or later").count(), 2);
}

#[test]
fn the_colours_of_the_notebook_are_those_of_the_figures() {
    let notebook = &blocks("python")[0];
    let (_, rest) = notebook.split_once("hues = \"").unwrap();
    let hues: Vec<&str> = rest.split('"').next().unwrap().split(' ').collect();
    let own = |k: usize| {
        let Colour(r, g, b) = diverging(2.0 * k as f64 / (hues.len() - 1) as f64 - 1.0);
        format!("#{r:02x}{g:02x}{b:02x}")
    };
    assert!(hues.len() >= 9 && (0..hues.len()).all(|k| hues[k] == own(k)), "{hues:?}");
}
