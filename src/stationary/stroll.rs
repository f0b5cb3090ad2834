//! On along a valley from a minimum that parts nothing: what a lattice holds of a wall that is broader than a few of its sites is less
//! than any digit that is told, but a well at every site, and a descent that ended in the first would need a saddle for each to go on.
//! It goes on over them as long as the energy stays level: to where it falls, or to a minimum that it was to reach.

use super::circuit::Circuit;
use super::point::Point;
use super::state::State;
use super::tolerances::{LARGER, LAST_DIGITS, STEP};
use super::valley::{GROWTH, SHORTEST};
use super::walk::{STEEP, STEPS, Walk};
use crate::linalg::slab;
use crate::path::{largest_angle, turned, turns};
use crate::spins::Spins;
use std::mem::swap;

/// A well of depth d that is s wide (in the norm of all spins, rad) has a curvature of 2π²d/s²: wells that part nothing are softer than
/// this times the rise that is none, if they are a seventh of a radian wide.
pub(super) const SOFT: f64 = 1e3;

/// How a stroll ends.
enum End {
    /// On a slope.
    Falls,
    /// In a minimum beside the descent.
    Met,
    /// Where the energy rises, or where it began.
    Nowhere,
}

impl Walk<'_> {
    /// On along the softest mode; whether to where the energy falls. If not, the descent is in a minimum: one beside it, or where it was.
    pub(super) fn stroll(&mut self) -> bool {
        if self.meets() {
            return false;
        }
        let (start, trail) = (self.here.clone(), self.trail.clone());
        let end = if self.set_out() { self.stay_level() } else { End::Nowhere };
        if matches!(end, End::Nowhere) {
            (self.here, self.trail) = (start, trail);
        }
        matches!(end, End::Falls)
    }

    /// Turns towards where the descent was going, along the softest mode; whether there is one.
    fn set_out(&mut self) -> bool {
        let state = State::of(self.h, self.here.clone());
        let Some(mode) = state.lowest_mode(self.h) else { return false };
        self.tau = state.field(&mode.vector);
        // a descent that steps over the top before a well comes back to it
        let before = self.trail.last_beyond(&self.here.m, STEP);
        let moved = self.here.m.iter().zip(before);
        let ahead: f64 = moved.zip(&self.tau).map(|((m, before), t)| (m - before) * t).sum();
        if ahead < 0.0 {
            slab::scale(&mut self.tau, -1.0);
        }
        self.last = None;
        true
    }

    /// Along the valley while it rises by no more than what is level above the lowest place so far.
    fn stay_level(&mut self) -> End {
        let (start, steep) = (self.here.clone(), STEEP * self.h.stiffness_mev());
        let (mut step, mut deepest_mev, mut circuit) = (LAST_DIGITS, 0.0_f64, Circuit::from(&start.m));
        for _ in 0..STEPS {
            if self.h.is_stopped() {
                break;
            }
            self.predict(step);
            let kept = self.cross(step) && self.settle(self.level_mev, f64::INFINITY);
            let fallen_mev = start.above_mev(&self.next);
            if !kept || deepest_mev - fallen_mev > self.level_mev {
                if step < SHORTEST {
                    break;
                }
                self.turn_back();
                step /= LARGER;
                continue;
            }
            let slope = self.slope_ahead();
            swap(&mut self.here, &mut self.next);
            self.trail.pass(&self.here.m);
            deepest_mev = deepest_mev.max(fallen_mev);
            if self.meets() {
                return End::Met;
            }
            if slope > steep {
                return End::Falls;
            }
            if circuit.closes(&self.here.m) {
                return End::Nowhere;
            }
            step = (GROWTH * step).min(STEP);
        }
        End::Nowhere
    }

    /// Into a minimum beside the descent that it comes by on a level, turned about the symmetry axes as it is here; whether there is one.
    fn meets(&mut self) -> bool {
        let here = Spins::from_unit_components(&self.here.m);
        let ends = self.beside.iter().map(|end| turned(end, &turns(self.h, end, &here)));
        let near = |end: &Spins| largest_angle(end.as_slice(), here.as_slice()) < STEP;
        let Some(end) = ends.into_iter().find(near).map(|end| Point::at(self.h, end.as_slice().to_vec())) else {
            return false;
        };
        let is_level = self.here.above_mev(&end) > -self.level_mev;
        if is_level {
            self.here = end;
        }
        is_level
    }
}
