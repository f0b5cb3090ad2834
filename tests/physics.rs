//! What physics knows beforehand: symmetries, limits, and that nothing depends on the number of threads.

use crate::common::{Build, forward, solve};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use spinneb::drive::{Outcome, Problem, StopCode};
use spinneb::energy::{Anisotropy, Dmi, Exchange, Hamiltonian, Medium, TermSpec, Zeeman};
use spinneb::geometry::Direction;
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::landscape::Minimum;
use spinneb::lattice::Chain;
use spinneb::linalg::eigenvalues_symmetric;
use spinneb::path::guess::{Edge, GuessSpec, Sweep};
use spinneb::spins::Spins;
use spinneb::units::{Length, Magnetisation, Moment};

fn staggered(n: usize, s: f64) -> Spins {
    let vectors: Vec<_> = (0..n).map(|i| [0.0, 0.0, if i % 2 == 1 { -s } else { s }]).collect();
    Spins::from_vectors(&vectors).expect("unit vectors")
}

#[test]
fn an_antiferromagnet_has_the_barrier_of_its_ferromagnetic_mirror() {
    for (ring, shells, d) in [(false, [1.0, 0.0], 0.0), (false, [1.0, -0.2], 0.05), (true, [1.0, 0.1], 0.0)] {
        let n = 30;
        let build = |sign: f64| {
            let mut build = if ring { Build::ring(n) } else { Build::open(n) };
            let chain = build.lattice.clone();
            build.terms = vec![Box::new(Exchange::uniform(&chain, &[sign * shells[0], shells[1]]))];
            build.easy(0.05).with(Dmi::uniform(&chain, sign * d, Direction::Y))
        };
        let ferro = solve(&build(1.0).reversal());
        let antiferro = solve(&build(-1.0).problem(staggered(n, 1.0), staggered(n, -1.0)));
        let (f, a) = (forward(&ferro), forward(&antiferro));
        assert!((f - a).abs() < 1e-11 * f, "ring {ring}, J {shells:?}, D {d}: {f} {a}");
    }
}

