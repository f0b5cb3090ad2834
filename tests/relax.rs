//! `relax` as a user meets it: states by themselves, what is said of them, and files that go back into a config.

use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// A wall that is put five sites beside a weak stretch; there is no final state.
const WALL: &str = r#"{
  "material": {"name": "toy", "energy": [
    {"exchange": {"J": ["10 meV"]}},
    {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}
  ]},
  "lattice": {"chain": {"sites": 30, "spacing": "0.25 nm"}},
  "energy": [{"anisotropy": {"K": "-0.25 meV", "axis": [0, 0, 1], "sites": [15]}}],
  "initial": {"domain_wall": {"center": 12}},
  "output": {"formats": ["npz", "ovf", "ovf_text", "csv", "vtk"]}
}"#;

fn spinneb(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_spinneb")).current_dir(folder).args(arguments).output().unwrap();
    (status.code(), String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap())
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("wall.json"), WALL).unwrap();
    folder
}

/// The lines of JSON of a `relax`.
fn relaxed(folder: &Path, arguments: &[&str]) -> Vec<Value> {
    let (code, out, said) = spinneb(folder, &[&["relax", "wall.json", "--json", "--quiet"], arguments].concat());
    assert_eq!((code, said.as_str()), (Some(0), ""));
    out.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is no number"))
}

#[test]
fn a_wall_relaxes_into_a_weak_stretch_and_is_a_minimum_with_its_rotation_as_zero_mode() {
    let folder = folder();
    let states = relaxed(folder.path(), &[]);
    assert_eq!(states.len(), 1);
    let wall = &states[0];
    assert_eq!((&wall["name"], &wall["state"]), (&"wall".into(), &"initial".into()));
    assert_eq!(
        (&wall["minimum"], &wall["converged"], &wall["left_saddle"]),
        (&true.into(), &true.into(), &false.into())
    );
    let modes = ["negative_modes", "zero_modes", "flat_modes"].map(|key| wall[key].as_u64().unwrap());
    assert_eq!(modes, [0, 1, 0]);
    assert!(number(&wall["energy_meV"]) < number(&wall["energy_as_given_meV"]) - 0.01);
    assert!(number(&wall["max_torque_meV"]) < 1e-12 && number(&wall["max_torque_as_given_meV"]) > 1e-3);
    let terms: f64 = wall["energies_meV"].as_object().unwrap().values().map(number).sum();
    assert!((terms - number(&wall["energy_meV"])).abs() < 1e-9);
    let lowest: Vec<f64> = wall["lowest_eigenvalues_meV"].as_array().unwrap().iter().map(number).collect();
    assert!(lowest.len() == 6 && lowest[0] > 0.0 && lowest.windows(2).all(|w| w[0] <= w[1]), "{lowest:?}");
    // a wall in the weak site: as many sites up as down, but for the site itself, which is the sixteenth of thirty
    let mean = wall["mean_spin"].as_array().unwrap();
    assert!((number(&mean[2]) - 1.0 / 30.0).abs() < 1e-3, "{mean:?}");
    assert_eq!(relaxed(folder.path(), &["--modes", "2"])[0]["lowest_eigenvalues_meV"].as_array().unwrap().len(), 2);
    assert!(!folder.path().join("results").exists());
}

