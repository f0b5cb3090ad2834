//! A = L D Lᵀ of a sparse matrix, without pivoting: front by front, with the inertia (Sylvester: the signs of D are those of the
//! eigenvalues) and ln|det|.

use super::{SparseMatrix, solve};
use crate::linalg::slab;
use std::mem::take;

/// The factors L and D of a [`SparseMatrix`], and the matrix.
#[derive(Clone, Debug, Default)]
pub struct SparseLdl {
    /// With the factors in its memory.
    matrix: SparseMatrix,
    negatives: usize,
}

impl SparseLdl {
    /// The factors of a matrix, in the memory that it brings. A pivot smaller than the rounding error of the matrix is replaced
    /// by that error's size, sign kept.
    pub fn of(mut matrix: SparseMatrix) -> SparseLdl {
        let floor = 4.0 * f64::EPSILON * matrix.size().max(1e-280);
        let plan = &matrix.plan;
        let memory = if matrix.memory.l.is_empty() { plan.spare.any() } else { take(&mut matrix.memory) };
        let mut memory = memory.fitting(plan.entries, plan.pivots, plan.waiting);
        memory.eliminate(&matrix, floor);
        let negatives = memory.d.iter().filter(|d| **d < 0.0).count();
        matrix.memory = memory;
        SparseLdl { matrix, negatives }
    }

    /// The factors of A, and on the way the solution of A X = B as by [`solve`](Self::solve).
    pub fn solving(matrix: SparseMatrix, x: &mut [f64], columns: usize) -> SparseLdl {
        let factors = SparseLdl::of(matrix);
        factors.solve(x, columns);
        factors
    }

    /// The matrix, with the memory of the factors for the next ones.
    pub fn into_memory(self) -> SparseMatrix {
        self.matrix
    }

