//! Magnetostatics against what is known by pen, and end to end.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use serde_json::Value;
use spinneb::drive::{Images, Outcome, Problem, Silent, run};
use spinneb::energy::magnetostatics::MU_0_MU_B_SQUARED;
use spinneb::energy::{Exchange, Hamiltonian, Medium, TermSpec};
use spinneb::geometry::Direction;
use spinneb::hessian::{TangentBasis, assemble};
use spinneb::lattice::{Chain, Lattice};
use spinneb::linalg::eigenvalues_symmetric;
use spinneb::profile::Profile;
use spinneb::spins::Spins;
use spinneb::units::{Length, Magnetisation, Moment};
use std::process::Command;

/// ζ(3).
const ZETA_3: f64 = 1.2020569031595942;

fn dipoles(sites: usize, periodic: bool) -> (Lattice, Hamiltonian) {
    let chain = Chain { periodic, spacing: Some(Length(0.5)), ..Chain::open(sites) }.resolve().unwrap();
    let spec: TermSpec = serde_json::from_str(r#"{"dipolar": {}}"#).unwrap();
    let medium = Medium::new(&chain, Some(Moment(3.0).into()), None);
    let term = spec.member().build(&medium).unwrap();
    let h = Hamiltonian::new(&chain, vec![term]).unwrap();
    (chain, h)
}

/// μ₀μ²/4πa³ (meV) of [`dipoles`].
fn unit() -> f64 {
    MU_0_MU_B_SQUARED * 9.0 / (4.0 * std::f64::consts::PI * 0.125)
}

fn alternating(sites: usize) -> Spins {
    let vectors: Vec<_> = (0..sites).map(|i| [0.0, 0.0, if i % 2 == 0 { 1.0 } else { -1.0 }]).collect();
    Spins::from_vectors(&vectors).unwrap()
}

#[test]
fn the_unit_of_dipolar_energy_is_that_of_codata() {
    // two moments of 1 μ_B at 1 nm: μ₀μ_B²/(4π nm³) = 8.6007e-47 J²/T² × 1e-7 × 1e27 = 5.36835e-5 meV
    let mu_b = 9.274_010_065_7e-24f64;
    let expected = 1.256_637_061_27e-6 * mu_b * mu_b / 1e-27 / 1.602_176_634e-22;
    assert!((MU_0_MU_B_SQUARED / expected - 1.0).abs() < 1e-10, "{MU_0_MU_B_SQUARED} {expected}");
}

#[test]
fn a_ring_of_dipoles_has_the_energies_of_the_infinite_chain() {
    for sites in [4, 10, 300] {
        let (_, h) = dipoles(sites, true);
        let along = h.energy_mev(Spins::uniform(sites, Direction::X).as_slice()) / sites as f64;
        let across = h.energy_mev(Spins::uniform(sites, Direction::Y).as_slice()) / sites as f64;
        let staggered = h.energy_mev(alternating(sites).as_slice()) / sites as f64;
        assert!((along / (-2.0 * ZETA_3 * unit()) - 1.0).abs() < 1e-13, "{sites}: {along}");
        assert!((across / (ZETA_3 * unit()) - 1.0).abs() < 1e-13, "{sites}: {across}");
        assert!((staggered / (-0.75 * ZETA_3 * unit()) - 1.0).abs() < 1e-13, "{sites}: {staggered}");
    }
}

#[test]
fn an_open_chain_of_dipoles_tends_to_the_infinite_one_as_its_ends_matter_less() {
    let error = |sites: usize| {
        let (_, h) = dipoles(sites, false);
        let along = h.energy_mev(Spins::uniform(sites, Direction::X).as_slice()) / sites as f64;
        along / (-2.0 * ZETA_3 * unit()) - 1.0
    };
    // Σ_n (N − n)/n³ = N ζ(3) − ζ(2) + …
    let zeta_2 = std::f64::consts::PI.powi(2) / 6.0;
    for sites in [200, 2000, 20_000] {
        let expected = -zeta_2 / ZETA_3 / sites as f64;
        assert!((error(sites) / expected - 1.0).abs() < 2.0 / sites as f64, "{sites}: {} {expected}", error(sites));
    }
}

/// A result from `spinneb run`.
fn result(name: &str, config: &str) -> (Option<i32>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let file = format!("{name}.json");
    std::fs::write(folder.path().join(&file), config).unwrap();
    let run = Command::new(env!("CARGO_BIN_EXE_spinneb"))
        .current_dir(folder.path())
        .args(["run", &file, "--quiet", "--set", r#"output={"formats":[],"plots":[]}"#])
        .output()
        .unwrap();
    let summary = std::fs::read_to_string(folder.path().join(format!("results/{name}/summary.json")));
    let summary = summary.unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&run.stderr)));
    (run.status.code(), serde_json::from_str(&summary).unwrap())
}

