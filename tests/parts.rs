//! States by region whose parts choose their senses and sizes: each its own, and together where they are coupled.

use serde_json::{Value, json};
use spinneb::config::load_text;
use spinneb::drive::{Outcome, Problem, Silent, run};
use spinneb::field::Components;
use spinneb::spins::Spins;
use std::path::Path;

fn try_problem(config: &Value) -> Result<Problem, String> {
    let loaded = load_text(Path::new("parts.json"), config.to_string()).map_err(|e| e.to_string())?;
    loaded.problem().map_err(|e| e.to_string())
}

fn problem(config: &Value) -> Problem {
    try_problem(config).unwrap()
}

fn barriers(outcome: &Outcome) -> [f64; 2] {
    let barrier = outcome.barrier.as_ref().unwrap();
    [barrier.forward_mev, barrier.backward_mev]
}

fn charge(problem: &Problem, spins: &Spins) -> f64 {
    problem.hamiltonian.lattice().triangles().charge(Components::new(spins.as_slice()))
}

fn up(z: f64) -> Value {
    json!({"uniform": {"direction": [0, 0, z]}})
}

fn skyrmion(center: [f64; 2]) -> Value {
    json!({"skyrmion": {"center": center}})
}

/// A film of two halves, the right one of the name `r`, with a Dzyaloshinskii–Moriya interaction in each.
fn film(d: [f64; 2], kind: &str, k: f64, initial: Value, last: Value) -> Value {
    let dmi = |d: f64, sites: Value| json!({"dmi": {"D": format!("{d} meV"), "kind": kind, "sites": sites}});
    let from = [12.6, -9.0];
    let [left, right] =
        [json!({"box": {"from": [-9, -9], "to": [12.4, 99]}}), json!({"box": {"from": from, "to": [99, 99]}})];
    let of_halves = vec![dmi(d[0], left), dmi(d[1], right)];
    let dmis =
        if d[0] == d[1] { vec![json!({"dmi": {"D": format!("{} meV", d[0]), "kind": kind}})] } else { of_halves };
    let mut config = json!({
        "material": {"name": "m", "energy": [
            {"exchange": {"J": ["1 meV"]}},
            {"anisotropy": {"K": format!("{k} meV"), "axis": [0, 0, 1]}},
        ]},
        "lattice": {"square": {"cells": [26, 12], "periodic": true, "regions": {"r": {"box": {"from": from, "to": [99, 99]}}}}},
        "initial": initial,
        "final": last,
        "search": {"effort": "none"},
    });
    config["material"]["energy"].as_array_mut().unwrap().extend(dmis);
    config
}

fn two_skyrmions(left: [f64; 2], right: [f64; 2]) -> Value {
    json!({"regions": {"default": skyrmion(left), "r": skyrmion(right)}})
}

#[test]
fn each_of_two_skyrmions_side_by_side_has_the_helicity_and_the_size_of_its_own() {
    for (d, k) in [(0.6, 0.5), (-0.6, 0.5), (0.5, 0.4)] {
        for kind in ["interfacial", "bulk"] {
            for (left, right) in [([6.5, 5.5], [19.5, 5.5]), ([6.0, 5.0], [19.0, 5.0]), ([6.0, 0.0], [20.0, 6.0])] {
                let built = problem(&film([d, d], kind, k, two_skyrmions(left, right), up(1.0)));
                let found = charge(&built, &built.initial);
                assert!((found + 2.0).abs() < 1e-6, "{d} {kind} {left:?}: {found}");
            }
        }
    }
    // each half has an interaction of its own sign
    let built = problem(&film([0.6, -0.6], "interfacial", 0.5, two_skyrmions([6.0, 5.0], [19.0, 5.0]), up(1.0)));
    assert!((charge(&built, &built.initial) + 2.0).abs() < 1e-6);
    let right_of = |x: usize| built.initial.get(x + 2 + 26 * 5)[0];
    assert!(right_of(6) > 0.3 && right_of(19) < -0.3, "{} {}", right_of(6), right_of(19));
}

#[test]
fn one_of_two_skyrmions_collapses_over_the_same_barrier_whichever_end_has_both() {
    let (both, one) = (two_skyrmions([6.5, 5.5], [19.5, 5.5]), skyrmion([6.5, 5.5]));
    let [there, back] = [[&both, &one], [&one, &both]].map(|[initial, last]| {
        run(&problem(&film([0.6; 2], "interfacial", 0.5, initial.clone(), last.clone())), &mut Silent).unwrap()
    });
    let ([a, b], [c, d]) = (barriers(&there), barriers(&back));
    assert!(there.certified && back.certified);
    assert!((a - 1.526508).abs() < 1e-5 && (b - 7.316949).abs() < 1e-5, "{a} {b}");
    assert!((a - d).abs() < 1e-8 && (b - c).abs() < 1e-8, "{a} {b} {c} {d}");
}

#[test]
fn a_skyrmion_whose_wall_leaves_its_place_by_the_long_sides_is_none() {
    // of least energy is a stripe across a strip that is open along it, and a stripe across a region: two walls, no ring
    let mut strip = film([0.7, 0.7], "interfacial", 0.9, skyrmion([14.5, 3.5]), up(1.0));
    strip["lattice"] = json!({"square": {"cells": [30, 8]}});
    let mut region = film([0.5, 0.5], "interfacial", 0.9, json!({"regions": {"r": skyrmion([19.5, 5.5])}}), up(1.0));
    region["initial"]["regions"]["default"] = up(-1.0);
    region["lattice"]["square"]["cells"] = json!([26, 14]);
    region["lattice"]["square"]["regions"]["r"]["box"]["from"] = json!([8, -9]);
    for (config, key) in [(strip, "initial"), (region, "initial.regions.r")] {
        let said = try_problem(&config).err().unwrap();
        assert!(said.contains(&format!("{key}.skyrmion.radius: no size of this skyrmion is stable here")), "{said}");
    }
}

