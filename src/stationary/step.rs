//! Steps towards a saddle of index one, inside a trust region.
//!
//! ```text
//! s = −Σ_k ± (g_k/|λ_k|) u_k      up (−) along the lowest mode, down along all others
//! ```
//! This is Newton's step −H⁻¹g with its parts along the wrong modes reversed: one factorisation where one direction is negative,
//! and the modes in question where more are or none is. Where many are, or Lanczos by the factors does not tell them soon, the step
//! goes down: s = −(H + μ)⁻¹g. A step is cut to the trust radius, which follows how well the model told the energy. Along a mode that
//! is all but flat, as a wall's that slides, it has a part only once what is left to turn across that mode can no longer change its
//! curvature, and none where that is rounding. Such a mode is not flat beside its valley, which bends: once one was met, a part that
//! leads further off the valley than the step is to lead back waits too.
//! (Cerjan, Miller, J. Chem. Phys. 75, 2800 (1981), doi:10.1063/1.442352; Wales, J. Chem. Phys. 101, 3750 (1994),
//! doi:10.1063/1.467559.)

use super::border::pin_all;
use super::point::Point;
use super::spectrum::floor_mev;
use super::state::stirred;
use super::tolerances::{ALIKE, FEW, FIRST_SHIFT, LARGER, LAST_DIGITS, LAST_SHIFT, ROUGHLY};
use crate::energy::Evaluator;
use crate::field::project;
use crate::hessian::TangentBasis;
use crate::linalg::{Factors, Matrix, lowest_modes, modes_by_factors, remove, slab};
use crate::sphere::rotation_of;
use std::mem::take;
use std::ops::Range;

/// A trust region, with the memory for steps inside it.
#[derive(Debug)]
pub struct Region<'a> {
    pub(super) h: Evaluator<'a>,
    /// Largest rotation of a spin in a step (rad), now and ever.
    radius: f64,
    largest: f64,
    pub(super) hessian: Matrix,
    room: Matrix,
    kept: Option<Factored>,
    /// Whether a mode was all but flat at any point so far.
    met_flat: bool,
    /// The lowest modes when they were last needed (3N each).
    pub(super) modes: Vec<Vec<f64>>,
    pub(super) x: Vec<f64>,
    /// The step (3N).
    pub v: Vec<f64>,
}

/// The factors of a step, where they are dear and the step is theirs alone; they serve for the next steps too as long as each is much
/// shorter than the one before.
#[derive(Debug)]
struct Factored {
    factors: Factors,
    /// Where they are of.
    basis: TangentBasis,
    zeros: Vec<Vec<f64>>,
    /// Largest rotation of a spin in the last step by them (rad).
    rotation: f64,
}

/// What became of the part of a step along a mode that is all but flat.
enum Soft {
    /// No mode is.
    None,
    /// It is told well enough.
    Kept,
    /// It was left out; whether the mode's curvature is negative, by chance where it is flat to rounding.
    Frozen { falls: bool, is_flat: bool },
}

impl Soft {
    fn is_none(&self) -> bool {
        matches!(self, Soft::None)
    }
}

/// A step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Negative directions where it begins, zero modes apart.
    pub negative: usize,
    /// Largest rotation of a spin (rad).
    pub rotation: f64,
    /// The same before the step was cut (rad).
    pub asked: f64,
    /// It is Newton's, not cut, and there is one negative direction.
    pub is_newton: bool,
    /// There is a way to go along a mode that is all but flat, however small the torque.
    pub is_underway: bool,
    /// By how much the energy is to rise (meV).
    pub rise_mev: f64,
    /// |g||s| (meV).
    size_mev: f64,
}

