//! The last digits of a stationary point: a few plain Newton steps, and of the points on the way the one with the least torque.
//!
//! A valley bends, so that a step along a soft mode first costs torque across it, and the next steps take that away again: only steps
//! that do neither that nor come to less torque than ever are in vain.

use super::point::Point;
use super::step::Region;
use super::tolerances::{LAST_DIGITS, MANY, SHARP};
use crate::energy::Evaluator;

/// Most steps in vain.
const IN_VAIN: usize = 2;

/// The stationary point that `here` all but is, the zero modes left as they are. A point from which Newton's method leads far
/// away, or nowhere, is given back as it came.
pub fn polish(h: Evaluator, here: Point) -> Point {
    polish_on(&mut Region::new(h, LAST_DIGITS), here)
}

/// The same, by steps that go on from those before.
pub(super) fn polish_on(region: &mut Region, mut here: Point) -> Point {
    let h = region.h;
    let sharp = SHARP * h.stiffness_mev();
    let mut best = here.clone();
    let mut in_vain = 0;
    for _ in 0..MANY {
        let least = best.max_torque_mev();
        // a NaN is no small rotation either
        let goes_on = least > sharp && in_vain < IN_VAIN && !h.is_stopped() && region.last(&here) < LAST_DIGITS;
        if !goes_on {
            break;
        }
        let before = here.max_torque_mev();
        here.move_by(h, &region.v);
        let torque = here.max_torque_mev();
        in_vain = if torque < 0.5 * least { 0 } else { in_vain + usize::from(torque > 0.5 * before) };
        if torque < least {
            best.clone_from(&here);
        }
    }
    best
}
