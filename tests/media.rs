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
