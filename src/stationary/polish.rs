//! The last digits of a stationary point: a few plain Newton steps, and of the points on the way the one with the least torque.
//!
//! A valley bends, so that a step along a soft mode first costs torque across it.

use super::point::Point;
use super::step::Region;
use super::tolerances::SHARP;
use crate::energy::Evaluator;

/// A longer step (rad, any spin) is no last digit.
const FARTHEST: f64 = 0.05;
/// Most steps.
const STEPS: usize = 6;

/// The stationary point that `here` all but is, the zero modes left as they are. A point from which Newton's method leads far
/// away, or nowhere, is given back as it came.
pub fn polish(h: Evaluator, mut here: Point) -> Point {
    let mut region = Region::new(h, FARTHEST);
    let mut best = here.clone();
    for _ in 0..STEPS {
        if h.is_stopped() {
            break;
        }
        // a NaN is no small rotation either
        let is_near = region.plain(&here) < FARTHEST;
        if best.max_torque_mev() <= SHARP * h.stiffness_mev() || !is_near {
            break;
        }
        here.move_by(h, &region.v);
        if here.max_torque_mev() < best.max_torque_mev() {
            best.clone_from(&here);
        }
    }
    best
}
