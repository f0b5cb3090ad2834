//! Which first paths are natural for two states, and about which axis opposite spins turn.
//!
//! The per-spin geodesic alone is the coherent rotation, in long chains a saddle of high order; a wall that sweeps through is
//! the usual way. So several guesses are relaxed loosely, and the lowest goes on.

use super::Problem;
use crate::geometry::{Direction, Vector, vector};
use crate::path::guess::{Edge, FirstGuess, Geodesic, GuessContext, GuessSpec, NoiseSpec, Rotation, Sweep, best_turn};
use crate::spins::Spins;
use crate::units::Angle;

/// Noise that frees a swept wall from accidental symmetries (rad).
const NOISE: f64 = 2e-3;

/// Turns by less (rad) are no rotation of the whole.
const TURNS: f64 = 0.3;

/// The geodesic; rigid rotations in both senses, where one brings the states together; a wall that enters from either end
/// (from the middle of a ring): each with the noise it starts with.
pub fn natural_guesses(
    problem: &Problem,
    a: &Spins,
    b: &Spins,
    axis: Direction,
) -> Vec<(GuessSpec, Option<NoiseSpec>)> {
    let geodesic = GuessSpec::Geodesic(Geodesic { axis: Some(axis) });
    let mut guesses = vec![(geodesic, None)];
    for axis in rotation_axes(problem, a, b) {
        guesses.push((GuessSpec::Rotation(Rotation { axis: Some(axis) }), None));
    }
    if problem.chain.sites > 1 {
        let edges = if problem.chain.periodic { vec![Edge::Center, Edge::Left] } else { vec![Edge::Left, Edge::Right] };
        for from in edges {
            let sweep = GuessSpec::Sweep(Sweep { from, width: None, axis: Some(axis) });
            guesses.push((sweep, Some(NoiseSpec { amplitude: Angle(NOISE), seed: 5 })));
        }
    }
    guesses
}

/// Axes (x, y, z and the symmetry axes, both senses of a half turn) about which a rigid turn brings a to b, all spins to a
/// degree or so. Where every spin is reversed the geodesic is such a turn already.
fn rotation_axes(problem: &Problem, a: &Spins, b: &Spins) -> Vec<Direction> {
    let n = a.sites() as f64;
    if (0..a.sites()).all(|i| vector::dot(a.get(i), b.get(i)) < -0.99) {
        return Vec::new();
    }
    let mut axes: Vec<Direction> = Vec::new();
    let cartesian = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for v in cartesian.iter().chain(problem.hamiltonian.symmetry_axes()) {
        let Ok(axis) = Direction::new(*v) else { continue };
        let (angle, together) = best_turn(a, b, axis);
        let new = axes.iter().all(|k| vector::norm(vector::cross(k.vector(), *v)) > 1e-6);
        if new && angle.abs() > TURNS && together > n - 1e-3 * n.max(10.0) {
            axes.push(axis);
            if angle.abs() > std::f64::consts::PI - 1e-3 {
                axes.push(axis.reversed());
            }
        }
    }
    axes
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
