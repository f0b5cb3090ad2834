//! Dense symmetric matrices, and their LDLᵀ without pivoting: one front, all of whose columns are its own.

use super::front::{backward, eliminate, forward};
use super::panels::{self, WIDTH};
use super::slab;
use multiversion::multiversion;

/// A symmetric matrix all of whose entries count.
#[derive(Clone, Debug, Default)]
pub struct Dense {
    order: usize,
    /// Panels of as many rows as fill the last one; what is beyond the order, or above the diagonal, is zero.
    entries: Vec<f64>,
}

impl Dense {
    /// The zero matrix.
    pub fn zeros(order: usize) -> Dense {
        let mut dense = Dense::default();
        dense.reset(order);
        dense
    }

    /// Makes it a zero matrix of the given order, in the memory it has.
    pub fn reset(&mut self, order: usize) {
        self.order = order;
        self.entries.clear();
        self.entries.resize(panels::length(self.rows(), self.panels()), 0.0);
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

    fn panels(&self) -> usize {
        self.order.div_ceil(WIDTH)
    }

    fn rows(&self) -> usize {
        WIDTH * self.panels()
    }

    /// Where the entry (i, j), i ≥ j, stands.
    #[inline]
    fn at(&self, i: usize, j: usize) -> usize {
        let panel = j / WIDTH;
        panels::first(self.rows(), panel) + WIDTH * (i - WIDTH * panel) + j % WIDTH
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let at = self.at(i.max(j), i.min(j));
        self.entries[at] += v;
    }

    /// Adds a block to the rows 2i, 2i + 1 and the columns 2j, 2j + 1, another site's, and to its mirror image.
    #[inline]
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        let [[a, b], [c, d]] = block;
        let (i, j, block) = if i > j { (i, j, block) } else { (j, i, [[a, c], [b, d]]) };
        for (r, [first, second]) in block.into_iter().enumerate() {
            let at = self.at(2 * i + r, 2 * j);
            self.entries[at] += first;
            self.entries[at + 1] += second;
        }
    }

    /// Adds to the rows 2i, 2i + 1 the block that each site j before i gives, and to its mirror image.
    #[inline]
    pub fn add_blocks_before(&mut self, i: usize, block: impl Fn(usize) -> [[f64; 2]; 2]) {
        for j in 0..i {
            let at = self.at(2 * i, 2 * j);
            let [above, below] = block(j);
            let both = &mut self.entries[at..at + WIDTH + 2];
            (both[0], both[1]) = (both[0] + above[0], both[1] + above[1]);
            (both[WIDTH], both[WIDTH + 1]) = (both[WIDTH] + below[0], both[WIDTH + 1] + below[1]);
        }
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.entries[self.at(i.max(j), i.min(j))]
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        (0..self.order).for_each(|i| self.add(i, i, s));
    }

    /// The smallest diagonal entry.
    pub fn smallest_diagonal(&self) -> f64 {
        (0..self.order).map(|i| self.get(i, i)).fold(f64::INFINITY, f64::min)
    }

    /// The rows of each panel, with the first column.
    fn by_panel(&self) -> impl Iterator<Item = (usize, &[[f64; WIDTH]])> {
        let rows = self.rows();
        let panel = move |p: usize| &self.entries[panels::first(rows, p)..panels::first(rows, p + 1)];
        (0..self.panels()).map(move |p| (WIDTH * p, panel(p).as_chunks().0))
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        for (first, rows) in self.by_panel() {
            let own: [f64; WIDTH] = std::array::from_fn(|k| x.get(first + k).copied().unwrap_or(0.0));
            let mut sums = [0.0; WIDTH];
            for ((i, row), y) in (first..).zip(rows).zip(&mut y[first..]) {
                let below = (i - first).min(WIDTH);
                for k in 0..below {
                    *y += row[k] * own[k];
                    sums[k] += row[k] * x[i];
                }
                if below < WIDTH {
                    *y += row[below] * own[below];
                }
            }
            y[first..].iter_mut().zip(sums).for_each(|(y, sum)| *y += sum);
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let mut all = vec![0.0; self.rows()];
        for (first, rows) in self.by_panel() {
            for (i, row) in (first..).zip(rows) {
                for (k, a) in row.iter().enumerate().take(i - first + 1) {
                    all[first + k] += a.abs();
                    all[i] += if i > first + k { a.abs() } else { 0.0 };
                }
            }
        }
        all.into_iter().fold(0.0, f64::max)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        slab::largest(&self.entries)
    }
}

/// The factors L and D of a [`Dense`] matrix, in its memory.
#[derive(Clone, Debug, Default)]
pub struct DenseLdl {
    l: Dense,
    /// D, 1 where the last panel has more columns than the matrix.
    d: Vec<f64>,
}

impl DenseLdl {
    /// The factors of a matrix. A pivot smaller than `floor` is replaced by that size, sign kept.
    pub fn of(mut a: Dense, floor: f64) -> DenseLdl {
        let rows = a.rows();
        let mut d = vec![0.0; rows];
        for i in a.order..rows {
            let at = a.at(i, i);
            a.entries[at] = 1.0;
        }
        eliminate(&mut a.entries, rows, &mut [], &mut d, floor, &mut Vec::new());
        DenseLdl { l: a, d }
    }

