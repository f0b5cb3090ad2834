//! Chains that are not the same everywhere: profiles of parameters, and vacancies.

use serde_json::{Value, json};
use std::process::Command;

/// What `spinneb run` finds for a config: exit code and `summary.json`.
fn run(config: &Value) -> (Option<i32>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let mut config = config.clone();
    config["output"] = json!({"formats": [], "plots": []});
    std::fs::write(folder.path().join("case.json"), config.to_string()).unwrap();
    let done = Command::new(env!("CARGO_BIN_EXE_spinneb"))
        .current_dir(folder.path())
        .args(["run", "case.json", "--quiet"])
        .output()
        .unwrap();
    let text = std::fs::read_to_string(folder.path().join("results/case/summary.json"));
    let text = text.unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&done.stderr)));
    (done.status.code(), serde_json::from_str(&text).unwrap())
}

fn certified(config: &Value) -> f64 {
    let (code, summary) = run(config);
    assert_eq!((code, &summary["certified"]), (Some(0), &Value::Bool(true)), "{summary}");
    summary["barrier_meV"]["forward"].as_f64().unwrap()
}

fn reversal(sites: usize, j: Value, k: Value) -> Value {
    json!({
        "material": {"name": "toy", "moment": "2 mu_B", "energy": [
            {"exchange": {"J": j}},
            {"anisotropy": {"K": k, "axis": [0, 0, 1]}}
        ]},
        "lattice": {"chain": {"sites": sites}},
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}}
    })
}

#[test]
fn equal_values_are_the_same_as_one_value_as_a_list_and_as_a_ramp() {
    let uniform = certified(&reversal(30, json!(["1 meV"]), json!("0.05 meV")));
    let listed = certified(&reversal(30, json!([vec!["1 meV"; 29]]), json!(vec!["0.05 meV"; 30])));
    let ramp = json!({"from": "0.05 meV", "to": "0.05 meV", "shape": "tanh"});
    let ramped = certified(&reversal(30, json!([{"from": "1 meV", "to": "1 meV"}]), ramp));
    assert_eq!((listed, ramped), (uniform, uniform));
}

#[test]
fn in_an_exchange_spring_the_wall_waits_in_the_soft_part_and_must_enter_the_hard_one() {
    // hard and soft half, an abrupt step between them: a wall of the soft part is √(K_s/K_h) of one of the hard part
    let step = json!({"from": "0.02 meV", "to": "0.1 meV", "shape": "step"});
    let spring = certified(&reversal(100, json!(["1 meV"]), step));
    let hard = certified(&reversal(100, json!(["1 meV"]), json!("0.1 meV")));
    let soft = certified(&reversal(100, json!(["1 meV"]), json!("0.02 meV")));
    assert!(soft < spring && spring < hard, "{soft} {spring} {hard}");
    // a graded chain is easier to reverse than the hard one, and no easier than its soft end
    let graded = certified(&reversal(100, json!(["1 meV"]), json!({"from": "0.02 meV", "to": "0.1 meV"})));
    assert!(soft < graded && graded < hard, "{soft} {graded} {hard}");
}

#[test]
fn a_vacancy_makes_two_chains_of_one() {
    // nine spins each: too short for a wall, so each turns as a whole, over 9 K
    let mut config = reversal(19, json!(["1 meV"]), json!("0.05 meV"));
    config["lattice"]["chain"]["vacant"] = json!([9]);
    let barrier = certified(&config);
    assert!((barrier - 0.45).abs() < 1e-10, "{barrier}");
}

#[test]
fn a_vacancy_has_no_dipole() {
    let energy = |vacant: Value, sites: usize| {
        let mut config = reversal(sites, json!(["1 meV"]), json!("0.5 meV"));
        config["lattice"]["chain"]["spacing"] = json!("0.5 nm");
        config["lattice"]["chain"]["vacant"] = vacant;
        config["energy"] = json!([{"dipolar": {}}]);
        certified(&config)
    };
    // at the end of a chain it is as if it were not there
    let (short, long) = (energy(Value::Null, 6), energy(json!([6]), 7));
    assert!((short - long).abs() < 1e-12 * short, "{short} {long}");
}

