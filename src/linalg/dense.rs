//! Dense symmetric matrices, and their LDLᵀ without pivoting.

use super::pivot::guarded;
use super::slab;
use multiversion::multiversion;

/// A symmetric matrix all of whose entries count.
#[derive(Clone, Debug, Default)]
pub struct Dense {
    order: usize,
    /// Row by row: entry (i, j) at i n + j, lower half used.
    entries: Vec<f64>,
}

impl Dense {
    /// The zero matrix.
    pub fn zeros(order: usize) -> Dense {
        Dense { order, entries: vec![0.0; order * order] }
    }

    /// Makes it a zero matrix of the given order, in the memory it has.
    pub fn reset(&mut self, order: usize) {
        self.order = order;
        self.entries.clear();
        self.entries.resize(order * order, 0.0);
    }

    /// Makes it a copy of another matrix, in the memory it has.
    pub(super) fn copy_from(&mut self, other: &Dense) {
        self.order = other.order;
        self.entries.clone_from(&other.entries);
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        self.entries[i.max(j) * self.order + i.min(j)] += v;
    }

    /// Adds a block to the rows 2i, 2i + 1 and the columns 2j, 2j + 1, another site's, and to its mirror image.
    #[inline]
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        let [[a, b], [c, d]] = block;
        let (i, j, block) = if i > j { (i, j, block) } else { (j, i, [[a, c], [b, d]]) };
        for (r, [first, second]) in block.into_iter().enumerate() {
            let at = (2 * i + r) * self.order + 2 * j;
            self.entries[at] += first;
            self.entries[at + 1] += second;
        }
    }

    /// Adds to the rows 2i, 2i + 1 the block that each site j before i gives, and to its mirror image.
    #[inline]
    pub fn add_blocks_before(&mut self, i: usize, block: impl Fn(usize) -> [[f64; 2]; 2]) {
        let (first, second) = self.entries[2 * i * self.order..].split_at_mut(self.order);
        let pairs = first[..2 * i].as_chunks_mut().0.iter_mut().zip(second[..2 * i].as_chunks_mut().0);
        for (j, ([a, b], [c, d])) in pairs.enumerate() {
            let [above, below] = block(j);
            (*a, *b) = (*a + above[0], *b + above[1]);
            (*c, *d) = (*c + below[0], *d + below[1]);
        }
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.entries[i.max(j) * self.order + i.min(j)]
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        self.entries.iter_mut().step_by(self.order + 1).for_each(|d| *d += s);
    }

    /// The smallest diagonal entry.
    pub fn smallest_diagonal(&self) -> f64 {
        self.diagonal().fold(f64::INFINITY, f64::min)
    }

    /// The diagonal.
    pub(super) fn diagonal(&self) -> impl Iterator<Item = f64> + '_ {
        self.entries.iter().step_by(self.order + 1).copied()
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for (r, row) in self.entries.chunks_exact(self.order.max(1)).enumerate() {
            for (s, a) in row[..r].iter().enumerate() {
                y[r] += a * x[s];
                y[s] += a * x[r];
            }
            y[r] += row[r] * x[r];
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let mut sums = vec![0.0; self.order];
        for (r, row) in self.entries.chunks_exact(self.order.max(1)).enumerate() {
            for (s, a) in row[..r].iter().enumerate() {
                sums[r] += a.abs();
                sums[s] += a.abs();
            }
            sums[r] += row[r].abs();
        }
        sums.into_iter().fold(0.0, f64::max)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        slab::largest(&self.entries)
    }

    /// A = L D Lᵀ in place, D on the diagonal; pivots smaller than the floor are replaced by that.
    pub(super) fn eliminate(&mut self, floor: f64) {
        eliminate(&mut self.entries, self.order, floor);
    }

    /// Substitution, of what [`eliminate`](Self::eliminate) has made; c interleaved right-hand sides.
    pub(super) fn substitute(&self, x: &mut [f64], c: usize) {
        let n = self.order;
        let l = |r: usize, s: usize| self.entries[r * n + s];
        for r in 0..n {
            for s in 0..r {
                for q in 0..c {
                    x[r * c + q] -= l(r, s) * x[s * c + q];
                }
            }
        }
        for r in 0..n {
            for q in 0..c {
                x[r * c + q] /= l(r, r);
            }
        }
        for s in (0..n).rev() {
            for r in 0..s {
                for q in 0..c {
                    x[r * c + q] -= l(s, r) * x[s * c + q];
                }
            }
        }
    }
}

/// Elimination of a matrix of n rows, row by row, lower half.
#[multiversion(targets("x86_64+avx2"))]
fn eliminate(entries: &mut [f64], n: usize, floor: f64) {
    let mut column = vec![0.0; n];
    for j in 0..n {
        let d = guarded(entries[j * n + j], floor);
        entries[j * n + j] = d;
        for r in j + 1..n {
            column[r] = entries[r * n + j];
        }
        for r in j + 1..n {
            let l = column[r] / d;
            for (x, c) in entries[r * n + j + 1..=r * n + r].iter_mut().zip(&column[j + 1..]) {
                *x -= l * c;
            }
            entries[r * n + j] = l;
        }
    }
}
