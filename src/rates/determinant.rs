//! ln|det'H| without the zero modes, from one banded factorisation.
//!
//! With the zero modes Z (orthonormal, HZ = 0) and as many unit columns E, each on one site,
//!
//! ```text
//! det(H + κ E Eᵀ) = κ^P det(EᵀZ)² det'H
//! ```
//! exactly: what is added makes the zero eigenvalues positive and of ordinary size, and its effect is divided out in closed form.
//! The same limit as that of the bordered matrix [H Z; Zᵀ 0], whose determinant is (−1)^P det'H. That holds whatever the eigenvalues of
//! the modes Z are, and for directions Z that are none, so soft ones that are left out because they are integrated otherwise are
//! bordered, on top of their pins (see the module `bordered`).
//!
//! The descending mode t of a saddle is left out too. Its eigenvalue λ₁ is divided out if it is well above the rounding error; if it
//! is all but flat, it is pinned as well, and the pin taken back through a second border column, so that no small number is
//! divided by (see `Pinned` of the module `stationary`):
//!
//! ```text
//! C = [t, −e],  S = diag(0, 1/κ) − Cᵀ(H' + κ e eᵀ)⁻¹C,    det'H/λ₁ = −κ det(H' + κ e eᵀ) det S / (κ^P det(EᵀZ)²)
//! ```

use super::Unstable;
use super::bordered::{Bordered, determinant};
use crate::linalg::{Factors, Matrix, remove, slab};
use crate::stationary::{Border, Pin, pin};

/// A Hessian whose zero modes are pinned, factorised; without its descending mode, if it has one.
#[derive(Debug)]
pub struct PinnedHessian {
    factors: Factors,
    /// Modes that are left out as they are: zero modes, and a stiff descending one.
    zeros: Vec<Vec<f64>>,
    /// Leaves a flat descending mode out.
    border: Option<Border>,
    log_determinant: f64,
}

/// From this part of ‖H‖₁ on an eigenvalue is no small number. (A pin on a stiff mode could make the matrix singular.)
const STIFF: f64 = 1e-5;

impl PinnedHessian {
    /// Of a Hessian (meV) with these orthonormal zero modes and, at a saddle, its descending mode (unit, orthogonal to them); κ is
    /// the stiffness of the pins (meV).
    pub fn new(hessian: &Matrix, zeros: &[Vec<f64>], descending: Option<&Unstable>, kappa: f64) -> PinnedHessian {
        let mut matrix = hessian.clone();
        let mut used = Vec::new();
        let pins: Vec<Pin> = zeros.iter().map(|z| pin(&mut matrix, z, &mut used, kappa)).collect();
        let overlaps: Vec<f64> = pins.iter().flat_map(|e| zeros.iter().map(|z| e.dot(z))).collect();
        let added = zeros.len() as f64 * libm::log(kappa) + 2.0 * libm::log(determinant(&overlaps, zeros.len()).abs());
        let soft = !are_flat(hessian, zeros);
        let mut zeros = zeros.to_vec();
        let (factors, border, own) = match descending {
            Some(u) if -u.eigenvalue_mev < STIFF * hessian.norm1() => {
                let mut border = Border::along(u.mode.clone());
                let (_, factors) = border.factor_refined(matrix, &mut used, kappa);
                let [[a, b], [c, d]] = border.schur;
                (factors, Some(border), libm::log(kappa) + libm::log((a * d - b * c).abs()))
            }
            Some(u) => {
                zeros.push(u.mode.clone());
                (matrix.factor(), None, -libm::log(-u.eigenvalue_mev))
            }
            None => (matrix.factor(), None, 0.0),
        };
        let mut log_determinant = factors.log_abs_determinant() - added + own;
        if soft {
            let left_out = zeros.iter().take(pins.len()).chain(border.as_ref().map(|b| &b.soft));
            let all_pins: Vec<Pin> = pins.iter().copied().chain(border.as_ref().map(|b| b.pin)).collect();
            let own = if border.is_some() { 0.0 } else { own };
            log_determinant = Bordered::new(&factors, left_out.collect(), &all_pins, kappa).log_determinant() + own;
        }
        PinnedHessian { factors, zeros, border, log_determinant }
    }

    /// ln|det'H|, energies in meV; without the descending mode's factor, if that was given.
    pub fn log_determinant(&self) -> f64 {
        self.log_determinant
    }