    /// The matrix.
    pub fn matrix(&self) -> &SparseMatrix {
        &self.matrix
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.matrix.order()
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        self.negatives
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        slab::sum(&self.matrix.memory.d.iter().map(|d| libm::log(d.abs())).collect::<Vec<f64>>())
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        solve::solve(&self.matrix.plan, &self.matrix.memory, x, columns);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse::Symbolic;
    use crate::linalg::sparse::samples::{self, Lattice};
    use crate::linalg::{Graph, Layout, Matrix, Places, eigenvalues_symmetric, solve_dense};
    use rand::{RngExt, SeedableRng, seq::SliceRandom};
    use rand_chacha::ChaCha8Rng;
    use std::sync::Arc;

    fn numbers(r: &mut ChaCha8Rng, n: usize) -> Vec<f64> {
        (0..n).map(|_| r.random_range(-1.0..1.0)).collect()
    }

    fn difference(a: &[f64], b: &[f64]) -> f64 {
        assert_eq!(a.len(), b.len());
        a.iter().zip(b).fold(0.0, |m, (a, b)| m.max((a - b).abs()))
    }

    /// The solution of A x = b, with one step of refinement.
    fn refined(factors: &SparseLdl, b: &[f64]) -> Vec<f64> {
        let (mut x, mut rest) = (b.to_vec(), vec![0.0; b.len()]);
        factors.solve(&mut x, 1);
        factors.matrix().multiply(&x, &mut rest);
        rest.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
        factors.solve(&mut rest, 1);
        slab::add_scaled(&mut x, 1.0, &rest);
        x
    }

    #[test]
    fn inertia_determinant_and_solution_agree_with_dense_arithmetic_on_all_kinds_of_graphs() {
        let mut r = ChaCha8Rng::seed_from_u64(11);
        for lattice in samples::all(&mut r) {
            for level in [0.0, 4.0, -4.0] {
                let mut a = lattice.random(&mut r);
                a.shift(level);
                let n = a.order();
                let full = samples::dense(&a);
                let eigen = eigenvalues_symmetric(&full, n);
                let smallest = eigen.iter().fold(f64::MAX, |s, l| s.min(l.abs()));
                assert!(smallest > 1e-8, "{}: an eigenvalue of {smallest:e} tells nothing", lattice.name);
                let factors = SparseLdl::of(a);
                let negatives = eigen.iter().filter(|l| **l < 0.0).count();
                assert_eq!((factors.order(), factors.negatives()), (n, negatives), "{}", lattice.name);
                let log: f64 = eigen.iter().map(|l| l.abs().ln()).sum();
                let error = (factors.log_abs_determinant() - log).abs();
                assert!(error < 1e-10 * (n as f64 + log.abs()), "{}: {error:e}", lattice.name);
                let b = numbers(&mut r, n);
                let exact = solve_dense(&full, &b, n).expect("regular");
                let error = difference(&refined(&factors, &b), &exact);
                assert!(error < 1e-12 / smallest.min(1.0).powi(2), "{}: {error:e}, {smallest:e}", lattice.name);
            }
        }
    }

    #[test]
    fn chains_and_rings_agree_with_the_banded_code() {
        let mut r = ChaCha8Rng::seed_from_u64(12);
        for (sites, reach, ring) in
            [(1, 1, false), (2, 1, false), (40, 1, false), (61, 2, false), (50, 1, true), (33, 3, true)]
        {
            let lattice = Lattice::chain(sites, reach, ring);
            let a = lattice.random(&mut r);
            let n = a.order();
            let folded = |i: usize| if 2 * i < sites { 2 * i } else { 2 * (sites - 1 - i) + 1 };
            let places = Places::new((0..sites).map(|i| if ring { folded(i) } else { i }).collect());
            let mut banded = Matrix::default();
            banded.reset(&Layout::Band { span: if ring { 2 * reach } else { reach }, places }, sites, 0);
            for j in 0..n {
                (j..n).filter(|i| a.get(*i, j) != 0.0).for_each(|i| banded.add(i, j, a.get(i, j)));
            }
            let mut b = numbers(&mut r, 2 * n);
            let mut x = b.clone();
            let banded = banded.factor();
            banded.solve(&mut b, 2);
            let factors = SparseLdl::solving(a, &mut x, 2);
            assert_eq!(factors.negatives(), banded.negatives());
            let logs = [factors.log_abs_determinant(), banded.log_abs_determinant()];
            assert!((logs[0] - logs[1]).abs() < 1e-11 * (n as f64 + logs[0].abs()), "{sites}: {logs:?}");
            assert!(difference(&x, &b) < 1e-9 * (1.0 + slab::max_abs(&b)), "{sites}: {:e}", difference(&x, &b));
        }
    }

    #[test]
    fn any_order_gives_the_same_answers() {
        let mut r = ChaCha8Rng::seed_from_u64(13);
        for lattice in samples::all(&mut r) {
            let mut a = lattice.random(&mut r);
            a.shift(3.0);
            let b = numbers(&mut r, a.order());
            let first = SparseLdl::of(a.clone());
            let x = refined(&first, &b);
            let mut order: Vec<u32> = (0..lattice.positions.len() as u32).collect();
            for _ in 0..3 {
                order.shuffle(&mut r);
                let mut other = SparseMatrix::zeros(Arc::new(Symbolic::in_order(lattice.graph(), &order)));
                other.blocks.clone_from(&a.blocks);
                let factors = SparseLdl::of(other);
                assert_eq!(factors.negatives(), first.negatives(), "{}", lattice.name);
                let logs = [factors.log_abs_determinant(), first.log_abs_determinant()];
                assert!((logs[0] - logs[1]).abs() < 1e-10 * (1.0 + logs[0].abs()), "{}: {logs:?}", lattice.name);
                let error = difference(&x, &refined(&factors, &b));
                assert!(error < 1e-10 * (1.0 + slab::max_abs(&x)), "{}: {error:e}", lattice.name);
            }
        }
    }

    #[test]
    fn sites_with_other_numbers_have_the_same_inertia_determinant_and_solution() {
        let mut r = ChaCha8Rng::seed_from_u64(14);
        let lattice = Lattice::grid([6, 5, 2], [true, false, false], 1.0, &mut r);
        let a = lattice.random(&mut r);
        let mut numbers_of: Vec<usize> = (0..lattice.positions.len()).collect();
        numbers_of.shuffle(&mut r);
        let mut renamed = Lattice { bonds: Vec::new(), ..lattice.clone() };
        numbers_of.iter().zip(&lattice.positions).for_each(|(k, p)| renamed.positions[*k] = *p);
        renamed.bonds.extend(lattice.bonds.iter().map(|(i, j)| (numbers_of[*i], numbers_of[*j])));
        let mut other = renamed.zeros();
        let unknown = |i: usize| 2 * numbers_of[i / 2] + i % 2;
        for j in 0..a.order() {
            (j..a.order()).filter(|i| a.get(*i, j) != 0.0).for_each(|i| other.add(unknown(i), unknown(j), a.get(i, j)));
        }
        let b = numbers(&mut r, a.order());
        let mut c = vec![0.0; b.len()];
        (0..b.len()).for_each(|i| c[unknown(i)] = b[i]);
        let factors = [SparseLdl::of(a), SparseLdl::of(other)];
        let (x, y) = (refined(&factors[0], &b), refined(&factors[1], &c));
        let y: Vec<f64> = (0..b.len()).map(|i| y[unknown(i)]).collect();
        assert!(difference(&x, &y) < 1e-10 * (1.0 + slab::max_abs(&x)), "{:e}", difference(&x, &y));
        let logs = factors.each_ref().map(|f| f.log_abs_determinant());
        assert!((logs[0] - logs[1]).abs() < 1e-10 && factors[0].negatives() == factors[1].negatives(), "{logs:?}");
    }

    #[test]
    fn memory_that_was_used_gives_the_same_bits() {
        let mut r = ChaCha8Rng::seed_from_u64(15);
        let mut memory = SparseMatrix::default();
        for lattice in samples::all(&mut r) {
            let a = lattice.random(&mut r);
            let fresh = SparseLdl::of(a.clone());
            memory.reset(a.plan());
            memory.copy_from(&a);
            let b = numbers(&mut r, 7 * a.order());
            let (mut x, mut y) = (b.clone(), b);
            fresh.solve(&mut x, 7);
            let again = SparseLdl::solving(memory, &mut y, 7);
            assert_eq!((&x, fresh.log_abs_determinant()), (&y, again.log_abs_determinant()), "{}", lattice.name);
            memory = again.into_memory();
        }
    }

    #[test]
    fn factors_take_the_memory_that_the_plan_promises() {
        let mut r = ChaCha8Rng::seed_from_u64(18);
        for lattice in samples::all(&mut r) {
            let factors = SparseLdl::of(lattice.random(&mut r));
            let m = &factors.matrix.memory;
            let numbers =
                m.l.len() + m.d.len() + m.waiting[0].len() + m.waiting[1].len() + 4 * factors.matrix.blocks.len();
            assert_eq!(size_of::<f64>() * numbers, factors.matrix.plan.bytes(1), "{}", lattice.name);
        }
    }

    #[test]
    fn branches_side_by_side_have_the_bits_of_one_after_the_other() {
        let mut r = ChaCha8Rng::seed_from_u64(19);
        for cells in [[110, 90, 1], [12, 11, 13]] {
            let lattice = Lattice::grid(cells, [true, false, false], 1.0, &mut r);
            let a = lattice.random(&mut r);
            let (plan, whole) = (a.plan(), Arc::new(a.plan().without_branches()));
            assert!(plan.branches.len() > 8 && whole.branches.is_empty(), "{} {:e}", plan.branches.len(), plan.flops());
            let mut b = SparseMatrix::zeros(whole);
            b.blocks.clone_from(&a.blocks);
            let (x, y) = (SparseLdl::of(a), SparseLdl::of(b));
            assert!(
                x.matrix.memory.l == y.matrix.memory.l
                    && x.matrix.memory.d == y.matrix.memory.d
                    && x.negatives == y.negatives
            );
        }
    }

    #[test]
    fn columns_together_have_the_bits_of_one_alone() {
        let mut r = ChaCha8Rng::seed_from_u64(16);
        let lattice = Lattice::grid([7, 6, 1], [false, true, false], 1.0, &mut r);
        let factors = SparseLdl::of(lattice.random(&mut r));
        let n = factors.order();
        for columns in [0, 1, 2, 3, 4, 5, 11] {
            let b = numbers(&mut r, n * columns);
            let mut x = b.clone();
            factors.solve(&mut x, columns);
            for c in 0..columns {
                let mut alone: Vec<f64> = b[c..].iter().step_by(columns).copied().collect();
                factors.solve(&mut alone, 1);
                assert!(x[c..].iter().step_by(columns).eq(&alone), "{c} of {columns}");
            }
        }
    }

    #[test]
    fn singular_matrices_and_pivots_of_zero_give_finite_numbers() {
        let mut r = ChaCha8Rng::seed_from_u64(17);
        for lattice in samples::all(&mut r) {
            let mut ring_of_ones = lattice.zeros();
            for (i, j) in &lattice.bonds {
                (0..2).for_each(|u| ring_of_ones.add(2 * i + u, 2 * j + u, 1.0));
            }
            for a in [lattice.zeros(), ring_of_ones] {
                let factors = SparseLdl::of(a);
                let x = refined(&factors, &vec![1e-300; factors.order()]);
                assert!(
                    x.iter().all(|v| v.is_finite()) && factors.log_abs_determinant().is_finite(),
                    "{}",
                    lattice.name
                );
            }
        }
    }

    #[test]
    fn zeros_on_the_diagonal_leave_the_inertia_right() {
        let plan = Arc::new(Symbolic::in_order(Graph::new(2, [(0, 1)]), &[0, 1]));
        let mut a = SparseMatrix::zeros(plan);
        (0..2).for_each(|u| a.add(u, 2 + u, 1.0));
        let factors = SparseLdl::of(a);
        assert_eq!(factors.negatives(), 2);
        assert!(factors.log_abs_determinant().abs() < 1e-12);
        let x = refined(&factors, &[1.0, 2.0, 3.0, 4.0]);
        assert!(difference(&x, &[3.0, 4.0, 1.0, 2.0]) < 1e-12, "{x:?}");
    }

    #[test]
    fn no_unknowns_have_no_factors() {
        let factors = SparseLdl::of(SparseMatrix::zeros(Arc::new(Symbolic::of(Graph::new(0, []), &[]))));
        factors.solve(&mut [], 1);
        assert_eq!((factors.order(), factors.negatives(), factors.log_abs_determinant()), (0, 0, 0.0));
    }
}
