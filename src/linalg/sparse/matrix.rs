//! Sparse symmetric matrices by 2 × 2 blocks of sites.

use super::Symbolic;
use super::memory::Memory;
use crate::linalg::slab;
use std::mem::take;
use std::sync::Arc;

/// A symmetric matrix with two unknowns a site, 2i and 2i + 1, coupled along the bonds of a graph.
#[derive(Debug, Default)]
pub struct SparseMatrix {
    pub(super) plan: Arc<Symbolic>,
    /// Of the lower half by columns of sites (see `Graph::block`), each row by row; those on the diagonal whole.
    pub(super) blocks: Vec<[f64; 4]>,
    /// For the factors; no copy has it.
    pub(super) memory: Memory,
}

impl Clone for SparseMatrix {
    fn clone(&self) -> SparseMatrix {
        SparseMatrix { plan: self.plan.clone(), blocks: self.blocks.clone(), memory: Memory::default() }
    }
}

impl Drop for SparseMatrix {
    fn drop(&mut self) {
        self.plan.spare.keep(take(&mut self.memory));
    }
}

impl SparseMatrix {
    /// The zero matrix of a plan's graph.
    pub fn zeros(plan: Arc<Symbolic>) -> SparseMatrix {
        let blocks = vec![[0.0; 4]; plan.graph.block_count()];
        SparseMatrix { plan, blocks, memory: Memory::default() }
    }

    /// Makes it the zero matrix of a plan's graph, in the memory it has.
    pub fn reset(&mut self, plan: &Arc<Symbolic>) {
        self.plan.clone_from(plan);
        self.blocks.clear();
        self.blocks.resize(plan.graph.block_count(), [0.0; 4]);
    }

    /// Makes it a copy of another matrix, in the memory it has.
    pub fn copy_from(&mut self, other: &SparseMatrix) {
        self.plan.clone_from(&other.plan);
        self.blocks.clone_from(&other.blocks);
    }

