//! A = L D Lᵀ of a band, without pivoting: O(n w²), with the inertia (Sylvester: the signs of D are those of the eigenvalues) and
//! ln|det|.
//!
//! Long bands of short reach are eliminated from both ends at once (see `twisted`).

use super::pivot::guarded;
use super::{Banded, slab, twisted};

/// The factors L and D of a [`Banded`] matrix, in its memory.
#[derive(Clone, Debug, Default)]
pub struct Ldl {
    /// L, and the inverse pivots on its diagonal.
    a: Banded,
    negatives: usize,
}

impl Ldl {
    /// The factors of A, and on the way the solution of A X = B as by [`solve`](Self::solve). A pivot smaller than the floor is
    /// replaced by that, sign kept.
    pub fn solving(mut a: Banded, floor: f64, x: &mut [f64], columns: usize) -> Ldl {
        let width = twisted::width(&a);
        let (negatives, solved) = match (width, columns) {
            (Some(3), 1) => (from_both_ends::<3, 4, 1>(&mut a, floor, x), true),
            (Some(3), 2) => (from_both_ends::<3, 4, 2>(&mut a, floor, x), true),
            (Some(5), 1) => (from_both_ends::<5, 6, 1>(&mut a, floor, x), true),
            (Some(5), 2) => (from_both_ends::<5, 6, 2>(&mut a, floor, x), true),
            (Some(1), _) => (twisted::eliminate::<1, 2, 0>(&mut a, floor, &mut []), false),
            (Some(3), _) => (twisted::eliminate::<3, 4, 0>(&mut a, floor, &mut []), false),
            (Some(5), _) => (twisted::eliminate::<5, 6, 0>(&mut a, floor, &mut []), false),
            _ => (eliminate(&mut a, floor), false),
        };
        let factors = Ldl { a, negatives };
        if columns > 0 && !solved {
            factors.solve(x, columns);
        }
        factors
    }

    /// The memory, to be filled anew.
    pub fn into_memory(self) -> Banded {
        self.a
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.a.order
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        self.negatives
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        let stride = self.a.width + 1;
        let inverses = self.a.band[..self.a.order * stride].iter().step_by(stride);
        slab::sum(&inverses.map(|inverse| -libm::log(inverse.abs())).collect::<Vec<f64>>())
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        match (twisted::width(&self.a), columns) {
            (Some(1), 1) => twisted::substitute::<1, 2, 1>(&self.a, x),
            (Some(1), 3) => twisted::substitute::<1, 2, 3>(&self.a, x),
            (Some(3), 1) => twisted::substitute::<3, 4, 1>(&self.a, x),
            (Some(3), 2) => twisted::substitute::<3, 4, 2>(&self.a, x),
            (Some(5), 1) => twisted::substitute::<5, 6, 1>(&self.a, x),
            (Some(5), 2) => twisted::substitute::<5, 6, 2>(&self.a, x),
            (Some(_), _) => slab::one_by_one(x, columns, |x| self.solve(x, 1)),
            (None, _) => substitute(&self.a, columns, x),
        }
    }
}

/// Eliminates and solves; the number of negative pivots.
fn from_both_ends<const W: usize, const S: usize, const C: usize>(a: &mut Banded, floor: f64, x: &mut [f64]) -> usize {
    let negatives = twisted::eliminate::<W, S, C>(a, floor, x);
    twisted::substitute_back::<W, S, C>(a, x);
    negatives
}

/// Right-looking elimination in place, of any width. The inverse pivots stand on the diagonal; returns how many are negative.
fn eliminate(m: &mut Banded, floor: f64) -> usize {
    let (w, stride) = (m.width, m.width + 1);
    let mut negatives = 0;
    for j in 0..m.order {
        let (head, tail) = m.band.split_at_mut((j + 1) * stride);
        let column = &mut head[j * stride..];
        let inverse = 1.0 / guarded(column[0], floor);
        negatives += usize::from(inverse < 0.0);
        column[0] = inverse;
        for k in 1..=w {
            let l = column[k] * inverse;
            let target = &mut tail[(k - 1) * stride..k * stride];
            for q in k..=w {
                target[q - k] -= l * column[q];
            }
        }
        for k in 1..=w {
            column[k] *= inverse;
        }
    }
    negatives
}

/// Forward and backward substitution of any width.
fn substitute(m: &Banded, c: usize, x: &mut [f64]) {
    let (n, w) = (m.order, m.width);
    let stride = w + 1;
    for j in 0..n {
        let l = &m.band[j * stride..(j + 1) * stride];
        let (head, tail) = x.split_at_mut((j + 1) * c);
        let xj = &head[j * c..];
        for k in 1..=w.min(n - 1 - j) {
            for q in 0..c {
                tail[(k - 1) * c + q] -= l[k] * xj[q];
            }
        }
    }
    for j in (0..n).rev() {
        let l = &m.band[j * stride..(j + 1) * stride];
        let (head, tail) = x.split_at_mut((j + 1) * c);
        let xj = &mut head[j * c..];
        for q in 0..c {
            xj[q] *= l[0];
        }
        for k in 1..=w.min(n - 1 - j) {
            for q in 0..c {
                xj[q] -= l[k] * tail[(k - 1) * c + q];
            }
        }
    }
}
