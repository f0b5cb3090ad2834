//! A Hessian without some directions, and the valleys along them.
//!
//! ```text
//! [H  Z] [y]   [0]      y_k: among all moves by 1 along Z_k and by 0 along the others the one of least energy, the way that a soft
//! [Zᵀ 0] [−K_k]  [e_k]          state takes;  K = (ZᵀH⁻¹Z)⁻¹: the energy of such moves is ½ xᵀK x
//! ```
//! By factors of H + κ E Eᵀ, with a pin E_k on one site for each of the orthonormal directions Z_k, so that H may be singular along them:
//!
//! ```text
//! C = [Z, E],  S = diag(0, 1/κ) − Cᵀ(H + κ E Eᵀ)⁻¹C,    |det H on the space normal to Z| = κ^P |det(H + κ E Eᵀ) det S|
//! K = −(S⁻¹)_ZZ,   y_k = −(H + κ E Eᵀ)⁻¹C S⁻¹e_k
//! ```

use crate::linalg::{Factors, slab, solve_dense};
use crate::stationary::Pin;

/// The bordered matrix, eliminated but for its last few rows.
pub(super) struct Bordered<'a> {
    factors: &'a Factors,
    directions: Vec<&'a Vec<f64>>,
    pins: &'a [Pin],
    kappa: f64,
    /// (H + κ E Eᵀ)⁻¹C, column after column.
    solved: Vec<Vec<f64>>,
    /// S, row after row.
    schur: Vec<f64>,
}

