//! Steps towards a stationary state with a wanted number of negative directions, inside a trust region.
//!
//! ```text
//! to a saddle    s = −Σ_k ± (g_k/|λ_k|) u_k      up (−) along the lowest mode, down along all others
//! to a minimum   s = −(H + μ)⁻¹ g                μ = 0 where H is positive definite
//! ```
//! The first is Newton's step −H⁻¹g with its parts along the wrong modes reversed: one factorisation where the number of negative
//! directions is the wanted one, and the modes in question where it is not. Reversal on the way to a minimum takes more steps than a
//! shift, and longer. A step is cut to the trust radius, which follows how well the model
//! told the energy. (Cerjan, Miller, J. Chem. Phys. 75, 2800 (1981), doi:10.1063/1.442352; Wales, J. Chem. Phys. 101, 3750 (1994),
//! doi:10.1063/1.467559.)

use super::border::pin;
use super::point::Point;
use crate::energy::Evaluator;
use crate::linalg::{Factors, Matrix, lowest_modes, modes_by_factors, remove, slab};
use crate::sphere::rotation_of;
use std::mem::take;
use std::ops::Range;

/// More modes than this are not reversed one by one: the step is one to a minimum.
const MODES: usize = 8;
/// How sharp a mode must be to be reversed: |A⁻¹v − v/λ| in parts of 1/|λ|.
const MODE: f64 = 0.3;
/// The model's error, in parts of |g||s|, below which the radius is doubled, and above which it is half the step.
const GOOD: f64 = 0.15;
const POOR: f64 = 0.3;

/// What a stationary state is wanted to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// A minimum: no negative direction.
    Minimum,
    /// A saddle of index one.
    Saddle,
}

impl Wanted {
    /// How many negative directions that is.
    pub fn negative(self) -> usize {
        usize::from(self == Wanted::Saddle)
    }
}

/// A trust region, with the memory for steps inside it.
#[derive(Debug)]
pub struct Region<'a> {
    h: Evaluator<'a>,
    wanted: Wanted,
    /// Largest rotation of a spin in a step (rad), now and ever.
    radius: f64,
    largest: f64,
    hessian: Matrix,
    room: Matrix,
    /// The lowest modes when they were last needed (3N each).
    modes: Vec<Vec<f64>>,
    x: Vec<f64>,
    /// The step (3N).
    pub v: Vec<f64>,
}

/// A step.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Negative directions where it begins, zero modes apart.
    pub negative: usize,
    /// Largest rotation of a spin (rad).
    pub rotation: f64,
    /// It is Newton's, not cut, and there are as many negative directions as wanted.
    pub is_newton: bool,
    /// By how much the energy is to rise (meV).
    pub rise_mev: f64,
    /// |g||s| (meV).
    size_mev: f64,
}

