//! The factors L and D of a [`Matrix`], with the inertia (Sylvester: the signs of D are those of the eigenvalues) and ln|det|.

use super::{DenseLdl, Ldl, Matrix, Places, SparseLdl, TailLdl, TailedBand, slab};

/// The factors of a symmetric matrix.
#[derive(Clone, Debug)]
pub enum Factors {
    /// Of a band, in its own order.
    Band(Ldl, Places),
    /// Of a band with a tail, and the matrix itself, whose memory they do not use.
    Tail(TailLdl, TailedBand),
    /// Of blocks of coupled sites.
    Sparse(SparseLdl),
    /// Of all entries.
    Dense(DenseLdl),
}

impl Default for Factors {
    fn default() -> Factors {
        Factors::Band(Ldl::default(), Places::default())
    }
}

impl Matrix {
    /// A = L D Lᵀ, in the memory of A. A pivot smaller than the rounding error of the matrix is replaced by that error's
    /// size, sign kept.
    pub fn factor(self) -> Factors {
        Factors::solving(self, &mut [], 0)
    }
}

impl Factors {
    /// The factors of A, and on the way the solution of A X = B as by [`solve`](Self::solve).
    pub fn solving(a: Matrix, x: &mut [f64], columns: usize) -> Factors {
        let size = a.size();
        Factors::solving_sized(a, size, x, columns)
    }

    /// The same of a matrix whose largest entry, roughly, is known.
    pub fn solving_sized(a: Matrix, size: f64, x: &mut [f64], columns: usize) -> Factors {
        let floor = 4.0 * f64::EPSILON * size.max(1e-280);
        let factors = match a {
            Matrix::Band(band, places) => {
                let ldl = places.within(x, |x| Ldl::solving(band, floor, x, columns));
                return Factors::Band(ldl, places);
            }
            Matrix::Tail(tailed) => Factors::Tail(TailLdl::of(&tailed, floor), tailed),
            Matrix::Sparse(sparse) => Factors::Sparse(SparseLdl::of(sparse)),
            Matrix::Dense(dense) => Factors::Dense(DenseLdl::of(dense, floor)),
        };
        if columns > 0 {
            factors.solve(x, columns);
        }
        factors
    }

    /// The memory, to be filled anew.
    pub fn into_memory(self) -> Matrix {
        match self {
            Factors::Band(ldl, places) => Matrix::Band(ldl.into_memory(), places),
            Factors::Tail(_, tailed) => Matrix::Tail(tailed),
            Factors::Sparse(ldl) => Matrix::Sparse(ldl.into_memory()),
            Factors::Dense(ldl) => Matrix::Dense(ldl.into_memory()),
        }
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        match self {
            Factors::Band(ldl, _) => ldl.order(),
            Factors::Tail(_, tailed) => tailed.band.order(),
            Factors::Sparse(ldl) => ldl.order(),
            Factors::Dense(ldl) => ldl.pivots().len(),
        }
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        let count = |pivots: &[f64]| pivots.iter().filter(|d| **d < 0.0).count();
        match self {
            Factors::Band(ldl, _) => ldl.negatives(),
            Factors::Tail(ldl, _) => count(ldl.pivots()),
            Factors::Sparse(ldl) => ldl.negatives(),
            Factors::Dense(ldl) => count(ldl.pivots()),
        }
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        let sum = |pivots: &[f64]| slab::sum(&pivots.iter().map(|d| libm::log(d.abs())).collect::<Vec<f64>>());
        match self {
            Factors::Band(ldl, _) => ldl.log_abs_determinant(),
            Factors::Tail(ldl, _) => sum(ldl.pivots()),
            Factors::Sparse(ldl) => ldl.log_abs_determinant(),
            Factors::Dense(ldl) => sum(ldl.pivots()),
        }
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        match self {
            Factors::Band(ldl, places) => places.within(x, |x| ldl.solve(x, columns)),
            Factors::Tail(ldl, _) => slab::one_by_one(x, columns, |x| ldl.solve(x)),
            Factors::Sparse(ldl) => ldl.solve(x, columns),
            Factors::Dense(ldl) => ldl.solve(x, columns),
        }
    }
}