impl<'a> Bordered<'a> {
    /// From the factors of H with all of these pins of stiffness κ (meV), one for each of the orthonormal directions.
    pub fn new(factors: &'a Factors, directions: Vec<&'a Vec<f64>>, pins: &'a [Pin], kappa: f64) -> Bordered<'a> {
        let n = directions.len();
        let columns = directions.iter().map(|z| z.to_vec()).chain(pins.iter().map(|e| e.column(factors.order())));
        let solved: Vec<Vec<f64>> = columns
            .map(|mut column| {
                factors.solve(&mut column, 1);
                column
            })
            .collect();
        let entry = |r: usize, c: usize| {
            let own = if r < n { slab::dot(directions[r], &solved[c]) } else { pins[r - n].dot(&solved[c]) };
            if r == c && r >= n { 1.0 / kappa - own } else { -own }
        };
        let schur = (0..2 * n).flat_map(|r| (0..2 * n).map(move |c| (r, c))).map(|(r, c)| entry(r, c)).collect();
        Bordered { factors, directions, pins, kappa, solved, schur }
    }

    /// ln|det| of the Hessian on the space normal to the directions (energies in meV).
    pub fn log_determinant(&self) -> f64 {
        let n = self.pins.len();
        let last = determinant(&self.schur, 2 * n).abs();
        n as f64 * libm::log(self.kappa) + self.factors.log_abs_determinant() + libm::log(last)
    }

    /// From a point of gradient g (meV) the way to where the energy is at rest normal to the directions, by its Hessian.
    pub fn to_rest(&self, gradient: &[f64]) -> Option<Vec<f64>> {
        let mut way = gradient.to_vec();
        self.factors.solve(&mut way, 1);
        let along = self.directions.iter().map(|z| slab::dot(z, &way));
        let along: Vec<f64> = along.chain(self.pins.iter().map(|e| e.dot(&way))).collect();
        let shares = solve_dense(&self.schur, &along, along.len())?;
        slab::add_all(&mut way, &shares, &self.solved);
        slab::scale(&mut way, -1.0);
        Some(way)
    }

    /// y_k, and row k of K (meV); nothing where Z has a direction of no cost on which nothing depends.
    pub fn valley(&self, k: usize) -> Option<(Vec<f64>, Vec<f64>)> {
        let n = self.directions.len();
        let unit: Vec<f64> = (0..2 * n).map(|r| f64::from(u8::from(r == k))).collect();
        let mut weights = solve_dense(&self.schur, &unit, 2 * n)?;
        slab::scale(&mut weights, -1.0);
        let mut y = vec![0.0; self.directions[k].len()];
        slab::add_all(&mut y, &weights, &self.solved);
        weights.truncate(n);
        Some((y, weights))
    }
}

/// The determinant of an n × n matrix of a few rows, by elimination with row exchanges.
pub(super) fn determinant(matrix: &[f64], n: usize) -> f64 {
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
    use crate::linalg::{Banded, Matrix, orthonormal};
    use crate::stationary::pin;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn valleys_are_the_moves_of_least_energy_and_flat_ones_cost_nothing() {
        let n = 8;
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let mut random = |count: usize| -> Vec<Vec<f64>> {
            orthonormal((0..count).map(|_| (0..n).map(|_| r.random_range(-1.0..1.0)).collect()).collect(), 1e-3)
        };
        for lowest in [1.0, 1e-3, 0.0] {
            let axes = random(n);
            let value = |k: usize| if k == 0 { lowest } else { (k + 1) as f64 };
            let entry = |i: usize, j: usize| (0..n).map(|k| value(k) * axes[k][i] * axes[k][j]).sum::<f64>();
            let mut matrix = Matrix::from(Banded::zeros(n, n));
            (0..n).for_each(|i| (0..=i).for_each(|j| matrix.add(i, j, entry(i, j))));
            let hessian = matrix.clone();
            let directions =
                if lowest == 0.0 { orthonormal([&axes[..1], &random(1)].concat(), 0.0) } else { random(2) };
            let mut used = Vec::new();
            let pins: Vec<Pin> = directions.iter().map(|z| pin(&mut matrix, z, &mut used, 2.0)).collect();
            let factors = matrix.factor();
            let bordered = Bordered::new(&factors, directions.iter().collect(), &pins, 2.0);
            // the way to rest normal to the directions is that by the Hessian with them held stiffly
            let mut stiff = hessian.clone();
            let held = |i: usize, j: usize| 1e7 * directions.iter().map(|z| z[i] * z[j]).sum::<f64>();
            (0..n).for_each(|i| (0..=i).for_each(|j| stiff.add(i, j, held(i, j))));
            let gradient: Vec<f64> = (0..n).map(|i| f64::from(i as u32) - 2.5).collect();
            let mut x = gradient.clone();
            stiff.factor().solve(&mut x, 1);
            let way = bordered.to_rest(&gradient).unwrap();
            assert!(directions.iter().all(|z| slab::dot(z, &way).abs() < 1e-12), "{lowest}");
            assert!(way.iter().zip(&x).all(|(w, x)| (w + x).abs() < 1e-5), "{lowest}: {way:?} {x:?}");
            for k in 0..2 {
                let (y, stiffness) = bordered.valley(k).unwrap();
                let mut force = vec![0.0; n];
                hessian.multiply(&y, &mut force);
                for (l, z) in directions.iter().enumerate() {
                    assert!((slab::dot(z, &y) - f64::from(u8::from(k == l))).abs() < 1e-12);
                    assert!((slab::dot(z, &force) - stiffness[l]).abs() < 1e-12);
                    slab::add_scaled(&mut force, -stiffness[l], z);
                }
                assert!(slab::norm(&force) < 1e-12, "{lowest}: it is pulled along the directions alone");
            }
            if lowest == 0.0 {
                assert!(bordered.valley(0).unwrap().1.iter().all(|k| k.abs() < 1e-14));
            }
        }
    }

    #[test]
    fn determinants_of_small_matrices_are_right() {
        assert_eq!(determinant(&[], 0), 1.0);
        assert_eq!(determinant(&[0.0, 2.0, 3.0, 0.0], 2), -6.0);
        assert_eq!(determinant(&[0.0; 4], 2), 0.0);
    }
}
