//! States that turn about an axis at less cost than k_BT: closed forms, dense arithmetic, and the limits of none and of much cost.

use crate::common::{Build, solve};
use crate::rates::{Dense, cold, dot, made, mean, rate, settings, unit, unit_hz, with};
use spinneb::config::load_text;
use spinneb::drive::{Outcome, Problem, Silent, run};
use spinneb::geometry::{Direction, vector};
use spinneb::rates::{SaddleRate, Theory, Way, ZeroKind};
use spinneb::units::K_B;
use std::f64::consts::PI;

/// e^(−u) I₀(u).
fn bessel(u: f64) -> f64 {
    (0..1000).map(|k| (u * ((2.0 * PI * f64::from(k) / 1000.0).cos() - 1.0)).exp()).sum::<f64>() / 1000.0
}

/// The rates of a chain at one temperature (K).
fn outcome(problem: Problem, damping: f64, kelvin: f64) -> Outcome {
    let sites = problem.hamiltonian.sites();
    let outcome = solve(&with(problem, settings(sites, 2.0, damping, kelvin)));
    assert!(outcome.certified, "{:?}", outcome.warnings);
    outcome
}

fn ln_langer(rate: &SaddleRate) -> f64 {
    rate.rows[0].ln_langer_per_s.expect("a rate")
}

#[test]
fn one_or_two_spins_have_the_partition_function_of_their_ring() {
    for (sites, k, hard, kelvin) in [(1, 4.0, 0.4, 6.0), (1, 4.0, 0.05, 6.0), (2, 0.5, 0.04, 1.5), (2, 0.5, 1e-5, 1.5)]
    {
        let (n, thermal) = (sites as f64, K_B * kelvin);
        let outcome = outcome(Build::open(sites).easy(k).hard(hard).reversal(), 0.3, kelvin);
        let found = rate(&outcome, Way::Forward);
        let zeros = &made(found).saddle_zeros;
        assert_eq!((zeros.len(), zeros[0].kind, zeros[0].count), (1, ZeroKind::Rotation, 1));
        // all spins alike: N hard sin²φ, whose height is that of its curvature
        assert!(
            [zeros[0].pinning[0].curved_mev, zeros[0].pinning[0].top_mev]
                .iter()
                .all(|u| (u / (n * hard) - 1.0).abs() < 1e-9),
            "{zeros:?}"
        );
        assert!((zeros[0].volume / (2.0 * PI * n.sqrt()) - 1.0).abs() < 1e-12);
        // e^(−u) I₀(u) on the ring of both wells, where each is √(2πk_BT/ε) if it is harmonic
        let u = 0.5 * n * hard / thermal;
        let harmonic = 2.0 * (2.0 * PI * thermal / (2.0 * hard)).sqrt();
        let expected = 2.0 * PI * n.sqrt() * bessel(u) / harmonic;
        assert_eq!(cold(found).equivalents.count, 2);
        let well = |theory| cold(found).prefactor(theory).expect("a prefactor").ln_hz_at(kelvin) + 2f64.ln();
        let ring = |theory| found.ln_rate_per_s(theory, kelvin).expect("a rate") + found.barrier_mev.unwrap() / thermal;
        // Langer's frequency is another one between places
        let ratio = ring(Theory::Htst) - well(Theory::Htst);
        assert!((ratio.exp() / expected - 1.0).abs() < 1e-9, "{sites} {hard}: {} {expected}", ratio.exp());
    }
}

#[test]
fn ten_spins_agree_with_dense_arithmetic() {
    let (n, k, hard, kelvin, damping) = (10, 0.15, 0.01, 1.0, 0.3);
    let thermal = K_B * kelvin;
    let problem = Build::open(n).easy(k).hard(hard).reversal();
    let h = Build::open(n).easy(k).hard(hard).reversal().hamiltonian;
    let outcome = outcome(problem, damping, kelvin);
    let found = rate(&outcome, Way::Forward);
    let [top, bottom] = [outcome.saddles[0].spins.clone(), outcome.path.spins(0)].map(|m| Dense::new(&h, m));
    let z = Direction::Z.vector();
    let turned: Vec<[f64; 3]> = (0..n).map(|i| vector::cross(z, top.m.get(i))).collect();
    let turned = top.coordinates(&turned);
    let inverse = |v: &[f64]| -> Vec<f64> {
        let parts = top.vectors.iter().zip(&top.values).map(|(u, value)| (u, dot(u, v) / value));
        parts.fold(vec![0.0; v.len()], |sum, (u, p)| sum.iter().zip(u).map(|(s, u)| s + p * u).collect())
    };
    let valley = unit(inverse(&turned));
    let stiffness = 1.0 / dot(&valley, &inverse(&valley));
    let length = PI * dot(&valley, &turned).abs();
    let curved = stiffness * length * length / (2.0 * PI * PI);
    let zeros = &made(found).saddle_zeros[0];
    assert!((zeros.pinning[0].curved_mev / curved - 1.0).abs() < 1e-8, "{zeros:?} {curved}");
    assert!((zeros.volume / (2.0 * length) - 1.0).abs() < 1e-8, "{zeros:?} {length}");
    let volume = 2.0 * length * mean(&zeros.pinning[0], thermal) / (2.0 * PI * thermal).sqrt();
    // the determinant on the space normal to the valley
    let across = top.log_determinant(0) - stiffness.ln();
    let gyration = vec![unit_hz(2.0); n];
    let ends = made(found).equivalents.count as f64;
    assert_eq!(ends, 2.0, "{}", made(found).equivalents.by);
    let entropy = 0.5 * (bottom.log_determinant(0) - across);
    let static_part = entropy.exp() * volume * ends;
    let expected = top.growth_rate(&gyration, damping) / (2.0 * PI) * static_part;
    let own = (ln_langer(found) + found.barrier_mev.unwrap() / thermal).exp();
    assert!((own / expected - 1.0).abs() < 1e-7, "{own} {expected}");
}