#[test]
fn the_energies_and_modes_are_those_that_a_run_reports_of_its_ends() {
    let folder = folder();
    let uniform = |z: i32| format!("{{\"uniform\": {{\"direction\": [0.3, 0, {z}]}}}}");
    let ends = [format!("initial={}", uniform(1)), format!("final={}", uniform(-1))];
    let sets = ["--set", &ends[0], "--set", &ends[1]];
    let states = relaxed(folder.path(), &sets);
    let (code, _, said) = spinneb(folder.path(), &[&["run", "wall.json"][..], &sets].concat());
    assert_eq!(code, Some(0), "{said}");
    let summary: Value =
        serde_json::from_slice(&fs::read(folder.path().join("results/wall/summary.json")).unwrap()).unwrap();
    for (state, which) in states.iter().zip(["initial", "final"]) {
        assert_eq!(state["state"], which);
        for key in ["energy_meV", "negative_modes"] {
            assert_eq!(state[key], summary[which][key], "{which} {key}");
        }
        // 2K less the weak site's share, above it 2K: a uniform state has no rotation to be free in
        assert_eq!((&state["zero_modes"], &state["flat_modes"]), (&0.into(), &0.into()));
        assert!((0.5..1.0).contains(&number(&state["lowest_eigenvalues_meV"][0])));
    }
}

#[test]
fn relaxed_states_are_written_as_files_that_a_config_reads_again() {
    let folder = folder();
    let (code, out, said) = spinneb(folder.path(), &["relax", "wall.json", "--out", "relaxed"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(out.starts_with("wall\n  initial: a minimum\n    energy      -"), "{out}");
    assert!(
        out.contains("    modes       0 negative, 1 zero (rotations about symmetry axes), 0 flat (below "),
        "{out}"
    );
    let mut files: Vec<String> = fs::read_dir(folder.path().join("relaxed"))
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    files.sort();
    assert_eq!(files, ["initial.csv", "initial.npz", "initial.ovf", "initial.vtp", "initial_text.ovf", "relax.json"]);
    let document: Value = serde_json::from_slice(&fs::read(folder.path().join("relaxed/relax.json")).unwrap()).unwrap();
    let first = &document["states"][0];
    assert_eq!(first["files"].as_array().unwrap().len(), 5);
    for file in ["initial.csv", "initial.npz", "initial.ovf", "initial_text.ovf"] {
        let set = format!("initial={{\"file\": {{\"path\": \"relaxed/{file}\"}}}}");
        let again = relaxed(folder.path(), &["--set", &set]);
        assert!((number(&again[0]["energy_meV"]) - number(&first["energy_meV"])).abs() < 1e-11, "{file}");
        assert!(number(&again[0]["largest_rotation_rad"]) < 1e-12, "{file}");
    }
}

#[test]
fn nothing_is_replaced_unless_that_is_wished() {
    let folder = folder();
    fs::create_dir(folder.path().join("relaxed")).unwrap();
    let ovf = folder.path().join("relaxed/initial.ovf");
    fs::write(&ovf, "mine").unwrap();
    let arguments = ["relax", "wall.json", "--out", "relaxed", "--quiet"];
    let (code, out, said) = spinneb(folder.path(), &arguments);
    assert_eq!((code, out.as_str()), (Some(2), ""));
    assert!(said.contains("initial.ovf: exists already; use --force to replace it"), "{said}");
    assert_eq!(fs::read_to_string(&ovf).unwrap(), "mine");
    assert!(!folder.path().join("relaxed/relax.json").exists());
    assert_eq!(spinneb(folder.path(), &[&arguments[..], &["--force"]].concat()).0, Some(0));
    assert!(fs::metadata(&ovf).unwrap().len() > 500);
}

#[test]
fn a_state_on_a_saddle_is_left_and_two_states_of_one_minimum_are_told() {
    let folder = folder();
    let sets = [
        "--set",
        "initial={\"uniform\": {\"direction\": [1, 0, 0]}}",
        "--set",
        "final={\"uniform\": {\"direction\": [1, 0, 0]}}",
    ];
    let (code, out, said) = spinneb(folder.path(), &[&["relax", "wall.json"][..], &sets].concat());
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("wall: warning: the initial state came to rest where it is no minimum: the energy falls by"),
        "{said}"
    );
    assert!(out.ends_with("  both states relax to the same minimum\n"), "{out}");
    let states = relaxed(folder.path(), &sets);
    assert!(states.iter().all(|s| s["left_saddle"] == true && s["minimum"] == true));
}

#[test]
fn without_an_anisotropy_a_state_is_free_to_turn_and_still_a_minimum() {
    let folder = folder();
    let free =
        WALL.replace("\"K\": \"0.5 meV\"", "\"K\": \"0 meV\"").replace("\"K\": \"-0.25 meV\"", "\"K\": \"0 meV\"");
    fs::write(folder.path().join("wall.json"), free).unwrap();
    let states = relaxed(folder.path(), &["--set", "initial={\"uniform\": {\"direction\": [0, 1, 0]}}"]);
    let modes = ["negative_modes", "zero_modes", "flat_modes"].map(|key| states[0][key].as_u64().unwrap());
    assert_eq!((modes[0], modes[1] + modes[2], &states[0]["minimum"]), (0, 2, &true.into()));
}

#[test]
fn what_is_wrong_is_said_with_its_place_and_several_configs_have_the_worst_code() {
    let folder = folder();
    for (set, words) in [
        (
            "initial.domain_wall.centre=3",
            "initial.domain_wall.centre: unknown key \"centre\": did you mean \"center\"?",
        ),
        ("finall={}", "finall: unknown key \"finall\": did you mean \"final\"?"),
        ("initial={\"file\": {\"path\": \"none.ovf\"}}", "there is no file none.ovf"),
    ] {
        let (code, out, said) = spinneb(folder.path(), &["relax", "wall.json", "--set", set]);
        assert_eq!((code, out.as_str()), (Some(2), ""), "{said}");
        assert!(said.contains("error: --set ") && said.contains(words), "{said}");
    }
    let (code, out, _) = spinneb(folder.path(), &["relax", "none.json", "wall.json", "--json", "--quiet"]);
    assert_eq!((code, out.lines().count()), (Some(1), 1));
    fs::copy(folder.path().join("wall.json"), folder.path().join("other.json")).unwrap();
    let both = ["relax", "wall.json", "other.json", "--out", "all", "--quiet"];
    assert_eq!(spinneb(folder.path(), &both).0, Some(0));
    assert!(["wall", "other"].iter().all(|name| folder.path().join("all").join(name).join("relax.json").is_file()));
}

/// A wall of the dear handedness between two stretches of weaker K in a film with DMI.
fn dear_wall(weaker: &str) -> String {
    format!(
        r#"{{
  "material": "cobalt_platinum",
  "lattice": {{"chain": {{"sites": 200, "spacing": "1 nm", "cross_section": ["50 nm", "0.4 nm"]}}}},
  "energy": [
    {{"demag": {{}}}},
    {{"anisotropy": {{"K": "{weaker}", "axis": [0, 0, 1], "sites": {{"from": 60, "to": 79}}}}}},
    {{"anisotropy": {{"K": "{weaker}", "axis": [0, 0, 1], "sites": {{"from": 120, "to": 139}}}}}}
  ],
  "initial": {{"domain_wall": {{"center": 69.5, "through": [1, 0, 0]}}}}
}}"#
    )
}