#[test]
fn a_material_is_named_as_people_say_it_and_written_out_in_the_result() {
    let mut config = json!({
        "material": "FePt",
        "lattice": {"chain": {"sites": 1, "spacing": "2 nm", "cross_section": ["3 nm", "3 nm"]}},
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}}
    });
    let by_name = certified(&config);
    // K V of the file
    assert!((by_name / (6.6e6 * 18e-27 / 1.602176634e-22) - 1.0).abs() < 1e-12, "{by_name}");
    let file = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/configs/materials/fept.json")).unwrap();
    config["material"] = serde_json::from_str(&file).unwrap();
    assert_eq!(certified(&config), by_name);
}

#[test]
fn a_wire_of_varying_section_has_the_barrier_of_its_cells() {
    // no exchange: each cell turns by itself, and the largest is the highest saddle
    let config = json!({
        "material": {"name": "grains", "Ms": "1 MA/m", "energy": [{"anisotropy": {"K": "100 kJ/m^3", "axis": [0, 0, 1]}}]},
        "lattice": {"chain": {
            "sites": 2, "spacing": "3 nm", "cross_section": ["3 nm", "3 nm"],
            "sections": [{"sites": [1], "width": "6 nm"}]
        }},
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}}
    });
    let barrier = certified(&config);
    assert!((barrier - 2.0 * 16.852_074_5).abs() < 1e-5, "{barrier}");
}

#[test]
fn a_wall_crosses_a_step_in_the_section_as_flux_and_volume_say() {
    // a wall in a wide wire costs more than in a narrow one, in proportion to the section, once it is far from the step
    let config = |widths: Value| {
        let mut config = reversal(80, json!(["1 meV"]), json!("0.05 meV"));
        config["material"] = json!({"name": "wire", "Ms": "1 MA/m", "energy": [
            {"exchange": {"A": "10 pJ/m"}}, {"anisotropy": {"K": "100 kJ/m^3", "axis": [0, 0, 1]}}
        ]});
        config["lattice"] = json!({"chain": {"sites": 80, "spacing": "2 nm", "cross_section": [widths, "5 nm"]}});
        config
    };
    let narrow = certified(&config(json!("10 nm")));
    let wide = certified(&config(json!("20 nm")));
    let step = certified(&config(json!({"from": "10 nm", "to": "20 nm", "shape": "step"})));
    assert!((wide / narrow - 2.0).abs() < 1e-9, "{narrow} {wide}");
    assert!((step / wide - 1.0).abs() < 0.01, "{step} {wide}");
}

#[test]
fn moments_follow_the_magnetisation_of_each_site() {
    // a field costs each cell 2 μB: the sum over a ramp of Ms from 1 to 0.5 MA/m
    let config = json!({
        "material": {"name": "graded", "Ms": {"from": "1 MA/m", "to": "500 kA/m"}, "energy": [
            {"exchange": {"A": "10 pJ/m"}}, {"anisotropy": {"K": "200 kJ/m^3", "axis": [0, 0, 1]}}
        ]},
        "lattice": {"chain": {"sites": 5, "spacing": "2 nm", "cross_section": ["2 nm", "2 nm"],
            "moments": [{"sites": [4], "Ms": "100 kA/m"}]}},
        "energy": [{"zeeman": {"B": ["0 T", "0 T", "20 mT"]}}],
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}}
    });
    let (code, summary) = run(&config);
    assert_eq!(code, Some(0), "{summary}");
    let energy = |end: &str| summary[end]["energy_meV"].as_f64().unwrap();
    let sum = (1.0 + 0.875 + 0.75 + 0.625 + 0.1) * 1e6 * 8e-27;
    let expected = 2.0 * 0.02 * sum / 1.602176634e-22;
    assert!(((energy("final") - energy("initial")) / expected - 1.0).abs() < 1e-9, "{summary}");
}
