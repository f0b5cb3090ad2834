//! Symmetric matrices with a band: A_ij = 0 where |i − j| > w, the half-bandwidth.

use super::slab;
use std::ops::Range;

/// A symmetric band.
#[derive(Clone, Debug, Default)]
pub struct Banded {
    pub(super) order: usize,
    pub(super) width: usize,
    /// Column by column, diagonal first: band[j (w+1) + k] = A[j+k][j].
    pub(super) band: Vec<f64>,
}

impl Banded {
    /// The zero matrix.
    pub fn zeros(order: usize, width: usize) -> Banded {
        Banded { order, width, band: vec![0.0; (order + width) * (width + 1)] }
    }

    /// Makes it a zero matrix of the given shape, in the memory it has, but for the first `written` columns: all their entries are
    /// to be written.
    pub fn reset(&mut self, order: usize, width: usize, written: usize) {
        (self.order, self.width) = (order, width);
        self.band.resize((order + width) * (width + 1), 0.0);
        self.band[written * (width + 1)..].fill(0.0);
    }

    /// Makes it a copy of another matrix, in the memory it has.
    pub(super) fn copy_from(&mut self, other: &Banded) {
        (self.order, self.width) = (other.order, other.width);
        self.band.clone_from(&other.band);
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image. The entry must lie in the band.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        debug_assert!(i - j <= self.width);
        self.band[j * (self.width + 1) + i - j] += v;
    }

    /// Adds a block to rows 2i, 2i + 1 and columns 2j, 2j + 1, i ≠ j, and to its mirror image.
    #[inline(always)]
    pub fn add_block(&mut self, i: usize, j: usize, b: [[f64; 2]; 2]) {
        let (i, j, b) = if i > j { (i, j, b) } else { (j, i, [[b[0][0], b[1][0]], [b[0][1], b[1][1]]]) };
        debug_assert!(2 * (i - j) < self.width);
        let stride = self.width + 1;
        let columns = &mut self.band[2 * j * stride + 2 * (i - j)..][..stride + 1];
        columns[0] += b[0][0];
        columns[1] += b[1][0];
        columns[stride - 1] += b[0][1];
        columns[stride] += b[1][1];
    }

    /// The columns 2i and 2i + 1 of all sites i of a row, from the diagonal down: w + 1 entries each.
    pub fn columns_of(&mut self, sites: Range<usize>) -> &mut [f64] {
        let pair = 2 * (self.width + 1);
        &mut self.band[sites.start * pair..sites.end * pair]
    }

    /// Entry (i, j); zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        if i - j <= self.width { self.band[j * (self.width + 1) + i - j] } else { 0.0 }
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        self.band.iter_mut().step_by(self.width + 1).take(self.order).for_each(|d| *d += s);
    }

    /// The smallest diagonal entry.
    pub fn smallest_diagonal(&self) -> f64 {
        let diagonal = self.band.iter().step_by(self.width + 1).take(self.order);
        diagonal.copied().fold(f64::INFINITY, f64::min)
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match self.width {
            1 => self.multiply_narrow::<1, 2>(x, y),
            3 => self.multiply_narrow::<3, 4>(x, y),
            5 => self.multiply_narrow::<5, 6>(x, y),
            _ => self.multiply_any(x, y),
        }
    }

    /// A half-bandwidth of W = S − 1: with what the last columns still owe to the next rows in registers.
    fn multiply_narrow<const W: usize, const S: usize>(&self, x: &[f64], y: &mut [f64]) {
        let n = self.order;
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
        let (n, w) = (self.order, self.width);
        y.fill(0.0);
        for j in 0..n {
            let column = &self.band[j * (w + 1)..(j + 1) * (w + 1)];
            let mut sum = column[0] * x[j];
            for k in 1..=w.min(n - 1 - j) {
                sum += column[k] * x[j + k];
                y[j + k] += column[k] * x[j];
            }
            y[j] += sum;
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let (n, w) = (self.order, self.width);
        let mut sums = vec![0.0; n];
        for j in 0..n {
            for k in 0..=w.min(n - 1 - j) {
                let a = self.band[j * (w + 1) + k].abs();
                sums[j] += a;
                if k > 0 {
                    sums[j + k] += a;
                }
            }
        }
        sums.into_iter().fold(0.0, f64::max)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        slab::largest(&self.band)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn products_of_narrow_bands_have_the_bits_of_any_other() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        for width in [1, 3, 5] {
            for n in [1, 2, 5, 6, 7, 40] {
                let mut a = Banded::zeros(n, width);
                for j in 0..n {
                    (j..n.min(j + width + 1)).for_each(|i| a.add(i, j, r.random_range(-1.0..1.0)));
                }
                let x: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
                let (mut narrow, mut any) = (vec![9.0; n], vec![9.0; n]);
                a.multiply(&x, &mut narrow);
                a.multiply_any(&x, &mut any);
                assert_eq!(narrow, any);
            }
        }
    }

    #[test]
    fn a_block_is_added_as_its_entries() {
        for (i, j) in [(2, 1), (1, 2), (0, 2)] {
            let (mut a, mut b) = (Banded::zeros(6, 5), Banded::zeros(6, 5));
            a.add_block(i, j, [[1.0, 2.0], [3.0, 4.0]]);
            (0..4).for_each(|k| b.add(2 * i + k / 2, 2 * j + k % 2, (k + 1) as f64));
            assert_eq!(a.band, b.band);
        }
    }
}
