//! A skyrmion that is seen to escape, against Langer's rate: a piece of `benches/dynamics.rs` that takes seconds.

use spinneb::config::load_text;
use spinneb::drive::{Silent, run};
use spinneb::dynamics::{Bath, Flux, forward_flux, total};
use spinneb::geometry::Vector;
use spinneb::units::{HBAR, K_B};

/// k_BT is a quarter of the barrier.
const SKYRMION: &str = r#"{"material": {"name": "skyrmion", "moment": "1 mu_B", "energy": [{"exchange": {"J": ["1 meV", "1 meV"]}},
    {"dmi": {"D": "1 meV", "kind": "interfacial"}}]}, "energy": [{"zeeman": {"B": ["0 T", "0 T", "5.5 T"]}}],
    "lattice": {"triangular": {"cells": [12, 12], "periodic": true}},
    "initial": {"skyrmion": {"radius": 3}}, "final": {"uniform": {"direction": [0, 0, 1]}},
    "rates": {"temperatures": ["0.72405 K"], "damping": 1}}"#;

fn order(m: Vector) -> f64 {
    (m[2] - 0.5).min(0.0)
}

#[test]
fn a_skyrmion_of_144_spins_collapses_as_often_as_langer_says_but_for_the_low_barrier() {
    let problem = load_text("skyrmion.json".as_ref(), SKYRMION.into()).unwrap().problem().unwrap();
    let outcome = run(&problem, &mut Silent).unwrap();
    let escape = &outcome.rates.as_ref().unwrap().transitions[0].rows[0].escape;
    assert!((escape.barrier_over_kt - 4.0).abs() < 1e-3, "{escape:?}");
    // γ/μ per meV is the unit of time
    let langer = libm::exp(escape.ln_langer_per_s.unwrap()) / (1e12 * 2.0 / HBAR);
    let h = &problem.hamiltonian;
    let bath = Bath::new(h, &vec![1.0; h.sites()], 1.0, K_B * escape.temperature_k, 0.05);
    let start = outcome.path.spins(0);
    let [begin, goal] = [0, outcome.path.images() - 1].map(|k| total(&order, outcome.path.spins(k).as_slice()));
    let at = |part: f64| begin + part * (goal - begin);
    let interfaces = std::iter::once(0.03).chain((0..20).map(|k| 0.15 + 0.8 * f64::from(k) / 19.0)).map(at).collect();
    let flux = Flux { interfaces, settle: 1000, crossings: 160, trials: 160, blocks: 4, seed: 11 };
    let found = forward_flux(&bath, start.as_slice(), &order, &flux);
    let [ratio, error] = [found.per_s, found.error_per_s].map(|rate| rate / langer);
    // the campaign: 0.85
    assert!(error < 0.12 && (ratio - 0.85).abs() < 3.0 * error.max(0.03), "{ratio} ± {error}");
}