impl<'a> Region<'a> {
    /// Of steps no longer than `radius` (rad, any spin).
    pub fn new(h: Evaluator<'a>, radius: f64) -> Region<'a> {
        let [hessian, room] = [(); 2].map(|()| Matrix::default());
        let (modes, x, v) = (Vec::new(), Vec::new(), Vec::new());
        Region { h, radius, largest: radius, hessian, room, kept: None, met_flat: false, modes, x, v }
    }

    /// Newton's step from a point, in `v`, wherever it leads (without factors, [`step`](Self::step)'s); its largest rotation of a spin (rad).
    pub fn plain(&mut self, here: &Point) -> f64 {
        here.write_hessian(self.h, 0.0, &mut self.hessian);
        if self.h.forgoes_factors() {
            self.iterate(here);
        } else {
            let factors = self.newton(here);
            let soft = self.freeze(here, &factors);
            self.keep(here, factors, soft.is_none());
        }
        here.write_field(&self.x, &mut self.v);
        self.turned()
    }

    /// One of the last steps to a point of rest, in `v`: by the factors of the step before, where they still serve, or Newton's; its
    /// largest rotation of a spin (rad).
    pub fn last(&mut self, here: &Point) -> f64 {
        self.again(here).unwrap_or_else(|| self.plain(here))
    }

    /// The step by the factors of the step before, in `v`, where they still serve; its largest rotation of a spin (rad).
    fn again(&mut self, here: &Point) -> Option<f64> {
        let Factored { factors, basis, zeros, rotation: last } =
            self.kept.as_mut().filter(|k| k.rotation < LAST_DIGITS)?;
        here.write_field(&here.slope, &mut self.v);
        basis.write_coordinates(&self.v, &mut self.x);
        slab::scale(&mut self.x, -1.0);
        factors.solve(&mut self.x, 1);
        remove(&mut self.x, zeros);
        basis.field(&self.x, &mut self.v);
        project(&here.m, &mut self.v);
        let rotation = rotation_of(&self.v);
        let serves = LARGER * rotation < *last;
        *last = rotation;
        serves.then_some(rotation)
    }

    /// Keeps factors for the next steps, or their memory.
    fn keep(&mut self, here: &Point, factors: Factors, serve: bool) {
        if serve && self.h.has_dear_factors() {
            let (basis, zeros) = (here.basis.clone(), here.zeros.clone());
            self.kept = Some(Factored { factors, basis, zeros, rotation: f64::INFINITY });
        } else {
            self.room = factors.into_memory();
        }
    }

    /// The largest rotation of a spin in the step (rad), which is that of the factors that are kept.
    fn turned(&mut self) -> f64 {
        let rotation = rotation_of(&self.v);
        if let Some(kept) = &mut self.kept {
            kept.rotation = rotation;
        }
        rotation
    }

    /// The step from a point, in `v`.
    pub fn step(&mut self, here: &Point) -> Step {
        if let Some(rotation) = self.again(here) {
            here.basis.write_coordinates(&self.v, &mut self.x);
            // the Hessian at hand is that of another point, in its basis
            let mut image = vec![0.0; self.v.len()];
            self.h.hessian_product(&here.m, &here.gradient, &self.v, &mut image);
            let rise_mev = slab::dot(&here.slope, &self.x) + 0.5 * slab::dot(&self.v, &image);
            let size_mev = self.size_mev(here);
            let negative = self.kept.as_ref().map_or(0, |kept| kept.factors.negatives());
            return Step {
                negative,
                rotation,
                asked: rotation,
                is_newton: negative == 1,
                is_underway: false,
                rise_mev,
                size_mev,
            };
        }
        here.write_hessian(self.h, 0.0, &mut self.hessian);
        let (negative, leads_on) =
            if self.h.forgoes_factors() { (self.iterate(here), false) } else { self.by_factors(here) };
        here.write_field(&self.x, &mut self.v);
        self.h.hold_frozen(&mut self.v);
        let rotation = self.turned();
        let whole = rotation <= self.radius;
        if !whole {
            slab::scale(&mut self.x, self.radius / rotation);
            slab::scale(&mut self.v, self.radius / rotation);
        }
        let (rise_mev, size_mev) = (here.predicted_mev(&self.hessian, &self.x), self.size_mev(here));
        let (is_newton, is_underway) = (whole && negative == 1, leads_on || rotation > LAST_DIGITS);
        Step {
            negative,
            rotation: rotation.min(self.radius),
            asked: rotation,
            is_newton,
            is_underway,
            rise_mev,
            size_mev,
        }
    }

    /// |g||s| (meV).
    fn size_mev(&self, here: &Point) -> f64 {
        slab::norm(&self.x) * slab::norm(&here.slope)
    }

    /// Writes the step to `x`; how many directions are negative, and whether the step leads along a mode that is all but flat, or is to be
    /// followed by one that does.
    fn by_factors(&mut self, here: &Point) -> (usize, bool) {
        let factors = self.newton(here);
        let soft = self.freeze(here, &factors);
        let all = factors.negatives();
        let (negative, leads_on) = match soft {
            Soft::None => (all, false),
            Soft::Kept => (all, all == 0),
            Soft::Frozen { falls, is_flat } => ((all - usize::from(falls)).max(1), !is_flat),
        };
        let is_told = match negative {
            0 => self.reverse(here, &factors, 0..1),
            1 => true,
            2..=FEW => self.reverse(here, &factors, 1..negative),
            _ => false,
        };
        self.keep(here, factors, all == 1 && soft.is_none());
        if !is_told {
            self.shifted(here);
        }
        (negative, leads_on)
    }

    /// Fits the radius to what the energy did (meV) in a step.
    pub fn judge(&mut self, step: &Step, risen_mev: f64) {
        let error = (risen_mev - step.rise_mev).abs() - ROUGHLY * step.size_mev;
        if error < 0.0 {
            self.radius = (2.0 * self.radius).min(self.largest);
        } else if error > self.h.rounding_mev() {
            self.radius = 0.5 * step.rotation;
        }
    }

    /// A way along the second of the lowest modes (rad, any spin), in `v`; whether there is one.
    pub fn along_second(&mut self, here: &Point, rotation: f64) -> bool {
        if self.h.forgoes_factors() {
            let Some(second) = self.modes.get(1) else { return false };
            self.v.clone_from(second);
        } else {
            let modes = lowest_modes(&self.hessian, 2, &here.zeros);
            here.write_field(&modes[modes.len() - 1].vector, &mut self.v);
        }
        self.h.hold_frozen(&mut self.v);
        let size = rotation_of(&self.v);
        slab::scale(&mut self.v, rotation / size);
        true
    }

    /// Newton's step in `x`; the factors.
    fn newton(&mut self, here: &Point) -> Factors {
        if let Some(kept) = self.kept.take() {
            self.room = kept.factors.into_memory();
        }
        let mut matrix = take(&mut self.room);
        matrix.copy_from(&self.hessian);
        pin_all(&mut matrix, &here.zeros, self.h.stiffness_mev());
        self.solve(here, matrix)
    }

    /// Takes the part along a mode out of `x`, Newton's step, where nothing tells how long that is: the mode is flat to rounding, or all
    /// but flat, here or in its valley, while its curvature may still change by more than that is, with what is left to turn across it.
    fn freeze(&mut self, here: &Point, factors: &Factors) -> Soft {
        let scale = self.h.stiffness_mev();
        let along = slab::norm(&self.x);
        let curvature = slab::dot(&self.x, &here.slope).abs() / (along * along);
        let is_soft = curvature < ALIKE * scale;
        self.met_flat |= is_soft;
        // what may lead so far off a valley that what is left across is less, and changes the curvature
        let may_bend = || self.met_flat && curvature < scale * slab::max_abs(&self.x).powi(2).min(LAST_DIGITS);
        if !is_soft && !may_bend() {
            return Soft::None;
        }
        let mut soft = self.x.clone();
        slab::normalise(&mut soft);
        factors.solve(&mut soft, 1);
        remove(&mut soft, &here.zeros);
        let size = slab::normalise(&mut soft);
        let part = slab::dot(&soft, &self.x);
        let inverse = part / along * size;
        let mut across = self.x.clone();
        remove(&mut across, std::slice::from_ref(&soft));
        let (floor, left) = (floor_mev(self.h, self.hessian.norm1()), slab::max_abs(&across));
        let is_told = inverse.abs() * (scale * left).max(floor) < 1.0;
        let bends = left < LAST_DIGITS && left < (part * slab::max_abs(&soft)).powi(2);
        if is_told || !is_soft && !bends {
            return if is_soft { Soft::Kept } else { Soft::None };
        }
        self.x = across;
        Soft::Frozen { falls: inverse < 0.0, is_flat: inverse.abs() * floor >= 1.0 }
    }

    /// Solves A x = −g; the factors of A.
    fn solve(&mut self, here: &Point, matrix: Matrix) -> Factors {
        here.write_downhill(&mut self.x);
        let factors = Factors::solving_sized(matrix, self.h.stiffness_mev(), &mut self.x, 1);
        remove(&mut self.x, &here.zeros);
        factors
    }

    /// Reverses the parts of `x`, Newton's step, along some of the lowest modes, which are told by its factors; not where these do not
    /// tell several soon. Whether it did.
    fn reverse(&mut self, here: &Point, factors: &Factors, which: Range<usize>) -> bool {
        let before = self.modes.iter().map(|mode| here.basis.coordinates(mode));
        let starts = std::iter::once(stirred(self.x.clone())).chain(before).collect();
        let lowest = || lowest_modes(&self.hessian, 1, &here.zeros).into_iter().map(|mode| mode.vector).collect();
        let found = modes_by_factors(factors, &here.zeros, starts, ROUGHLY);
        let Some(modes) = found.or_else(|| (which.start == 0).then(lowest)) else { return false };
        for u in modes.get(which).unwrap_or_default() {
            let along = slab::dot(u, &self.x);
            slab::add_scaled(&mut self.x, -2.0 * along, u);
        }
        self.modes = modes.iter().map(|u| here.field(u)).collect();
        true
    }

    /// The step of the least shift, in fours, that makes the Hessian positive definite.
    fn shifted(&mut self, here: &Point) {
        let scale = self.h.stiffness_mev();
        let mut shift = FIRST_SHIFT * scale;
        while shift < LAST_SHIFT * scale && !self.h.is_stopped() {
            let mut matrix = take(&mut self.room);
            matrix.copy_from(&self.hessian);
            matrix.shift(shift);
            let factors = self.solve(here, matrix);
            let positive = factors.negatives() == 0;
            self.room = factors.into_memory();
            if positive {
                break;
            }
            shift *= LARGER;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Vector;
    use crate::spins::Spins;
    use crate::stationary::STEP;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_step_by_the_factors_of_the_one_before_tells_what_the_energy_does_too() {
        let easy = r#"{"anisotropy": {"K": "0.001 meV", "axis": [0, 0, 1]}}"#;
        let film = lattice(r#"{"square": {"cells": [40, 40]}}"#);
        let h = hamiltonian(&film, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        assert!(h.has_dear_factors());
        // beside the film across its axis, which falls if all its spins turn together alone
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        let vectors: Vec<Vector> =
            (0..h.sites()).map(|_| [1.0, 0.2, 0.02].map(|c| c + r.random_range(-0.01..0.01))).collect();
        let start: Vec<f64> = (0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect();
        let h = Evaluator::from(&h);
        let mut here = Point::at(h, Spins::from_components(&start).unwrap().as_slice().to_vec());
        let (mut region, mut next, mut again) = (Region::new(h, STEP), Point::default(), 0);
        for _ in 0..12 {
            let before = region.hessian.norm1();
            let step = region.step(&here);
            next.go(h, &here, &region.v);
            // at the last digits differences are rounding
            if region.hessian.norm1() == before && here.max_torque_mev() > 1e-6 {
                let risen = next.above_mev(&here);
                assert!((risen / step.rise_mev - 1.0).abs() < 1e-3, "{risen:e} {:e}", step.rise_mev);
                again += 1;
            }
            std::mem::swap(&mut here, &mut next);
        }
        assert!(again > 0);
    }
}
