//! Symmetric matrices with a band and, for rings, a rim.
//!
//! ```text
//!   ⎡ T   Rᵀ ⎤   T: n × n, half-bandwidth w          (the open chain)
//!   ⎣ R   C  ⎦   R: b × n dense, C: b × b             (the sites that close a ring)
//! ```
//! A matrix without a rim may have a long-ranged [`Tail`] besides. Factorised by [`Ldl`].

use super::{Ldl, Tail, slab};
use std::ops::Range;

/// A symmetric matrix of `inner` banded unknowns followed by `border` unknowns coupled to all.
#[derive(Clone, Debug, Default)]
pub struct Banded {
    pub(super) inner: usize,
    pub(super) width: usize,
    pub(super) border: usize,
    /// Column by column, diagonal first: band[j (w+1) + k] = A[j+k][j].
    pub(super) band: Vec<f64>,
    /// rim[j b + r] = A[n+r][j].
    pub(super) rim: Vec<f64>,
    /// corner[r b + s] = A[n+r][n+s], lower half used.
    pub(super) corner: Vec<f64>,
    /// What reaches further than the band.
    pub(super) tail: Option<Tail>,
}

impl Banded {
    /// The zero matrix.
    pub fn zeros(inner: usize, width: usize, border: usize) -> Banded {
        Banded {
            inner,
            width,
            border,
            band: vec![0.0; (inner + width) * (width + 1)],
            rim: vec![0.0; inner * border],
            corner: vec![0.0; border * border],
            tail: None,
        }
    }

    /// Makes it a zero matrix of the given shape, in the memory it has, but for the first `written` columns of the band: all
    /// their entries are to be written.
    pub fn reset(&mut self, inner: usize, width: usize, border: usize, written: usize) {
        (self.inner, self.width, self.border) = (inner, width, border);
        self.band.resize((inner + width) * (width + 1), 0.0);
        self.band[written * (width + 1)..].fill(0.0);
        for (entries, length) in [(&mut self.rim, inner * border), (&mut self.corner, border * border)] {
            entries.clear();
            entries.resize(length, 0.0);
        }
        self.tail = None;
    }

    /// Makes it a copy of another matrix, in the memory it has.
    pub(super) fn copy_from(&mut self, other: &Banded) {
        (self.inner, self.width, self.border) = (other.inner, other.width, other.border);
        self.band.clone_from(&other.band);
        self.rim.clone_from(&other.rim);
        self.corner.clone_from(&other.corner);
        self.tail.clone_from(&other.tail);
    }

    /// Adds a tail to a matrix of two unknowns a site, without a rim.
    pub fn set_tail(&mut self, tail: Tail) {
        debug_assert!(self.border == 0 && self.inner == 2 * tail.rows.len());
        self.tail = Some(tail);
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.inner + self.border
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.band.fill(0.0);
        self.rim.fill(0.0);
        self.corner.fill(0.0);
        self.tail = None;
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image. The entry must lie in the band or the rim.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        if i < self.inner {
            debug_assert!(i - j <= self.width);
            self.band[j * (self.width + 1) + i - j] += v;
        } else if j < self.inner {
            self.rim[j * self.border + i - self.inner] += v;
        } else {
            self.corner[(i - self.inner) * self.border + j - self.inner] += v;
        }
    }

    /// The columns 2i and 2i + 1 of all sites i of a row, from the diagonal down: w + 1 entries each.
    pub fn columns_of(&mut self, sites: Range<usize>) -> &mut [f64] {
        let pair = 2 * (self.width + 1);
        &mut self.band[sites.start * pair..sites.end * pair]
    }

