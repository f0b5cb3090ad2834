//! One symmetric matrix, whatever keeps it best, with the unknowns as the sites are counted.

use super::{Banded, Dense, Layout, Places, SparseMatrix, Tail, TailedBand};
use std::mem::take;

/// A symmetric matrix that can be factorised.
#[derive(Clone, Debug)]
pub enum Matrix {
    /// A band, in an order of its own.
    Band(Banded, Places),
    /// A band with a tail, as the sites are counted.
    Tail(TailedBand),
    /// Blocks of coupled sites.
    Sparse(SparseMatrix),
    /// All entries.
    Dense(Dense),
}

impl Default for Matrix {
    fn default() -> Matrix {
        Matrix::Band(Banded::default(), Places::default())
    }
}

impl From<Banded> for Matrix {
    fn from(band: Banded) -> Matrix {
        Matrix::Band(band, Places::default())
    }
}

impl Matrix {
    /// Makes it a zero matrix of so many sites, two unknowns each, in the memory it has if that is of the same kind; but for the
    /// first `written` sites of a band in the order of counting, all entries of which are to be written.
    pub fn reset(&mut self, layout: &Layout, sites: usize, written: usize) {
        *self = match (layout, take(self)) {
            (Layout::Band { span, places }, old) => {
                let mut band = match old {
                    Matrix::Band(band, _) | Matrix::Tail(TailedBand { band, .. }) => band,
                    _ => Banded::default(),
                };
                let written = if places.moved().is_none() { written } else { 0 };
                band.reset(2 * sites, 2 * span + 1, 2 * written);
                Matrix::Band(band, places.clone())
            }
            (Layout::Sparse(plan), old) => {
                let mut sparse = if let Matrix::Sparse(sparse) = old { sparse } else { SparseMatrix::default() };
                sparse.reset(plan);
                Matrix::Sparse(sparse)
            }
            (Layout::Dense, old) => {
                let mut dense = if let Matrix::Dense(dense) = old { dense } else { Dense::default() };
                dense.reset(2 * sites);
                Matrix::Dense(dense)
            }
        };
    }

    /// Makes it a copy of another matrix, in the memory it has if that is of the same kind.
    pub fn copy_from(&mut self, other: &Matrix) {
        match (&mut *self, other) {
            (Matrix::Band(band, places), Matrix::Band(from, order)) => {
                band.copy_from(from);
                places.clone_from(order);
            }
            (Matrix::Sparse(sparse), Matrix::Sparse(from)) => sparse.copy_from(from),
            (Matrix::Dense(dense), Matrix::Dense(from)) => dense.copy_from(from),
            _ => *self = other.clone(),
        }
    }