#[test]
fn a_saddle_is_left_where_no_force_leads_away_from_it_and_where_the_way_to_it_is_long() {
    let folder = folder();
    // the relaxation comes to rest on the saddle itself, and crawls along a soft mode beside it
    for weaker in ["-0.2 MJ/m^3", "-0.08 MJ/m^3"] {
        fs::write(folder.path().join("dear.json"), dear_wall(weaker)).unwrap();
        let (code, out, said) = spinneb(folder.path(), &["relax", "dear.json", "--json"]);
        assert_eq!(code, Some(0), "{said}");
        assert!(said.contains("the energy falls by 2.50") && said.contains("most, towards ("), "{said}");
        let state: Value = serde_json::from_str(&out).unwrap();
        assert!(state["minimum"] == true && state["converged"] == true && state["left_saddle"] == true, "{out}");
        assert_eq!(state["negative_modes"], 0);
    }
}

#[test]
fn a_skyrmion_on_top_of_what_its_lattice_holds_it_by_comes_to_rest() {
    let folder = folder();
    let config = r#"{
        "material": {"name": "film", "moment": "2.7 mu_B", "energy": [
            {"exchange": {"J": ["7 meV"]}}, {"dmi": {"D": "2.2 meV", "kind": "interfacial"}},
            {"anisotropy": {"K": "0.8 meV", "axis": [0, 0, 1]}}, {"zeeman": {"B": ["0 T", "0 T", "1.5 T"]}}]},
        "lattice": {"triangular": {"cells": [30, 30], "periodic": true}},
        "initial": {"skyrmion": {"radius": 5, "center": [15, 15]}},
        "final": {"uniform": {"direction": [0, 0, 1]}}
    }"#;
    fs::write(folder.path().join("film.json"), config).unwrap();
    let (code, out, said) = spinneb(folder.path(), &["relax", "film.json", "--json", "--quiet"]);
    assert_eq!(code, Some(0), "{said}");
    let state: Value = serde_json::from_str(out.lines().next().unwrap()).unwrap();
    assert!(state["minimum"] == true && state["converged"] == true, "{state}");
}

