//! Which minima a saddle joins, against the gradient's flow in small steps.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde_json::json;
use spinneb::config::load_text;
use spinneb::drive::Silent;
use spinneb::drive::survey::{Survey, SurveyProblem, survey};
use spinneb::energy::Hamiltonian;
use spinneb::path::largest_angle;
use spinneb::sphere::{move_points, rotation_of};
use spinneb::stationary::State;

/// A chain of so many spins with soft and hard axes of its own on each of them, in a field.
fn random_chain(random: &mut ChaCha8Rng, sites: usize) -> SurveyProblem {
    let mut some = || [0; 3].map(|_| random.random_range(-1.0..1.0));
    let of_site = |site: usize, k: &str, axis: [f64; 3]| json!({"anisotropy": {"K": k, "axis": axis, "sites": [site]}});
    let mut energy =
        vec![json!({"exchange": {"J": ["0.8 meV"]}}), json!({"zeeman": {"B": some().map(|b| format!("{b} T"))}})];
    for site in 0..sites {
        energy.push(of_site(site, "1 meV", some()));
        energy.push(of_site(site, "-0.6 meV", some()));
    }
    let config = json!({
        "material": {"name": "random", "moment": "2 mu_B", "energy": energy},
        "lattice": {"chain": {"sites": sites}},
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}},
        "landscape": {"effort": "quick"},
    });
    load_text("random.json".as_ref(), config.to_string()).unwrap().survey().unwrap()
}

/// Δt of the flow (1/meV), and so many steps are looked at once.
const STEP: f64 = 0.01;
const STEPS: usize = 100;

/// The minimum that Heun's method leads to from a state: the first that it comes near.
fn flow(h: &Hamiltonian, m: &mut [f64], found: &Survey) -> Option<usize> {
    let (mut g, mut here, mut there) = (vec![0.0; m.len()], vec![0.0; m.len()], vec![0.0; m.len()]);
    for _ in 0..1000 {
        for _ in 0..STEPS {
            h.energy_gradient(m, &mut g);
            h.force(m, &g, &mut here);
            let mut next = m.to_vec();
            move_points(&mut next, &here, m.len(), STEP);
            h.energy_gradient(&next, &mut g);
            h.force(&next, &g, &mut there);
            here.iter_mut().zip(&there).for_each(|(a, b)| *a = 0.5 * (*a + b));
            move_points(m, &here, m.len(), STEP);
        }
        let near = found.minima.iter().position(|minimum| largest_angle(minimum.spins.as_slice(), m) < 0.02);
        if near.is_some() {
            return near;
        }
    }
    None
}

/// How many saddles of a landscape join other minima than the flow from 1e-3 rad beside them on either side.
fn wrong(asked: &SurveyProblem, found: &Survey) -> usize {
    let h = &asked.problem.hamiltonian;
    let joins_others = |saddle: &spinneb::drive::survey::FoundSaddle| {
        let state = State::at(asked.problem.evaluator(), saddle.spins.as_slice().to_vec());
        let valley = state.field(&state.lowest_mode(asked.problem.evaluator()).unwrap().vector);
        let mut ends = [1e-3, -1e-3].map(|far| {
            let mut m = state.m.clone();
            move_points(&mut m, &valley, state.m.len(), far / rotation_of(&valley));
            flow(h, &mut m, found)
        });
        let mut told = saddle.minima.map(Some);
        ends.sort();
        told.sort();
        ends != told && !ends.contains(&None)
    };
    found.saddles.iter().filter(|saddle| joins_others(saddle)).count()
}

#[test]
fn saddles_join_the_minima_that_the_flow_leads_to() {
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let chains: Vec<SurveyProblem> = (0..40).map(|k| random_chain(&mut random, 3 + k % 2)).collect();
    let counts: Vec<[usize; 2]> = chains
        .par_iter()
        .map(|asked| {
            let found = survey(asked, &mut Silent).unwrap();
            [wrong(asked, &found), found.saddles.len()]
        })
        .collect();
    let [wrong, all] = [0, 1].map(|k| counts.iter().map(|c| c[k]).sum::<usize>());
    println!("{wrong} of {all}");
    assert!(all > 300 && 300 * wrong <= all, "{wrong} of {all}");
}
