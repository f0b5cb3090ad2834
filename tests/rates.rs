//! Rates against closed forms, the reference and dense eigenvalues; what has no rate is refused.

mod common;

use common::{Build, cases, number, solve};
use spinneb::drive::{Outcome, Problem};
use spinneb::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;
use spinneb::rates::{RateSettings, SaddleRate, Theory, Way};
use spinneb::units::{HBAR, K_B};

/// Both theories at one temperature, moments of n μ_B each.
fn settings(sites: usize, moment: f64, damping: f64, kelvin: f64) -> RateSettings {
    RateSettings {
        temperatures_k: vec![kelvin],
        damping,
        g_factor: 2.0,
        theories: Theory::ALL.to_vec(),
        moments_mub: vec![moment; sites],
    }
}

/// γ/μ times 1 meV, in Hz.
fn unit_hz(moment: f64) -> f64 {
    1e12 * 2.0 / (HBAR * moment)
}

fn with(mut problem: Problem, settings: RateSettings) -> Problem {
    problem.rates = Some(settings);
    problem
}

fn rate(outcome: &Outcome, way: Way) -> &SaddleRate {
    let rates = outcome.rates.as_ref().expect("rates");
    rates.saddles.iter().find(|r| r.way == way).expect("a saddle")
}

#[test]
fn the_reference_is_met_by_both_theories_at_all_dampings() {
    let reference = cases();
    let tolerance = number(&reference["rates"], "tolerance");
    for case in reference["rates"]["cases"].as_array().expect("cases") {
        let n = case["N"].as_u64().expect("N") as usize;
        let build = || Build::open(n).easy(number(case, "K")).hard(number(case, "K_hard"));
        for (damping, expected) in case["langer"].as_object().expect("langer") {
            let alpha: f64 = damping.parse().expect("a damping");
            let outcome = solve(&with(build().reversal(), settings(n, 1.5, alpha, 10.0)));
            assert!(outcome.certified);
            let r = rate(&outcome, Way::Forward);
            let htst = r.htst.expect("HTST").hz_at(10.0) / unit_hz(1.5);
            let langer = r.langer.expect("Langer").hz_at(10.0) / unit_hz(1.5);
            println!("N = {n}, α = {alpha}: {htst} {langer}");
            let expected = expected.as_f64().expect("a number");
            assert!((htst / number(case, "htst") - 1.0).abs() < tolerance, "N = {n}: {htst}");
            assert!((langer / expected - 1.0).abs() < tolerance, "N = {n}, α = {alpha}: {langer}, {expected}");
        }
    }
}
