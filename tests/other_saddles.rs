//! The times of a path over saddles that are not its own: one spin that turns over either of two of them.

use spinneb::config::load_text;
use spinneb::drive::{Outcome, Silent, run};
use spinneb::rates::TransitionRate;
use spinneb::units::{HBAR, K_B, MU_B_MEV_PER_T};

const EASY: f64 = 4.0;
const HARD: f64 = 1.0;
const MOMENT: f64 = 2.0;
const DAMPING: f64 = 0.3;
const KELVIN: f64 = 8.0;

/// One spin, z easy and x hard, in a field along y (T): it turns over y, or over −y.
fn turned(tesla: f64, effort: &str) -> Outcome {
    in_field([0.0, tesla, 0.0], effort)
}

/// In any field (T).
fn in_field([x, y, z]: [f64; 3], effort: &str) -> Outcome {
    let config = format!(
        r#"{{"material": {{"name": "one spin", "moment": "{MOMENT} mu_B", "energy": [
            {{"anisotropy": {{"K": "{EASY} meV", "axis": [0, 0, 1]}}}}, {{"anisotropy": {{"K": "-{HARD} meV", "axis": [1, 0, 0]}}}}]}},
        "lattice": {{"chain": {{"sites": 1}}}}, "energy": [{{"zeeman": {{"B": ["{x} T", "{y} T", "{z} T"]}}}}],
        "initial": {{"uniform": {{"direction": [0, 0, 1]}}}}, "final": {{"uniform": {{"direction": [0, 0, -1]}}}},
        "search": {{"effort": "{effort}"}}, "rates": {{"temperatures": ["{KELVIN} K"], "damping": {DAMPING}}}}}"#
    );
    let outcome = run(&load_text("one.json".as_ref(), config).unwrap().problem().unwrap(), &mut Silent).unwrap();
    assert!(outcome.certified, "{:?}", outcome.warnings);
    outcome
}

/// ln of Langer's rate (1/s) over one of the two, side 1 or −1.
fn ln_langer(tesla: f64, side: f64) -> f64 {
    let zeeman = side * MOMENT * MU_B_MEV_PER_T * tesla;
    // at rest sin θ = μB/2K; curvatures along and across the plane of easy axis and field
    let tilt = MOMENT * MU_B_MEV_PER_T * tesla / (2.0 * EASY);
    let least = -EASY - MOMENT * MU_B_MEV_PER_T * tesla * tilt / 2.0;
    let well = [2.0 * EASY * (1.0 - tilt * tilt), 2.0 * (EASY + HARD)];
    let top = [-2.0 * EASY + zeeman, 2.0 * HARD + zeeman];
    let (sum, product) = (DAMPING * (top[0] + top[1]), (1.0 + DAMPING * DAMPING) * top[0] * top[1]);
    let growth = (-sum + (sum * sum - 4.0 * product).sqrt()) / 2.0;
    // g μ_B/ħ over the moment, g = 2, ħ in meV ps
    let gamma = 2e12 / (HBAR * MOMENT * (1.0 + DAMPING * DAMPING));
    let entropy = 0.5 * (well[0] * well[1] / (top[0] * top[1]).abs()).ln();
    (gamma * growth / (2.0 * std::f64::consts::PI)).ln() + entropy - (-zeeman - least) / (K_B * KELVIN)
}

fn forward(outcome: &Outcome) -> &TransitionRate {
    &outcome.rates.as_ref().unwrap().transitions[0]
}

#[test]
fn the_time_of_the_network_is_over_the_saddle_on_the_other_side_too() {
    for tesla in [0.01, 0.3, 2.0, 6.0] {
        let outcome = turned(tesla, "normal");
        let transition = forward(&outcome);
        let [lower, higher] = [1.0, -1.0].map(|side| ln_langer(tesla, side));
        let both = lower + (higher - lower).exp().ln_1p();
        let found = -transition.network[0].ln_time_s[1].unwrap();
        assert!((found - both).abs() < 1e-6, "{tesla} T: {found} {both}");
        let own = transition.rows[0].passage.ln_langer_per_s.unwrap();
        assert!(own < both + 2e-3 && own > lower - 1e-6, "{tesla} T: {own} {lower} {both}");
        let is_told = outcome.warnings.iter().any(|warning| warning.contains("network_first_passage_s"));
        let known = transition.rows[0].passage.known_within.unwrap().ln();
        assert_eq!(is_told, both - own > known, "{tesla} T: {:?}", outcome.warnings);
    }
}

#[test]
fn both_ways_have_the_equilibrium_of_the_two_minima() {
    let outcome = in_field([0.0, 2.0, 0.5], "normal");
    let ways = &outcome.rates.as_ref().unwrap().transitions;
    let [network, own] = [0, 1].map(|which| {
        let ln_time = |way: usize| match which {
            0 => ways[way].network[0].ln_time_s[1].unwrap(),
            _ => -ways[way].rows[0].passage.ln_langer_per_s.unwrap(),
        };
        ln_time(0) - ln_time(1)
    });
    assert!(own.abs() > 0.1 && (network - own).abs() < 1e-6, "{network} {own}");
}

#[test]
fn nothing_is_looked_for_where_no_effort_is_made() {
    assert!(forward(&turned(2.0, "none")).network.is_empty());
}
