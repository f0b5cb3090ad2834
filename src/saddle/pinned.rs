//! Solutions and inertia of a Hessian that is singular along known modes and nearly so along one more, without trusting tiny
//! pivots.
//!
//! ```text
//! H' = H + Σ_z κ e_z e_zᵀ     e_z: direction of the zero mode z on its largest site. Hz = 0 exactly, so the negative
//!                              eigenvalues keep their number and each 0 becomes positive
//! H″ = H' + κ e eᵀ            the same for the soft mode t, on another site: well conditioned
//! C = [t, −e],  Z = H″⁻¹C,  S = diag(0, 1/κ) − CᵀZ        takes the last pin back through one border column
//! negatives in the complement of t and the zero modes = n(H″) + n(S) − 1
//! soft pivot s = 1/κ − eᵀH″⁻¹e,   Morse index = n(H″) + [s < 0]
//! ```

use super::state::State;
use crate::linalg::{Banded, Ldl, slab};
use std::mem::take;

/// A factorised, pinned Hessian.
#[derive(Debug)]
pub struct Pinned {
    /// Kept where solutions are refined.
    matrix: Banded,
    factors: Ldl,
    /// Solutions get a step of iterative refinement.
    refined: bool,
    zeros: Vec<Vec<f64>>,
    /// The soft mode: unit vector, orthogonal to the zero modes.
    pub soft: Vec<f64>,
    columns: [Vec<f64>; 2],
    solved: [Vec<f64>; 2],
    schur: [[f64; 2]; 2],
    /// Negative directions in the complement of the soft mode and the zero modes.
    pub complement_negatives: usize,
    /// Its sign is that of the soft direction's curvature.
    pub soft_pivot: f64,
    /// Negative eigenvalues of H, zero modes apart.
    pub index: usize,
}

impl Pinned {
    /// Of H + shift·1 at a state, with the soft mode `t` (tangent coordinates, any length) and `frozen` further modes that are
    /// treated as zero modes; κ is the stiffness of the pins (meV).
    pub fn new(state: &State, t: &[f64], shift: f64, frozen: &[Vec<f64>], kappa: f64) -> Pinned {
        Pinned::factorised(state, t, shift, frozen, kappa, true)
    }

    /// The same without further modes, whose solutions are less accurate and quicker: good enough for steps that are corrected.
    pub fn rough(state: &State, t: &[f64], shift: f64, kappa: f64) -> Pinned {
        Pinned::factorised(state, t, shift, &[], kappa, false)
    }

    fn factorised(state: &State, t: &[f64], shift: f64, frozen: &[Vec<f64>], kappa: f64, refined: bool) -> Pinned {
        let mut matrix = state.hessian.clone();
        matrix.shift(shift);
        let mut used = Vec::new();
        let mut zeros: Vec<Vec<f64>> = Vec::new();
        for mode in state.zeros.iter().chain(frozen) {
            let mut z = mode.clone();
            super::state::remove(&mut z, &zeros);
            let size = slab::norm(&z);
            if size > 1e-3 {
                slab::scale(&mut z, 1.0 / size);
                pin(&mut matrix, &z, &mut used, kappa);
                zeros.push(z);
            }
        }
        let mut soft = t.to_vec();
        super::state::remove(&mut soft, &zeros);
        let size = slab::norm(&soft);
        slab::scale(&mut soft, 1.0 / size.max(f64::MIN_POSITIVE));
        let e = pin(&mut matrix, &soft, &mut used, kappa);
        let mut minus_e = e;
        slab::scale(&mut minus_e, -1.0);
        let columns = [soft.clone(), minus_e];
        let (factors, solved) = match refined {
            true => two_refined(&matrix, &columns),
            false => two(take(&mut matrix), &columns),
        };
        let mut schur = [[0.0; 2]; 2];
        for i in 0..2 {
            for j in 0..2 {
                let symmetric = 0.5 * (slab::dot(&columns[i], &solved[j]) + slab::dot(&columns[j], &solved[i]));
                schur[i][j] = if i == 1 && j == 1 { 1.0 / kappa } else { 0.0 } - symmetric;
            }
        }
        let negatives = factors.negatives();
        let soft_pivot = schur[1][1];
        Pinned {
            complement_negatives: (negatives + negatives_of(schur)).saturating_sub(1),
            index: negatives + usize::from(soft_pivot < 0.0),
            matrix,
            factors,
            refined,
            zeros,
            soft,
            columns,
            solved,
            schur,
            soft_pivot,
        }
    }

