//! First ways between two minima, none of them relaxed.

use super::{Landscape, turned, turns};
use crate::path::Path;
use crate::path::guess::{Edge, FirstGuess, Geodesic, GuessContext, GuessSpec, Sweep, Translation};

/// How many there are.
pub const WAYS: usize = 6;

/// The k-th way between two minima, the second turned about the symmetry axes to be near the first: geodesic (in a film from place to place
/// what has moved), walls from the two ends (of a ring from the middle and one end), and all three in the other sense.
pub fn way(land: &Landscape, [a, b]: [usize; 2], k: usize, images: usize, context: &GuessContext) -> Option<Path> {
    let [a, b] = [a, b].map(|k| &land.minima()[k].spins);
    let b = &turned(b, &turns(land.evaluator(), b, a));
    let edges = if context.states.lattice.is_ring() { [Edge::Center, Edge::Left] } else { [Edge::Left, Edge::Right] };
    let axis = if k < WAYS / 2 { context.default_axis } else { context.default_axis.reversed() };
    let guess = match k % (WAYS / 2) {
        0 => GuessSpec::Geodesic(Geodesic { axis: Some(axis) }),
        k => GuessSpec::Sweep(Sweep { axis: Some(axis), ..edges[k - 1].into() }),
    };
    let moves = k == 0 && !context.states.lattice.is_row();
    let moved = moves.then(|| Translation {}.path(a, b, images, context).ok()).flatten();
    moved.or_else(|| guess.member().path(a, b, images, context).ok())
}
