//! Turns about symmetry axes that bring one state nearest to another.

use super::guess::best_turn;
use crate::energy::Evaluator;
use crate::geometry::Direction;
use crate::sphere::rotate_sites;
use crate::spins::Spins;

/// Turns about the symmetry axes, one after the other, that bring a state nearest to another. None without symmetry axes.
pub fn turns(h: Evaluator, from: &Spins, to: &Spins) -> Vec<(Direction, f64)> {
    let axes = h.symmetry_axes_at(to.as_slice());
    let axes: Vec<Direction> = axes.iter().filter_map(|axis| Direction::new(*axis).ok()).collect();
    let mut now = from.clone();
    let mut turns = Vec::new();
    for _ in 0..if axes.len() > 1 { 4 } else { 1 } {
        for axis in &axes {
            let angle = best_turn(&now, to, *axis);
            now = rotated(&now, *axis, angle);
            turns.push((*axis, angle));
        }
    }
    turns
}

/// A state after turns.
pub fn turned(spins: &Spins, turns: &[(Direction, f64)]) -> Spins {
    turns.iter().fold(spins.clone(), |s, (axis, angle)| if *angle == 0.0 { s } else { rotated(&s, *axis, *angle) })
}

fn rotated(spins: &Spins, axis: Direction, angle: f64) -> Spins {
    let mut m = spins.as_slice().to_vec();
    rotate_sites(&mut m, 0..spins.sites(), axis, angle);
    Spins::from_unit_components(&m)
}