    /// The modes treated as zero modes, orthonormal.
    pub fn zeros(&self) -> &[Vec<f64>] {
        &self.zeros
    }

    /// Solves [H t; tᵀ 0] (x, ν) = (b, along) in the complement of the zero modes.
    pub fn solve(&self, b: &[f64], along: f64) -> (Vec<f64>, f64) {
        let mut b = b.to_vec();
        super::state::remove(&mut b, &self.zeros);
        if self.refined {
            b = accurate(&self.matrix, &self.factors, &b);
        } else {
            self.factors.solve(&mut b, 1);
        }
        self.bordered(b, along)
    }

    /// The valley's direction: solves [H t; tᵀ 0] (x, ν) = (0, 1).
    pub fn valley(&self) -> (Vec<f64>, f64) {
        self.bordered(vec![0.0; self.soft.len()], 1.0)
    }

    /// From H″⁻¹b to the solution with the last pin taken back and the component `along` the soft mode.
    fn bordered(&self, mut x: Vec<f64>, along: f64) -> (Vec<f64>, f64) {
        let r = [along - slab::dot(&self.columns[0], &x), -slab::dot(&self.columns[1], &x)];
        let [[a, b], [c, d]] = self.schur;
        let determinant = a * d - b * c;
        let q = [(d * r[0] - b * r[1]) / determinant, (a * r[1] - c * r[0]) / determinant];
        slab::add_scaled(&mut x, -q[0], &self.solved[0]);
        slab::add_scaled(&mut x, -q[1], &self.solved[1]);
        super::state::remove(&mut x, &self.zeros);
        (x, q[0])
    }
}

/// Adds κ e eᵀ on the site where `mode` is largest and no pin stands yet; returns e.
pub(crate) fn pin(matrix: &mut Banded, mode: &[f64], used: &mut Vec<usize>, kappa: f64) -> Vec<f64> {
    let size = |i: usize| mode[2 * i].powi(2) + mode[2 * i + 1].powi(2);
    let mut site = 0;
    let mut largest = -1.0;
    for i in (0..mode.len() / 2).filter(|i| !used.contains(i)) {
        if size(i) > largest {
            (site, largest) = (i, size(i));
        }
    }
    used.push(site);
    let norm = size(site).sqrt().max(f64::MIN_POSITIVE);
    let e = [mode[2 * site] / norm, mode[2 * site + 1] / norm];
    let mut column = vec![0.0; mode.len()];
    for a in 0..2 {
        column[2 * site + a] = e[a];
        for b in 0..=a {
            matrix.add(2 * site + a, 2 * site + b, kappa * e[a] * e[b]);
        }
    }
    column
}

/// A⁻¹ b with one step of iterative refinement.
pub(crate) fn accurate(matrix: &Banded, factors: &Ldl, b: &[f64]) -> Vec<f64> {
    let mut x = b.to_vec();
    factors.solve(&mut x, 1);
    let mut r = vec![0.0; b.len()];
    matrix.multiply(&x, &mut r);
    for (r, b) in r.iter_mut().zip(b) {
        *r = b - *r;
    }
    factors.solve(&mut r, 1);
    slab::add_scaled(&mut x, 1.0, &r);
    x
}

/// The factors of A, and A⁻¹ of two columns.
fn two(matrix: Banded, columns: &[Vec<f64>; 2]) -> (Ldl, [Vec<f64>; 2]) {
    let (mut both, mut solved) = (Vec::new(), [Vec::new(), Vec::new()]);
    slab::interleave(&columns[0], &columns[1], &mut both);
    let factors = Ldl::solving(matrix, &mut both, 2);
    let [x, y] = &mut solved;
    slab::deinterleave(&both, x, y);
    (factors, solved)
}

/// The same with a step of iterative refinement.
fn two_refined(matrix: &Banded, columns: &[Vec<f64>; 2]) -> (Ldl, [Vec<f64>; 2]) {
    let (factors, mut solved) = two(matrix.clone(), columns);
    let (mut both, mut rest) = (Vec::new(), [vec![0.0; solved[0].len()], vec![0.0; solved[1].len()]]);
    for ((rest, x), b) in rest.iter_mut().zip(&solved).zip(columns) {
        matrix.multiply(x, rest);
        rest.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
    }
    slab::interleave(&rest[0], &rest[1], &mut both);
    factors.solve(&mut both, 2);
    let [r, s] = &mut rest;
    slab::deinterleave(&both, r, s);
    solved.iter_mut().zip(&rest).for_each(|(x, r)| slab::add_scaled(x, 1.0, r));
    (factors, solved)
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
