//! A = L D Lᵀ of a banded matrix, without pivoting: O(n (w + b)²), with the inertia (Sylvester: the signs of D are those of the
//! eigenvalues) and ln|det|.
//!
//! Open chains of short reach are eliminated from both ends at once (see `twisted`).

use super::pivot::guarded;
use super::{Banded, TailLdl, slab, twisted};
use multiversion::multiversion;

/// The factors L and D of a [`Banded`] matrix.
#[derive(Clone, Debug, Default)]
pub struct Ldl {
    a: Banded,
    /// The factors, where the matrix has a tail: then `a` is the matrix as it was.
    tail: Option<TailLdl>,
    negatives: usize,
}

impl Ldl {
    /// The factors of a matrix, in its memory. A pivot smaller than the rounding error of the matrix is replaced by that
    /// error's size, sign kept.
    pub fn of(a: Banded) -> Ldl {
        Ldl::solving(a, &mut [], 0)
    }

    /// The factors of A, and on the way the solution of A X = B as by [`solve`](Self::solve).
    pub fn solving(a: Banded, x: &mut [f64], columns: usize) -> Ldl {
        let size = a.size();
        Ldl::solving_sized(a, size, x, columns)
    }

    /// The same of a matrix whose largest entry, roughly, is known.
    pub fn solving_sized(mut a: Banded, size: f64, x: &mut [f64], columns: usize) -> Ldl {
        let floor = 4.0 * f64::EPSILON * size.max(1e-280);
        let done = match (twisted::width(&a), columns) {
            (Some(1), 0) => Some(twisted::eliminate::<1, 2, 0>(&mut a, floor, x)),
            (Some(3), 0) => Some(twisted::eliminate::<3, 4, 0>(&mut a, floor, x)),
            (Some(5), 0) => Some(twisted::eliminate::<5, 6, 0>(&mut a, floor, x)),
            (Some(3), 1) => Some(from_both_ends::<3, 4, 1>(&mut a, floor, x)),
            (Some(3), 2) => Some(from_both_ends::<3, 4, 2>(&mut a, floor, x)),
            (Some(5), 1) => Some(from_both_ends::<5, 6, 1>(&mut a, floor, x)),
            (Some(5), 2) => Some(from_both_ends::<5, 6, 2>(&mut a, floor, x)),
            _ => None,
        };
        if let Some(negatives) = done {
            return Ldl { a, tail: None, negatives };
        }
        let factors = match twisted::width(&a) {
            Some(_) => Ldl::of(a),
            None => Ldl::of_any_shape(a, floor),
        };
        if columns > 0 {
            factors.solve(x, columns);
        }
        factors
    }

    fn of_any_shape(mut a: Banded, floor: f64) -> Ldl {
        let tail = a.tail.is_some().then(|| TailLdl::of(&a, floor));
        if tail.is_none() {
            eliminate(&mut a, floor);
        }
        let mut factors = Ldl { a, tail, negatives: 0 };
        let (band, rest) = factors.pivots();
        factors.negatives = band.chain(rest).filter(|d| **d < 0.0).count();
        factors
    }

    /// The memory, to be filled anew.
    pub fn into_memory(self) -> Banded {
        self.a
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.a.order()
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        self.negatives
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        let (band, rest) = self.pivots();
        let logs = band.map(|inverse| -libm::log(inverse.abs())).chain(rest.map(|d| libm::log(d.abs())));
        slab::sum(&logs.collect::<Vec<f64>>())
    }

    /// 1/D of the band, and the rest of D, or the eigenvalues of its blocks.
    fn pivots(&self) -> (impl Iterator<Item = &f64>, impl Iterator<Item = &f64>) {
        let (s, b) = (self.a.width + 1, self.a.border);
        let inner = if self.tail.is_some() { 0 } else { self.a.inner };
        let tail = self.tail.iter().flat_map(|t| t.pivots());
        let corner = (0..b).map(move |r| &self.a.corner[r * b + r]);
        (self.a.band[..inner * s].iter().step_by(s), corner.chain(tail))
    }