    /// The plan of its factorisation.
    pub fn plan(&self) -> &Arc<Symbolic> {
        &self.plan
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.plan.order()
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.blocks.fill([0.0; 4]);
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image. The sites must be the same or coupled.
    ///
    /// # Panics
    /// Where the graph has no such bond.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        let Some(block) = self.plan.graph.block(i / 2, j / 2) else {
            panic!("no bond of sites {} and {}", j / 2, i / 2)
        };
        let block = &mut self.blocks[block];
        block[2 * (i % 2) + j % 2] += v;
        if i != j && i / 2 == j / 2 {
            block[1] += v;
        }
    }

    /// Adds a block to the rows of site i and the columns of another site j, and to its mirror image. The sites must be coupled.
    ///
    /// # Panics
    /// Where the graph has no such bond.
    #[inline]
    pub fn add_block(&mut self, i: usize, j: usize, [[a, b], [c, d]]: [[f64; 2]; 2]) {
        let (row, column, block) = if i >= j { (i, j, [a, b, c, d]) } else { (j, i, [a, c, b, d]) };
        let Some(own) = self.block_mut(row, column) else { panic!("no bond of sites {column} and {row}") };
        own.iter_mut().zip(block).for_each(|(own, v)| *own += v);
    }

    /// The block of site i's rows and site j's columns, row by row, if j ≤ i and the sites are the same or coupled. One on the
    /// diagonal must stay symmetric.
    pub fn block_mut(&mut self, i: usize, j: usize) -> Option<&mut [f64; 4]> {
        self.plan.graph.block(i, j).map(|block| &mut self.blocks[block])
    }

    /// Entry (i, j); zero where the sites are not coupled.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        let block = self.plan.graph.block(i / 2, j / 2);
        block.map_or(0.0, |block| self.blocks[block][2 * (i % 2) + j % 2])
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        for site in 0..self.plan.graph.sites() {
            let block = &mut self.blocks[self.plan.graph.blocks_of(site).start];
            block[0] += s;
            block[3] += s;
        }
    }

    /// The smallest diagonal entry, which no smallest eigenvalue exceeds.
    pub fn smallest_diagonal(&self) -> f64 {
        let sites = 0..self.plan.graph.sites();
        let diagonal = sites.map(|site| &self.blocks[self.plan.graph.blocks_of(site).start]);
        diagonal.fold(f64::INFINITY, |least, block| least.min(block[0]).min(block[3]))
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let graph = &self.plan.graph;
        y.fill(0.0);
        for j in 0..graph.sites() {
            let blocks = &self.blocks[graph.blocks_of(j)];
            let (x0, x1, d) = (x[2 * j], x[2 * j + 1], &blocks[0]);
            let mut sums = [d[0] * x0 + d[1] * x1, d[2] * x0 + d[3] * x1];
            for (i, b) in graph.later(j).iter().zip(&blocks[1..]) {
                let i = *i as usize;
                let (z, y) = (&x[2 * i..2 * i + 2], &mut y[2 * i..2 * i + 2]);
                y[0] += b[0] * x0 + b[1] * x1;
                y[1] += b[2] * x0 + b[3] * x1;
                sums[0] += b[0] * z[0] + b[2] * z[1];
                sums[1] += b[1] * z[0] + b[3] * z[1];
            }
            y[2 * j] += sums[0];
            y[2 * j + 1] += sums[1];
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let mut sizes = self.clone();
        sizes.blocks.iter_mut().flatten().for_each(|v| *v = v.abs());
        let mut sums = vec![0.0; self.order()];
        sizes.multiply(&vec![1.0; self.order()], &mut sums);
        sums.into_iter().fold(0.0, f64::max)
    }

    /// The largest entry; those that are no numbers do not count.
    pub(in crate::linalg) fn size(&self) -> f64 {
        slab::largest(self.blocks.as_flattened())
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn products_norms_and_shifts_agree_with_dense_arithmetic() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(21);
        for lattice in samples::all(&mut r) {
            let mut a = lattice.random(&mut r);
            let n = a.order();
            let before = samples::dense(&a);
            a.shift(0.25);
            let full = samples::dense(&a);
            for k in 0..n * n {
                let (i, j) = (k / n, k % n);
                assert_eq!(full[k], full[j * n + i]);
                assert_eq!(full[k], before[k] + if i == j { 0.25 } else { 0.0 });
            }
            let x: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
            let mut y = vec![9.0; n];
            a.multiply(&x, &mut y);
            for i in 0..n {
                let direct: f64 = (0..n).map(|j| full[i * n + j] * x[j]).sum();
                assert!((direct - y[i]).abs() < 1e-13, "{}", lattice.name);
            }
            let column = |j: usize| (0..n).map(|i| full[i * n + j].abs()).sum::<f64>();
            assert!(((0..n).map(column).fold(0.0, f64::max) - a.norm1()).abs() < 1e-13);
            assert_eq!((0..n).map(|i| full[i * n + i]).fold(f64::INFINITY, f64::min), a.smallest_diagonal());
            assert_eq!(full.iter().fold(0.0f64, |m, v| m.max(v.abs())), a.size());
        }
    }

    #[test]
    fn a_block_is_written_as_its_entries() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(22);
        let mut a = samples::Lattice::chain(4, 1, true).random(&mut r);
        assert!(a.block_mut(2, 0).is_none() && a.block_mut(0, 1).is_none());
        *a.block_mut(3, 0).expect("a ring") = [1.0, 2.0, 3.0, 4.0];
        assert_eq!([a.get(6, 0), a.get(6, 1), a.get(7, 0), a.get(1, 7)], [1.0, 2.0, 3.0, 4.0]);
        let before = samples::dense(&a);
        let mut by_entries = a.clone();
        for (i, j) in [(3, 0), (1, 2)] {
            a.add_block(i, j, [[0.1, 0.2], [0.3, 0.4]]);
            [0.1, 0.2, 0.3, 0.4].iter().enumerate().for_each(|(k, v)| by_entries.add(2 * i + k / 2, 2 * j + k % 2, *v));
        }
        assert_eq!(samples::dense(&a), samples::dense(&by_entries));
        assert!(samples::dense(&a) != before);
        a.clear();
        assert!(samples::dense(&a).iter().all(|v| *v == 0.0));
    }

    #[test]
    #[should_panic(expected = "no bond of sites 0 and 2")]
    fn an_entry_of_no_bond_is_refused() {
        samples::Lattice::chain(3, 1, false).zeros().add(0, 5, 1.0);
    }
}