#[test]
fn without_cost_it_is_the_zero_mode_and_with_much_the_wells() {
    let at = |hard: f64, kelvin: f64| {
        let outcome = outcome(Build::open(12).easy(0.15).hard(hard).reversal(), 0.5, kelvin);
        (ln_langer(rate(&outcome, Way::Forward)), made(rate(&outcome, Way::Forward)).clone())
    };
    let (free, exact) = at(0.0, 1.0);
    assert!(exact.saddle_zeros[0].pinning.is_empty());
    for hard in [1e-4, 1e-6, 1e-8, 1e-10] {
        let (soft, regime) = at(hard, 1.0);
        assert_eq!(regime.saddle_zeros[0].pinning.len(), 1, "{hard}");
        // what is left is the precession across the saddle, which goes with the cost over the descending curvature
        assert!((soft - free).abs() < 2e3 * hard + 1e-8, "{hard}: {soft} {free}");
        assert_eq!(regime.equivalents, exact.equivalents);
    }
    // cold, four wells: at either end, on either side
    let (_, wells) = at(0.1, 0.5);
    assert!(wells.saddle_zeros.is_empty() && wells.equivalents.count == 4, "{}", wells.equivalents.by);
}

#[test]
fn forms_of_one_problem_have_one_rate() {
    let (k, hard, kelvin) = (0.15, 0.003, 1.0);
    let rates = |easy: [f64; 3], across: [f64; 3], reversed: bool| {
        let [z, x] = [easy, across].map(|d| Direction::new(d).expect("a direction"));
        let build = Build::open(12);
        let n = build.lattice.sites;
        let terms = [spinneb::energy::Anisotropy::uniform(n, k, z), spinneb::energy::Anisotropy::uniform(n, -hard, x)];
        let build = terms.into_iter().fold(build.defect(3, 0.02), Build::with);
        let mut ends = [z, z.reversed()].map(|d| spinneb::spins::Spins::uniform(n, d));
        if reversed {
            ends.reverse();
        }
        let [a, b] = ends;
        let outcome = outcome(build.problem(a, b), 0.3, kelvin);
        outcome
            .rates
            .expect("rates")
            .transitions
            .iter()
            .map(|t| t.rows[0].passage.ln_langer_per_s.expect("a rate"))
            .collect::<Vec<f64>>()
    };
    let first = rates([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], false);
    for reversed in [false, true] {
        let other = rates([0.0, 0.0, 1.0], [0.6, 0.8, 0.0], reversed);
        assert!(first.iter().zip(&other).all(|(a, b)| (a - b).abs() < 1e-8), "{first:?} {other:?}");
    }
}

#[test]
fn a_rate_depends_on_its_own_temperature_alone() {
    let rows = |temperatures_k: &[f64]| {
        let mut settings = settings(12, 2.0, 0.3, 1.0);
        settings.temperatures_k = temperatures_k.to_vec();
        let outcome = solve(&with(Build::open(12).easy(0.15).hard(0.01).reversal(), settings));
        let rates = outcome.rates.expect("rates");
        (rates.saddles[0].rows.clone(), rates.transitions[0].rows.clone())
    };
    let (all, whole) = rows(&[0.1, 0.5, 1.0, 2.0, 300.0]);
    for (k, kelvin) in [0.1, 0.5, 1.0, 2.0, 300.0].into_iter().enumerate() {
        let (alone, passage) = rows(&[kelvin]);
        assert_eq!((&alone[0], &passage[0]), (&all[k], &whole[k]), "{kelvin} K");
    }
}

