//! Which first paths are natural for two states, and about which axis opposite spins turn.
//!
//! The per-spin geodesic alone is the coherent rotation, in long chains a saddle of high order; a wall that sweeps through is
//! the usual way. So several guesses are relaxed loosely, and the lowest goes on.

use super::Problem;
use crate::geometry::{Direction, Vector};
use crate::path::guess::{Edge, FirstGuess, Geodesic, GuessContext, GuessSpec, NoiseSpec, Sweep};
use crate::spins::Spins;
use crate::units::Angle;

/// Noise that frees a swept wall from accidental symmetries (rad).
const NOISE: f64 = 2e-3;

/// Geodesic, and a wall that enters from either end (from the middle of a ring), each with the noise it starts with.
pub fn natural_guesses(problem: &Problem, axis: Direction) -> Vec<(GuessSpec, Option<NoiseSpec>)> {
    let geodesic = GuessSpec::Geodesic(Geodesic { axis: Some(axis) });
    let mut guesses = vec![(geodesic, None)];
    if problem.chain.sites > 1 {
        let edges = if problem.chain.periodic { vec![Edge::Center, Edge::Left] } else { vec![Edge::Left, Edge::Right] };
        for from in edges {
            let sweep = GuessSpec::Sweep(Sweep { from, width: None, axis: Some(axis) });
            guesses.push((sweep, Some(NoiseSpec { amplitude: Angle(NOISE), seed: 5 })));
        }
    }
    guesses
}

/// The axis about which opposite spins turn: of ±x, ±y, ±z and the symmetry axes, the one whose wall halfway is lowest.
pub fn turning_axis(problem: &Problem, a: &Spins, b: &Spins, context: &GuessContext) -> Direction {
    let h = &problem.hamiltonian;
    let cartesian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let candidates = cartesian.iter().chain(h.symmetry_axes()).flat_map(|v| [*v, v.map(|c| -c)]);
    let cost = |axis: Vector| -> Option<(f64, Direction)> {
        let axis = Direction::new(axis).ok()?;
        let wall = Sweep { from: Edge::Left, width: None, axis: Some(axis) }.path(a, b, 3, context).ok()?;
        Some((h.energy_mev(wall.image(1)), axis))
    };
    let mut best: Option<(f64, Direction)> = None;
    for found in candidates.filter_map(cost) {
        let better = best.is_none_or(|(e, _)| found.0 < e - 1e-9 * h.stiffness_mev());
        if better {
            best = Some(found);
        }
    }
    best.map_or(Direction::X, |(_, axis)| axis)
}