#[test]
fn the_same_chain_told_in_continuum_terms_has_the_same_barrier() {
    let cell = [1.5, 4.0, 2.0];
    let chain = Chain {
        spacing: Some(Length(cell[0])),
        cross_section: Some([Length(cell[1]), Length(cell[2])].map(Into::into)),
        ..Chain::open(40)
    }
    .resolve()
    .unwrap();
    let micro = [
        r#"{"exchange": {"A": "10 pJ/m"}}"#,
        r#"{"anisotropy": {"K": "0.4 MJ/m^3", "axis": [0, 0, 1]}}"#,
        r#"{"dmi": {"D": "0.8 mJ/m^2", "direction": [0, 1, 0]}}"#,
        r#"{"zeeman": {"B": ["0 T", "0 T", "-20 mT"]}}"#,
    ];
    // J = 2 A S/a, K V, D S, Ms V in meV and μ_B
    let e = 1.602176634e-22;
    let (section, volume) = (cell[1] * cell[2] * 1e-18, cell[0] * cell[1] * cell[2] * 1e-27);
    let atomic = [
        format!(r#"{{"exchange": {{"J": ["{} meV"]}}}}"#, 2.0 * 10e-12 * section / (cell[0] * 1e-9) / e),
        format!(r#"{{"anisotropy": {{"K": "{} meV", "axis": [0, 0, 1]}}}}"#, 0.4e6 * volume / e),
        format!(r#"{{"dmi": {{"D": "{} meV", "direction": [0, 1, 0]}}}}"#, 0.8e-3 * section / e),
        r#"{"zeeman": {"B": ["0 T", "0 T", "-20 mT"]}}"#.to_string(),
    ];
    let moment = Moment(1e6 * volume / (5.7883817982e-5 * 1.602176634e-19));
    let barrier = |texts: &[&str], medium: Medium| {
        let term = |t: &&str| serde_json::from_str::<TermSpec>(t).expect(t).member().build(&medium).expect(t);
        let h = Hamiltonian::new(&chain, texts.iter().map(term).collect()).expect("a chain");
        let up = Spins::uniform(40, Direction::Z);
        forward(&solve(&Problem::new(h, up, Spins::uniform(40, Direction::Z.reversed()))))
    };
    let si = barrier(&micro, Medium::new(&chain, None, Some(Magnetisation(1e6).into())));
    let texts: Vec<&str> = atomic.iter().map(String::as_str).collect();
    let atomistic = barrier(&texts, Medium::new(&chain, Some(moment.into()), None));
    assert!((si - atomistic).abs() < 1e-12 * si, "{si} {atomistic}");
}

#[test]
fn results_are_the_same_to_the_bit_in_every_run_and_for_any_number_of_threads() {
    let problem = || Build::open(60).easy(0.05).hard(0.02).field([0.01, 0.0, -0.03]).reversal();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| solve(&problem()))
    };
    let print = |o: &Outcome| {
        format!("{:?} {:?} {:?} {:?} {:?}", o.path, o.barrier, o.saddles, o.history, o.work.force_evaluations)
    };
    let first = print(&on(1));
    assert_eq!(first, print(&on(1)));
    assert_eq!(first, print(&on(2)));
    assert_eq!(first, print(&on(3)));
}

#[test]
fn a_wall_hops_in_the_peierls_regime_by_one_and_by_several_sites() {
    // barriers of one hop in long chains, to 16 digits, by Newton's method on the exact gradient
    for (k, expected) in
        [(0.5, 0.03758763335845837), (0.8, 0.3722670355367258), (1.0, 0.6379634091095359), (1.5, 1.237367479663958)]
    {
        for sites in [1, 3, 5] {
            let build = Build::open(40).easy(k);
            let width = (0.5f64 / k).sqrt();
            let wall = |center: f64| build.wall(center, width, Direction::X);
            let (a, b) = (wall(17.5), wall(17.5 + sites as f64));
            let outcome = solve(&build.problem(a, b));
            assert!(outcome.certified, "K = {k}, {sites} sites: {:?}", outcome.warnings);
            assert_eq!(outcome.saddles.len(), sites, "K = {k}");
            assert_eq!(outcome.intermediate_minima.len(), sites - 1, "K = {k}");
            assert!((forward(&outcome) - expected).abs() < 1e-9, "K = {k}, {sites} sites: {}", forward(&outcome));
        }
    }
}

#[test]
fn states_joined_by_a_flat_valley_have_a_certified_barrier_of_zero_and_the_reason_is_said() {
    // an easy plane: turning within it costs nothing, whatever the first path
    for guess in [None, Some(GuessSpec::Sweep(Sweep::from(Edge::Left)))] {
        let plane = Build::open(8).hard(0.1);
        let mut problem = plane.problem(Spins::uniform(8, Direction::Z), Spins::uniform(8, Direction::Y));
        problem.guess = guess;
        let outcome = solve(&problem);
        assert_eq!(outcome.stop_code, StopCode::FlatValley, "{} {:?}", outcome.stop_reason, outcome.warnings);
        assert!(outcome.certified && outcome.converged && outcome.stop_reason.contains("no barrier"));
        assert!(outcome.stop_reason.contains("flat to rounding (") && outcome.stop_reason.contains(" meV)"));
        assert!(forward(&outcome) == 0.0 && outcome.saddles.is_empty());
    }
}

#[test]
fn of_ends_that_are_one_minimum_turned_each_is_told_with_its_own_energy_and_torque() {
    let build = Build::open(24).easy(0.3);
    let wall = |through: [f64; 3]| build.wall(11.6, 3.0, Direction::new(through).expect("a direction"));
    let [from, to] = [wall([1.0, 0.0, 0.0]), wall([0.2, 0.9, 0.0])];
    let problem = build.problem(from, to);
    let outcome = solve(&problem);
    assert_eq!(outcome.stop_code, StopCode::FlatValley, "{}", outcome.stop_reason);
    let ends = [(&outcome.initial, 0), (&outcome.final_state, outcome.path.images() - 1)];
    let torques = ends.map(|(told, image)| {
        let own = Minimum::examine(problem.evaluator(), &outcome.path.spins(image));
        assert_eq!((told.energy_mev, told.max_torque_mev), (own.energy_mev, own.max_torque_mev), "image {image}");
        own.max_torque_mev
    });
    assert!(torques[0] != torques[1], "{torques:?}");
}

#[test]
fn ends_that_relax_to_one_minimum_give_no_barrier_but_the_reason() {
    let tilted = Spins::uniform(5, Direction::new([0.3, 0.0, 1.0]).expect("a direction"));
    let outcome = solve(&Build::open(5).easy(0.1).problem(Spins::uniform(5, Direction::Z), tilted));
    assert!(outcome.barrier.is_none() && !outcome.converged);
    assert!(outcome.stop_reason.contains("same minimum"), "{}", outcome.stop_reason);
}

/// A random chain: open or ring, ferro- or antiferromagnetic, with disorder, DMI and fields of any kind.
fn random_chain(r: &mut ChaCha8Rng) -> (Problem, String) {
    let n = r.random_range(5..=60);
    let ring = r.random_range(0..3) == 0;
    let mut build = if ring { Build::ring(n) } else { Build::open(n) };
    let chain = build.lattice.clone();
    let antiferro = r.random_range(0..4) == 0 && (!ring || n % 2 == 0);
    let k: f64 = libm::exp(r.random_range(-4.6..-0.5));
    let mut exchange = Exchange::uniform(&chain, &[if antiferro { -1.0 } else { 1.0 }]);
    let mut easy = Anisotropy::uniform(n, k, Direction::Z);
    let mut dmi = Dmi::uniform(&chain, 0.0, Direction::Y);
    let kind = r.random_range(0..6);
    if kind % 2 == 1 {
        exchange.families[0].mev.iter_mut().for_each(|j| *j *= r.random_range(0.4..1.6));
        easy.k.iter_mut().for_each(|k| *k *= r.random_range(0.3..1.7));
    }
    if kind >= 3 {
        let scale = 0.5 * 4.0 / std::f64::consts::PI * (0.5 * k).sqrt();
        for i in 0..chain.bonds(1).len() {
            dmi.families[0].mev[i] = scale * r.random_range(0.0..1.0);
        }
    }
    let mut field = [0.0; 3];
    if kind == 2 || kind == 5 {
        field = [0; 3].map(|_| 0.3 * k * r.random_range(-1.0..1.0));
    }
    build.terms = vec![Box::new(exchange), Box::new(easy), Box::new(dmi), Box::new(Zeeman::uniform(n, field))];
    let text = format!("N {n} ring {ring} antiferro {antiferro} K {k:.4} kind {kind}");
    let problem = match antiferro {
        true => build.problem(staggered(n, 1.0), staggered(n, -1.0)),
        false => build.reversal(),
    };
    (problem, text)
}

/// Eigenvalues of the Riemannian Hessian of image k, by a dense solver.
fn dense_eigenvalues(problem: &Problem, m: &[f64]) -> (Vec<f64>, f64) {
    let h = &problem.hamiltonian;
    let mut g = vec![0.0; m.len()];
    h.energy_gradient(m, &mut g);
    let matrix = assemble(h, m, &g, &TangentBasis::at(m));
    let n = matrix.order();
    let full: Vec<f64> = (0..n * n).map(|k| matrix.get(k / n, k % n)).collect();
    (eigenvalues_symmetric(&full, n), matrix.norm1())
}

#[test]
fn two_hundred_random_chains_give_no_nan_and_no_wrong_claim() {
    let mut r = ChaCha8Rng::seed_from_u64(2026);
    let chains: Vec<_> = (0..200).map(|_| random_chain(&mut r)).collect();
    let certified = chains.par_iter().filter(|(problem, text)| claims_hold(problem, text)).count();
    println!("{certified} of 200 certified");
    assert!(certified >= 190, "only {certified} of 200 were certified");
}

/// Solves a chain and checks every claim of the outcome; whether it was certified.
fn claims_hold(problem: &Problem, text: &str) -> bool {
    let outcome = solve(problem);
    println!(
        "{text}: {} {:.2} s, {} evaluations, {} saddles, {}",
        outcome.certified,
        outcome.work.seconds,
        outcome.work.force_evaluations,
        outcome.saddles.len(),
        outcome.stop_reason
    );
    for m in outcome.path.to_image_site_xyz().rows() {
        assert!((m.dot(&m) - 1.0).abs() < 1e-14, "{text}: a spin of length {}", m.dot(&m).sqrt());
    }
    let finite = outcome.barrier.is_none_or(|b| b.forward_mev.is_finite() && b.backward_mev.is_finite());
    assert!(finite, "{text}");
    if !outcome.certified {
        return false;
    }
    let reference = problem.hamiltonian.energy_mev(outcome.path.image(0));
    for s in &outcome.saddles {
        let (values, norm) = dense_eigenvalues(problem, s.spins.as_slice());
        // a dense solver finds exact zero modes to some eps·‖H‖ only
        let floor = 1e-13 * norm;
        let negative = values.iter().filter(|v| **v < -floor).count();
        assert!(negative <= 1, "{text}: {negative} negative modes {:?}", &values[..3]);
        assert!(s.max_torque_mev.expect("a torque") <= 1e-12 * norm, "{text}");
        let energy = problem.hamiltonian.energy_mev(s.spins.as_slice());
        assert!((energy - reference - s.above_initial_mev).abs() < 1e-11, "{text}");
    }
    let top = outcome.saddles.iter().map(|s| s.above_initial_mev).fold(f64::MIN, f64::max);
    assert!((top - forward(&outcome)).abs() < 1e-12, "{text}");
    true
}

/// A wall in a chain with a weak site, its ends kept as they are: at `from` and at `to`.
fn kept(from: f64, to: f64) -> Outcome {
    let build = Build::open(40).easy(0.05).defect(19, -0.04);
    let wall = |center: f64| build.wall(center, 3.2, Direction::X);
    let (a, b) = (wall(from), wall(to));
    let mut problem = build.problem(a, b);
    problem.relax_ends = false;
    solve(&problem)
}

#[test]
fn kept_ends_that_are_the_highest_point_of_the_path_give_no_barrier_and_the_reason() {
    for (from, to, which) in [(12.0, 19.0, "initial"), (19.0, 12.0, "final")] {
        let outcome = kept(from, to);
        let difference = outcome.initial.energy_mev - outcome.final_state.energy_mev;
        assert!(difference.abs() > 1e-3 && (difference > 0.0) == (which == "initial"), "{difference}");
        assert!(outcome.barrier.is_none() && !outcome.converged && !outcome.certified, "{which}");
        assert_eq!(outcome.stop_code, StopCode::KeptEnd, "{}", outcome.stop_reason);
        assert!(
            outcome.stop_reason.contains(&format!("is the {which} state, kept as given")),
            "{}",
            outcome.stop_reason
        );
        assert_eq!(outcome.initial.moved_rad, None);
    }
}
