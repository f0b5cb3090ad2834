//! A saddle that slides over its film at temperatures at which the minimum beside it is held in one place, and at those at which both do.

use spinneb::config::load_text;
use spinneb::drive::{Outcome, Silent, run};
use spinneb::rates::{SaddleRate, Theory, Way, ZeroModes};
use spinneb::units::K_B;

/// A skyrmion that collapses in a strip of 20 by 12 cells which repeats along its length, at these temperatures (K).
fn collapse(kelvin: &[f64]) -> Outcome {
    let kelvin: Vec<String> = kelvin.iter().map(|t| format!("\"{t} K\"")).collect();
    let config = format!(
        r#"{{"material": {{"name": "film", "moment": "2 mu_B", "energy": [{{"exchange": {{"J": ["1 meV"]}}}},
            {{"dmi": {{"D": "0.55 meV", "kind": "interfacial"}}}}, {{"anisotropy": {{"K": "0.45 meV", "axis": [0, 0, 1]}}}}]}},
        "lattice": {{"square": {{"cells": [20, 12], "periodic": [true, false]}}}},
        "initial": {{"skyrmion": {{}}}}, "final": {{"uniform": {{"direction": [0, 0, 1]}}}},
        "search": {{"effort": "none"}}, "rates": {{"temperatures": [{}], "damping": 0.05}}}}"#,
        kelvin.join(", ")
    );
    let outcome = run(&load_text("strip.json".as_ref(), config).unwrap().problem().unwrap(), &mut Silent).unwrap();
    assert!(outcome.certified, "{:?}", outcome.warnings);
    outcome
}

fn over(outcome: &Outcome, way: Way) -> &SaddleRate {
    outcome.rates.as_ref().unwrap().saddles.iter().find(|rate| rate.way == way).unwrap()
}

/// Langer's rate without Boltzmann's factor.
fn ln_prefactor(rate: &SaddleRate, kelvin: f64) -> f64 {
    rate.ln_rate_per_s(Theory::Langer, kelvin).unwrap() + rate.barrier_mev.unwrap() / (K_B * kelvin)
}

#[test]
fn a_saddle_slides_below_the_temperature_at_which_its_minimum_does() {
    let outcome = collapse(&[0.1]);
    let forward = over(&outcome, Way::Forward);
    let slides = |zeros: &[ZeroModes]| zeros.iter().any(ZeroModes::slides);
    let begins = |of: &dyn Fn(usize) -> bool| forward.regimes[(0..).find(|k| of(*k)).unwrap()].above_k;
    let saddle = begins(&|k| slides(&forward.regimes[k].saddle_zeros));
    let minimum = begins(&|k| slides(&forward.regimes[k].minimum_zeros));
    assert!(saddle < 0.1 * minimum, "{saddle} {minimum}");
    // what the saddle's valley holds of one place of the minimum goes on from below to above where that slides, as its own integral does
    let [below, above] = [0.99, 1.01].map(|part| ln_prefactor(forward, part * minimum));
    assert!((above - below).abs() < 0.2, "{below} {above}");
    // back, a rate leads to one place, and then to all 20
    let back = over(&outcome, Way::Backward);
    let [below, above] = [0.99, 1.01].map(|part| ln_prefactor(back, part * minimum));
    assert!((above - below - f64::ln(20.0)).abs() < 0.05, "{below} {above}");
}

#[test]
fn where_states_begin_to_slide_lifetimes_change_by_no_more_than_is_said() {
    let outcome = collapse(&[0.1]);
    let changes = over(&outcome, Way::Forward).regimes[1..].iter().map(|regime| regime.above_k);
    let barriers = outcome.barrier.unwrap();
    let mut met = 0;
    for from in changes.filter(|from| K_B * from < 0.5 * barriers.forward_mev) {
        let rates = collapse(&[0.995 * from, 1.005 * from]).rates.unwrap();
        for (transition, barrier) in rates.transitions.iter().zip([barriers.forward_mev, barriers.backward_mev]) {
            let ln = |k: usize| {
                let row = &transition.rows[k].escape;
                (row.ln_lifetime_s().unwrap() - barrier / (K_B * row.temperature_k), row.known_within.unwrap().ln())
            };
            let [(below, known_below), (above, known_above)] = [ln(0), ln(1)];
            assert!((above - below).abs() < known_below + known_above, "{from} {below} {above}");
            met += 1;
        }
    }
    assert!(met >= 4, "{met}");
}
