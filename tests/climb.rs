//! Climbs from any state to a saddle.

use crate::common::Build;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use spinneb::energy::{Anisotropy, Evaluator, Exchange, Hamiltonian};
use spinneb::geometry::{Direction, Vector, rotate};
use spinneb::lattice::{Chain, Frozen, Selection};
use spinneb::linalg::{eigenvalues_symmetric, slab};
use spinneb::sphere::move_points;
use spinneb::spins::Spins;
use spinneb::stationary::{Climb, GaveUp, Limits, Saddle, Spectrum, State, climb, relax_to_minimum};

const NOTHING: &(dyn Fn(&[f64], f64) -> bool + Sync) = &|_, _| false;

fn limits() -> Limits<'static> {
    Limits { steps: 60, without_mode: 8, radius: 0.5, ceiling_mev: f64::INFINITY, known: NOTHING }
}

fn hamiltonian(build: Build) -> Hamiltonian {
    Hamiltonian::new(&build.lattice, build.terms).expect("a valid chain")
}

fn component_major(spins: &[Vector]) -> Vec<f64> {
    (0..3).flat_map(|c| spins.iter().map(move |s| s[c])).collect()
}

fn random_spins(n: usize, r: &mut ChaCha8Rng) -> Vec<Vector> {
    (0..n).map(|_| random_direction(r).vector()).collect()
}

fn random_direction(r: &mut ChaCha8Rng) -> Direction {
    Direction::new([(); 3].map(|()| r.random_range(-1.0..1.0))).expect("no zero vector")
}

fn saddle(h: &Hamiltonian, spins: &[Vector]) -> Saddle {
    climb(h.into(), &component_major(spins), &limits()).saddle.expect("a saddle")
}

/// A frustrated chain: random bonds to both neighbours, axes and fields, in a frame turned by some angle about an axis.
fn glass(n: usize, seed: u64, turn: (Direction, f64)) -> Hamiltonian {
    let mut r = ChaCha8Rng::seed_from_u64(seed);
    let turned = |d: Direction| Direction::new(rotate(d.vector(), turn.0, turn.1)).expect("of unit length");
    let mut build = Build::on(Chain::open(n));
    build.terms.clear();
    let mut exchange = Exchange::uniform(&build.lattice, &[1.0, 1.0][..n.min(3) - 1]);
    for j in exchange.families.iter_mut().flat_map(|f| &mut f.mev) {
        *j *= r.random_range(-4.0..4.0);
    }
    build = build.with(exchange);
    for i in 0..n {
        let mut own = Anisotropy::uniform(n, 0.0, turned(random_direction(&mut r)));
        own.k[i] = r.random_range(0.2..2.0);
        build = build.with(own);
    }
    let field = turned(random_direction(&mut r)).vector().map(|b| 0.5 * b);
    hamiltonian(build.field(field))
}

const UNTURNED: (Direction, f64) = (Direction::Z, 0.0);

fn eigenvalues(h: &Hamiltonian, m: &[f64]) -> Vec<f64> {
    let state = State::at(h.into(), m.to_vec());
    let n = state.hessian.order();
    let full: Vec<f64> = (0..n * n).map(|k| state.hessian.get(k / n, k % n)).collect();
    eigenvalues_symmetric(&full, n)
}

#[test]
fn a_spin_with_two_axes_climbs_to_the_intermediate_one() {
    let h = hamiltonian(Build::open(1).easy(0.7).hard(0.4));
    let start = rotate([0.0, 0.0, 1.0], Direction::new([0.6, 0.8, 0.0]).unwrap(), 2.0);
    let s = saddle(&h, &[start]);
    // E = −K z² + K' x²: 0 along y, falling as −K θ² along z
    assert!((h.energy_mev(&s.state.m)).abs() < 1e-14 && s.state.m[1].abs() > 1.0 - 1e-14, "{:?}", s.state.m);
    assert!((s.curvature_mev + 1.4).abs() < 1e-13 && s.mode[2].abs() > 1.0 - 1e-13, "{} {:?}", s.curvature_mev, s.mode);
}

#[test]
fn two_spins_turn_together_or_one_after_the_other() {
    // E = −J m₁·m₂ − K (z₁² + z₂²): the saddles are 2K above the minimum for J > K, and J + K for J < K
    for (k, height) in [(0.4, 0.8), (2.0, 3.0)] {
        let h = hamiltonian(Build::open(2).easy(k));
        let [axis, other] = [[1.0, 0.2, 0.0], [0.9, 0.5, 0.1]].map(|a| Direction::new(a).unwrap());
        let spins = [rotate([0.0, 0.0, 1.0], axis, 1.2), rotate([0.0, 0.0, 1.0], other, 0.8)];
        let s = saddle(&h, &spins);
        assert!((h.energy_mev(&s.state.m) + 1.0 + 2.0 * k - height).abs() < 1e-13, "{k}: {}", h.energy_mev(&s.state.m));
        assert_eq!(Spectrum::of((&h).into(), &s.state, 0).zero, 1);
    }
}

