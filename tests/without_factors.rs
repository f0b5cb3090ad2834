//! Where memory would not hold factors: the same minima, saddles and barriers by iteration, their directions bounded.

use spinneb::config::load_text;
use spinneb::drive::{Certificate, Outcome, Problem, Silent, run};

fn problem(lattice: &str, energy: &str, [initial, end]: [&str; 2], rates: &str) -> Problem {
    let config = format!(
        r#"{{"material": {{"name": "test", "moment": "1 mu_B", "energy": [{energy}]}}, "lattice": {lattice}, "initial": {initial},
            "final": {end}, "search": {{"effort": "none"}}{rates}}}"#
    );
    load_text(std::path::Path::new("film.json"), config).unwrap().problem().unwrap()
}

const UP: &str = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
const DOWN: &str = r#"{"uniform": {"direction": [0, 0, -1]}}"#;

fn counted_and_bounded(made: impl Fn() -> Problem) -> [Outcome; 2] {
    let mut without = made();
    without.hamiltonian.forgo_factors();
    assert!(without.hamiltonian.forgoes_factors());
    [made(), without].map(|problem| run(&problem, &mut Silent).unwrap())
}

#[test]
fn barriers_of_films_and_crystals_are_those_that_factors_give() {
    let easy = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.025 meV", "axis": [0, 0, 1]}}"#;
    let skyrmion = r#"{"exchange": {"J": ["10 meV"]}}, {"dmi": {"D": ["6 meV"], "kind": "bulk"}},
                      {"zeeman": {"B": ["0 T", "0 T", "50 T"]}}"#;
    let round = r#"{"skyrmion": {"radius": 3}}"#;
    let frozen =
        r#"{"square": {"cells": [24, 24], "periodic": true, "frozen": [{"sites": [0, 5], "direction": [0, 0, 1]}]}}"#;
    for (lattice, energy, ends) in [
        (r#"{"square": {"cells": [32, 32]}}"#, easy, [UP, DOWN]),
        (r#"{"cubic": {"cells": [8, 8, 8]}}"#, easy, [UP, DOWN]),
        (r#"{"square": {"cells": [30, 30], "periodic": true}}"#, skyrmion, [round, UP]),
        (frozen, skyrmion, [round, UP]),
    ] {
        let [counted, bounded] = counted_and_bounded(|| problem(lattice, energy, ends, ""));
        assert!(counted.certified && bounded.certified, "{lattice}: {:?} {:?}", counted.warnings, bounded.warnings);
        assert_eq!(counted.certificate, Some(Certificate::Counted));
        let Some(Certificate::Bounded(bound)) = bounded.certificate else {
            panic!("{lattice}: {:?}", bounded.certificate)
        };
        assert!((1e-9..0.01).contains(&bound.part) && bound.steps > 20 && bound.probability == 1e-12, "{bound:?}");
        let [p, q] = [&counted, &bounded].map(|found| found.barrier.unwrap());
        let off = (p.forward_mev - q.forward_mev).abs().max((p.backward_mev - q.backward_mev).abs());
        assert!(off < 1e-11 * p.forward_mev, "{lattice}: {p:?} {q:?}");
        let saddles = [&counted, &bounded].map(|found| &found.saddles[0]);
        assert_eq!(saddles.map(|saddle| saddle.negative_modes), [Some(1); 2]);
        let [exact, told] = saddles.map(|saddle| &saddle.lowest_eigenvalues_mev);
        assert!(
            exact.len() == 4 && exact.iter().zip(told).all(|(e, t)| (e - t).abs() < 1e-9 * exact[3].abs()),
            "{exact:?} {told:?}"
        );
    }
}

#[test]
fn what_has_no_factors_has_no_prefactor_and_says_so() {
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}},
                    {"anisotropy": {"K": "-0.05 meV", "axis": [1, 0, 0]}}"#;
    let rates = r#", "rates": {"theory": ["htst"], "temperatures": ["30 K"]}"#;
    let [counted, bounded] =
        counted_and_bounded(|| problem(r#"{"square": {"cells": [20, 16]}}"#, energy, [UP, DOWN], rates));
    assert!(counted.certified && bounded.certified);
    let refused = |found: &Outcome| -> Vec<String> {
        let rates = &found.rates.as_ref().unwrap().saddles;
        rates.iter().flat_map(|rate| &rate.regimes).flat_map(|r| &r.refused).map(|(_, why)| why.to_string()).collect()
    };
    assert_eq!(refused(&counted), [] as [&str; 0]);
    let words = refused(&bounded);
    assert!(!words.is_empty() && words.iter().all(|why| why.contains("does not hold the factors")), "{words:?}");
}

#[test]
fn a_state_that_is_no_minimum_is_left_without_factors_too() {
    use spinneb::stationary::relax_to_minimum;
    // a uniform state across the easy axis is stationary, with as many negative directions as there are long waves
    let energy = r#"{"exchange": {"J": ["1 meV"]}}, {"anisotropy": {"K": "0.05 meV", "axis": [0, 0, 1]}},
                    {"anisotropy": {"K": "-0.05 meV", "axis": [0, 1, 0]}}"#;
    let across = r#"{"uniform": {"direction": [1, 0, 0]}}"#;
    let mut problem = problem(r#"{"square": {"cells": [16, 12]}}"#, energy, [across, UP], "");
    problem.hamiltonian.forgo_factors();
    let h = problem.evaluator();
    let relaxed = relax_to_minimum(h, &problem.initial, 1e-14 * h.stiffness_mev()).unwrap();
    assert!(relaxed.left.is_some() && relaxed.converged, "{relaxed:?}");
    let spectrum = relaxed.spectrum.unwrap();
    assert!(spectrum.negative == 0 && spectrum.bound.is_some(), "{spectrum:?}");
    assert!(relaxed.spins.get(5)[2].abs() > 1.0 - 1e-12);
}