    /// How many directions fall, what was left out apart.
    pub fn negatives(&self) -> usize {
        self.factors.negatives()
    }

    /// The solution of Hx = b in the space orthogonal to the zero modes and the descending one, for the part of b in that space.
    pub fn solve(&self, b: &mut [f64]) {
        remove(b, &self.zeros);
        self.factors.solve(b, 1);
        if let Some(border) = &self.border {
            border.take_back(b);
        }
        remove(b, &self.zeros);
    }
}

/// Whether modes are zero modes to rounding.
fn are_flat(hessian: &Matrix, modes: &[Vec<f64>]) -> bool {
    let (noise, mut image) = (8.0 * f64::EPSILON * hessian.norm1(), vec![0.0; hessian.order()]);
    modes.iter().all(|z| {
        hessian.multiply(z, &mut image);
        slab::dot(z, &image).abs() <= noise
    })
}

/// ln|det'H| (energies in meV) of a Hessian with these orthonormal zero modes; κ is any stiffness of the Hessian's size (meV).
pub fn log_determinant(hessian: &Matrix, zeros: &[Vec<f64>], kappa: f64) -> f64 {
    PinnedHessian::new(hessian, zeros, None, kappa).log_determinant()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::Banded;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_zero_mode_of_a_free_string_leaves_the_product_of_the_others() {
        // A free string of n beads has the eigenvalues 2 − 2 cos(πk/n); those with k > 0 multiply to n.
        for n in [2, 7, 300] {
            let mut a = Matrix::from(Banded::zeros(2 * n, 3));
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
    fn a_descending_mode_is_left_out_however_flat_it_is() {
        // eigenvalues 1 … n along random axes, the lowest replaced by −λ: dense in a band as wide as the matrix
        let n = 6;
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(8);
        let random: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| r.random_range(-1.0..1.0)).collect()).collect();
        let axes = crate::linalg::orthonormal(random, 1e-3);
        for lambda in [1.0, 1e-3, 1e-9, 0.0] {
            let value = |k: usize| if k == 0 { -lambda } else { (k + 1) as f64 };
            let mut a = Matrix::from(Banded::zeros(n, n));
            for i in 0..n {
                for j in 0..=i {
                    a.add(i, j, (0..n).map(|k| value(k) * axes[k][i] * axes[k][j]).sum());
                }
            }
            let descending = Unstable { eigenvalue_mev: -lambda, mode: axes[0].clone() };
            let pinned = PinnedHessian::new(&a, &[], Some(&descending), 3.0);
            assert!((pinned.log_determinant() - libm::log(720.0)).abs() < 1e-12, "{lambda}");
            let mut x = axes[1].clone();
            slab::add_scaled(&mut x, 2.0, &axes[0]);
            pinned.solve(&mut x);
            assert!(x.iter().zip(&axes[1]).all(|(x, e)| (x - 0.5 * e).abs() < 1e-12), "{lambda}");
        }
    }

    #[test]
    fn modes_that_are_soft_or_stiff_are_left_out_to_the_last_digit() {
        let n = 8;
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(9);
        let random: Vec<Vec<f64>> = (0..n).map(|_| (0..n).map(|_| r.random_range(-1.0..1.0)).collect()).collect();
        let axes = crate::linalg::orthonormal(random, 1e-3);
        for (soft, falling) in [(1e-9, 1.0), (1e-4, 1e-9), (0.3, 1e-2), (2.0, 1e-12), (0.0, 1e-9)] {
            let value = |k: usize| [-falling, soft, 0.7 * soft].get(k).copied().unwrap_or((k + 1) as f64);
            let mut a = Matrix::from(Banded::zeros(n, n));
            for i in 0..n {
                for j in 0..=i {
                    a.add(i, j, (0..n).map(|k| value(k) * axes[k][i] * axes[k][j]).sum());
                }
            }
            let descending = Unstable { eigenvalue_mev: -falling, mode: axes[0].clone() };
            let pinned = PinnedHessian::new(&a, &axes[1..3], Some(&descending), 3.0);
            let expected = libm::log((4..=8).product::<usize>() as f64);
            assert!(
                (pinned.log_determinant() - expected).abs() < 1e-12,
                "{soft} {falling}: {}",
                pinned.log_determinant()
            );
        }
    }
}