    /// Entry (i, j); zero outside the band where there is no tail.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.get_band(i, j) + self.tail.as_ref().map_or(0.0, |t| t.get(i, j))
    }

    /// Entry (i, j) without the tail.
    pub(super) fn get_band(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        if i < self.inner {
            if i - j <= self.width { self.band[j * (self.width + 1) + i - j] } else { 0.0 }
        } else if j < self.inner {
            self.rim[j * self.border + i - self.inner]
        } else {
            self.corner[(i - self.inner) * self.border + j - self.inner]
        }
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        for j in 0..self.inner {
            self.band[j * (self.width + 1)] += s;
        }
        for r in 0..self.border {
            self.corner[r * self.border + r] += s;
        }
    }

    /// The smallest diagonal entry, which no smallest eigenvalue exceeds.
    pub fn smallest_diagonal(&self) -> f64 {
        let band = (0..self.inner).map(|j| self.band[j * (self.width + 1)]);
        band.chain((0..self.border).map(|r| self.corner[r * self.border + r])).fold(f64::INFINITY, f64::min)
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match (self.width, self.border) {
            (1, 0) => self.multiply_narrow::<1, 2>(x, y),
            (3, 0) => self.multiply_narrow::<3, 4>(x, y),
            (5, 0) => self.multiply_narrow::<5, 6>(x, y),
            _ => self.multiply_any(x, y),
        }
        if let Some(tail) = &self.tail {
            tail.add_product(x, y);
        }
    }

    /// The band alone, of half-bandwidth W = S − 1: with what the last columns still owe to the next rows in registers.
    fn multiply_narrow<const W: usize, const S: usize>(&self, x: &[f64], y: &mut [f64]) {
        let n = self.inner;
        let mut owed = [0.0; S];
        let inside = n.saturating_sub(W);
        for j in 0..n {
            let column = &self.band[j * S..][..S];
            let mut sum = column[0] * x[j];
            if j < inside {
                let ahead = &x[j + 1..][..W];
                for k in 0..W {
                    sum += column[k + 1] * ahead[k];
                    owed[k + 1] += column[k + 1] * x[j];
                }
            } else {
                for k in 1..n - j {
                    sum += column[k] * x[j + k];
                    owed[k] += column[k] * x[j];
                }
            }
            y[j] = owed[0] + sum;
            for k in 0..W {
                owed[k] = owed[k + 1];
            }
            owed[W] = 0.0;
        }
    }

    fn multiply_any(&self, x: &[f64], y: &mut [f64]) {
        let (n, w, b) = (self.inner, self.width, self.border);
        y.fill(0.0);
        for j in 0..n {
            let column = &self.band[j * (w + 1)..(j + 1) * (w + 1)];
            let reach = w.min(n - 1 - j);
            let mut sum = column[0] * x[j];
            for k in 1..=reach {
                sum += column[k] * x[j + k];
                y[j + k] += column[k] * x[j];
            }
            for r in 0..b {
                let a = self.rim[j * b + r];
                sum += a * x[n + r];
                y[n + r] += a * x[j];
            }
            y[j] += sum;
        }
        for r in 0..b {
            for s in 0..=r {
                let a = self.corner[r * b + s];
                y[n + r] += a * x[n + s];
                if s != r {
                    y[n + s] += a * x[n + r];
                }
            }
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁; a tail counts with its estimate.
    pub fn norm1(&self) -> f64 {
        let (n, w, b) = (self.inner, self.width, self.border);
        let mut sums = vec![0.0; n + b];
        for j in 0..n {
            for k in 0..=w.min(n - 1 - j) {
                let a = self.band[j * (w + 1) + k].abs();
                sums[j] += a;
                if k > 0 {
                    sums[j + k] += a;
                }
            }
            for r in 0..b {
                let a = self.rim[j * b + r].abs();
                sums[j] += a;
                sums[n + r] += a;
            }
        }
        for r in 0..b {
            for s in 0..=r {
                let a = self.corner[r * b + s].abs();
                sums[n + r] += a;
                if s != r {
                    sums[n + s] += a;
                }
            }
        }
        sums.into_iter().fold(0.0, f64::max) + self.tail.as_ref().map_or(0.0, |t| t.norm)
    }

    /// A = L D Lᵀ, in the memory of A. A pivot smaller than the rounding error of the matrix is replaced by that error's
    /// size, sign kept.
    pub fn factor(self) -> Ldl {
        Ldl::of(self)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        let entries = slab::largest(&self.band).max(slab::largest(&self.rim)).max(slab::largest(&self.corner));
        entries.max(self.tail.as_ref().map_or(0.0, |t| t.norm))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{eigenvalues_symmetric, solve_dense};
    use rand::{Rng, RngExt, SeedableRng};

    fn random(r: &mut impl Rng, inner: usize, width: usize, border: usize) -> Banded {
        let mut a = Banded::zeros(inner, width, border);
        for j in 0..inner + border {
            for i in j..inner + border {
                if i >= inner || i - j <= width {
                    a.add(i, j, r.random_range(-1.0..1.0));
                }
            }
        }
        a
    }

    fn dense(a: &Banded) -> Vec<f64> {
        let n = a.order();
        (0..n * n).map(|k| a.get(k / n, k % n)).collect()
    }

    #[test]
    fn solution_inertia_determinant_and_product_agree_with_dense_arithmetic() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for (inner, width, border) in [
            (1, 1, 0),
            (2, 1, 0),
            (9, 3, 0),
            (12, 5, 0),
            (8, 3, 2),
            (10, 5, 4),
            (6, 0, 0),
            (7, 7, 1),
            (16, 1, 0),
            (23, 1, 0),
            (32, 3, 0),
            (41, 3, 0),
            (48, 5, 0),
            (55, 5, 0),
        ] {
            for columns in 1..4 {
                let a = random(&mut r, inner, width, border);
                let n = a.order();
                let full = dense(&a);
                let x: Vec<f64> = (0..n * columns).map(|_| r.random_range(-1.0..1.0)).collect();
                let mut b = vec![0.0; n * columns];
                for c in 0..columns {
                    let xc: Vec<f64> = (0..n).map(|j| x[j * columns + c]).collect();
                    let mut y = vec![0.0; n];
                    a.multiply(&xc, &mut y);
                    for i in 0..n {
                        let direct: f64 = (0..n).map(|j| full[i * n + j] * xc[j]).sum();
                        assert!((direct - y[i]).abs() < 1e-14);
                        b[i * columns + c] = y[i];
                    }
                }
                let eigen = eigenvalues_symmetric(&full, n);
                let f = a.clone().factor();
                assert_eq!(f.negatives(), eigen.iter().filter(|l| **l < 0.0).count());
                let log: f64 = eigen.iter().map(|l| l.abs().ln()).sum();
                assert!((f.log_abs_determinant() - log).abs() < 1e-8 * (1.0 + log.abs()));
                let mut on_the_way = b.clone();
                let g = Ldl::solving(a.clone(), &mut on_the_way, columns);
                f.solve(&mut b, columns);
                assert_eq!((&on_the_way, g.negatives()), (&b, f.negatives()));
                let smallest = eigen.iter().fold(f64::MAX, |s, l| s.min(l.abs()));
                for (p, q) in b.iter().zip(&x) {
                    assert!((p - q).abs() < 1e-11 / smallest, "{p} {q} {smallest}");
                }
                let single: Vec<f64> = (0..n).map(|j| full[j * n]).collect();
                let unit = solve_dense(&full, &single, n).expect("regular");
                assert!((unit[0] - 1.0).abs() < 1e-10 / smallest);
            }
        }
    }

    #[test]
    fn products_of_narrow_bands_have_the_bits_of_any_other() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        for width in [1, 3, 5] {
            for n in [1, 2, 5, 6, 7, 40] {
                let a = random(&mut r, n, width, 0);
                let x: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
                let (mut narrow, mut any) = (vec![9.0; n], vec![9.0; n]);
                a.multiply(&x, &mut narrow);
                a.multiply_any(&x, &mut any);
                assert_eq!(narrow, any);
            }
        }
    }

    #[test]
    fn norm1_is_the_largest_column_sum() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let a = random(&mut r, 7, 3, 2);
        let n = a.order();
        let full = dense(&a);
        let direct = (0..n).map(|j| (0..n).map(|i| full[i * n + j].abs()).sum::<f64>()).fold(0.0, f64::max);
        assert!((a.norm1() - direct).abs() < 1e-14);
    }

    #[test]
    fn a_singular_matrix_gives_finite_numbers() {
        for (inner, width, border) in [(4, 1, 0), (40, 3, 0), (6, 3, 2)] {
            let f = Banded::zeros(inner, width, border).factor();
            let mut x = vec![1.0; f.order()];
            f.solve(&mut x, 1);
            assert!(x.iter().all(|v| !v.is_nan()));
        }
    }
}