    /// The memory, to be filled anew.
    pub fn into_memory(self) -> Dense {
        self.l
    }

    /// The pivots, as many as there are unknowns.
    pub fn pivots(&self) -> &[f64] {
        &self.d[..self.l.order]
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        for first in (0..columns).step_by(4) {
            match columns - first {
                1 => substitute::<1>(self, x, columns, first),
                2 => substitute::<2>(self, x, columns, first),
                _ => substitute::<4>(self, x, columns, first),
            }
        }
    }
}

/// Substitution of C right-hand sides or as many as there are, from one of them on.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn substitute<const C: usize>(factors: &DenseLdl, x: &mut [f64], columns: usize, first: usize) {
    let there = first..columns.min(first + C);
    let mut w = vec![[0.0; C]; factors.d.len()];
    for (w, x) in w.iter_mut().zip(x.chunks_exact(columns)) {
        w.iter_mut().zip(&x[there.clone()]).for_each(|(w, x)| *w = *x);
    }
    let panels = factors.l.panels();
    forward(&factors.l.entries, panels, &mut w);
    w.iter_mut().zip(&factors.d).for_each(|(w, d)| w.iter_mut().for_each(|w| *w /= d));
    backward(&factors.l.entries, panels, &mut w);
    for (w, x) in w.iter().zip(x.chunks_exact_mut(columns)) {
        x[there.clone()].iter_mut().zip(w).for_each(|(x, w)| *x = *w);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;

    #[test]
    fn products_norms_factors_and_solutions_of_all_orders_agree_with_the_textbook() {
        for (n, c) in [(1, 1), (2, 2), (3, 2), (4, 1), (7, 5), (8, 1), (9, 3), (16, 4), (37, 6), (50, 1), (130, 2)] {
            let mut matrix = Dense::zeros(n);
            for i in 0..n {
                (0..i).for_each(|j| matrix.add(i, j, libm::sin((3 * i + 7 * j) as f64)));
                matrix.add(i, i, if i % 3 == 0 { -4.0 } else { 5.0 } * (n as f64).sqrt());
            }
            matrix.shift(0.25);
            let full: Vec<f64> = (0..n * n).map(|k| matrix.get(k / n, k % n)).collect();
            let sums = full.chunks(n).map(|row| row.iter().map(|a| a.abs()).sum::<f64>());
            assert!((matrix.norm1() - sums.fold(0.0, f64::max)).abs() < 1e-12 * n as f64);
            assert_eq!(matrix.size(), slab::largest(&full));
            assert_eq!(matrix.smallest_diagonal(), (0..n).map(|i| full[i * n + i]).fold(f64::INFINITY, f64::min));
            let b: Vec<f64> = (0..n * c).map(|i| libm::cos(i as f64)).collect();
            let (x, mut y): (Vec<f64>, _) = ((0..n).map(|j| b[j * c]).collect(), vec![1.0; n]);
            matrix.multiply(&x, &mut y);
            let product = |i: usize| (0..n).map(|j| full[i * n + j] * x[j]).sum::<f64>();
            assert!((0..n).all(|i| (y[i] - product(i)).abs() < 1e-13 * n as f64), "{n}");
            let factors = DenseLdl::of(matrix, 1e-12);
            assert_eq!(factors.pivots().iter().filter(|d| **d < 0.0).count(), n.div_ceil(3), "{n}");
            let mut solved = b.clone();
            factors.solve(&mut solved, c);
            for q in 0..c {
                let column: Vec<f64> = (0..n).map(|j| b[j * c + q]).collect();
                let expected = solve_dense(&full, &column, n).unwrap();
                assert!((0..n).all(|j| (solved[j * c + q] - expected[j]).abs() < 1e-12), "{n} {q}");
            }
            assert_eq!(factors.into_memory().order(), n);
        }
    }
}