    /// Adds a tail to a band of two unknowns a site in the order of counting.
    ///
    /// # Panics
    /// Where the matrix is no such band.
    pub fn set_tail(&mut self, tail: Tail) {
        let Matrix::Band(band, places) = take(self) else { panic!("a tail belongs to a band") };
        assert!(places.moved().is_none() && band.order() == 2 * tail.rows.len());
        *self = Matrix::Tail(TailedBand { band, tail });
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        match self {
            Matrix::Band(band, _) => band.order(),
            Matrix::Tail(tailed) => tailed.band.order(),
            Matrix::Sparse(sparse) => sparse.order(),
            Matrix::Dense(dense) => dense.order(),
        }
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image. The entry must be one that the matrix keeps.
    #[inline(always)]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        match self {
            Matrix::Band(band, places) => {
                let n = band.order();
                band.add(places.unknown(i, n), places.unknown(j, n), v);
            }
            Matrix::Tail(tailed) => tailed.band.add(i, j, v),
            Matrix::Sparse(sparse) => sparse.add(i, j, v),
            Matrix::Dense(dense) => dense.add(i, j, v),
        }
    }

    /// Adds a block to the rows of site i and the columns of another site j, and to its mirror image.
    #[inline(always)]
    pub fn add_block(&mut self, i: usize, j: usize, block: [[f64; 2]; 2]) {
        match self {
            Matrix::Band(band, places) => band.add_block(places.of(i), places.of(j), block),
            Matrix::Dense(dense) => dense.add_block(i, j, block),
            Matrix::Sparse(sparse) => sparse.add_block(i, j, block),
            Matrix::Tail(_) => {
                for (k, v) in block.into_iter().flatten().enumerate() {
                    self.add(2 * i + k / 2, 2 * j + k % 2, v);
                }
            }
        }
    }

    /// Adds to the rows of site i a block for each earlier site j, in its columns, and the mirror images.
    pub fn add_blocks_before(&mut self, i: usize, block: impl Fn(usize) -> [[f64; 2]; 2]) {
        match self {
            Matrix::Dense(dense) => dense.add_blocks_before(i, block),
            _ => (0..i).for_each(|j| self.add_block(i, j, block(j))),
        }
    }

    /// Entry (i, j); zero where the matrix keeps none.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        match self {
            Matrix::Band(band, places) => {
                let n = band.order();
                band.get(places.unknown(i, n), places.unknown(j, n))
            }
            Matrix::Tail(tailed) => tailed.get(i, j),
            Matrix::Sparse(sparse) => sparse.get(i, j),
            Matrix::Dense(dense) => dense.get(i, j),
        }
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        match self {
            Matrix::Band(band, _) | Matrix::Tail(TailedBand { band, .. }) => band.shift(s),
            Matrix::Sparse(sparse) => sparse.shift(s),
            Matrix::Dense(dense) => dense.shift(s),
        }
    }

    /// The smallest diagonal entry, which no smallest eigenvalue exceeds.
    pub fn smallest_diagonal(&self) -> f64 {
        match self {
            Matrix::Band(band, _) | Matrix::Tail(TailedBand { band, .. }) => band.smallest_diagonal(),
            Matrix::Sparse(sparse) => sparse.smallest_diagonal(),
            Matrix::Dense(dense) => dense.smallest_diagonal(),
        }
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        match self {
            Matrix::Band(band, places) => match places.moved() {
                None => band.multiply(x, y),
                Some(_) => places.within(y, |y| band.multiply(&places.placed(x), y)),
            },
            Matrix::Tail(tailed) => {
                tailed.band.multiply(x, y);
                tailed.tail.add_product(x, y);
            }
            Matrix::Sparse(sparse) => sparse.multiply(x, y),
            Matrix::Dense(dense) => dense.multiply(x, y),
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁; a tail counts with its estimate.
    pub fn norm1(&self) -> f64 {
        match self {
            Matrix::Band(band, _) => band.norm1(),
            Matrix::Tail(tailed) => tailed.band.norm1() + tailed.tail.norm,
            Matrix::Sparse(sparse) => sparse.norm1(),
            Matrix::Dense(dense) => dense.norm1(),
        }
    }

    /// The largest entry; those that are no numbers do not count.
    pub(super) fn size(&self) -> f64 {
        match self {
            Matrix::Band(band, _) => band.size(),
            Matrix::Tail(tailed) => tailed.band.size().max(tailed.tail.norm),
            Matrix::Sparse(sparse) => sparse.size(),
            Matrix::Dense(dense) => dense.size(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{Factors, Graph, Symbolic, eigenvalues_symmetric};
    use rand::{Rng, RngExt, SeedableRng};

    fn band(r: &mut impl Rng, order: usize, width: usize, places: Places) -> Matrix {
        let mut a = Banded::zeros(order, width);
        for j in 0..order {
            (j..order.min(j + width + 1)).for_each(|i| a.add(i, j, r.random_range(-1.0..1.0)));
        }
        Matrix::Band(a, places)
    }

    /// Where the sites of a folded ring stand.
    fn folded(sites: usize) -> Places {
        Places::new((0..sites).map(|i| if 2 * i < sites { 2 * i } else { 2 * (sites - 1 - i) + 1 }).collect())
    }

    fn matrices(r: &mut impl Rng) -> Vec<Matrix> {
        let shapes =
            [(1, 1), (2, 1), (9, 3), (12, 5), (6, 0), (7, 7), (16, 1), (23, 1), (32, 3), (41, 3), (48, 5), (55, 5)];
        let mut all: Vec<Matrix> = shapes.iter().map(|(n, w)| band(r, *n, *w, Places::default())).collect();
        for (sites, each, width) in [(3, 2, 5), (9, 1, 2), (24, 2, 5), (31, 2, 5), (12, 2, 9)] {
            all.push(band(r, each * sites, width, folded(sites)));
        }
        let sites = 14;
        let bonds: Vec<(usize, usize)> = (0..sites).flat_map(|i| [(i, (i + 2) % sites), (i, i ^ 1)]).collect();
        let positions: Vec<[f64; 3]> = (0..sites).map(|i| [(i / 2) as f64, (i % 2) as f64, 0.0]).collect();
        let plan = Symbolic::of(Graph::new(sites, bonds.iter().copied()), &positions).into();
        let (mut sparse, mut dense) = (Matrix::default(), Matrix::default());
        sparse.reset(&Layout::Sparse(plan), sites, 0);
        dense.reset(&Layout::Dense, sites, 0);
        for k in 0..2 * sites {
            (0..=k).for_each(|j| dense.add(k, j, r.random_range(-1.0..1.0)));
            sparse.add(k, k, r.random_range(-1.0..1.0));
        }
        for (i, j) in bonds {
            sparse.add_block(i, j, [(); 2].map(|()| [(); 2].map(|()| r.random_range(-1.0..1.0))));
        }
        all.extend([sparse, dense]);
        all
    }

    fn full(a: &Matrix) -> Vec<f64> {
        let n = a.order();
        (0..n * n).map(|k| a.get(k / n, k % n)).collect()
    }

    #[test]
    fn solution_inertia_determinant_and_product_of_every_kind_agree_with_dense_arithmetic() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for (a, columns) in matrices(&mut r).into_iter().flat_map(|a| [1, 2, 3].map(|c| (a.clone(), c))) {
            let (n, full) = (a.order(), full(&a));
            let x: Vec<f64> = (0..n * columns).map(|_| r.random_range(-1.0..1.0)).collect();
            let mut b = vec![0.0; n * columns];
            for c in 0..columns {
                let xc: Vec<f64> = (0..n).map(|j| x[j * columns + c]).collect();
                let mut y = vec![9.0; n];
                a.multiply(&xc, &mut y);
                for i in 0..n {
                    let direct: f64 = (0..n).map(|j| full[i * n + j] * xc[j]).sum();
                    assert!((direct - y[i]).abs() < 1e-13);
                    b[i * columns + c] = y[i];
                }
            }
            let eigen = eigenvalues_symmetric(&full, n);
            let f = a.clone().factor();
            assert_eq!((f.order(), f.negatives()), (n, eigen.iter().filter(|l| **l < 0.0).count()));
            let log: f64 = eigen.iter().map(|l| l.abs().ln()).sum();
            assert!((f.log_abs_determinant() - log).abs() < 1e-8 * (1.0 + log.abs()));
            let mut on_the_way = b.clone();
            let g = Factors::solving(a.clone(), &mut on_the_way, columns);
            f.solve(&mut b, columns);
            assert_eq!((&on_the_way, g.negatives()), (&b, f.negatives()));
            let smallest = eigen.iter().fold(f64::MAX, |s, l| s.min(l.abs()));
            for (p, q) in b.iter().zip(&x) {
                assert!((p - q).abs() < 1e-11 / smallest, "{p} {q} {smallest}");
            }
        }
    }

    #[test]
    fn norms_and_diagonals_of_every_kind_are_those_of_its_entries_and_copies_are_alike() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let mut copy = Matrix::default();
        for mut a in matrices(&mut r) {
            let before = full(&a);
            a.shift(0.25);
            let (n, full) = (a.order(), full(&a));
            assert!((0..n * n).all(|k| full[k] == before[k] + if k % (n + 1) == 0 { 0.25 } else { 0.0 }));
            let column = |j: usize| (0..n).map(|i| full[i * n + j].abs()).sum::<f64>();
            assert!((a.norm1() - (0..n).map(column).fold(0.0, f64::max)).abs() < 1e-13);
            assert_eq!(a.smallest_diagonal(), (0..n).map(|i| full[i * n + i]).fold(f64::INFINITY, f64::min));
            assert_eq!(a.size(), full.iter().fold(0.0f64, |m, v| m.max(v.abs())));
            copy.copy_from(&a);
            assert!((0..n * n).all(|k| copy.get(k / n, k % n) == full[k]));
        }
    }

    #[test]
    fn blocks_of_all_earlier_sites_are_added_to_every_kind_that_keeps_them() {
        let sites = 5;
        let plan = Symbolic::of(
            Graph::new(sites, (0..sites).flat_map(|i| (0..i).map(move |j| (i, j)))),
            &[0, 1, 2, 3, 4].map(|x| [f64::from(x), 0.0, 0.0]),
        );
        let folded = folded(sites);
        for layout in [
            Layout::Dense,
            Layout::Sparse(plan.into()),
            Layout::Band { span: sites - 1, places: Places::default() },
            Layout::Band { span: sites - 1, places: folded },
        ] {
            let mut a = Matrix::default();
            a.reset(&layout, sites, 0);
            (0..sites).for_each(|i| {
                a.add_blocks_before(i, |j| [[1.0, 2.0], [3.0, 4.0]].map(|r| r.map(|x| x + (10 * i + j) as f64)))
            });
            for (i, j) in (0..2 * sites).flat_map(|i| (0..i).map(move |j| (i, j))) {
                let block = if i / 2 == j / 2 { 0.0 } else { (10 * (i / 2) + j / 2 + 2 * (i % 2) + j % 2 + 1) as f64 };
                assert_eq!((a.get(i, j), a.get(j, i)), (block, block), "{layout:?} {i} {j}");
            }
        }
    }

    #[test]
    fn memory_is_used_again_whatever_it_held_and_begins_at_zero() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        for old in matrices(&mut r) {
            for layout in [Layout::Band { span: 2, places: folded(5) }, Layout::Dense] {
                let mut a = old.clone().factor().into_memory();
                a.reset(&layout, 5, 3);
                assert_eq!((a.order(), a.norm1()), (10, 0.0));
            }
        }
    }

    #[test]
    fn a_singular_matrix_of_any_kind_gives_finite_numbers() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        for layout in [Layout::Band { span: 1, places: Places::default() }, Layout::Dense] {
            let mut a = matrices(&mut r).remove(0);
            a.reset(&layout, 20, 0);
            let mut x = vec![1.0; a.order()];
            a.factor().solve(&mut x, 1);
            assert!(x.iter().all(|v| !v.is_nan()));
        }
    }
}
