//! What a program that links the library may get wrong, and do more than once.

use serde_json::json;
use spinneb::config::load_text;
use spinneb::drive::survey::{SurveyProblem, survey};
use spinneb::drive::{HistoryRow, Images, Observer, Outcome, Problem, Silent, run};
use spinneb::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian};
use spinneb::error::Error;
use spinneb::geometry::Direction;
use spinneb::landscape::Effort;
use spinneb::lattice::{Chain, LatticeSpec};
use spinneb::path::Path as SpinPath;
use spinneb::path::guess::NoiseSpec;
use spinneb::rates::{RateSettings, Theory};
use spinneb::spins::Spins;
use spinneb::units::Angle;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

const SITES: usize = 20;

fn easy_axis(sites: usize) -> Box<dyn EnergyTerm> {
    Box::new(Anisotropy::uniform(sites, 0.5, Direction::Z))
}

fn exchange(sites: usize) -> Box<dyn EnergyTerm> {
    Box::new(Exchange::uniform(&Chain::open(sites).resolve().unwrap(), &[10.0]))
}

fn problem() -> Problem {
    let chain = Chain::open(SITES).resolve().unwrap();
    let hamiltonian = Hamiltonian::new(&chain, vec![exchange(SITES), easy_axis(SITES)]).unwrap();
    let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(SITES, d));
    Problem::new(hamiltonian, up, down)
}

fn rates() -> RateSettings {
    let [temperatures_k, moments_mub] = [vec![4.0], vec![2.0; SITES]];
    RateSettings { temperatures_k, damping: 0.1, g_factor: 2.0, theories: Theory::ALL.to_vec(), moments_mub }
}

fn changed(change: impl Fn(&mut Problem)) -> Result<Outcome, Error> {
    let mut problem = problem();
    change(&mut problem);
    run(&problem, &mut Silent)
}

/// Where an error stands, and what it says.
fn told<T: std::fmt::Debug>(found: Result<T, Error>) -> String {
    found.unwrap_err().to_string()
}

#[test]
fn a_problem_is_run_as_often_as_one_likes() {
    let mut problem = problem();
    problem.neb.max_evaluations = 100;
    let first = run(&problem, &mut Silent).unwrap();
    assert!(first.certified);
    for _ in 0..5 {
        let again = run(&problem, &mut Silent).unwrap();
        assert_eq!(again.barrier.unwrap().forward_mev.to_bits(), first.barrier.unwrap().forward_mev.to_bits());
        assert_eq!(again.work.force_evaluations, first.work.force_evaluations);
        assert!(again.certified && again.search.searches == first.search.searches);
    }
}

/// Stops a run after so many bands were relaxed.
struct StopAfter {
    relaxed: usize,
    last: usize,
    switch: Arc<AtomicBool>,
}

impl Observer for StopAfter {
    fn iteration(&mut self, _: &HistoryRow) {}

    fn relaxed(&mut self, _: &SpinPath, _: &[HistoryRow]) {
        self.relaxed += 1;
        if self.relaxed == self.last {
            self.switch.store(true, Ordering::Relaxed);
        }
    }
}

#[test]
fn what_is_stopped_after_its_last_relaxation_is_no_result() {
    // without factors the eigenvalues that are told come by iteration, after the last relaxation
    let config = json!({
        "material": {"name": "film", "moment": "2 mu_B", "energy": [
            {"exchange": {"J": ["10 meV"]}},
            {"anisotropy": {"K": "0.5 meV", "axis": [0, 0, 1]}},
        ]},
        "lattice": {"square": {"cells": [24, 24]}},
        "initial": {"uniform": {"direction": [0, 0, 1]}},
        "final": {"uniform": {"direction": [0, 0, -1]}},
        "search": {"effort": "none"},
    });
    let stopped_after = |last: usize| {
        let mut problem = load_text(Path::new("film.json"), config.to_string()).unwrap().problem().unwrap();
        problem.hamiltonian.forgo_factors();
        let mut observer = StopAfter { relaxed: 0, last, switch: problem.control.switch().clone() };
        let found = run(&problem, &mut observer);
        (observer.relaxed, found)
    };
    let (all, found) = stopped_after(usize::MAX);
    assert!(all > 1 && found.unwrap().certified);
    for last in [1, all] {
        let (_, found) = stopped_after(last);
        assert!(matches!(found, Err(Error::Stopped)), "{last} of {all}");
    }
}

#[test]
fn terms_of_another_lattice_are_refused() {
    let chain = Chain::open(SITES).resolve().unwrap();
    for sites in [15, 25] {
        let words = format!("a term of {sites} sites on a lattice of 20");
        for term in [easy_axis(sites), exchange(sites)] {
            let place = term.name().to_string();
            assert_eq!(told(Hamiltonian::new(&chain, vec![term])), format!("{place}: {words}"));
        }
    }
}

#[test]
fn terms_with_the_bonds_of_another_lattice_of_as_many_sites_are_refused() {
    let square = |periodic| -> LatticeSpec {
        serde_json::from_value(json!({"square": {"cells": [6, 6], "periodic": periodic}})).unwrap()
    };
    let lattices = [
        Chain::open(36).resolve().unwrap(),
        Chain::ring(36).resolve().unwrap(),
        square([false, false]).resolve().unwrap(),
        square([true, false]).resolve().unwrap(),
    ];
    for (k, lattice) in lattices.iter().enumerate() {
        for (l, other) in lattices.iter().enumerate() {
            let made = Hamiltonian::new(lattice, vec![Box::new(Exchange::uniform(other, &[10.0]))]);
            match k == l {
                true => assert!(made.is_ok()),
                false => assert!(told(made).starts_with("exchange: a term of another lattice"), "{k} {l}"),
            }
        }
    }
}

