//! Paths with many saddles, and paths that are long beside a wall's width.

use crate::common::{Build, forward, solve};
use spinneb::drive::{Outcome, Problem};
use spinneb::energy::Exchange;
use spinneb::geometry::Direction;
use spinneb::lattice::Chain;

/// A run from default settings: certified, resolved, and with its barrier at the highest of its saddles.
fn certified(what: &str, problem: &Problem) -> Outcome {
    let outcome = solve(problem);
    println!(
        "{what}: {} meV, {} saddles, {} images, {:.2} s",
        forward(&outcome),
        outcome.saddles.len(),
        outcome.path.images(),
        outcome.work.seconds
    );
    assert!(outcome.certified, "{what}: {:?}", outcome.warnings);
    assert!(outcome.path.largest_rotation() < 1.5, "{what}: {}", outcome.path.largest_rotation());
    let s = outcome.path.reaction_coordinate();
    assert!(s.windows(2).all(|w| w[1] > w[0]), "{what}: {s:?}");
    let heights = heights(&outcome);
    let highest = heights.iter().copied().fold(f64::MIN, f64::max);
    assert!((highest - forward(&outcome)).abs() < 1e-12, "{what}: {heights:?}");
    assert_eq!(outcome.intermediate_minima.len() + 1, heights.len(), "{what}");
    outcome
}

fn heights(outcome: &Outcome) -> Vec<f64> {
    outcome.saddles.iter().map(|s| s.above_initial_mev).collect()
}

#[test]
fn a_wall_three_sites_wide_crosses_five_hundred_sites() {
    let outcome = certified("N = 500", &Build::open(500).easy(0.05).reversal());
    // the barrier of a chain of any length: a wall, 2√(2JK), less a little for the lattice
    assert!((forward(&outcome) - 0.629_778_104_052).abs() < 1e-11, "{}", forward(&outcome));
}

#[test]
fn a_wall_crosses_weak_and_strong_sites_one_after_the_other() {
    let chain = || Build::open(150).easy(0.05).defect(30, -0.02).defect(75, 0.04).defect(100, -0.03);
    let outcome = certified("defects", &chain().reversal());
    assert_eq!(outcome.saddles.len(), 3);
    // the strong site is the highest of them; the other two are a free wall
    let heights = heights(&outcome);
    assert!(heights[1] > heights[0] + 0.03 && heights[1] > heights[2] + 0.03, "{heights:?}");
    // from weak site to weak site over the strong one: the same top, less the wall in the weak site
    let pinned = |site: f64| chain().wall(site, 10f64.sqrt(), Direction::X);
    let inner = certified("defects, inner", &chain().problem(pinned(30.0), pinned(100.0)));
    let top = |o: &Outcome, start: f64| start + forward(o);
    let lowest = inner.initial.energy_mev - outcome.initial.energy_mev;
    assert!((top(&inner, lowest) - forward(&outcome)).abs() < 1e-9, "{} {}", top(&inner, lowest), forward(&outcome));
}

#[test]
fn competing_neighbours_make_a_row_of_saddles() {
    for sites in [50, 100] {
        let mut build = Build::on(Chain::open(sites));
        build.terms[0] = Box::new(Exchange::uniform(&build.lattice, &[1.0, -0.2]));
        let outcome = certified("J2 = −0.2 J", &build.easy(0.05).reversal());
        let heights = heights(&outcome);
        // the chain is its own mirror, and so is the row
        for (a, b) in heights.iter().zip(heights.iter().rev()) {
            assert!((a - b).abs() < 1e-9, "{heights:?}");
        }
        assert!((forward(&outcome) - 0.317_355_717_496).abs() < 1e-11, "{}", forward(&outcome));
    }
}