#[test]
fn a_single_cube_has_the_barrier_of_its_anisotropy_for_demagnetising_a_cube_costs_the_same_in_all_directions() {
    let config = r#"{
      "material": {"name": "cube", "Ms": "800 kA/m", "energy": [
        {"anisotropy": {"K": "50 kJ/m^3", "axis": [1, 0, 0]}},
        {"anisotropy": {"K": "-20 kJ/m^3", "axis": [0, 0, 1]}},
        {"demag": {}}
      ]},
      "lattice": {"chain": {"sites": 1, "spacing": "5 nm", "cross_section": ["5 nm", "5 nm"]}},
      "initial": {"uniform": {"direction": [1, 0, 0]}},
      "final": {"uniform": {"direction": [-1, 0, 0]}}
    }"#;
    let (code, summary) = result("cube", config);
    assert_eq!((code, &summary["certified"]), (Some(0), &Value::Bool(true)), "{summary}");
    let barrier = summary["barrier_J"]["forward"].as_f64().unwrap();
    assert!((barrier / 6.25e-21 - 1.0).abs() < 1e-12, "{barrier:e}");
}

#[test]
fn two_cells_without_exchange_or_magnetostatics_turn_one_after_the_other() {
    let config = r#"{
      "material": {"name": "grains", "Ms": "1 MA/m", "energy": [
        {"anisotropy": {"K": "100 kJ/m^3", "axis": [0, 0, 1]}}
      ]},
      "lattice": {"chain": {"sites": 2, "spacing": "3 nm", "cross_section": ["3 nm", "3 nm"]}},
      "initial": {"uniform": {"direction": [0, 0, 1]}},
      "final": {"uniform": {"direction": [0, 0, -1]}}
    }"#;
    let (code, summary) = result("grains", config);
    let barrier = summary["barrier_meV"]["forward"].as_f64().unwrap();
    assert!((barrier / 16.852_074_5 - 1.0).abs() < 1e-8, "{summary}");
    assert_eq!((code, &summary["certified"]), (Some(0), &Value::Bool(true)), "{summary}");
}

#[test]
fn two_cells_that_turn_at_once_cost_twice_that_and_are_never_certified() {
    let chain =
        Chain { spacing: Some(Length(3.0)), cross_section: Some([Length(3.0); 2].map(Into::into)), ..Chain::open(2) }
            .resolve()
            .unwrap();
    let medium = Medium::new(&chain, None, Some(Magnetisation(1e6).into()));
    let easy = r#"{"anisotropy": {"K": "100 kJ/m^3", "axis": [0, 0, 1]}}"#;
    let build = || vec![serde_json::from_str::<TermSpec>(easy).unwrap().member().build(&medium).unwrap()];
    let h = Hamiltonian::new(&chain, build()).unwrap();
    // half-way: twice the barrier, and two ways down
    let [up, across] = [Direction::Z, Direction::X].map(|d| Spins::uniform(2, d));
    let height = h.difference_mev(across.as_slice(), up.as_slice());
    assert!((height / 33.704_149_0 - 1.0).abs() < 1e-9, "{height}");
    let mut g = vec![0.0; 6];
    h.energy_gradient(across.as_slice(), &mut g);
    let matrix = assemble(&h, across.as_slice(), &g, &TangentBasis::at(across.as_slice()));
    let full: Vec<f64> = (0..16).map(|k| matrix.get(k / 4, k % 4)).collect();
    assert_eq!(eigenvalues_symmetric(&full, 4).iter().filter(|e| **e < -1e-9).count(), 2);
    // a run that is told to begin there, by a geodesic or a rigid rotation, does not end there
    for guess in [r#"{"geodesic": {"axis": [1, 0, 0]}}"#, r#"{"rotation": {"axis": [1, 0, 0]}}"#] {
        for images in [11, 12] {
            let mut problem = Problem::new(Hamiltonian::new(&chain, build()).unwrap(), up.clone(), up.clone());
            problem.final_state = Spins::uniform(2, Direction::Z.reversed());
            problem.guess = Some(serde_json::from_str(guess).unwrap());
            problem.images = Images::Count(images);
            let barrier = solved(&problem).barrier.unwrap().forward_mev;
            assert!((barrier / 16.852_074_5 - 1.0).abs() < 1e-8, "{guess} {images}: {barrier}");
        }
    }
}

