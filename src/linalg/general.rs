//! Banded matrices without symmetry, and their LU factors with row exchanges.

/// A matrix whose entries lie within `width` of the diagonal.
#[derive(Clone, Debug)]
pub struct General {
    order: usize,
    width: usize,
    /// Row by row: entry (i, j) at i (3w + 1) + j + w − i; the last w places of a row are for fill-in.
    rows: Vec<f64>,
}

impl General {
    /// The zero matrix.
    pub fn zeros(order: usize, width: usize) -> General {
        General { order, width, rows: vec![0.0; order * (3 * width + 1)] }
    }

    /// Adds `v` to the entry (i, j), which must lie in the band.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        debug_assert!(i.abs_diff(j) <= self.width);
        let at = self.at(i, j);
        self.rows[at] += v;
    }

    #[inline]
    fn at(&self, i: usize, j: usize) -> usize {
        i * (3 * self.width + 1) + j + self.width - i
    }

    /// P A = L U. A pivot that vanishes is replaced by the matrix' rounding error.
    pub fn factor(mut self) -> Lu {
        let (n, w) = (self.order, self.width);
        let largest = self.rows.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let floor = f64::EPSILON * largest.max(1e-280);
        let mut lower = vec![0.0; n * w];
        let mut exchange = vec![0; n];
        let mut sign = 1.0;
        for k in 0..n {
            let last = (k + w).min(n - 1);
            let p = (k..=last)
                .fold(k, |p, r| if self.rows[self.at(r, k)].abs() > self.rows[self.at(p, k)].abs() { r } else { p });
            exchange[k] = p;
            let end = (k + 2 * w).min(n - 1);
            if p != k {
                sign = -sign;
                for j in k..=end {
                    let (a, b) = (self.at(k, j), self.at(p, j));
                    self.rows.swap(a, b);
                }
            }
            let diagonal = self.at(k, k);
            if self.rows[diagonal].abs() < floor {
                self.rows[diagonal] = floor.copysign(self.rows[diagonal]);
            }
            let pivot = self.rows[diagonal];
            sign *= pivot.signum();
            for i in k + 1..=last {
                let l = self.rows[self.at(i, k)] / pivot;
                lower[k * w + i - k - 1] = l;
                if l != 0.0 {
                    for j in k + 1..=end {
                        let (to, from) = (self.at(i, j), self.at(k, j));
                        self.rows[to] -= l * self.rows[from];
                    }
                }
            }
        }
        Lu { upper: self, lower, exchange, sign }
    }
}

/// The factors of a [`General`] matrix.
#[derive(Clone, Debug)]
pub struct Lu {
    upper: General,
    lower: Vec<f64>,
    exchange: Vec<usize>,
    sign: f64,
}

impl Lu {
    /// The sign of the determinant, 1 or −1.
    pub fn sign(&self) -> f64 {
        self.sign
    }

    /// Solves A x = b in place.
    pub fn solve(&self, x: &mut [f64]) {
        let (n, w) = (self.upper.order, self.upper.width);
        for k in 0..n {
            x.swap(k, self.exchange[k]);
            for i in k + 1..=(k + w).min(n - 1) {
                x[i] -= self.lower[k * w + i - k - 1] * x[k];
            }
        }
        for k in (0..n).rev() {
            let mut sum = x[k];
            for j in k + 1..=(k + 2 * w).min(n - 1) {
                sum -= self.upper.rows[self.upper.at(k, j)] * x[j];
            }
            x[k] = sum / self.upper.rows[self.upper.at(k, k)];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn solutions_agree_with_dense_arithmetic_also_where_rows_must_be_exchanged() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        for (n, w) in [(1, 0), (1, 2), (2, 1), (9, 1), (20, 3), (31, 5)] {
            let mut a = General::zeros(n, w);
            let mut dense = vec![0.0; n * n];
            for i in 0..n {
                for j in i.saturating_sub(w)..=(i + w).min(n - 1) {
                    // small diagonals make exchanges necessary
                    let v = r.random_range(-1.0..1.0) * if i == j && w > 0 { 1e-3 } else { 1.0 };
                    a.add(i, j, v);
                    dense[i * n + j] = v;
                }
            }
            let b: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
            let expected = solve_dense(&dense, &b, n).unwrap();
            let factors = a.factor();
            let mut x = b;
            factors.solve(&mut x);
            let size = expected.iter().fold(1.0f64, |m, v| m.max(v.abs()));
            assert!(x.iter().zip(&expected).all(|(p, q)| (p - q).abs() < 1e-11 * size), "{n} {w}");
        }
    }

    #[test]
    fn the_sign_of_the_determinant_counts_exchanges() {
        let matrix = |entries: [f64; 4]| {
            let mut a = General::zeros(2, 1);
            (0..4).for_each(|k| a.add(k / 2, k % 2, entries[k]));
            a.factor().sign()
        };
        assert_eq!(matrix([0.0, 1.0, 1.0, 0.0]), -1.0);
        assert_eq!(matrix([0.1, 2.0, -3.0, 1.0]), 1.0);
        assert_eq!(matrix([2.0, 0.0, 0.0, -1.0]), -1.0);
    }
}