#[test]
fn narrow_walls_hop_from_end_to_end_at_the_height_of_one_hop() {
    let outcome = certified("K = J", &Build::open(60).easy(1.0).reversal());
    let heights = heights(&outcome);
    // far from the ends a hop starts from 2 J, the energy of a wall between two sites, and costs what the reference says
    let hop = 0.637_963_409_109_5;
    assert!((forward(&outcome) - 2.0 - hop).abs() < 1e-11, "{}", forward(&outcome));
    assert!(heights.iter().all(|h| *h < 2.0 + hop + 1e-11), "{heights:?}");
    // at the ends the wall enters over less
    assert!(heights[0] < 2.1 && heights[heights.len() - 1] < 2.1, "{heights:?}");
}

#[test]
fn dzyaloshinskii_rings_and_their_mirror_images_have_one_barrier() {
    for (d, direction) in [(0.1, Direction::Y), (0.3, Direction::Y), (0.1, Direction::Z), (0.3, Direction::Z)] {
        let [a, b] = [d, -d].map(|d| solve(&Build::ring(30).easy(0.2).dmi(d, direction).reversal()));
        assert!((forward(&a) - forward(&b)).abs() < 1e-10, "D = ±{d}: {} {}", forward(&a), forward(&b));
    }
}

#[test]
fn two_walls_on_a_ring_pass_each_other_over_the_lower_azimuth() {
    // beside these there are saddles on both sides of which lies one minimum: one wall turns all the way round
    for (sites, k, d) in [(30, 0.4, 0.1), (41, 0.2, 0.3)] {
        let [a, b] = [d, -d].map(|d| certified("a ring", &Build::ring(sites).easy(k).dmi(d, Direction::Z).reversal()));
        assert!((forward(&a) - forward(&b)).abs() < 1e-10, "D = ±{d}: {} {}", forward(&a), forward(&b));
    }
}

#[test]
fn two_walls_far_apart_on_a_ring_cost_what_each_does_alone() {
    let (k, d) = (0.4, 0.3);
    let ring = certified("a ring", &Build::ring(41).easy(k).dmi(d, Direction::Z).reversal());
    // one of them at rest between two sites, the other on the top of its hop
    let chain = certified("an open chain", &Build::open(41).easy(k).dmi(d, Direction::Z).reversal());
    let rests = chain.intermediate_minima.iter().map(|m| m.state.energy_mev - chain.initial.energy_mev);
    let rest = rests.fold(0.0, f64::max);
    let apart = forward(&ring) - (forward(&chain) + rest);
    assert!(apart < 0.0 && apart > -1e-6, "{apart}");
}

#[test]
fn two_equal_soft_modes_at_the_top_do_not_stop_a_descent() {
    // two walls half a ring apart: their distance and their azimuths cost some millionths of J
    let ring = certified("a ring", &Build::ring(60).easy(0.1).reversal());
    let chain = certified("an open chain", &Build::open(60).easy(0.1).reversal());
    let apart = forward(&ring) - 2.0 * forward(&chain);
    assert!(apart < 0.0 && apart > -2e-5, "{apart}");
}

#[test]
fn a_top_before_the_first_image_is_a_top() {
    // near the spiral's instability the wall enters over a low and narrow pass, after which the energy falls
    let [a, b] = [0.2, -0.2].map(|d| certified("D", &Build::open(50).easy(0.02).dmi(d, Direction::Y).reversal()));
    assert!((forward(&a) - forward(&b)).abs() < 1e-12, "{} {}", forward(&a), forward(&b));
}

#[test]
fn a_wall_between_flat_sides_is_followed_to_both_ends() {
    // far from the ends the energy does not depend on the wall's place to double precision: the top of the path is a plateau
    for (sites, k) in [(300, 0.01), (1000, 0.002)] {
        let wide = certified("hard axis", &Build::open(sites).easy(k).hard(0.5 * k).reversal());
        // a wall in the easy plane does not feel the hard axis
        let uniaxial = certified("uniaxial", &Build::open(sites).easy(k).reversal());
        assert!((forward(&wide) - forward(&uniaxial)).abs() < 1e-12, "{} {}", forward(&wide), forward(&uniaxial));
        assert_eq!(wide.saddles.len(), 1);
    }
}
