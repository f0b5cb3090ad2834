//! Along a valley's floor, where the gradient is rounding error and no guide: steps along it, and Newton's method across.

use super::circuit::Circuit;
use super::pinned::Pinned;
use super::tolerances::{LARGER, LAST_DIGITS, MANY, ROUGHLY, STEP};
use super::walk::{NOISE, Room, Walk};
use crate::field::project;
use crate::linalg::slab;
use crate::sphere::rotation_of;
use std::mem::swap;

/// How fast steps along a valley grow. Between two soft modes the first one may be shorter than others (rad, any spin), down to the
/// shortest.
pub(super) const GROWTH: f64 = 1.4;
pub(super) const SHORTEST: f64 = 1e-4;
/// Most Newton steps across a valley after each step along it, which end when one is less than this part of that step; and most that
/// are taken more where the slope is not the valley's.
const CORRECTIONS: usize = 3;
const ON_THE_WAY: f64 = 0.1;
/// What is added to the Hessian across the valley, in parts of the stiffness scale.
const SHIFT: f64 = 1e-6;
/// Slopes below this part of the stiffness (a radian) may be rounding error.
const FLAT: f64 = LARGER * NOISE;
/// A slope below this part of the torque is not the valley's, but of what is left across it.
const ROUGH: f64 = 1e-3;

impl Walk<'_> {
    /// Along the valley to where its slope (meV/rad) is `enough`, or all around one that closes; whether it went any way.
    pub(super) fn march(&mut self, enough: f64) -> bool {
        let noise = NOISE * self.h.stiffness_mev();
        let flat = FLAT * self.h.stiffness_mev();
        let mut step = LAST_DIGITS;
        let mut moved = false;
        let mut circuit = Circuit::from(&self.here.m);
        self.last = None;
        for _ in 0..MANY {
            self.predict(step);
            let kept = self.cross(step) && self.settle(noise, flat);
            let fallen = self.here.above_mev(&self.next);
            if fallen < -noise && !moved && step > SHORTEST && !self.h.is_stopped() {
                self.turn_back();
                step /= LARGER;
                continue;
            }
            if fallen < -noise || self.h.is_stopped() {
                break;
            }
            if step > LAST_DIGITS && !kept {
                self.turn_back();
                step /= 2.0;
                continue;
            }
            let slope = self.slope_ahead();
            swap(&mut self.here, &mut self.next);
            self.trail.pass(&self.here.m);
            moved = true;
            if slope > enough || slope < -flat || circuit.closes(&self.here.m) {
                break;
            }
            step = (GROWTH * step).min(STEP);
        }
        moved
    }

    /// A step along the valley, bent as the last one was: ds (t + ½ ds ∂t/∂s), the change ∂t/∂s of its direction from
    /// the last place to this.
    pub(super) fn predict(&mut self, step: f64) {
        let speed = rotation_of(&self.tau);
        slab::scale(&mut self.tau, 1.0 / speed);
        let along = &mut self.room.v;
        along.clone_from(&self.tau);
        slab::scale(along, step);
        if let Some((before, length)) = &mut self.last {
            project(&self.here.m, before);
            let half = 0.5 * step * step / *length;
            slab::add_scaled(along, half, &self.tau);
            slab::add_scaled(along, -half, before);
            let rotation = rotation_of(along);
            slab::scale(along, step / rotation);
        }
        let (before, length) = self.last.get_or_insert_with(Default::default);
        before.clone_from(&self.tau);
        *length = step;
        self.next.go(self.h, &self.here, along);
        project(&self.next.m, &mut self.tau);
    }

    /// Newton's method across the valley, after a step along it; whether it stayed near.
    pub(super) fn cross(&mut self, step: f64) -> bool {
        for _ in 0..CORRECTIONS {
            let Some(rotation) = self.correct() else { return false };
            // it may have left its valley for the next
            if rotation > ROUGHLY * step {
                return false;
            }
            if rotation < ON_THE_WAY * step {
                break;
            }
        }
        true
    }

    /// More steps across the valley, where the energy seems to rise or what is left of the torque across could hide the slope;
    /// whether the valley is still there.
    pub(super) fn settle(&mut self, noise: f64, flat: f64) -> bool {
        for _ in 0..CORRECTIONS {
            let rises = self.here.above_mev(&self.next) < -noise;
            let torque = self.next.max_torque_mev();
            let hidden = torque > flat && self.slope_ahead() < ROUGH * torque;
            if !(rises || hidden) {
                break;
            }
            if self.correct().is_none() {
                return false;
            }
        }
        true
    }

    /// By how much the energy falls along the valley at `next` (meV/rad).
    pub(super) fn slope_ahead(&mut self) -> f64 {
        let t = &mut self.room.x;
        self.next.basis.write_coordinates(&self.tau, t);
        -slab::dot(&self.next.slope, t) / slab::norm(t)
    }

    /// Back to the start of the last step.
    pub(super) fn turn_back(&mut self) {
        if let Some((before, _)) = self.last.take() {
            self.tau = before;
        }
    }

    /// One Newton step across the valley, which bends away from any step along it, and the valley's direction there; its size
    /// (rad, any spin). None where the valley is lost: straight on, the descent will find the way.
    fn correct(&mut self) -> Option<f64> {
        self.left = self.left.checked_sub(1)?;
        if self.unfactored.is_some() {
            self.iterate_across()?
        } else {
            self.solve_across()?
        }
        let v = &mut self.room.v;
        let rotation = rotation_of(v);
        if rotation > STEP {
            slab::scale(v, STEP / rotation);
        }
        self.next.move_by(self.h, v);
        project(&self.next.m, &mut self.tau);
        Some(rotation)
    }

    /// Newton's step across the valley, in `v`, and its direction, in `tau`, by factors.
    fn solve_across(&mut self) -> Option<()> {
        let Room { pinned: p, x, v, .. } = &mut self.room;
        let kappa = Pinned::strength_mev(self.h, self.c);
        let mut matrix = p.take_memory();
        self.next.write_hessian(self.h, SHIFT * self.c, &mut matrix);
        self.next.basis.write_coordinates(&self.tau, x);
        p.factor(matrix, &self.next.zeros, x, kappa);
        p.write_valley(x);
        if p.complement_negatives > 0 || slab::dot(x, p.soft()).abs() < ON_THE_WAY * slab::norm(x) {
            return None;
        }
        self.next.write_field(x, &mut self.tau);
        self.next.write_downhill(x);
        p.solve_in_place(x);
        self.next.write_field(x, v);
        Some(())
    }

    /// The same without.
    fn iterate_across(&mut self) -> Option<()> {
        let Room { x, v, .. } = &mut self.room;
        let unfactored = self.unfactored.as_mut()?;
        slab::normalise(&mut self.tau);
        let valley = unfactored.valley(&self.h, &self.next, SHIFT * self.c, &self.tau)?;
        if 1.0 < ON_THE_WAY * slab::norm(&valley) {
            return None;
        }
        self.next.write_downhill(x);
        self.next.write_field(x, v);
        let across = unfactored.solve(&self.h, &self.next, SHIFT * self.c, &[&self.tau], v)?;
        v.copy_from_slice(across);
        self.tau = valley;
        Some(())
    }
}