#[test]
fn formats_that_only_a_path_has_are_said_not_to_be_written() {
    let folder = folder();
    for (format, code) in [("html", true), ("csv", false), ("npz", false), ("vtk", false), ("ovf_images", false)] {
        let set = format!("output.formats=[\"{format}\"]");
        let (_, _, said) = spinneb(folder.path(), &["relax", "wall.json", "--out", format, "--set", &set]);
        assert_eq!(said.contains(&format!("wall: not written: {format}")), code, "{said}");
        assert_eq!(fs::read_dir(folder.path().join(format)).unwrap().count(), if code { 1 } else { 2 });
    }
    // html is among the formats of a config that names none
    let silent = WALL.replace(r#"["npz", "ovf", "ovf_text", "csv", "vtk"]"#, r#"["csv", "npz", "ovf", "html"]"#);
    fs::write(folder.path().join("wall.json"), silent).unwrap();
    let (_, _, said) = spinneb(folder.path(), &["relax", "wall.json", "--out", "default"]);
    assert!(!said.contains("not written"), "{said}");
}

#[test]
fn vacant_sites_have_no_part_in_the_mean_spin() {
    let folder = folder();
    let config = r#"{
        "material": {"name": "film", "energy": [
            {"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [1, 0, 0]}}]},
        "lattice": {"square": {"cells": [4, 4], "vacant": {"from": 0, "to": 7}}},
        "initial": {"uniform": {"direction": [1, 0, 0.1]}}
    }"#;
    fs::write(folder.path().join("wall.json"), config).unwrap();
    let states = relaxed(folder.path(), &[]);
    assert!((number(&states[0]["mean_spin"][0]) - 1.0).abs() < 1e-12, "{}", states[0]["mean_spin"]);
}

#[test]
fn a_wall_that_an_end_far_away_draws_out_of_the_chain_is_followed_there() {
    let folder = folder();
    let config = r#"{
        "material": {"name": "chain", "moment": "1 mu_B", "energy": [
            {"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}}]},
        "lattice": {"chain": {"sites": 100}},
        "initial": {"domain_wall": {"center": 70.5}},
        "final": {"domain_wall": {"center": 30.5}}
    }"#;
    fs::write(folder.path().join("far.json"), config).unwrap();
    let (code, out, said) = spinneb(folder.path(), &["relax", "far.json", "--json"]);
    assert!(code == Some(0) && said.contains("far from where it was put"), "{said}");
    for line in out.lines() {
        let state: Value = serde_json::from_str(line).unwrap();
        assert!(state["minimum"] == true && (number(&state["energy_meV"]) + 1040.0).abs() < 1e-9, "{state}");
    }
}