/// A wire of cells that differ: a notch, a taper, a ring of beads.
fn uneven(sites: usize, periodic: bool, square: bool) -> (Lattice, Hamiltonian) {
    let width = |i: usize| Length(12.0 + 5.0 * ((i * i) as f64 * 0.7).sin());
    let widths: Vec<Length> = (0..sites).map(width).collect();
    let thickness: Vec<Length> = if square { widths.clone() } else { vec![Length(5.0); sites] };
    let chain = Chain {
        periodic,
        spacing: Some(Length(5.0)),
        cross_section: Some([Profile::List(widths), Profile::List(thickness)]),
        ..Chain::open(sites)
    };
    let chain = chain.resolve().unwrap();
    let medium = Medium::new(&chain, None, Some(Magnetisation(8e5).into()));
    let terms = [r#"{"exchange": {"A": "13 pJ/m"}}"#, r#"{"demag": {}}"#];
    let build = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    let h = Hamiltonian::new(&chain, terms.iter().map(build).collect()).unwrap();
    (chain, h)
}

#[test]
fn cells_of_unequal_sections_have_derivatives_of_their_energy() {
    let mut r = ChaCha8Rng::seed_from_u64(3);
    for (sites, periodic, square) in [(2, false, false), (9, false, true), (9, true, false), (40, false, false)] {
        let (_, h) = uneven(sites, periodic, square);
        let vectors: Vec<_> = (0..sites).map(|_| [(); 3].map(|()| r.random_range(-1.0..1.0))).collect();
        let spins = Spins::from_vectors(&vectors).unwrap();
        let m = spins.as_slice();
        let mut g = vec![0.0; m.len()];
        h.energy_gradient(m, &mut g);
        let scale = h.stiffness_mev();
        let v: Vec<f64> = (0..m.len()).map(|_| r.random_range(-1.0..1.0)).collect();
        // components taken as free: the energy is quadratic, so the central difference is exact but for rounding
        let density = |t: f64| {
            let moved: Vec<f64> = m.iter().zip(&v).map(|(m, v)| m + t * v).collect();
            h.energy_gradient(&moved, &mut vec![0.0; m.len()])
        };
        let difference = density(0.5) - density(-0.5);
        let slope: f64 = g.iter().zip(&v).map(|(g, v)| g * v).sum();
        assert!((difference - slope).abs() < 1e-11 * scale * sites as f64, "{sites}: {difference} {slope}");
        let basis = TangentBasis::at(m);
        let matrix = assemble(&h, m, &g, &basis);
        let n = 2 * sites;
        let (mut unit, mut field, mut out) = (vec![0.0; n], vec![0.0; m.len()], vec![0.0; m.len()]);
        for k in 0..n {
            unit.fill(0.0);
            unit[k] = 1.0;
            basis.field(&unit, &mut field);
            h.hessian_product(m, &g, &field, &mut out);
            for (i, x) in basis.coordinates(&out).iter().enumerate() {
                assert!((x - matrix.get(i, k)).abs() < 1e-12 * scale, "{sites} {i} {k}");
            }
        }
        assert_eq!(h.symmetry_axes().len(), usize::from(square), "{sites}");
    }
}

#[test]
fn a_wire_that_tapers_by_nothing_is_a_straight_one() {
    let straight = wire(30);
    let mut chain = straight.hamiltonian.lattice().clone();
    let barely = |i: usize| [20.0 * (1.0 + 1e-13 * i as f64), 5.0];
    chain.sections_nm = Some((0..30).map(barely).collect());
    let medium = Medium::new(&chain, None, Some(Magnetisation(8e5).into()));
    let terms = [r#"{"exchange": {"A": "13 pJ/m"}}"#, r#"{"demag": {}}"#];
    let build = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    let tapered = Hamiltonian::new(&chain, terms.iter().map(build).collect()).unwrap();
    let mut r = ChaCha8Rng::seed_from_u64(4);
    let vectors: Vec<_> = (0..30).map(|_| [(); 3].map(|()| r.random_range(-1.0..1.0))).collect();
    let spins = Spins::from_vectors(&vectors).unwrap();
    let [a, b] = [&straight.hamiltonian, &tapered].map(|h| h.energy_mev(spins.as_slice()));
    assert!((a / b - 1.0).abs() < 1e-11, "{a} {b}");
}

#[test]
fn a_hundred_thousand_cells_have_a_gradient_and_a_hessian() {
    let problem = wire(100_000);
    let (h, m) = (&problem.hamiltonian, problem.initial.as_slice());
    let mut g = vec![0.0; m.len()];
    assert!(h.energy_gradient(m, &mut g).is_finite());
    let matrix = assemble(h, m, &g, &TangentBasis::at(m));
    // magnetised along itself, the wire is stable
    assert_eq!(matrix.factor().negatives(), 0);
}

/// A Permalloy wire of 5 nm cells, 20 nm × 5 nm across, as long as `sites` cells; reversed.
fn wire(sites: usize) -> Problem {
    let chain = Chain {
        spacing: Some(Length(5.0)),
        cross_section: Some([Length(20.0), Length(5.0)].map(Into::into)),
        ..Chain::open(sites)
    };
    let chain = chain.resolve().unwrap();
    let medium = Medium::new(&chain, None, Some(Magnetisation(8e5).into()));
    let terms = [r#"{"exchange": {"A": "13 pJ/m"}}"#, r#"{"demag": {}}"#];
    let build = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    let h = Hamiltonian::new(&chain, terms.iter().map(build).collect()).unwrap();
    let [a, b] = [Direction::X, Direction::X.reversed()].map(|d| Spins::uniform(sites, d));
    Problem::new(h, a, b)
}

fn solved(problem: &Problem) -> Outcome {
    let outcome = run(problem, &mut Silent).unwrap();
    assert!(outcome.certified, "{:?} {:?}", outcome.stop_reason, outcome.warnings);
    outcome
}

#[test]
fn a_permalloy_wire_reverses_by_a_wall_and_the_barrier_does_not_grow_with_its_length() {
    let (short, long) = (solved(&wire(40)), solved(&wire(140)));
    let [a, b] = [&short, &long].map(|o| o.barrier.unwrap());
    // both ends are alike
    assert!((a.forward_mev / a.backward_mev - 1.0).abs() < 1e-9 && (b.forward_mev / b.backward_mev - 1.0).abs() < 1e-9);
    assert!((b.forward_mev / a.forward_mev - 1.0).abs() < 0.05, "{} {}", a.forward_mev, b.forward_mev);
}

#[test]
fn the_index_counted_by_exponentials_is_that_of_all_eigenvalues() {
    let sites = 130;
    let (chain, _) = dipoles(sites, false);
    let spec: TermSpec = serde_json::from_str(r#"{"dipolar": {}}"#).unwrap();
    let medium = Medium::new(&chain, Some(Moment(3.0).into()), None);
    for (exchange, k) in [(-0.02, 0), (0.0, 1), (0.02, 2)] {
        let terms = vec![spec.member().build(&medium).unwrap(), Box::new(Exchange::uniform(&chain, &[exchange]))];
        let h = Hamiltonian::new(&chain, terms).unwrap();
        let states = [Spins::uniform(sites, Direction::X), Spins::uniform(sites, Direction::Y), alternating(sites)];
        {
            let m = states[k].as_slice();
            let mut g = vec![0.0; m.len()];
            h.energy_gradient(m, &mut g);
            let matrix = assemble(&h, m, &g, &TangentBasis::at(m));
            let n = 2 * sites;
            let full: Vec<f64> = (0..n * n).map(|k| matrix.get(k / n, k % n)).collect();
            let eigen = eigenvalues_symmetric(&full, n);
            // off the zero mode of rotation about the chain
            for shift in [1e-6, -1e-6, 1e-3] {
                let mut shifted = matrix.clone();
                shifted.shift(shift);
                let negative = eigen.iter().filter(|e| **e + shift < 0.0).count();
                assert_eq!(shifted.factor().negatives(), negative, "{exchange} {shift}");
            }
        }
    }
}

#[test]
fn a_wall_leaves_one_pinning_region_of_a_permalloy_wire_for_another() {
    let wall = |center: usize| {
        format!(
            r#"{{"domain_wall": {{"center": {center}, "left": [1, 0, 0], "right": [-1, 0, 0], "through": [0, 1, 0]}}}}"#
        )
    };
    let soft = |from: usize| {
        let sites = format!(r#"{{"from": {from}, "to": {}}}"#, from + 10);
        format!(r#"{{"anisotropy": {{"K": "-40 kJ/m^3", "axis": [1, 0, 0], "sites": {sites}}}}}"#)
    };
    let config = format!(
        r#"{{
      "material": {{"name": "Permalloy", "Ms": "800 kA/m", "energy": [{{"exchange": {{"A": "13 pJ/m"}}}}, {{"demag": {{}}}}]}},
      "lattice": {{"chain": {{"sites": 126, "spacing": "5 nm", "cross_section": ["20 nm", "5 nm"]}}}},
      "energy": [{}, {}],
      "initial": {}, "final": {}
    }}"#,
        soft(28),
        soft(88),
        wall(33),
        wall(93)
    );
    let (code, summary) = result("depinning", &config);
    assert_eq!((code, &summary["certified"]), (Some(0), &Value::Bool(true)), "{summary}");
    assert_eq!(summary["saddles"].as_array().unwrap().len(), 1, "{summary}");
    // the wall moves as it is; to turn it over on the way would cost four times as much
    let barrier = summary["barrier_meV"]["forward"].as_f64().unwrap();
    assert!((barrier - 751.576_420_6).abs() < 1e-6, "{barrier}");
}

/// A short chain or ring of random dots or cells, with or without exchange and easy axes.
fn random(r: &mut ChaCha8Rng, sites: usize) -> (Problem, String) {
    let periodic = r.random_range(0..4) == 0;
    let edge = |r: &mut ChaCha8Rng| Length(r.random_range(2.0..12.0));
    let chain = Chain {
        periodic,
        spacing: Some(Length(r.random_range(5.0..8.0))),
        cross_section: Some([edge(r), edge(r)].map(Into::into)),
        ..Chain::open(sites)
    };
    let chain = chain.resolve().unwrap();
    let medium = Medium::new(&chain, None, Some(Magnetisation(r.random_range(3e5..1.2e6)).into()));
    let far = if r.random_range(0..3) == 0 { "dipolar" } else { "demag" };
    let axis = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.2, 1.0]][r.random_range(0..3)];
    let texts = [
        format!(r#"{{"{far}": {{}}}}"#),
        format!(r#"{{"exchange": {{"A": "{} pJ/m"}}}}"#, [0.0, 2.0, 10.0][r.random_range(0..3)]),
        format!(r#"{{"anisotropy": {{"K": "{} kJ/m^3", "axis": {axis:?}}}}}"#, r.random_range(20.0..400.0)),
    ];
    let build = |text: &String| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
    let h = Hamiltonian::new(&chain, texts.iter().map(build).collect()).unwrap();
    let up = Direction::new(axis).unwrap();
    let [a, b] = [up, up.reversed()].map(|d| Spins::uniform(sites, d));
    (Problem::new(h, a, b), format!("{sites} sites, ring {periodic}, {texts:?}"))
}

#[test]
fn every_certified_saddle_of_random_chains_has_one_negative_eigenvalue_by_a_dense_solver() {
    let mut r = ChaCha8Rng::seed_from_u64(11);
    let sizes = (0..40).map(|k| 1 + k % 19);
    let chains: Vec<(Problem, String)> = sizes.map(|n| random(&mut r, n.max(3))).collect();
    let claims: Vec<Option<bool>> = chains.par_iter().map(|(problem, text)| claim(problem, text)).collect();
    let paths = claims.iter().flatten().count();
    let certified = claims.iter().flatten().filter(|c| **c).count();
    println!("{certified} of {paths} paths certified, {} chains have one minimum only", claims.len() - paths);
    assert!(paths >= 25 && 10 * certified >= 9 * paths - 10, "only {certified} of {paths}");
}

/// Solves a chain and checks every claim of the outcome; whether it was certified, if there are two minima at all.
fn claim(problem: &Problem, text: &str) -> Option<bool> {
    let outcome = run(problem, &mut Silent).unwrap();
    println!("{} {text}: {} {:?}", outcome.certified, outcome.work.seconds, outcome.warnings);
    assert!(outcome.barrier.is_none_or(|b| b.forward_mev.is_finite() && b.backward_mev.is_finite()), "{text}");
    if !outcome.certified {
        return outcome.barrier.map(|_| false);
    }
    let h = &problem.hamiltonian;
    for s in &outcome.saddles {
        let m = s.spins.as_slice();
        let mut g = vec![0.0; m.len()];
        h.energy_gradient(m, &mut g);
        // column by column from products, which know nothing of exponentials
        let basis = TangentBasis::at(m);
        let n = 2 * h.sites();
        let mut full = vec![0.0; n * n];
        let (mut v, mut out, mut unit) = (vec![0.0; m.len()], vec![0.0; m.len()], vec![0.0; n]);
        for k in 0..n {
            unit.fill(0.0);
            unit[k] = 1.0;
            basis.field(&unit, &mut v);
            h.hessian_product(m, &g, &v, &mut out);
            full[k * n..(k + 1) * n].copy_from_slice(&basis.coordinates(&out));
        }
        let norm = full.chunks(n).map(|row| row.iter().map(|x| x.abs()).sum::<f64>()).fold(0.0, f64::max);
        let negative = eigenvalues_symmetric(&full, n).iter().filter(|e| **e < -1e-13 * norm).count();
        let told = s.negative_modes.unwrap();
        assert!(negative <= 1 && told <= 1, "{text}: {negative} negative eigenvalues, {told} told");
        let tangent = basis.coordinates(&g);
        assert!(tangent.iter().all(|t| t.abs() <= 1.1e-12 * norm), "{text}: not stationary");
    }
    Some(true)
}

#[test]
fn a_chain_whose_dipoles_are_all_but_nothing_has_the_rates_of_one_without() {
    let config = |far: &str, sites: usize, periodic: bool, [from, to]: [&str; 2]| {
        format!(
            r#"{{
          "material": {{"name": "chain", "moment": "2 mu_B", "energy": [
            {{"exchange": {{"J": ["1 meV"]}}}},
            {{"anisotropy": {{"K": "0.3 meV", "axis": [0, 0, 1]}}}},
            {{"anisotropy": {{"K": "-0.2 meV", "axis": [1, 0, 0]}}}}{far}
          ]}},
          "lattice": {{"chain": {{"sites": {sites}, "spacing": "300 nm", "periodic": {periodic}}}}},
          "initial": {from}, "final": {to},
          "rates": {{"temperatures": ["0.005 K"], "damping": 0.1}}
        }}"#
        )
    };
    let ends = [1, -1].map(|z| format!(r#"{{"uniform": {{"direction": [0, 0, {z}]}}}}"#));
    let hop = [69.5, 70.5].map(|center| format!(r#"{{"domain_wall": {{"center": {center}}}}}"#));
    // the Hessian of the longest is a band with a tail
    for (sites, periodic, [from, to]) in [(8, false, &ends), (8, true, &ends), (140, false, &hop)] {
        let rates = |far: &str| result("rates", &config(far, sites, periodic, [from, to])).1["rates"].clone();
        let (near, far) = (rates(""), rates(r#", {"dipolar": {}}"#));
        let (near, far) = (near.as_array().unwrap(), far.as_array().unwrap());
        assert!(!near.is_empty() && near.len() == far.len());
        for (a, b) in near.iter().zip(far) {
            for key in ["htst_prefactor_Hz", "langer_prefactor_Hz"] {
                let (a, b) = (a[key].as_f64().unwrap(), b[key].as_f64().unwrap());
                assert!((a / b - 1.0).abs() < 1e-6, "{sites} {key}: {a} {b}");
            }
        }
    }
}
