//! First ways between two minima, none of them relaxed.

use super::{Landscape, turned, turns};
use crate::geometry::Direction;
use crate::path::Path;
use crate::path::guess::{
    Edge, FirstGuess, Geodesic, GuessContext, GuessSpec, Rotation, Sweep, Translation, best_turn, own_axis,
};
use crate::spins::Spins;
use std::f64::consts::PI;

/// How many there are.
pub const WAYS: usize = 6;
/// A turn that is by less (rad) short of a half turn goes either way round.
const HALF: f64 = 0.1;

/// The k-th way between two minima, the second turned about the symmetry axes to be near the first: geodesic (in a film from place to place
/// what has moved), walls from the two ends (of a ring from the middle and one end), and all three in the other sense. In a film all
/// spins turn as one, also as a wall passes, where one rotation brings the two together.
pub fn way(land: &Landscape, [a, b]: [usize; 2], k: usize, images: usize, context: &GuessContext) -> Option<Path> {
    let [a, b] = [a, b].map(|k| &land.minima()[k].spins);
    let b = &turned(b, &turns(land.evaluator(), b, a));
    let edges = if context.states.lattice.is_ring() { [Edge::Center, Edge::Left] } else { [Edge::Left, Edge::Right] };
    let axis = if k < WAYS / 2 { context.default_axis } else { context.default_axis.reversed() };
    let in_a_film = !context.states.lattice.is_row();
    let joining = if in_a_film { turn_of_all(a, b, k < WAYS / 2) } else { None };
    let (axis, rigid) = (Some(joining.unwrap_or(axis)), joining.is_some());
    let guess = match k % (WAYS / 2) {
        0 if rigid => GuessSpec::Rotation(Rotation { axis }),
        0 => GuessSpec::Geodesic(Geodesic { axis }),
        k => GuessSpec::Sweep(Sweep { axis, rigid, ..edges[k - 1].into() }),
    };
    let moves = k == 0 && in_a_film;
    let moved = moves.then(|| Translation {}.path(a, b, images, context).ok()).flatten();
    moved.or_else(|| guess.member().path(a, b, images, context).ok())
}

/// The axis of the rotation that brings two states together, in the first or the other sense; only a half turn has another one.
fn turn_of_all(a: &Spins, b: &Spins, first: bool) -> Option<Direction> {
    let axis = own_axis(a, b)?;
    let is_half = best_turn(a, b, axis).abs() > PI - HALF;
    if first { Some(axis) } else { is_half.then(|| axis.reversed()) }
}