#[test]
fn a_skyrmion_that_has_no_size_in_its_region_or_its_core_outside_is_refused() {
    let state = two_skyrmions([6.5, 5.5], [19.5, 5.5]);
    // nothing holds them
    let said = try_problem(&film([0.6; 2], "interfacial", 0.9, state.clone(), up(1.0))).unwrap_err();
    let words = "initial.regions.default.skyrmion.radius: no size of this skyrmion is stable here, its energy falls all the way to \
                 nothing or to the whole of its region";
    assert!(said.contains(words), "{said}");
    // nothing holds the one on the right
    let said = try_problem(&film([0.6, 0.0], "interfacial", 0.5, state, up(1.0))).unwrap_err();
    assert!(said.contains("initial.regions.r.skyrmion.radius: no size of this skyrmion"), "{said}");
    let outside = two_skyrmions([16.0, 5.5], [19.5, 5.5]);
    let said = try_problem(&film([0.6; 2], "interfacial", 0.5, outside, up(1.0))).unwrap_err();
    assert!(said.contains("initial.regions.default.skyrmion.center: a skyrmion there has its core outside"), "{said}");
}

/// Two layers, `bot` and `top`, each with its own interaction, and the exchange between them.
fn bilayer(cells: [usize; 2], d: [f64; 2], kind: &str, between: f64, states: [Value; 2]) -> Value {
    let layer = |z: f64| json!({"box": {"from": [-1, -1, z - 0.1], "to": [99, 99, z + 0.1]}});
    let dmi = |d: f64, sites: &str| json!({"dmi": {"D": format!("{d} meV"), "kind": kind, "sites": sites}});
    let [initial, last] = states;
    json!({
        "material": {"name": "m", "energy": [
            {"exchange": {"J": ["1 meV"], "sites": "bot"}},
            {"exchange": {"J": ["1 meV"], "sites": "top"}},
            {"exchange": {"J": [format!("{between} meV")], "between": ["bot", "top"]}},
            {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
            dmi(d[0], "bot"),
            dmi(d[1], "top"),
        ]},
        "lattice": {"cubic": {
            "cells": [cells[0], cells[1], 2], "periodic": [true, true, false],
            "regions": {"bot": layer(0.0), "top": layer(1.0)},
        }},
        "initial": initial,
        "final": last,
        "search": {"effort": "none"},
    })
}

/// Skyrmions with opposite cores above each other, and the antiparallel layers without them.
fn opposite() -> [Value; 2] {
    let core = |z: f64| json!({"skyrmion": {"core": [0, 0, z]}});
    [
        json!({"regions": {"default": core(-1.0), "top": core(1.0)}}),
        json!({"regions": {"default": up(1.0), "top": up(-1.0)}}),
    ]
}

#[test]
fn a_synthetic_antiferromagnet_s_skyrmion_has_one_energy_with_interactions_that_a_turn_of_the_spins_joins() {
    let of =
        |kind: &str, d: f64| run(&problem(&bilayer([14, 12], [d; 2], kind, -0.2, opposite())), &mut Silent).unwrap();
    let neel = of("interfacial", 0.6);
    for (kind, d) in [("bulk", 0.6), ("bulk", -0.6), ("interfacial", -0.6)] {
        let other = of(kind, d);
        let [a, b] = [&neel, &other].map(|outcome| outcome.initial.energy_mev);
        assert!((a - b).abs() < 1e-9, "{kind} {d}: {a} {b}");
        assert!(other.certified && barriers(&other)[0] > 3.13, "{kind} {d}: {:?}", barriers(&other));
    }
}

#[test]
fn layers_whose_interactions_have_opposite_signs_have_skyrmions_of_opposite_helicities() {
    let n = 14 * 12;
    for (d, signs) in [([0.6, -0.6], [1.0, 1.0]), ([-0.6, 0.6], [-1.0, -1.0]), ([0.6, 0.6], [1.0, -1.0])] {
        let built = problem(&bilayer([14, 12], d, "interfacial", -0.02, opposite()));
        let middle = (0..n).find(|i| built.initial.get(*i)[2] < -0.999).unwrap();
        for (layer, sign) in signs.into_iter().enumerate() {
            let [x, y, _] = built.initial.get(middle + 2 + n * layer);
            assert!(sign * x > 0.3 && y.abs() < 1e-9, "{d:?}, layer {layer}: {x} {y}");
        }
    }
}

#[test]
fn a_layer_without_a_preference_turns_with_the_one_that_it_is_coupled_to() {
    let wall = |center: f64| json!({"domain_wall": {"center": center}});
    let walls = |center: f64| json!({"regions": {"default": wall(center), "top": wall(center)}});
    for between in [0.2, -0.2] {
        let mut config = bilayer([16, 2], [0.3, 0.0], "interfacial", between, [walls(5.5), walls(9.5)]);
        config["lattice"]["cubic"]["periodic"] = json!([false, true, false]);
        if between < 0.0 {
            for key in ["initial", "final"] {
                let top = &mut config[key]["regions"]["top"]["domain_wall"];
                (top["left"], top["right"]) = (json!([0, 0, -1]), json!([0, 0, 1]));
            }
        }
        let built = problem(&config);
        for spins in [&built.initial, &built.final_state] {
            let [below, above] = [0, 32].map(|first| (0..16).map(|x| spins.get(first + x)[0]).sum::<f64>());
            assert!(below < -1.0 && (above - f64::signum(between) * below).abs() < 1e-6, "{between}: {below} {above}");
        }
    }
}