#[test]
fn what_a_climb_ends_in_has_one_negative_direction_and_no_torque() {
    let mut r = ChaCha8Rng::seed_from_u64(1);
    let (mut found, mut steps) = (0, 0);
    let tries = 200;
    for seed in 0..tries {
        let n = 1 + seed as usize % 14;
        let h = glass(n.max(2), seed, UNTURNED);
        let start = component_major(&random_spins(h.sites(), &mut r));
        let Climb { saddle, steps: taken } = climb((&h).into(), &start, &limits());
        steps += taken;
        let Ok(s) = saddle else { continue };
        found += 1;
        let values = eigenvalues(&h, &s.state.m);
        assert!(values[0] < 0.0 && values[1] > 0.0, "{seed}: {values:?}");
        assert!(
            (values[0] - s.curvature_mev).abs() < 1e-12 * h.stiffness_mev(),
            "{seed}: {values:?} {}",
            s.curvature_mev
        );
        assert!(s.state.max_torque_mev() < 1e-14 * h.stiffness_mev(), "{seed}: {:e}", s.state.max_torque_mev());
        assert!((slab::norm(&s.mode) - 1.0).abs() < 1e-13);
        // the curvature as the energy has it
        let energy = |step: f64| {
            let mut m = s.state.m.clone();
            move_points(&mut m, &s.mode, s.mode.len(), step);
            h.difference_mev(&m, &s.state.m)
        };
        let difference = (energy(1e-3) + energy(-1e-3)) * 1e6;
        assert!((difference - s.curvature_mev).abs() < 1e-4 * h.stiffness_mev(), "{seed}: {difference}");
    }
    assert!(found > tries * 4 / 5 && steps < 25 * tries as usize, "{found} saddles in {steps} steps");
}

#[test]
fn a_turned_frame_turns_the_saddle() {
    let mut r = ChaCha8Rng::seed_from_u64(2);
    for seed in 0..20 {
        let turn = (random_direction(&mut r), r.random_range(0.3..3.0));
        let n = 3 + seed as usize % 6;
        let [h, turned] = [UNTURNED, turn].map(|turn| glass(n, seed, turn));
        let spins = random_spins(n, &mut r);
        let other: Vec<Vector> = spins.iter().map(|s| rotate(*s, turn.0, turn.1)).collect();
        let ends =
            [(&h, spins), (&turned, other)].map(|(h, s)| climb(h.into(), &component_major(&s), &limits()).saddle.ok());
        let [Some(a), Some(b)] = ends.map(|s| s.map(|s| s.state)) else { continue };
        let apart = a.m.iter().zip(rotated(&b.m, turn)).fold(0.0f64, |d, (x, y)| d.max((x - y).abs()));
        assert!(apart < 1e-9, "{seed}: {apart:e}, {} {}", a.energy_mev, b.energy_mev);
    }
}

/// The spins turned back into the frame.
fn rotated(m: &[f64], (axis, angle): (Direction, f64)) -> Vec<f64> {
    let n = m.len() / 3;
    let spins: Vec<Vector> = (0..n).map(|i| rotate([m[i], m[n + i], m[2 * n + i]], axis, -angle)).collect();
    component_major(&spins)
}

#[test]
fn a_climb_gives_up_where_its_limits_say_so() {
    let h = glass(6, 3, UNTURNED);
    let e: Evaluator = (&h).into();
    let mut r = ChaCha8Rng::seed_from_u64(4);
    let start = component_major(&random_spins(6, &mut r));
    let s = climb(e, &start, &limits()).saddle.expect("a saddle").state;
    let why = |limits: Limits| climb(e, &start, &limits).saddle.map(|_| ()).unwrap_err();
    assert_eq!(why(Limits { ceiling_mev: s.energy_mev - 0.5, ..limits() }), GaveUp::TooHigh);
    assert!(climb(e, &start, &Limits { ceiling_mev: s.energy_mev + 0.01, ..limits() }).saddle.is_ok());
    let beside = |m: &[f64], _: f64| m.iter().zip(&s.m).all(|(a, b)| (a - b).abs() < 0.05);
    assert_eq!(why(Limits { known: &beside, ..limits() }), GaveUp::Known);
    assert_eq!(why(Limits { steps: 2, ..limits() }), GaveUp::Steps);
    // no slope leads out of a minimum
    let minimum =
        relax_to_minimum(e, &Spins::from_components(&start).unwrap(), 1e-14 * h.stiffness_mev()).expect("a minimum");
    assert_eq!(climb(e, minimum.spins.as_slice(), &limits()).saddle.map(|_| ()).unwrap_err(), GaveUp::Stuck);
}

#[test]
fn a_symmetric_start_is_left_for_a_saddle_of_index_one() {
    // all spins across the axis: stationary, with a negative direction for every wall that fits in
    let h = hamiltonian(Build::open(16).easy(0.05));
    let across = vec![[0.6, 0.8, 0.0]; 16];
    let coherent = State::at((&h).into(), component_major(&across));
    assert!(Spectrum::of((&h).into(), &coherent, 0).negative > 1);
    let s = saddle(&h, &across);
    let negative = eigenvalues(&h, &s.state.m).iter().filter(|l| **l < -1e-12).count();
    assert!(negative == 1 && s.state.energy_mev < coherent.energy_mev - 0.01, "{negative} {}", s.state.energy_mev);
}

#[test]
fn frozen_spins_stay_where_they_are() {
    let frozen = vec![Frozen { sites: Selection::List(vec![0, 3]), direction: None }];
    let h = hamiltonian(Build::on(Chain { frozen, ..Chain::open(6) }).easy(0.5));
    let mut r = ChaCha8Rng::seed_from_u64(6);
    let mut found = 0;
    for _ in 0..40 {
        let start = component_major(&random_spins(6, &mut r));
        let Ok(top) = climb((&h).into(), &start, &limits()).saddle else { continue };
        found += 1;
        let m = top.state.m.clone();
        assert!([0, 3].iter().all(|i| (0..3).all(|c| m[6 * c + i] == start[6 * c + i])));
    }
    assert!(found > 5, "{found}");
}
