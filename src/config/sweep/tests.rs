use super::*;
use std::fs;

const CONFIG: &str = r#"{
  "material": {"name": "toy", "moment": "2 mu_B", "energy": [{"exchange": {"J": ["10 meV"]}}]},
  "lattice": {"chain": {"sites": 4}},
  "energy": [{"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}],
  "initial": {"uniform": {"direction": [0, 0, 1]}},
  "final": {"uniform": {"direction": [0, 0, -1]}}
}"#;

/// A sweep of the config by a file with this content.
fn sweep(text: &str) -> (tempfile::TempDir, Result<Sweep>) {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("chain.json"), CONFIG).unwrap();
    let path = dir.path().join("many.json");
    fs::write(&path, text).unwrap();
    let sweep = Sweep::load(&path);
    (dir, sweep)
}

const GRID: &str = r#"{"config": "chain.json", "grid": {
  "lattice.chain.sites": [3, 5],
  "energy[0].anisotropy.K": {"from": "0.1 meV", "to": "0.3 meV", "points": 3}}}"#;

/// What is said of a sweep that is wrong, without the folder.
fn said(text: &str) -> String {
    let (dir, sweep) = sweep(text);
    let all = sweep.and_then(|s| (0..s.len()).try_for_each(|k| s.problem(k, &s.load_point(k)?).map(|_| ())));
    let said = all.expect_err("a wrong sweep").to_string();
    said.replace(&format!("{}{}", dir.path().display(), std::path::MAIN_SEPARATOR), "")
}

#[test]
fn a_grid_takes_every_value_with_every_other_in_the_order_of_the_file() {
    let (_dir, sweep) = sweep(GRID);
    let sweep = sweep.unwrap();
    assert_eq!((sweep.name.as_str(), sweep.len()), ("many", 6));
    let names: Vec<&str> = (0..6).map(|k| sweep.directory(k)).collect();
    let [a, b, c] = ["sites_3__K_0.1meV", "sites_3__K_0.2meV", "sites_3__K_0.3meV"];
    assert_eq!(names, [a, b, c, "sites_5__K_0.1meV", "sites_5__K_0.2meV", "sites_5__K_0.3meV"]);
    for (k, sites, mev) in [(0, 3, 0.1), (4, 5, 0.2)] {
        let loaded = sweep.load_point(k).unwrap();
        assert_eq!((loaded.name.as_str(), loaded.lattice.sites), (names[k], sites));
        let problem = sweep.problem(k, &loaded).unwrap();
        let energies = problem.hamiltonian.energies_mev(problem.initial.as_slice());
        assert_eq!(energies[1], ("anisotropy", -mev * sites as f64));
    }
}

#[test]
fn a_zip_takes_values_together() {
    let zip = GRID.replace("grid", "zip").replace("[3, 5]", "[3, 5, 7]");
    let (_dir, sweep) = sweep(&zip);
    let sweep = sweep.unwrap();
    let names: Vec<&str> = (0..sweep.len()).map(|k| sweep.directory(k)).collect();
    assert_eq!(names, ["sites_3__K_0.1meV", "sites_5__K_0.2meV", "sites_7__K_0.3meV"]);
    assert!(said(&GRID.replace("grid", "zip")).contains("3:29: zip[\"energy[0].anisotropy.K\"]: found 3 values"));
}

#[test]
fn a_point_keeps_its_folder_and_its_hash_when_others_are_added() {
    let hashes = |text: &str| {
        let (_dir, sweep) = sweep(text);
        let sweep = sweep.unwrap();
        let one = |k| (sweep.directory(k).to_string(), sweep.load_point(k).unwrap().sha256);
        (0..sweep.len()).map(one).collect::<Vec<_>>()
    };
    let (few, many) = (hashes(GRID), hashes(&GRID.replace("[3, 5]", "[2, 3, 4, 5]")));
    assert!(few.iter().all(|point| many.contains(point)));
    assert_ne!(few[0].1, few[1].1);
}

#[test]
fn set_changes_all_points() {
    let (_dir, sweep) =
        sweep(&GRID.replace("\"grid\"", "\"set\": {\"path.images\": 9, \"output.plots\": []}, \"grid\""));
    let loaded = sweep.unwrap().load_point(5).unwrap();
    assert!(loaded.config.output.plots.is_empty());
    assert_eq!(loaded.config.path.images.0, crate::drive::Images::Count(9));
}

#[test]
fn folders_of_values_that_no_name_can_have_differ_by_a_hash() {
    let (_dir, sweep) = sweep(
        r#"{"config": "chain.json", "grid": {"energy[0].anisotropy.axis": [[0, 0, 1], [0, 1, 0]],
            "energy[0].anisotropy.K": ["1 mJ", "1 MJ"]}}"#,
    );
    let sweep = sweep.unwrap();
    let names: Vec<&str> = (0..4).map(|k| sweep.directory(k)).collect();
    assert!(names[0].starts_with("axis_-0-0-1-__K_1mJ-"), "{names:?}");
    let lower: std::collections::BTreeSet<String> = names.iter().map(|n| n.to_lowercase()).collect();
    assert_eq!(lower.len(), 4);
    assert!(names.iter().all(|n| Name::new(n).is_ok()));
}