#[test]
fn a_saddle_that_turns_freely_is_crossed_as_the_fokker_planck_equation_says() {
    // K = 40 meV = 15 k_BT, 1000 μ_B: damping, K_hard/k_BT, the rate (1/s) out of one well from the first eigenvalue of the Fokker–Planck
    // operator in spherical harmonics up to l = 58, equal to that of l = 50 in four digits
    let exact = [
        (1.0, 0.2, 6.922_6e4),
        (1.0, 0.75, 5.617_2e4),
        (1.0, 3.75, 3.142_6e4),
        (0.1, 0.2, 1.395_4e4),
        (0.1, 0.75, 1.356_7e4),
        (0.1, 3.75, 1.781_0e4),
        (0.02, 0.2, 3.026e3),
        (0.02, 0.75, 3.685e3),
        (0.02, 3.75, 5.878e3),
    ];
    let thermal = 40.0 / 15.0;
    for (damping, hard, expected) in exact {
        let kelvin = thermal / K_B;
        let problem = Build::open(1).easy(40.0).hard(hard * thermal).reversal();
        let outcome = solve(&with(problem, settings(1, 1000.0, damping, kelvin)));
        let row = &rate(&outcome, Way::Forward).rows[0];
        let over = row.ln_langer_per_s.expect("a rate").exp() / expected;
        let known = row.known_within.expect("an error");
        assert!(over < known && over > 1.0 / known, "{damping} {hard}: {over} {known}");
        // where it turns freely no damping makes the rate wrong by more
        assert!(hard > 1.0 || (0.6..1.1).contains(&over), "{damping} {hard}: {over}");
    }
}

#[test]
fn a_ring_of_more_places_than_its_symmetry_makes_is_crossed_where_it_is_straight() {
    // the hard axis of one spin makes two places of its ring, the tilted axis of the other, which hardly feels it, one
    let config = |kelvin: f64| {
        format!(
            r#"{{"material": {{"name": "two", "moment": "2 mu_B"}},
                "lattice": {{"chain": {{"sites": 2}}}},
                "energy": [{{"exchange": {{"J": ["0.02 meV"]}}}},
                           {{"anisotropy": {{"K": "3 meV", "axis": [0, 0, 1], "sites": [0]}}}},
                           {{"anisotropy": {{"K": "-0.8 meV", "axis": [1, 0, 0], "sites": [0]}}}},
                           {{"anisotropy": {{"K": "0.05 meV", "axis": [0, 1, 1], "sites": [1]}}}}],
                "initial": {{"uniform": {{"direction": [0, 0.1, 1]}}}}, "final": {{"uniform": {{"direction": [0, -0.1, -1]}}}},
                "rates": {{"temperatures": ["{kelvin} K"], "damping": 0.3}}}}"#
        )
    };
    // mean times (s) of the stochastic Landau–Lifshitz–Gilbert equation
    for (kelvin, expected) in [(5.0, 4.0e-10), (6.0, 1.43e-10), (8.0, 3.73e-11)] {
        let loaded = load_text(std::path::Path::new("two.json"), config(kelvin)).unwrap();
        let outcome = run(&loaded.problem().unwrap(), &mut Silent).unwrap();
        let passage = &outcome.rates.unwrap().transitions[0].rows[0].passage;
        let over = passage.ln_lifetime_s().unwrap().exp() / expected;
        // further saddles between the same two states are not in it: without them it is four times as long
        assert!((1.0..6.0).contains(&over), "{kelvin} K: {over}");
    }
}

#[test]
fn a_flat_top_is_crossed_no_faster_than_it_is_said_to_be() {
    // K = 1 meV = 20 k_BT along z, −2 along y and a cubic term K_c (meV): how many times Langer's rate the first eigenvalue of the
    // Fokker–Planck operator is, at damping 1
    for (cubic, faster) in
        [(0.5, 1.01), (0.8, 1.19), (0.9, 1.48), (0.95, 1.95), (0.98, 2.95), (0.99, 4.11), (0.999, 12.8)]
    {
        let text = format!(
            r#"{{"material": {{"name": "m", "moment": "2 mu_B", "energy": [{{"anisotropy": {{"K": "1 meV", "axis": [0, 0, 1]}}}},
            {{"anisotropy": {{"K": "-2 meV", "axis": [0, 1, 0]}}}}, {{"cubic_anisotropy": {{"K": "{cubic} meV"}}}}]}},
            "lattice": {{"chain": {{"sites": 1}}}}, "initial": {{"uniform": {{"direction": [0, 0, 1]}}}},
            "final": {{"uniform": {{"direction": [0, 0, -1]}}}}}}"#
        );
        let problem = load_text("flat.json".as_ref(), text).unwrap().problem().unwrap();
        let outcome = solve(&with(problem, settings(1, 2.0, 1.0, 0.05 / K_B)));
        let known = rate(&outcome, Way::Forward).rows[0].known_within.expect("an error");
        assert!(known > faster && known < 1.4 * faster, "{cubic}: {known} {faster}");
    }
}
