//! Newton's equations in a part of the tangent space without factors, by conjugate gradients:
//!
//! ```text
//! P (H + s) P x = P b,   P = 1 − C Cᵀ        C: orthonormal tangent fields
//! ```
//! preconditioned by P M⁻¹ P (see [`StandIn`]). A direction of negative curvature on the way tells that H + s has one in the complement
//! of C; where none is met there may still be one that b has little of. (T. Steihaug, SIAM J. Numer. Anal. 20, 626 (1983),
//! doi:10.1137/0720042.)

use super::StandIn;
use crate::energy::Hamiltonian;
use crate::field::project;
use crate::linalg::{multigrid, remove, slab};

/// Most products with H.
const PRODUCTS: usize = 100;
/// A product less negative than this part of its factors is zero.
const ROUNDING: f64 = 1e-8;

/// The configuration m with its gradient g (3N each), and s (meV).
#[derive(Clone, Copy, Debug)]
pub struct Place<'a> {
    /// The energy.
    pub h: &'a Hamiltonian,
    /// m.
    pub m: &'a [f64],
    /// g (meV).
    pub g: &'a [f64],
    /// s (meV).
    pub shift: f64,
    /// σ (meV), where g is the gradient of the energy with a pull to a configuration m_u near m, −σ Σ m·m_u; 0 where there is none.
    pub pull: f64,
}

/// The equations, with room for their solution: fields of 3N numbers.
#[derive(Debug, Default)]
pub struct Complement {
    /// C.
    pub border: Vec<Vec<f64>>,
    /// b; after a solution P b.
    pub right: Vec<f64>,
    /// The solution, tangent.
    pub x: Vec<f64>,
    /// Products with H so far.
    pub products: usize,
    residual: Vec<f64>,
    /// P M⁻¹ P of the residual.
    towards: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    room: multigrid::Room,
}

impl Complement {
    /// Solves for x, until a part `tolerance` of the residual is left. Where a direction of negative curvature is met, says how
    /// negative it is (meV): −vᵀ(H + s)v/|v|².
    pub fn solve(&mut self, at: Place, stand_in: &StandIn, tolerance: f64) -> Result<(), f64> {
        let Place { h, m, g, shift, .. } = at;
        for field in [&mut self.x, &mut self.towards, &mut self.direction, &mut self.image] {
            field.resize(m.len(), 0.0);
        }
        project(m, &mut self.right);
        h.hold_frozen(&mut self.right);
        remove(&mut self.right, &self.border);
        self.x.fill(0.0);
        self.residual.clone_from(&self.right);
        self.precondition(at, stand_in);
        self.direction.copy_from_slice(&self.towards);
        let mut fall = slab::dot(&self.residual, &self.towards);
        let enough = tolerance * slab::norm(&self.residual);
        for _ in 0..PRODUCTS {
            if fall <= 0.0 {
                // what is left turns no spin, or M has a negative direction; what is no number goes on, to be seen by who asked
                let rounding = fall >= -ROUNDING * slab::norm(&self.residual) * slab::norm(&self.towards);
                return if rounding { Ok(()) } else { Err(stand_in.c) };
            }
            h.hessian_product(m, g, &self.direction, &mut self.image);
            self.products += 1;
            slab::add_scaled(&mut self.image, shift, &self.direction);
            remove(&mut self.image, &self.border);
            let curvature = slab::dot(&self.direction, &self.image);
            if curvature <= 0.0 {
                return Err(-curvature / slab::dot(&self.direction, &self.direction));
            }
            let step = fall / curvature;
            slab::add_scaled(&mut self.x, step, &self.direction);
            slab::add_scaled(&mut self.residual, -step, &self.image);
            let left = slab::norm(&self.residual);
            if left <= enough || left.is_nan() {
                break;
            }
            self.precondition(at, stand_in);
            let before = std::mem::replace(&mut fall, slab::dot(&self.residual, &self.towards));
            slab::scale(&mut self.direction, fall / before);
            slab::add_scaled(&mut self.direction, 1.0, &self.towards);
        }
        Ok(())
    }

    /// q ← M⁻¹ q, nearly.
    pub fn apply_stand_in(&mut self, stand_in: &StandIn, q: &mut [f64]) {
        self.residual.clear();
        self.residual.extend_from_slice(q);
        stand_in.solve(0.0, &self.residual, q, &mut self.room);
    }

    fn precondition(&mut self, at: Place, stand_in: &StandIn) {
        stand_in.solve(at.shift + at.pull, &self.residual, &mut self.towards, &mut self.room);
        project(at.m, &mut self.towards);
        remove(&mut self.towards, &self.border);
    }
}