#[test]
fn problems_that_cannot_be_run_are_refused_before_any_work() {
    for sites in [0, 19, 21] {
        let state = || Spins::uniform(sites, Direction::Z);
        let words = format!("found {sites} spins, but the lattice has 20 sites");
        assert_eq!(told(changed(|p| p.initial = state())), format!("initial: {words}"));
        assert_eq!(told(changed(|p| p.final_state = state())), format!("final_state: {words}"));
    }
    for n in [0, 1, 2, usize::MAX, usize::MAX / 600] {
        let found = told(changed(|p| p.images = Images::Count(n)));
        assert!(found.starts_with(&format!("images: found {n}, but a path has 3")), "{found}");
    }
    let found = told(changed(|p| p.images = Images::Count(1 << 40)));
    assert!(found.contains("that memory holds (these need about"), "{found}");
    assert!(Spins::from_components(&[1.0, 2.0, 3.0, 4.0]).is_err());
}

#[test]
fn senseless_settings_of_a_run_are_refused() {
    for x in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        assert!(told(changed(|p| p.neb.tolerance = x)).starts_with("neb.tolerance: found "), "{x}");
    }
    assert!(told(changed(|p| p.neb.max_evaluations = 0)).starts_with("neb.max_evaluations: found 0"));
    for x in [f64::NAN, -0.1, 5.0] {
        assert!(told(changed(|p| p.smooth = Some(x))).starts_with("smooth: found "), "{x}");
    }
    let noise = |x| Some(NoiseSpec { amplitude: Angle(x), seed: 1 });
    assert!(told(changed(|p| p.noise = noise(f64::NAN))).starts_with("noise.amplitude: found "));
}

#[test]
fn states_and_fields_of_other_sizes_than_the_lattice_panic() {
    let h = problem().hamiltonian;
    let panics = |call: &dyn Fn()| catch_unwind(AssertUnwindSafe(call)).is_err();
    assert!(panics(&|| drop(SpinPath::new(&[]))));
    assert!(panics(&|| drop(SpinPath::new(&[5, 6].map(|n| Spins::uniform(n, Direction::Z))))));
    let up = Spins::uniform(SITES, Direction::Z);
    for sites in [SITES - 1, SITES + 1] {
        let mut g = vec![0.0; 3 * sites];
        let short = g.clone();
        assert!(panics(&|| assert!(h.energy_mev(&short).is_finite())));
        assert!(catch_unwind(AssertUnwindSafe(|| h.energy_gradient(up.as_slice(), &mut g))).is_err());
    }
}

#[test]
fn rates_of_senseless_settings_are_refused() {
    let with = |change: fn(&mut RateSettings)| {
        let mut rates = rates();
        change(&mut rates);
        told(changed(|p| p.rates = Some(rates.clone())))
    };
    for (change, place) in [
        ((|r| r.temperatures_k = vec![4.0, -5.0]) as fn(&mut RateSettings), "rates.temperatures_k[1]: "),
        (|r| r.temperatures_k = vec![f64::NAN], "rates.temperatures_k[0]: "),
        (|r| r.temperatures_k = vec![0.0], "rates.temperatures_k[0]: "),
        (|r| r.damping = -0.1, "rates.damping: found -0.1"),
        (|r| r.g_factor = 0.0, "rates.g_factor: found 0"),
        (|r| r.moments_mub = Vec::new(), "rates.moments_mub: found 0 of 20"),
        (|r| r.moments_mub[7] = f64::NAN, "rates.moments_mub[7]: "),
        (|r| r.moments_mub[7] = 0.0, "rates.moments_mub[7]: found 0"),
        (|r| r.theories = Vec::new(), "rates.theories: found none"),
    ] {
        let found = with(change);
        assert!(found.starts_with(place), "{found}");
    }
    assert!(changed(|p| p.rates = Some(rates())).unwrap().certified);
}

#[test]
fn surveys_that_cannot_be_made_are_refused() {
    let asked = |window_mev: f64, seed: usize| SurveyProblem {
        problem: problem(),
        seeds: vec![Spins::uniform(seed, Direction::Z)],
        window_mev,
        effort: Effort::None,
        groups: Vec::new(),
        rates: None,
        shares: 1,
        images: 100,
    };
    let made = |window: f64, seed: usize| told(survey(&asked(window, seed), &mut Silent).map(|_| ()));
    assert!(made(f64::NAN, SITES).starts_with("window_mev: "));
    assert!(made(-1.0, SITES).starts_with("window_mev: found -1"));
    assert!(made(9.0, 3).starts_with("seeds[0]: found 3 spins"));
    let without = |change: fn(&mut SurveyProblem)| {
        let mut asked = asked(9.0, SITES);
        change(&mut asked);
        told(survey(&asked, &mut Silent).map(|_| ()))
    };
    assert!(without(|s| s.shares = 0).starts_with("shares: found 0"));
    assert!(without(|s| s.problem.rates = Some(rates())).starts_with("problem.rates: "));
    assert!(survey(&asked(9.0, SITES), &mut Silent).is_ok());
}
