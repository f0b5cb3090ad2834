//! `spinneb landscape --index` and `collect`: one search by several processes, however they come and go.

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};

/// Walls that stop at weak sites: some minima, and passes between them.
const CONFIG: &str = r#"{"material": {"name": "toy", "moment": "2 mu_B", "energy": [{"exchange": {"J": ["2 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}, {"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}]},
    "energy": [{"anisotropy": {"K": "-0.3 meV", "axis": [0, 0, 1], "sites": [3, 8]}}],
    "lattice": {"chain": {"sites": 12}}, "landscape": {"energy_window": "4 meV", "effort": "quick", "temperatures": ["1 K", "2 K"]}}"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("chain.json"), CONFIG).unwrap();
    folder
}

fn spinneb(folder: &Path, arguments: &str) -> (Option<i32>, String, String) {
    let arguments = arguments.split_whitespace();
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

/// It ends well; what it says on stdout.
fn done(folder: &Path, arguments: &str) -> String {
    let (code, out, said) = spinneb(folder, arguments);
    assert_eq!(code, Some(0), "{arguments}: {out}{said}");
    out
}

/// All files of a folder and of those in it.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let name = entry.file_name().unwrap().to_string_lossy().into_owned();
        match entry.is_dir() {
            true => found.extend(files(&entry).into_iter().map(|(own, bytes)| (format!("{name}/{own}"), bytes))),
            false => drop(found.insert(name, fs::read(&entry).unwrap())),
        }
    }
    found
}

fn same(a: &Path, b: &Path) {
    let [a, b] = [a, b].map(files);
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (name, bytes) in &a {
        assert!(*bytes == b[name], "{name}");
    }
}

#[test]
fn one_share_is_a_search_alone() {
    let folder = folder();
    let here = folder.path();
    done(here, "landscape chain.json --out alone -q");
    let out = done(here, "landscape chain.json --out shared --index 0/1 -q");
    assert!(out.contains("all 1 shares are at their end"), "{out}");
    done(here, "collect chain.json --out shared -q");
    same(&here.join("alone"), &here.join("shared"));
}

#[test]
fn shares_make_the_same_results_whoever_makes_them_and_whoever_is_missing() {
    let folder = folder();
    let here = folder.path();
    done(here, "landscape chain.json --out alone --index 0-2/3 -q");
    done(here, "collect alone -q");
    let document: Value = serde_json::from_slice(&fs::read(here.join("alone/landscape.json")).unwrap()).unwrap();
    assert_eq!(document["search"]["shares"], 3);
    assert!(document["minima"].as_array().unwrap().len() > 1, "{}", document["minima"]);
    // three at a time
    let children: Vec<_> = (0..3)
        .map(|k| {
            let index = format!("{k}/3");
            let arguments = ["landscape", "chain.json", "--out", "three", "--index", &index, "--threads", "1", "-q"];
            let mut command = Command::new(env!("CARGO_BIN_EXE_spinneb"));
            command.current_dir(here).args(arguments).stdout(Stdio::null()).spawn().unwrap()
        })
        .collect();
    for mut child in children {
        assert!(child.wait().unwrap().success());
    }
    let line: Value = serde_json::from_str(&done(here, "collect three --json -q")).unwrap();
    assert_eq!(line["finished"], true);
    same(&here.join("alone"), &here.join("three"));
    // one of three alone makes the others' shares too, once they do not come
    done(here, "landscape chain.json --out one --index 1/3 -q");
    let (code, _, said) = spinneb(here, "landscape chain.json --out one --index 2/3");
    assert_eq!(code, Some(0), "{said}");
    done(here, "collect one -q");
    same(&here.join("alone"), &here.join("one"));
    // what is finished stays
    let (code, out, said) = spinneb(here, "landscape chain.json --out one --index 1/3");
    assert!(code == Some(0) && said.contains("holds the finished result") && out.contains("minima of"), "{said}");
    assert!(!here.join("one/shares").exists());
}

#[test]
fn damaged_shares_are_made_anew_and_unfinished_ones_are_not_collected() {
    let folder = folder();
    let here = folder.path();
    done(here, "landscape chain.json --out alone --index 0-1/2 -q");
    let shares = here.join("alone/shares");
    let parts: Vec<String> = files(&shares).into_keys().filter(|name| name.contains(".1")).collect();
    assert!(parts.len() > 2, "{parts:?}");
    fs::remove_file(shares.join("done")).unwrap();
    let (code, _, said) = spinneb(here, "collect alone");
    assert!(code == Some(3) && said.contains("is not at its end") && said.contains("--index 0-1/2"), "{code:?} {said}");
    assert!(!here.join("alone/summary.json").exists());
    // one is cut off, one lost, one empty
    let cut = fs::read(shares.join(&parts[0])).unwrap();
    fs::write(shares.join(&parts[0]), &cut[..cut.len() / 2]).unwrap();
    fs::remove_file(shares.join(&parts[1])).unwrap();
    fs::write(shares.join(&parts[2]), "").unwrap();
    let (code, _, said) = spinneb(here, "landscape chain.json --out alone --index 0/2");
    assert!(code == Some(0) && said.contains("is damaged and made anew"), "{code:?} {said}");
    done(here, "collect alone -q");
    done(here, "landscape chain.json --out other --index 0-1/2 -q");
    done(here, "collect other -q");
    same(&here.join("alone"), &here.join("other"));
}

#[test]
fn shares_of_something_else_are_refused() {
    let folder = folder();
    let here = folder.path();
    let refused = |arguments: &str, words: &str| {
        let (code, _, said) = spinneb(here, arguments);
        assert!(code == Some(2) && said.contains(words), "{arguments}: {code:?} {said}");
    };
    for (index, words) in
        [("3", "a share and how many"), ("2/2", "the last is 1"), ("0/0", "1 to 1000"), ("1-0/2", "a share")]
    {
        refused(&format!("landscape chain.json --index {index}"), words);
    }
    refused("landscape chain.json --index 0/2 --resume", "--resume");
    refused("collect chain.json", "has no shares");
    refused("collect .", "is not the folder of a sweep's results");
    done(here, "landscape chain.json --out own --index 0-1/2 -q");
    let before = files(&here.join("own"));
    refused("landscape chain.json --out own --index 0/3", "a run in 2 shares (this is one of 3)");
    refused("landscape chain.json --out own --index 0/2 --set landscape.effort=\"thorough\"", "is of another config");
    fs::write(here.join("own/shares/0"), "mine").unwrap();
    refused("landscape chain.json --out own --index 0/2", "is there and is no share");
    refused("collect own", "is there and is no share");
    assert_eq!(fs::read(here.join("own/shares/0")).unwrap(), b"mine");
    fs::write(here.join("own/shares/0"), &before["shares/0"]).unwrap();
    // a share in the place of another one
    let parts: Vec<&String> = before.keys().filter(|name| name.ends_with(".1")).collect();
    fs::copy(here.join("own").join(parts[0].replace(".1", ".0")), here.join("own").join(parts[0])).unwrap();
    let (code, _, said) = spinneb(here, "landscape chain.json --out own --index 0/2");
    assert!(code == Some(1) && said.contains("does not hold what is computed here"), "{code:?} {said}");
}