#[test]
fn keys_are_labelled_by_the_shortest_end_that_tells_them_apart() {
    let labels = |grid: &str| {
        let (_dir, sweep) = sweep(&format!(r#"{{"config": "chain.json", "grid": {grid}}}"#));
        sweep.unwrap().keys.into_iter().map(|k| k.label).collect::<Vec<_>>()
    };
    assert_eq!(labels(r#"{"energy[0].anisotropy.axis[2]": [1], "energy.0.anisotropy.K": [1]}"#), ["axis_z", "K"]);
    let vectors = r#"{"energy[1].zeeman.B[2]": [1], "initial.skyrmion.center[0]": [1], "final.uniform.direction.1": [1],
        "energy[2].pairs.bonds[3].D[0]": [1], "initial.regions.pin.uniform.direction[2]": [1]}"#;
    assert_eq!(labels(vectors), ["B_z", "center_x", "direction_y", "D_x", "direction_z"]);
    let lists = r#"{"energy[0].exchange.J[1]": [1], "lattice.square.cells[0]": [1], "energy[1].dmi.D[2]": [1]}"#;
    assert_eq!(labels(lists), ["J[1]", "cells[0]", "D[2]"]);
    let two = r#"{"energy[0].anisotropy.K": [1], "energy[1].anisotropy.K": [1], "a.b": [2], "c.b": [2]}"#;
    assert_eq!(labels(two), ["energy[0].anisotropy.K", "energy[1].anisotropy.K", "a.b", "c.b"]);
}

#[test]
fn what_is_wrong_with_a_value_or_a_key_is_said_where_it_stands_in_the_sweep() {
    let grid = |members: &str| said(&format!("{{\"config\": \"chain.json\",\n \"grid\": {{{members}}}}}"));
    let key = "2:11: grid";
    for (members, place, words) in [
        (
            r#""energy[0].anisotropy.K": ["0.1 meV", "0.1 T"]"#,
            "2:49: grid[\"energy[0].anisotropy.K\"][1]: chain.json: energy[0].anisotropy.K: ",
            "\"0.1 T\" is a magnetic field, but an energy per site or per volume is wanted here",
        ),
        (
            r#""energy[0].anisotropy.K": {"from": "0.1 T", "to": "1 T", "points": 3}"#,
            "2:37: grid[\"energy[0].anisotropy.K\"]: with \"0.1 T\", chain.json: energy[0].anisotropy.K: ",
            "is a magnetic field",
        ),
        (
            r#""energy[0].anisotropi.K": ["0.1 meV"]"#,
            key,
            "chain.json has no \"anisotropi\" there: did you mean \"anisotropy\"?",
        ),
        (r#""path.imagse": [11]"#, key, "unknown key \"imagse\": did you mean \"images\"?"),
        (r#""energy[3].anisotropy.K": ["0.1 meV"]"#, key, "energy ends with [0]: there is no [3]"),
        (r#""lattice.chain.sites": [10, 3.5]"#, "2:39: grid[\"lattice.chain.sites\"][1]", "whole number"),
        (r#""a..b": [1]"#, key, "\"a..b\" is not a path of keys"),
        (r#""name": ["a"]"#, "grid.name: ", "cannot be swept"),
        (
            r#""lattice.chain.sites": [5], "lattice.chain": [1]"#,
            ":39: ",
            "this key and \"lattice.chain.sites\" set the same value",
        ),
        (
            r#""energy[0].anisotropy.K": [1], "energy.0.anisotropy.K": [1]"#,
            ":42: ",
            "this is the key \"energy[0].anisotropy.K\" again",
        ),
        ("", "2:10: grid: ", "no key is swept"),
        (r#""final.uniform.direction": [[0, 0, 1]]"#, "grid[\"final.uniform.direction\"][0]", "are identical"),
    ] {
        let said = grid(members);
        assert!(said.starts_with("many.json:") && said.contains(place) && said.contains(words), "{said}");
    }
}

#[test]
fn what_is_wrong_with_the_file_is_said_at_its_place() {
    for (text, words) in [
        (r#"{"config": "chain.json"}"#, "neither \"grid\" nor \"zip\" is there"),
        (r#"{"config": "chain.json", "grid": {"a": [1]}, "zip": {"a": [1]}}"#, ":53: zip: found \"grid\" and \"zip\""),
        (r#"{"config": "chian.json", "grid": {"a": [1]}}"#, ":12: config: the config chian.json cannot be read"),
        (r#"{"confg": "chain.json", "grid": {"a": [1]}}"#, "unknown key \"confg\": did you mean \"config\"?"),
        (r#"{"config": "chain.json", "grid": {"a.b": {"from": 1, "to": 2, "point": 3}}}"#, "did you mean \"points\"?"),
        (
            r#"{"config": "chain.json", "set": {"a..b": 1}, "grid": {"a": [1]}}"#,
            "set[\"a..b\"]: \"a..b\" is not a path",
        ),
        (
            r#"{"config": "chain.json", "grid": {"lattice.chain.sites": {"from": 1, "to": 2e5, "points": 1e5}}}"#,
            "points",
        ),
        (
            r#"{"config": "chain.json", "set": {"energy.0.anisotropy.K": 1}, "grid": {"energy[0].anisotropy.K": [1]}}"#,
            "every point sets this by \"energy[0].anisotropy.K\" again",
        ),
    ] {
        let said = said(text);
        assert!(said.starts_with("many.json:1:") && said.contains(words), "{said}");
    }
}
