//! What relaxing a band costs, counted in evaluations of the whole band: it must not grow with the number of spins.
//!
//! Chains of the refinement series K = 0.05 (50/N)² J: the same wall on ever finer lattices. The path is read with 17 images
//! from a swept wall with 2 degrees of seeded noise, and is relaxed when |F⊥|∞ < 1e-5 c, c = 2K.

use crate::common::{Build, solve};
use rand::{RngExt, SeedableRng};
use spinneb::drive::{Images, Problem};
use spinneb::energy::{Anisotropy, Dmi, Exchange, Zeeman};
use spinneb::geometry::Direction;
use spinneb::optimise::OptimiserSpec;
use spinneb::path::guess::{Edge, GuessSpec, NoiseSpec, Sweep};
use spinneb::spins::Spins;
use spinneb::units::Angle;
use std::f64::consts::PI;

/// K of the series.
fn anisotropy(n: usize) -> f64 {
    0.05 * (50.0 / n as f64).powi(2)
}

/// A case of the series.
fn case(name: &str, n: usize) -> Problem {
    let k = anisotropy(n);
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(7);
    let mut build = if name == "ring in a field" { Build::ring(n) } else { Build::open(n) };
    let chain = build.lattice.clone();
    let along = |b: f64| Zeeman::uniform(n, [0.0, 0.0, b]);
    let mut staggered = false;
    build = match name {
        "plain" => build.easy(k),
        "hard axis 4K" => build.easy(k).hard(4.0 * k),
        "field h = 0.5" => build.easy(k).with(along(-0.5 * 2.0 * k)),
        "field h = 0.9" => build.easy(k).with(along(-0.9 * 2.0 * k)),
        "J2 = -0.2" => {
            build.terms = vec![Box::new(Exchange::uniform(&chain, &[1.0, -0.2]))];
            build.easy(k)
        }
        "antiferromagnet in a field" => {
            staggered = true;
            build.terms = vec![Box::new(Exchange::uniform(&chain, &[-1.0]))];
            build.easy(k).with(along(0.3 * (8.0 * k).sqrt()))
        }
        "DMI at 0.9 of critical" => {
            build.easy(k).with(Dmi::uniform(&chain, 0.9 * 4.0 / PI * (2.0 * k).sqrt() / 2.0, Direction::Y))
        }
        "random J and K" => {
            let (mut j, mut a) = (Exchange::uniform(&chain, &[1.0]), Anisotropy::uniform(n, k, Direction::Z));
            for i in 0..n {
                j.families[0].mev[i] *= random.random_range(0.3..1.7);
                a.k[i] *= random.random_range(-0.2..2.2);
            }
            build.terms = vec![Box::new(j)];
            build.with(a)
        }
        "ring in a field" => build.easy(k).with(along(-0.3 * 2.0 * k)),
        other => panic!("no case {other}"),
    };
    let state = |s: f64| {
        let vectors: Vec<_> = (0..n).map(|i| [0.0, 0.0, if staggered && i % 2 == 1 { -s } else { s }]).collect();
        Spins::from_vectors(&vectors).expect("unit vectors")
    };
    let mut problem = build.problem(state(1.0), state(-1.0));
    let from = if name == "ring in a field" { Edge::Center } else { Edge::Left };
    problem.guess = Some(GuessSpec::Sweep(Sweep::from(from)));
    problem.noise = Some(NoiseSpec { amplitude: Angle(2f64.to_radians()), seed: 1 });
    problem.images = Images::Count(17);
    (problem.refine, problem.certify, problem.neb.climb) = (false, false, false);
    problem.neb.max_evaluations = 200;
    problem
}

/// Evaluations until |F⊥|∞ < 1e-5 c.
fn evaluations(problem: &Problem, n: usize) -> usize {
    let outcome = solve(problem);
    let c = 2.0 * anisotropy(n);
    let there = outcome.history.iter().find(|r| r.images == 17 && r.max_perpendicular_torque_mev < 1e-5 * c);
    there.unwrap_or_else(|| panic!("not relaxed: {}", outcome.stop_reason)).iteration
}

fn with(optimiser: &str, mut problem: Problem) -> Problem {
    problem.neb.optimiser = serde_json::from_str::<OptimiserSpec>(optimiser).expect(optimiser);
    problem
}

#[test]
fn the_implicit_sweep_needs_at_most_15_evaluations_at_any_number_of_spins() {
    for n in [50, 200, 800, 3200] {
        let count = evaluations(&case("plain", n), n);
        println!("implicit, N = {n}: {count}");
        assert!(count <= 15, "N = {n}: {count}");
    }
}

#[test]
fn the_preconditioned_method_needs_at_most_45_evaluations_at_any_number_of_spins() {
    for n in [50, 200, 800, 3200] {
        let count = evaluations(&with(r#"{"preconditioned": {}}"#, case("plain", n)), n);
        println!("preconditioned, N = {n}: {count}");
        assert!(count <= 45, "N = {n}: {count}");
    }
}

/// Counts of the method's first implementation at N = 50, 200, 800; ours stay within one and a half of them.
#[test]
fn hard_axes_fields_frustration_dmi_and_disorder_cost_little_more() {
    let table = [
        ("plain", [7, 7, 10]),
        ("hard axis 4K", [7, 7, 10]),
        ("field h = 0.5", [8, 8, 8]),
        ("field h = 0.9", [10, 15, 11]),
        ("J2 = -0.2", [8, 8, 7]),
        ("antiferromagnet in a field", [8, 9, 11]),
        ("DMI at 0.9 of critical", [11, 11, 13]),
        ("random J and K", [8, 8, 11]),
        // the first implementation failed at N = 800 from so few images
        ("ring in a field", [11, 9, 11]),
    ];
    for (name, counts) in table {
        for (n, reference) in [50, 200, 800].into_iter().zip(counts) {
            let count = evaluations(&case(name, n), n);
            println!("{name}, N = {n}: {count} (reference {reference})");
            assert!(2 * count <= 3 * reference, "{name}, N = {n}: {count} evaluations, reference {reference}");
        }
    }
}

#[test]
fn the_usual_methods_find_the_same_path_in_many_more_evaluations() {
    let n = 50;
    let best = evaluations(&case("plain", n), n);
    for (optimiser, most) in [(r#"{"lbfgs": {}}"#, 400), (r#"{"velocity_projection": {}}"#, 4000)] {
        let mut problem = with(optimiser, case("plain", n));
        problem.neb.max_evaluations = most;
        let count = evaluations(&problem, n);
        println!("{optimiser}: {count}, implicit {best}");
        assert!(count > 5 * best);
    }
}

#[test]
fn on_the_finest_lattice_of_the_series_the_saddle_is_still_certified() {
    let n = 3200;
    let mut problem = case("plain", n);
    (problem.refine, problem.certify, problem.neb.climb) = (true, true, true);
    let outcome = solve(&problem);
    assert!(outcome.certified, "{:?}", outcome.warnings);
    // the continuum's wall, 2√(2JK), is approached from below as the square of the lattice constant over the wall width
    let continuum = 2.0 * (2.0 * anisotropy(n)).sqrt();
    let ratio = crate::common::forward(&outcome) / continuum;
    assert!((1.0 - ratio) > 0.0 && (1.0 - ratio) < 3e-6, "{ratio}");
}
