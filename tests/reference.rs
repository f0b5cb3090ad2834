//! Barriers against independent values, from default settings apart from the physics.

use crate::common::{Build, cases, forward, number};
use spinneb::drive::{Outcome, Problem};
use spinneb::geometry::Direction;
use spinneb::spins::Spins;

/// A run that must be certified, with one negative mode (or a valley flat to rounding) at each saddle.
///
/// Before that the band alone, its top image climbing but nothing refined further or certified, must give the same to 1e-6.
fn solve(mut problem: Problem) -> Outcome {
    (problem.refine, problem.certify) = (false, false);
    let band = crate::common::solve(&problem);
    (problem.refine, problem.certify) = (true, true);
    let outcome = crate::common::solve(&problem);
    let (coarse, fine) = (forward(&band), forward(&outcome));
    assert!((coarse - fine).abs() <= 1e-6 * fine, "the band alone gives {coarse}, the certified saddle {fine}");
    let (w, warnings) = (outcome.work, &outcome.warnings);
    println!(
        "{} saddles, {} evaluations, {:.3} s, certified {} {warnings:?}",
        outcome.saddles.len(),
        w.force_evaluations,
        w.seconds,
        outcome.certified
    );
    assert!(outcome.certified, "{warnings:?}");
    for s in &outcome.saddles {
        assert!(s.negative_modes == Some(1) || (s.negative_modes == Some(0) && s.zero_modes > Some(0)), "{s:?}");
    }
    outcome
}

/// The section's cases, each with the relative tolerance stated in the file.
fn section(name: &str) -> Vec<(serde_json::Value, f64)> {
    let cases = cases();
    let tolerance = number(&cases[name], "tolerance");
    cases[name]["cases"].as_array().expect("cases").iter().map(|c| (c.clone(), tolerance)).collect()
}

fn check(name: &str, case: &serde_json::Value, found: f64, expected: f64, tolerance: f64) {
    let error = (found - expected).abs() / expected.abs();
    println!("{name} {case}: {found} against {expected}, {error:.1e}");
    assert!(
        error <= tolerance,
        "{name} {case}: found {found}, expected {expected}: off by {error:.1e}, allowed {tolerance:.0e}"
    );
}

#[test]
fn single_spins_in_oblique_fields() {
    for (case, tolerance) in section("single_spin") {
        let (psi, h) = (number(&case, "psi").to_radians(), number(&case, "h"));
        // the field favours −z, at the angle ψ to the axis
        let b = [2.0 * h * psi.sin(), 0.0, -2.0 * h * psi.cos()];
        let outcome = solve(Build::open(1).easy(1.0).field(b).reversal());
        check("single_spin", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn open_chains_reverse_over_the_lowest_saddle() {
    for (case, tolerance) in section("open_chain_reversal") {
        let n = case["N"].as_u64().expect("N") as usize;
        let outcome = solve(Build::open(n).easy(number(&case, "K")).reversal());
        check("open_chain_reversal", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn a_ring_reverses_by_a_nucleus() {
    for (case, tolerance) in section("ring_nucleus") {
        let k = 0.01;
        let outcome = solve(Build::ring(200).easy(k).field([0.0, 0.0, -2.0 * k * number(&case, "h")]).reversal());
        check("ring_nucleus", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn a_wall_hops_by_one_site() {
    for (case, tolerance) in section("peierls") {
        let k = number(&case, "K");
        // 60 sites: the free ends are felt by less than 1e-16
        let build = Build::open(if k < 0.3 { 80 } else { 60 }).easy(k);
        let middle = build.lattice.sites as f64 / 2.0 - 0.5;
        let width = (0.5 / k).sqrt();
        let (a, b) = (build.wall(middle, width, Direction::X), build.wall(middle + 1.0, width, Direction::X));
        let outcome = solve(build.problem(a, b));
        check("peierls", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn a_wall_leaves_and_crosses_defects() {
    for (case, tolerance) in section("defect") {
        let (k, defect) = (0.05, number(&case, "K_defect"));
        let width = (0.5f64 / k).sqrt();
        if case["ends"] == "free" {
            let chain = || Build::open(100).easy(k).defect(49, defect - k);
            let build = chain();
            let pinned = build.wall(49.0, width, Direction::X);
            for (final_state, key) in
                [(Direction::Z.reversed(), "barrier_towards_low_index"), (Direction::Z, "barrier_towards_high_index")]
            {
                let outcome = solve(chain().problem(pinned.clone(), Spins::uniform(100, final_state)));
                check("defect", &case, forward(&outcome), number(&case, key), tolerance);
            }
        } else {
            let chain = || Build::between_walls(100).easy(k).defect(50, defect - k).field([0.0, 0.0, 0.01 * 2.0 * k]);
            let build = chain();
            // the field drives the wall to the right; a weak site holds it, a strong one stops it on its left
            let start = if defect < k { 50.0 } else { 45.0 };
            let (a, b) = (build.wall(start, width, Direction::X), build.wall(100.0, width, Direction::X));
            let outcome = solve(build.problem(a, b));
            check("defect", &case, forward(&outcome), number(&case, "barrier"), tolerance);
        }
    }
}

#[test]
fn a_wall_turns_its_plane_over_the_hard_axis() {
    for (case, tolerance) in section("chirality_reversal") {
        let k = number(&case, "K");
        let build = Build::between_walls(100).easy(k).hard(number(&case, "K_hard"));
        let width = (0.5 / k).sqrt();
        let (a, b) = (build.wall(50.5, width, Direction::Y), build.wall(50.5, width, Direction::Y.reversed()));
        let outcome = solve(build.problem(a, b));
        check("chirality_reversal", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn with_dmi_the_edge_is_the_barrier() {
    for (case, tolerance) in section("dmi_nucleation") {
        let outcome = solve(Build::open(100).easy(number(&case, "K")).dmi(number(&case, "D"), Direction::Y).reversal());
        check("dmi_nucleation", &case, forward(&outcome), number(&case, "barrier"), tolerance);
    }
}

#[test]
fn the_sign_of_dmi_tells_the_two_chiralities_apart() {
    for (case, tolerance) in section("dmi_sign") {
        let k = number(&case, "K");
        let build =
            Build::between_walls(100).easy(k).hard(number(&case, "K_hard")).dmi(number(&case, "D"), Direction::X);
        let width = (0.5 / k).sqrt();
        let (a, b) = (build.wall(50.5, width, Direction::Y), build.wall(50.5, width, Direction::Y.reversed()));
        let outcome = solve(build.problem(a, b));
        check("dmi_sign", &case, forward(&outcome), number(&case, "forward"), tolerance);
        check(
            "dmi_sign",
            &case,
            outcome.barrier.expect("a barrier").backward_mev,
            number(&case, "backward"),
            tolerance,
        );
    }
}
