//! Unit vectors and pairs that are hard to handle, for the tests of this folder.

use super::direction::Direction;
use super::vector::{Vector, add, cross, scale, unit_or};

/// ±x, ±y, ±z, edge, face and space diagonals, and some of no symmetry, as axes.
pub(super) fn axes() -> Vec<Direction> {
    let mut all = Vec::new();
    for x in -1..=1 {
        for y in -1..=1 {
            for z in -1..=1 {
                all.extend(Direction::new([f64::from(x), f64::from(y), f64::from(z)]));
            }
        }
    }
    for v in [[0.1, 0.7, -0.3], [-3.0, 1e-9, 2.0], [1e-7, -1e-7, 1.0], [1.0, 3e-7, 0.0], [1e-300, 1.0, -1e-12]] {
        all.extend(Direction::new(v));
    }
    all
}

/// The same as vectors.
pub(super) fn directions() -> Vec<Vector> {
    axes().into_iter().map(Direction::vector).collect()
}

/// Sideways steps from nothing through the denormal numbers to 1e-5.
fn steps() -> Vec<f64> {
    let mut steps = vec![0.0, 5e-324, 1e-310, 1e-200, 1e-154, 1e-100, 5e-7, 9.99999e-7, 1e-6, 1.000001e-6];
    steps.extend((5..=17).flat_map(|k| [libm::exp10(-k as f64), 3.0 * libm::exp10(-k as f64)]));
    steps
}

/// Each direction with itself, displaced sideways by each step.
pub(super) fn identical_pairs() -> Vec<(Vector, Vector)> {
    let mut pairs = Vec::new();
    for a in directions() {
        for off in [[0.36, 0.48, 0.8], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            for step in steps() {
                let b = add(a, scale(step, cross(off, a)));
                pairs.push((a, if step < 1e-17 { b } else { unit_or(b, a) }));
            }
        }
    }
    pairs
}

/// Each direction with its opposite, displaced sideways by each step.
pub(super) fn opposite_pairs() -> Vec<(Vector, Vector)> {
    identical_pairs().into_iter().map(|(a, b)| (a, scale(-1.0, b))).collect()
}

/// Pairs of different directions, from 0.1 rad to π − 0.1 rad and all the hard ones.
pub(super) fn pairs() -> Vec<(Vector, Vector)> {
    let mut pairs = identical_pairs();
    pairs.extend(opposite_pairs());
    for a in directions() {
        pairs.extend(directions().into_iter().map(|b| (a, b)));
    }
    pairs
}
