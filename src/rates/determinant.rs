//! ln|det'H| without the zero modes, from one banded factorisation.
//!
//! With the zero modes Z (orthonormal, HZ = 0) and as many unit columns E, each on one site,
//!
//! ```text
//! det(H + κ E Eᵀ) = κ^P det(EᵀZ)² det'H
//! ```
//! exactly: what is added makes the zero eigenvalues positive and of ordinary size, and its effect is divided out in closed form.
//! The same limit as that of the bordered matrix [H Z; Zᵀ 0], whose determinant is (−1)^P det'H.

use crate::linalg::{Banded, Ldl, slab};
use crate::saddle::pin;

/// A Hessian whose zero modes are pinned, factorised.
#[derive(Debug)]
pub struct PinnedHessian {
    factors: Ldl,
    zeros: Vec<Vec<f64>>,
    log_determinant: f64,
}

impl PinnedHessian {
    /// Of a Hessian (meV) with these orthonormal zero modes; κ is the stiffness of the pins (meV).
    pub fn new(hessian: &Banded, zeros: &[Vec<f64>], kappa: f64) -> PinnedHessian {
        let mut matrix = hessian.clone();
        let mut used = Vec::new();
        let columns: Vec<Vec<f64>> = zeros.iter().map(|z| pin(&mut matrix, z, &mut used, kappa)).collect();
        let factors = matrix.factor();
        let overlaps: Vec<f64> = columns.iter().flat_map(|e| zeros.iter().map(move |z| slab::dot(e, z))).collect();
        let added = zeros.len() as f64 * libm::log(kappa) + 2.0 * libm::log(determinant(&overlaps, zeros.len()).abs());
        let log_determinant = factors.log_abs_determinant() - added;
        PinnedHessian { factors, zeros: zeros.to_vec(), log_determinant }
    }

    /// ln|det'H|, energies in meV.
    pub fn log_determinant(&self) -> f64 {
        self.log_determinant
    }

    /// The solution of Hx = b in the space orthogonal to the zero modes, for the part of b in that space.
    pub fn solve(&self, b: &mut [f64]) {
        remove(b, &self.zeros);
        self.factors.solve(b, 1);
        remove(b, &self.zeros);
    }
}

/// ln|det'H| (energies in meV) of a Hessian with these orthonormal zero modes; κ is any stiffness of the Hessian's size (meV).
pub fn log_determinant(hessian: &Banded, zeros: &[Vec<f64>], kappa: f64) -> f64 {
    PinnedHessian::new(hessian, zeros, kappa).log_determinant()
}

/// v without its parts along orthonormal directions.
pub(super) fn remove(v: &mut [f64], directions: &[Vec<f64>]) {
    for d in directions {
        let overlap = slab::dot(d, v);
        slab::add_scaled(v, -overlap, d);
    }
}

/// The determinant of an n × n matrix of a few rows, by elimination with row exchanges.
fn determinant(matrix: &[f64], n: usize) -> f64 {
    let mut a = matrix.to_vec();
    let mut product = 1.0;
    for j in 0..n {
        let p = (j..n).fold(j, |p, r| if a[r * n + j].abs() > a[p * n + j].abs() { r } else { p });
        if a[p * n + j] == 0.0 {
            return 0.0;
        }
        if p != j {
            (0..n).for_each(|k| a.swap(j * n + k, p * n + k));
            product = -product;
        }
        product *= a[j * n + j];
        for i in j + 1..n {
            let l = a[i * n + j] / a[j * n + j];
            (j..n).for_each(|k| a[i * n + k] -= l * a[j * n + k]);
        }
    }
    product
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_zero_mode_of_a_free_string_leaves_the_product_of_the_others() {
        // A free string of n beads has the eigenvalues 2 − 2 cos(πk/n); those with k > 0 multiply to n.
        for n in [2, 7, 300] {
            let mut a = Banded::zeros(2 * n, 3, 0);
            for i in 0..n {
                for c in 0..2 {
                    let ends = usize::from(i == 0) + usize::from(i + 1 == n);
                    a.add(2 * i + c, 2 * i + c, 2.0 - ends as f64);
                    if i > 0 {
                        a.add(2 * i + c, 2 * i - 2 + c, -1.0);
                    }
                }
            }
            let zero = |c: usize| (0..2 * n).map(|k| if k % 2 == c { 1.0 / (n as f64).sqrt() } else { 0.0 }).collect();
            let found = log_determinant(&a, &[zero(0), zero(1)], 2.0);
            assert!((found - 2.0 * libm::log(n as f64)).abs() < 1e-12 * n as f64, "{n}: {found}");
        }
    }

    #[test]
    fn determinants_of_small_matrices_are_right() {
        assert_eq!(determinant(&[], 0), 1.0);
        assert_eq!(determinant(&[0.0, 2.0, 3.0, 0.0], 2), -6.0);
        assert_eq!(determinant(&[0.0; 4], 2), 0.0);
    }
}
