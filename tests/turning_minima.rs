//! Minima that an axis of symmetry makes rings of: frustrated antiferromagnets, and walls around spins that are held. Routes lead over
//! turns of such states, and each ring is one minimum; and one spin that no axis holds.

use spinneb::config::load_text;
use spinneb::drive::{Outcome, Silent, run};
use spinneb::spins::Spins;
use spinneb::stationary::{RELAXED, relax_to_minimum};

fn outcome(energy: &str, lattice: &str, ends: [&str; 2]) -> Outcome {
    let [initial, end] = ends;
    let config = format!(
        r#"{{"material": {{"name": "test", "energy": [{energy}]}}, "lattice": {lattice}, "initial": {initial}, "final": {end}}}"#
    );
    let problem = load_text(std::path::Path::new("test.json"), config).unwrap().problem().unwrap();
    run(&problem, &mut Silent).unwrap()
}

fn exchange_and_easy_axis(j: f64, k: f64) -> String {
    format!(r#"{{"exchange": {{"J": ["{j} meV"]}}}}, {{"anisotropy": {{"K": "{k} meV", "axis": [0, 0, 1]}}}}"#)
}

/// Barriers from random states of one lattice to others: all are the same, but for ends that are one state.
fn barriers(j: f64, k: f64, lattice: &str, seeds: &[u32]) -> Vec<f64> {
    let from = |seed: &u32| {
        let ends = [*seed, 100 + seed].map(|seed| format!(r#"{{"random": {{"seed": {seed}}}}}"#));
        let found = outcome(&exchange_and_easy_axis(j, k), lattice, [&ends[0], &ends[1]]);
        assert!(found.certified, "{lattice} {seed}: {:?}", found.warnings);
        let lower = |warning: &String| warning.contains("put together");
        assert!(!found.warnings.iter().any(lower), "{lattice} {seed}: {:?}", found.warnings);
        // images of a turn are where they are to be, and not turned back to leave one long step
        assert!(found.path.largest_rotation() <= 1.0 + 1e-9, "{lattice} {seed}: {}", found.path.largest_rotation());
        found.barrier.unwrap().forward_mev
    };
    seeds.iter().map(from).collect()
}

#[test]
fn an_odd_ring_of_antiferromagnetic_spins_moves_its_misfit_from_bond_to_bond() {
    // five spins: two neighbours lean apart, and the misfit moves on by one bond
    for barrier in barriers(-4.0, 1.7, r#"{"chain": {"sites": 5, "periodic": true}}"#, &[1, 2, 5, 6, 9, 12, 18]) {
        assert!((barrier / 0.090_140_304_219_384 - 1.0).abs() < 1e-11, "{barrier}");
    }
}

#[test]
fn a_path_is_put_together_over_turns_of_any_angle() {
    let film = r#"{"square": {"cells": [5, 5], "periodic": true}}"#;
    for barrier in barriers(-4.0, 1.7, film, &[0, 12, 14]) {
        assert!((barrier / 8.167_791_458_849 - 1.0).abs() < 1e-11, "{barrier}");
    }
}

#[test]
fn minima_that_turn_freely_are_relaxed_to_rounding() {
    let up = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
    let axis = r#"{"exchange": {"J": ["-3.249 meV"]}}, {"anisotropy": {"K": "0.0731 meV", "axis": [1, 0, 0]}}"#;
    let config = format!(
        r#"{{"material": {{"name": "test", "energy": [{axis}]}}, "lattice": {{"triangular": {{"cells": [4, 3]}}}}, "initial": {up},
            "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
    );
    let problem = load_text(std::path::Path::new("test.json"), config).unwrap().problem().unwrap();
    let h = problem.evaluator();
    let goal = RELAXED * h.stiffness_mev();
    for seed in 0..20 {
        let relaxed = relax_to_minimum(h, &Spins::random(h.sites(), seed), goal).unwrap();
        // a force along the free turn was 1e-10 meV before
        assert!(relaxed.max_torque_mev <= 2.0 * goal, "{seed}: {:e} {goal:e}", relaxed.max_torque_mev);
    }
}

#[test]
fn one_spin_between_two_body_diagonals_crosses_an_edge() {
    // |K| (1/3 − 1/4): no term gives it a torque along the axes of the cube
    for k in [0.07, 1.0, 5.0] {
        let ends = [[1, 1, 1], [1, 1, -1]].map(|d| format!(r#"{{"uniform": {{"direction": {d:?}}}}}"#));
        let cubic = format!(r#"{{"cubic_anisotropy": {{"K": "{} meV"}}}}"#, -k);
        let found = outcome(&cubic, r#"{"chain": {"sites": 1}}"#, [&ends[0], &ends[1]]);
        assert!(found.certified && (found.barrier.unwrap().forward_mev / (k / 12.0) - 1.0).abs() < 1e-12, "{k}");
    }
}

#[test]
fn spins_that_are_held_stay_to_the_bit_and_leave_a_rotation_free() {
    let up = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
    let down = r#"{"uniform": {"direction": [0, 0, -1]}}"#;
    for ([x, y], k, sites, expected) in [
        ([6, 5], 0.25, "0, 1, 6", 7.505_990),
        ([5, 4], 0.35, "0, 1, 5", 7.730_780),
        ([5, 5], 0.3, "0, 1, 5", 7.921_136),
    ] {
        let held = format!(r#"[{{"sites": [{sites}], "direction": [0, 0, 1]}}]"#);
        let film = format!(r#"{{"square": {{"cells": [{x}, {y}], "frozen": {held}}}}}"#);
        let found = outcome(&exchange_and_easy_axis(1.0, k), &film, [up, down]);
        assert!(found.certified, "{film}: {:?}", found.warnings);
        assert!((found.barrier.unwrap().forward_mev - expected).abs() < 1e-6, "{film}: {:?}", found.barrier);
        for image in 0..found.path.images() {
            assert_eq!(found.path.spins(image).get(0), [0.0, 0.0, 1.0], "{film}: image {image}");
        }
    }
}
