//! Solutions and inertia of a Hessian that is singular along known modes and nearly so along one more, without trusting tiny
//! pivots.
//!
//! ```text
//! H' = H + Σ_z κ e_z e_zᵀ     e_z: direction of the zero mode z on its largest site. Hz = 0 exactly, so the negative
//!                              eigenvalues keep their number and each 0 becomes positive
//! H″ = H' + κ e eᵀ            the same for the soft mode t, on another site: well conditioned
//! C = [t, −e],  Z = H″⁻¹C,  S = diag(0, 1/κ) − CᵀZ        takes the last pin back through one border column
//! negatives in the complement of t and the zero modes = n(H″) + n(S) − 1
//! ```

use super::border::{Border, pin};
use super::tolerances::INDEPENDENT;
use crate::energy::Evaluator;
use crate::linalg::{Factors, Matrix, remove, slab};
use std::mem::take;

/// A factorised, pinned Hessian.
#[derive(Debug, Default)]
pub struct Pinned {
    factors: Factors,
    zeros: Vec<Vec<f64>>,
    border: Border,
    /// Negative directions in the complement of the soft mode and the zero modes.
    pub complement_negatives: usize,
}

impl Pinned {
    /// How stiff the pinned directions are made (meV).
    pub fn strength_mev(h: Evaluator, c: f64) -> f64 {
        (h.stiffness_mev() / 3.0).max(c)
    }

    /// The matrix of the last factors, to be filled for [`factor`](Self::factor).
    pub fn take_memory(&mut self) -> Matrix {
        take(&mut self.factors).into_memory()
    }

    /// Takes a matrix with orthonormal zero modes and the soft mode `t` (tangent coordinates, any length), in the memory there is; κ is
    /// the stiffness of the pins (meV).
    pub fn factor(&mut self, mut matrix: Matrix, zeros: &[Vec<f64>], t: &[f64], kappa: f64) {
        let mut used = self.pin_zeros(&mut matrix, zeros, kappa);
        self.aim(t);
        let factors = self.border.factor(matrix, &mut used, kappa);
        self.count(factors);
    }

    /// Pins the zero modes; the sites that have pins now.
    fn pin_zeros(&mut self, matrix: &mut Matrix, modes: &[Vec<f64>], kappa: f64) -> Vec<usize> {
        let mut used = Vec::new();
        let mut memory = take(&mut self.zeros).into_iter();
        for mode in modes {
            let mut z = memory.next().unwrap_or_default();
            z.clone_from(mode);
            remove(&mut z, &self.zeros);
            let size = slab::norm(&z);
            if size > INDEPENDENT {
                slab::scale(&mut z, 1.0 / size);
                pin(matrix, &z, &mut used, kappa);
                self.zeros.push(z);
            }
        }
        used
    }

    /// Makes `t` the soft mode, without its parts along the zero modes.
    fn aim(&mut self, t: &[f64]) {
        let soft = &mut self.border.soft;
        soft.clear();
        soft.extend_from_slice(t);
        remove(soft, &self.zeros);
        slab::normalise(soft);
    }

    fn count(&mut self, factors: Factors) {
        let (negatives, schur) = (factors.negatives(), self.border.schur);
        self.complement_negatives = (negatives + negatives_of(schur)).saturating_sub(1);
        self.factors = factors;
    }

    /// The soft mode: unit vector, orthogonal to the zero modes.
    pub fn soft(&self) -> &[f64] {
        &self.border.soft
    }

    /// Solves [H t; tᵀ 0] (x, ν) = (b, 0) in the complement of the zero modes, where `x` is b at first.
    pub fn solve_in_place(&self, x: &mut [f64]) {
        remove(x, &self.zeros);
        self.factors.solve(x, 1);
        self.border.take_back(x);
        remove(x, &self.zeros);
    }

    /// The valley's direction, into the memory of `x`: solves [H t; tᵀ 0] (x, ν) = (0, 1).
    pub fn write_valley(&self, x: &mut Vec<f64>) {
        self.border.valley(x);
        remove(x, &self.zeros);
    }
}

/// Negative eigenvalues of a symmetric 2 × 2 matrix.
fn negatives_of([[a, b], [_, d]]: [[f64; 2]; 2]) -> usize {
    let determinant = a * d - b * b;
    if determinant < 0.0 {
        1
    } else if a + d < 0.0 {
        2
    } else {
        0
    }
}