impl<'a> Region<'a> {
    /// Of steps no longer than `radius` (rad, any spin).
    pub fn new(h: Evaluator<'a>, wanted: Wanted, radius: f64) -> Region<'a> {
        let [hessian, room] = [(); 2].map(|()| Matrix::default());
        let (modes, x, v) = (Vec::new(), Vec::new(), Vec::new());
        Region { h, wanted, radius, largest: radius, hessian, room, modes, x, v }
    }

    /// Newton's step from a point, in `v`, wherever it leads; its largest rotation of a spin (rad).
    pub fn plain(&mut self, here: &Point) -> f64 {
        here.write_hessian(self.h, 0.0, &mut self.hessian);
        self.room = self.newton(here).into_memory();
        here.write_field(&self.x, &mut self.v);
        rotation_of(&self.v)
    }

    /// The step from a point, in `v`.
    pub fn step(&mut self, here: &Point) -> Step {
        here.write_hessian(self.h, 0.0, &mut self.hessian);
        let factors = self.newton(here);
        let negative = factors.negatives();
        let reversed = match (self.wanted, negative) {
            (Wanted::Saddle, 0) => Some(0..1),
            (Wanted::Saddle, 2..=MODES) => Some(1..negative),
            _ => None,
        };
        if let Some(which) = reversed.clone() {
            self.reverse(here, &factors, which);
        }
        self.room = factors.into_memory();
        if reversed.is_none() && negative != self.wanted.negative() {
            self.shifted(here);
        }
        here.write_field(&self.x, &mut self.v);
        self.h.hold_frozen(&mut self.v);
        let rotation = rotation_of(&self.v);
        let whole = rotation <= self.radius;
        if !whole {
            slab::scale(&mut self.x, self.radius / rotation);
            slab::scale(&mut self.v, self.radius / rotation);
        }
        let rise_mev = here.predicted_mev(&self.hessian, &self.x);
        let size_mev = slab::norm(&self.x) * slab::norm(&here.slope);
        let is_newton = whole && negative == self.wanted.negative();
        Step { negative, rotation: rotation.min(self.radius), is_newton, rise_mev, size_mev }
    }

    /// Fits the radius to what the energy did (meV) in a step.
    pub fn judge(&mut self, step: &Step, risen_mev: f64) {
        let error = (risen_mev - step.rise_mev).abs();
        if error < GOOD * step.size_mev {
            self.radius = (2.0 * self.radius).min(self.largest);
        } else if error > POOR * step.size_mev + 256.0 * f64::EPSILON * self.h.stiffness_mev() {
            self.radius = 0.5 * step.rotation;
        }
    }

    /// Makes the radius a part of a step that is not taken.
    pub fn cut(&mut self, step: &Step) {
        self.radius = 0.3 * step.rotation;
    }

    /// A way along one of the lowest modes (rad, any spin), in `v`.
    pub fn along(&mut self, here: &Point, mode: usize, rotation: f64) {
        let modes = lowest_modes(&self.hessian, mode + 1, &here.zeros);
        here.write_field(&modes[mode.min(modes.len() - 1)].vector, &mut self.v);
        self.h.hold_frozen(&mut self.v);
        let size = rotation_of(&self.v);
        slab::scale(&mut self.v, rotation / size);
    }

    /// Newton's step in `x`; the factors.
    fn newton(&mut self, here: &Point) -> Factors {
        let mut matrix = take(&mut self.room);
        matrix.copy_from(&self.hessian);
        let mut used = Vec::new();
        for z in &here.zeros {
            pin(&mut matrix, z, &mut used, self.h.stiffness_mev());
        }
        self.solve(here, matrix)
    }

    /// Solves A x = −g; the factors of A.
    fn solve(&mut self, here: &Point, matrix: Matrix) -> Factors {
        here.write_downhill(&mut self.x);
        let factors = Factors::solving_sized(matrix, self.h.stiffness_mev(), &mut self.x, 1);
        remove(&mut self.x, &here.zeros);
        factors
    }

    /// Reverses the parts of `x`, Newton's step, along some of the lowest modes, which are told by its factors.
    fn reverse(&mut self, here: &Point, factors: &Factors, which: Range<usize>) {
        let mut start = self.x.clone();
        slab::stir(&mut start, 0.1 * slab::norm(&self.x));
        let mut before = Vec::new();
        for mode in &self.modes {
            here.basis.write_coordinates(mode, &mut before);
            slab::add_scaled(&mut start, slab::norm(&self.x), &before);
        }
        let modes = modes_by_factors(factors, &here.zeros, vec![start], MODE).unwrap_or_else(|| {
            lowest_modes(&self.hessian, which.end, &here.zeros).into_iter().map(|mode| mode.vector).collect()
        });
        for u in modes.get(which).unwrap_or_default() {
            let along = slab::dot(u, &self.x);
            slab::add_scaled(&mut self.x, -2.0 * along, u);
        }
        self.modes = modes.iter().map(|u| here.field(u)).collect();
    }

    /// The step of the least shift, in fours, that makes the Hessian positive definite.
    fn shifted(&mut self, here: &Point) {
        let scale = self.h.stiffness_mev();
        let mut shift = 1e-3 * scale;
        while shift < 1e6 * scale && !self.h.is_stopped() {
            let mut matrix = take(&mut self.room);
            matrix.copy_from(&self.hessian);
            matrix.shift(shift);
            let factors = self.solve(here, matrix);
            let positive = factors.negatives() == 0;
            self.room = factors.into_memory();
            if positive {
                break;
            }
            shift *= 4.0;
        }
    }
}
