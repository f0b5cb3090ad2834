//! Which first paths are natural for two states, and about which axis opposite spins turn.
//!
//! The per-spin geodesic alone is the coherent rotation, in long chains a saddle of high order; a wall that sweeps through is
//! the usual way. So several guesses are relaxed loosely, and the lowest goes on.

use super::Problem;
use crate::geometry::Direction;
use crate::geometry::matrix::UNIT;
use crate::path::guess::{
    Edge, Geodesic, GuessContext, GuessSpec, NoiseSpec, Rotation, Sweep, Ways, joining_axes, natural,
};
use crate::spins::Spins;
use crate::stationary::{ALIKE, LOWER};
use crate::threads::{MADE, apiece};
use crate::units::Angle;
use rayon::prelude::*;

/// Noise that frees a swept wall from accidental symmetries (rad).
const NOISE: f64 = 2e-3;

/// A guess that only needs an axis.
#[derive(Clone, Copy)]
enum Natural {
    Geodesic,
    Sweep(Edge),
}

impl Natural {
    fn geodesic(axis: Direction) -> Geodesic {
        Geodesic { axis: Some(axis) }
    }

    fn sweep(from: Edge, axis: Direction) -> Sweep {
        Sweep { axis: Some(axis), ..from.into() }
    }

    fn about(self, axis: Direction) -> GuessSpec {
        match self {
            Natural::Geodesic => GuessSpec::Geodesic(Self::geodesic(axis)),
            Natural::Sweep(from) => GuessSpec::Sweep(Self::sweep(from, axis)),
        }
    }

    /// Its energy halfway (meV).
    fn halfway_mev(self, problem: &Problem, ways: &Ways, context: &GuessContext, axis: Direction) -> f64 {
        let path = match self {
            Natural::Geodesic => Ok(Self::geodesic(axis).along(ways, 3, context)),
            Natural::Sweep(from) => Self::sweep(from, axis).along(ways, 3, context),
        };
        path.map_or(f64::INFINITY, |path| problem.hamiltonian.energy_mev(path.image(1)))
    }
}

/// The geodesic; rigid rotations in both senses, where one brings the states together; a wall that enters from either end
/// (from the middle of a ring): each with the noise it starts with. Opposite spins turn about the axis whose configuration
/// halfway is lowest, for each guess its own (with a Dzyaloshinskii–Moriya interaction a wall from the left and one from the
/// right want opposite senses), and also the other way round where the two senses differ. On a lattice that is no chain: [`natural`].
pub fn natural_guesses(
    problem: &Problem,
    a: &Spins,
    b: &Spins,
    context: &GuessContext,
) -> Vec<(GuessSpec, Option<NoiseSpec>)> {
    let (ways, lattice) = (Ways::between(a, b), problem.hamiltonian.lattice());
    let turn = |axis| (GuessSpec::Rotation(Rotation { axis: Some(axis) }), None);
    let rotations = joining_axes(&problem.hamiltonian, a, b).into_iter().map(turn);
    if !lattice.is_row() {
        return natural(&problem.hamiltonian, a, b, context).into_iter().chain(rotations).collect();
    }
    let mut guesses = Vec::new();
    guesses.extend(both_senses(problem, &ways, context, Natural::Geodesic, None).into_iter().map(|g| (g, None)));
    guesses.extend(rotations);
    if lattice.sites > 1 {
        let edges = if lattice.is_ring() { [Edge::Center, Edge::Left] } else { [Edge::Left, Edge::Right] };
        for from in edges {
            let noise = NoiseSpec { amplitude: Angle(NOISE), seed: 5 };
            // the axis of a wall from the left is that of the context already
            let axis = (from == Edge::Left).then_some(context.default_axis);
            let sweeps = both_senses(problem, &ways, context, Natural::Sweep(from), axis);
            guesses.extend(sweeps.into_iter().map(|g| (g, Some(noise))));
        }
    }
    guesses
}

/// A guess about its best axis (`axis`, if that is known), and about the same axis the other way round if its image halfway
/// has another energy there.
fn both_senses(
    problem: &Problem,
    ways: &Ways,
    context: &GuessContext,
    guess: Natural,
    axis: Option<Direction>,
) -> Vec<GuessSpec> {
    let cost = |axis: Direction| guess.halfway_mev(problem, ways, context, axis);
    let axis = axis.unwrap_or_else(|| best_axis(problem, ways, cost));
    let other = axis.reversed();
    let least = LOWER * problem.hamiltonian.stiffness_mev();
    let differ = ways.have_a_choice() && (cost(axis) - cost(other)).abs() > least;
    if differ { vec![guess.about(axis), guess.about(other)] } else { vec![guess.about(axis)] }
}

/// The axis about which opposite spins turn: of ±x, ±y, ±z and the symmetry axes, the one whose wall halfway is lowest.
pub fn turning_axis(problem: &Problem, a: &Spins, b: &Spins, context: &GuessContext) -> Direction {
    let ways = Ways::between(a, b);
    best_axis(problem, &ways, |axis| Natural::Sweep(Edge::Left).halfway_mev(problem, &ways, context, axis))
}

/// Of ±x, ±y, ±z and the symmetry axes the one of least cost halfway (meV); of equal ones the first.
fn best_axis(problem: &Problem, ways: &Ways, cost: impl Fn(Direction) -> f64 + Sync) -> Direction {
    let h = problem.evaluator();
    if !ways.have_a_choice() {
        return Direction::X;
    }
    let oblique = h.symmetry_axes().iter().filter(|v| v.iter().all(|c| c.abs() < 1.0));
    let candidates = UNIT.iter().chain(oblique).flat_map(|v| [*v, v.map(|c| -c)]);
    let axes: Vec<Direction> = candidates.filter_map(|axis| Direction::new(axis).ok()).collect();
    let halfway = axes.par_iter().with_min_len(apiece(3 * h.sites(), MADE)).map(|axis| (cost(*axis), *axis));
    let mut best: Option<(f64, Direction)> = None;
    for found in halfway.collect::<Vec<_>>() {
        if best.is_none_or(|(e, _)| found.0 < e - ALIKE * h.stiffness_mev()) {
            best = Some(found);
        }
    }
    best.map_or(Direction::X, |(_, axis)| axis)
}