    /// Any number of interleaved right-hand sides, one by one.
    fn solve_each(&self, x: &mut [f64], columns: usize) {
        let mut one = vec![0.0; self.order()];
        for c in 0..columns {
            one.iter_mut().zip(x[c..].iter().step_by(columns)).for_each(|(o, x)| *o = *x);
            self.solve(&mut one, 1);
            x[c..].iter_mut().step_by(columns).zip(&one).for_each(|(x, o)| *x = *o);
        }
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        if let Some(tail) = &self.tail {
            return if columns == 1 { tail.solve(x) } else { self.solve_each(x, columns) };
        }
        match (twisted::width(&self.a), columns) {
            (Some(1), 1) => twisted::substitute::<1, 2, 1>(&self.a, x),
            (Some(1), 3) => twisted::substitute::<1, 2, 3>(&self.a, x),
            (Some(3), 1) => twisted::substitute::<3, 4, 1>(&self.a, x),
            (Some(3), 2) => twisted::substitute::<3, 4, 2>(&self.a, x),
            (Some(5), 1) => twisted::substitute::<5, 6, 1>(&self.a, x),
            (Some(5), 2) => twisted::substitute::<5, 6, 2>(&self.a, x),
            (Some(_), _) => self.solve_each(x, columns),
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

/// Right-looking elimination in place, of any shape. The inverse pivots stand on the diagonal of the band.
fn eliminate(m: &mut Banded, floor: f64) {
    let (w, b) = (m.width, m.border);
    let stride = w + 1;
    for j in 0..m.inner {
        let (head, tail) = m.band.split_at_mut((j + 1) * stride);
        let column = &mut head[j * stride..];
        let inverse = 1.0 / guarded(column[0], floor);
        column[0] = inverse;
        for k in 1..=w {
            let l = column[k] * inverse;
            let target = &mut tail[(k - 1) * stride..k * stride];
            for q in k..=w {
                target[q - k] -= l * column[q];
            }
        }
        if b > 0 {
            let (rim, later) = m.rim.split_at_mut((j + 1) * b);
            let rim = &mut rim[j * b..];
            for k in 1..=w.min(m.inner - 1 - j) {
                let l = column[k] * inverse;
                for r in 0..b {
                    later[(k - 1) * b + r] -= l * rim[r];
                }
            }
            for r in 0..b {
                let l = rim[r] * inverse;
                for s in 0..=r {
                    m.corner[r * b + s] -= l * rim[s];
                }
            }
            for r in 0..b {
                rim[r] *= inverse;
            }
        }
        for k in 1..=w {
            column[k] *= inverse;
        }
    }
    eliminate_corner(&mut m.corner, b, floor);
}

/// Elimination of a dense matrix, row by row, lower half.
#[multiversion(targets("x86_64+avx2"))]
fn eliminate_corner(corner: &mut [f64], b: usize, floor: f64) {
    let mut column = vec![0.0; b];
    for j in 0..b {
        let d = guarded(corner[j * b + j], floor);
        corner[j * b + j] = d;
        for r in j + 1..b {
            column[r] = corner[r * b + j];
        }
        for r in j + 1..b {
            let l = column[r] / d;
            for (x, c) in corner[r * b + j + 1..=r * b + r].iter_mut().zip(&column[j + 1..]) {
                *x -= l * c;
            }
            corner[r * b + j] = l;
        }
    }
}

/// Forward and backward substitution of any shape.
fn substitute(m: &Banded, c: usize, x: &mut [f64]) {
    let (n, w, b) = (m.inner, m.width, m.border);
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
        for r in 0..b {
            let rim = m.rim[j * b + r];
            for q in 0..c {
                tail[(n + r - j - 1) * c + q] -= rim * xj[q];
            }
        }
    }
    for r in 0..b {
        for s in 0..r {
            for q in 0..c {
                x[(n + r) * c + q] -= m.corner[r * b + s] * x[(n + s) * c + q];
            }
        }
    }
    for r in 0..b {
        for q in 0..c {
            x[(n + r) * c + q] /= m.corner[r * b + r];
        }
    }
    for s in (0..b).rev() {
        for r in 0..s {
            for q in 0..c {
                x[(n + r) * c + q] -= m.corner[s * b + r] * x[(n + s) * c + q];
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
        for r in 0..b {
            let rim = m.rim[j * b + r];
            for q in 0..c {
                xj[q] -= rim * tail[(n + r - j - 1) * c + q];
            }
        }
    }
}
