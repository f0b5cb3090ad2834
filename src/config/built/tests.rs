use super::*;
use crate::config::load_text;
use crate::drive::{Silent, run};
use crate::path::guess::{FirstGuess, Waypoints};
use serde_json::{Value, json};
use std::path::Path;

/// A chain with exchange J = 10 meV, a DMI along y, and two stretches of weaker anisotropy.
fn pinned(through: Value) -> Value {
    let weak = |from: usize| json!({"anisotropy": {"K": "-0.1 meV", "axis": [0, 0, 1], "sites": {"from": from, "to": from + 11}}});
    let wall = |center: f64| json!({"domain_wall": {"center": center, "through": through}});
    json!({
        "material": {"name": "toy", "energy": [
            {"exchange": {"J": ["10 meV"]}},
            {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
            {"dmi": {"D": "1.2 meV", "direction": [0, 1, 0]}},
        ]},
        "lattice": {"chain": {"sites": 64}},
        "energy": [weak(12), weak(40)],
        "initial": wall(17.5),
        "final": wall(45.5),
    })
}

fn problem(config: &Value) -> Problem {
    load_text(Path::new("wall.json"), config.to_string()).unwrap().problem().unwrap()
}

/// The direction on the way that the initial wall of a config took.
fn chosen(config: &Value) -> Vector {
    problem(config).sense.unwrap().through
}

#[test]
fn a_wall_between_opposite_domains_passes_where_it_is_cheapest() {
    let mut config = pinned(json!("auto"));
    assert_eq!(chosen(&config), [-1.0, 0.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["D"] = "-1.2 meV".into();
    assert_eq!(chosen(&config), [1.0, 0.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["direction"] = json!([1, 0, 0]);
    assert_eq!(chosen(&config), [0.0, -1.0, 0.0]);
    config["material"]["energy"][2]["dmi"]["D"] = "1.2 meV".into();
    assert_eq!(chosen(&config), [0.0, 1.0, 0.0]);
    for key in ["initial", "final"] {
        config[key]["domain_wall"].as_object_mut().unwrap().remove("through");
    }
    assert_eq!(chosen(&config), [0.0, 1.0, 0.0]);
}

#[test]
fn a_default_wall_with_an_interaction_that_has_a_handedness_leads_to_the_barrier_of_the_cheap_sense() {
    let [auto, given] = [json!("auto"), json!([-1, 0, 0])].map(|t| run(&problem(&pinned(t)), &mut Silent).unwrap());
    let forward = auto.barrier.unwrap().forward_mev;
    assert!(auto.certified, "{:?}", auto.warnings);
    assert!((forward - 0.5994182999086545).abs() < 1e-9, "{forward}");
    assert!((forward - given.barrier.unwrap().forward_mev).abs() < 1e-12, "{forward}");
}

#[test]
fn the_library_s_cobalt_on_platinum_has_walls_through_minus_x() {
    let mut config = pinned(json!("auto"));
    config["material"] = "cobalt_platinum".into();
    config["lattice"] = json!({"chain": {"sites": 64, "spacing": "1 nm", "cross_section": ["50 nm", "0.4 nm"]}});
    config["energy"] = json!([{"demag": {}}]);
    assert_eq!(chosen(&config), [-1.0, 0.0, 0.0]);
}

#[test]
fn senses_that_are_equal_to_rounding_are_the_usual_one() {
    let mut config = pinned(json!("auto"));
    config["material"]["energy"][2]["dmi"]["D"] = "0 meV".into();
    let auto = problem(&config);
    assert_eq!(auto.sense.unwrap().through, [1.0, 0.0, 0.0]);
    for key in ["initial", "final"] {
        config[key]["domain_wall"]["through"] = json!([1, 0, 0]);
    }
    let given = problem(&config);
    assert_eq!((auto.initial, auto.final_state), (given.initial, given.final_state));
    // y and z are the same to a square bar, but for the last digits of its demagnetising tensors
    let bar = json!({
        "material": "permalloy",
        "lattice": {"chain": {"sites": 60, "spacing": "5 nm", "cross_section": ["20 nm", "20 nm"]}},
        "energy": [{"demag": {}}],
        "initial": {"domain_wall": {"center": 20, "left": [1, 0, 0], "right": [-1, 0, 0]}},
        "final": {"domain_wall": {"center": 40, "left": [1, 0, 0], "right": [-1, 0, 0]}},
    });
    assert_eq!(chosen(&bar), [0.0, 1.0, 0.0]);
    let mut hard = config.clone();
    hard["initial"]["domain_wall"]["through"] = "auto".into();
    hard["energy"] = json!([{"anisotropy": {"K": "-0.2 meV", "axis": [1, 0, 0]}}]);
    // +y and −y cost the same, and less than ±x
    assert_eq!(chosen(&hard), [0.0, 1.0, 0.0]);
}

#[test]
fn the_final_wall_and_walls_on_the_way_take_the_sense_of_the_initial_one() {
    let mut config = pinned(json!("auto"));
    config["material"]["energy"][2]["dmi"]["D"] = "0 meV".into();
    // a wall by itself would pass through x on the left and through y on the right
    let hard = |axis: [f64; 3], from: usize| json!({"anisotropy": {"K": "-0.2 meV", "axis": axis, "sites": {"from": from, "to": from + 31}}});
    config["energy"] = json!([hard([0.0, 1.0, 0.0], 0), hard([1.0, 0.0, 0.0], 32)]);
    let found = problem(&config);
    let middle = |spins: &Spins, i: usize| spins.get(i)[0];
    assert!(middle(&found.initial, 17) > 0.9 && middle(&found.final_state, 45) > 0.9);
    let waypoint: Waypoints = serde_json::from_value(json!({"states": [{"domain_wall": {"center": 40}}]})).unwrap();
    let context =
        GuessContext { states: found.states(&Scales::of_terms(&found.hamiltonian)), default_axis: Direction::X };
    let path = waypoint.path(&found.initial, &found.final_state, 21, &context).unwrap();
    let most = (0..21).map(|k| middle(&path.spins(k), 40)).fold(0.0, f64::max);
    assert!(most > 0.9, "{most}");
    // a wall of the other kind has senses of its own
    config["final"]["domain_wall"]["left"] = json!([0, 0, -1]);
    config["final"]["domain_wall"]["right"] = json!([0, 0, 1]);
    assert!(problem(&config).final_state.get(45)[1].abs() > 0.9);
}

/// A helimagnet of one axis, x, with an easy plane across it, in a field along z: a ring, so that no end pulls.
fn helimagnet(d: &str, state: Value) -> Value {
    json!({
        "material": {"name": "helimagnet", "moment": "2 mu_B", "energy": [
            {"exchange": {"J": ["10 meV"]}},
            {"dmi": {"D": d, "direction": [1, 0, 0]}},
            {"anisotropy": {"K": "-1 meV", "axis": [1, 0, 0]}},
        ]},
        "lattice": {"chain": {"sites": 80, "periodic": true}},
        "energy": [{"zeeman": {"B": ["0 T", "0 T", "3.4552 T"]}}],
        "initial": {"soliton": state},
        "final": {"uniform": {"direction": [0, 0, 1]}},
    })
}

/// Turns about x from site 0 round the ring and back to it.
fn winding(spins: &Spins) -> f64 {
    let n = spins.sites();
    let step = |i: usize| {
        let ([_, ay, az], [_, by, bz]) = (spins.get(i), spins.get((i + 1) % n));
        libm::atan2(ay * bz - az * by, ay * by + az * bz)
    };
    (0..n).map(step).sum::<f64>() / std::f64::consts::TAU
}

#[test]
fn a_soliton_in_a_helimagnet_takes_its_handedness_and_stays() {
    for (d, turns) in [("1 meV", -1.0), ("-1 meV", 1.0)] {
        let built = problem(&helimagnet(d, json!({"center": 39.5})));
        assert!((winding(&built.initial) - turns).abs() < 1e-12, "{d}");
        let h = &built.hamiltonian;
        let relaxed = crate::drive::relax_to_minimum(h, &built.initial, 1e-12 * h.stiffness_mev()).unwrap();
        assert!((winding(&relaxed.spins) - turns).abs() < 1e-12, "{d}");
        // 8 √(J μB) − 2π |D|, and the lattice's correction of that
        let energy = h.difference_mev(relaxed.spins.as_slice(), built.final_state.as_slice());
        let expected = 8.0 * (10.0f64 * 0.4).sqrt() - std::f64::consts::TAU;
        assert!((energy - expected).abs() < 0.1, "{d}: {energy} {expected}");
    }
}

#[test]
fn a_soliton_is_as_wide_as_the_field_makes_it_and_goes_round_the_chain_where_nothing_else_is_cheaper() {
    let built = problem(&helimagnet("0 meV", json!({"center": 40})));
    // √(10/0.4) = 5 sites, so φ = 4 atan(1/e) that far before the center
    let angle = |i: usize| libm::atan2(built.initial.get(i)[1], built.initial.get(i)[2]);
    let expected = 4.0 * libm::atan(libm::exp(-1.0));
    assert!((angle(35) - expected).abs() < 1e-4, "{} {expected}", angle(35));
    assert!(built.initial.vectors().iter().all(|v| v[0].abs() < 1e-15));
    // an easy plane that holds the chain's direction is turned in
    let mut plane = helimagnet("0 meV", json!({"center": 40}));
    plane["energy"].as_array_mut().unwrap().push(json!({"anisotropy": {"K": "-2 meV", "axis": [0, 1, 0]}}));
    assert!(problem(&plane).initial.vectors().iter().all(|v| v[1].abs() < 1e-15));
}

#[test]
fn a_soliton_that_nothing_holds_together_asks_for_a_width() {
    let mut config = helimagnet("1 meV", json!({"center": 40}));
    config["energy"] = json!([]);
    let said = load_text(Path::new("s.json"), config.to_string()).unwrap().problem().unwrap_err().to_string();
    assert!(said.contains("initial.soliton.width: nothing holds the spins"), "{said}");
    config["initial"]["soliton"]["width"] = json!(5);
    assert!((winding(&problem(&config).initial) + 1.0).abs() < 1e-12);
}
