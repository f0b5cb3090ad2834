//! A = L D Lᵀ of a banded matrix, without pivoting: O(n (w + b)²), with the inertia (Sylvester: the signs of D are those of the
//! eigenvalues) and ln|det|.
//!
//! Open chains of short reach have a path of their own, with the next columns in registers: what follows a pivot waits for
//! nothing but that pivot.

use super::{Banded, TailLdl, slab};
use multiversion::multiversion;

/// The factors L and D of a [`Banded`] matrix.
#[derive(Clone, Debug, Default)]
pub struct Ldl {
    a: Banded,
    /// The factors, where the matrix has a tail: then `a` is the matrix as it was.
    tail: Option<TailLdl>,
}

impl Ldl {
    /// The factors of a matrix, in its memory. A pivot smaller than the rounding error of the matrix is replaced by that
    /// error's size, sign kept.
    pub fn of(mut a: Banded) -> Ldl {
        let floor = 4.0 * f64::EPSILON * a.size().max(1e-280);
        if a.tail.is_some() {
            let tail = Some(TailLdl::of(&a, floor));
            return Ldl { a, tail };
        }
        match (a.width, a.border) {
            (1, 0) => eliminate_open::<1, 2>(&mut a, floor),
            (3, 0) => eliminate_open::<3, 4>(&mut a, floor),
            (5, 0) => eliminate_open::<5, 6>(&mut a, floor),
            _ => eliminate(&mut a, floor),
        }
        Ldl { a, tail: None }
    }

    /// The memory, to be filled anew.
    pub fn into_memory(self) -> Banded {
        self.a
    }

    /// D, or the eigenvalues of its blocks.
    fn pivots(&self) -> impl Iterator<Item = f64> + '_ {
        let (s, b) = (self.a.width + 1, self.a.border);
        let inner = if self.tail.is_some() { 0 } else { self.a.inner };
        let band = (0..inner).map(move |j| self.a.band[j * s]);
        let tail = self.tail.iter().flat_map(|t| t.pivots().iter().copied());
        band.chain((0..b).map(move |r| self.a.corner[r * b + r])).chain(tail)
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.a.order()
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        self.pivots().filter(|d| *d < 0.0).count()
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        slab::sum(&self.pivots().map(|d| libm::log(d.abs())).collect::<Vec<f64>>())
    }

    /// x = A⁻¹ a and y = A⁻¹ b, in one pass over the factors; `room` is room to work in.
    pub fn solve_two(&self, a: &[f64], b: &[f64], room: &mut Vec<f64>, x: &mut Vec<f64>, y: &mut Vec<f64>) {
        room.resize(2 * a.len(), 0.0);
        for ((pair, a), b) in room.chunks_exact_mut(2).zip(a).zip(b) {
            (pair[0], pair[1]) = (*a, *b);
        }
        self.solve(room, 2);
        x.resize(a.len(), 0.0);
        y.resize(a.len(), 0.0);
        for ((pair, x), y) in room.chunks_exact(2).zip(x).zip(y) {
            (*x, *y) = (pair[0], pair[1]);
        }
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        if let Some(tail) = &self.tail {
            return solve_by_column(x, columns, |column| tail.solve(column));
        }
        match (self.a.width, self.a.border, columns) {
            (3, 0, 1) => substitute_open::<3, 4, 1>(&self.a, x),
            (3, 0, 2) => substitute_open::<3, 4, 2>(&self.a, x),
            (3, 0, 3) => substitute_open::<3, 4, 3>(&self.a, x),
            (5, 0, 1) => substitute_open::<5, 6, 1>(&self.a, x),
            (5, 0, 2) => substitute_open::<5, 6, 2>(&self.a, x),
            _ => substitute(&self.a, columns, x),
        }
    }
}

/// Elimination of an open chain of half-bandwidth W; S = W + 1 columns are on their way through the registers.
fn eliminate_open<const W: usize, const S: usize>(m: &mut Banded, floor: f64) {
    let mut window = [[0.0; S]; S];
    for (k, column) in m.band.chunks_exact(S).take(W).enumerate() {
        window[k].copy_from_slice(column);
    }
    for j in 0..m.inner {
        match m.band.get((j + W) * S..(j + W + 1) * S) {
            Some(column) => window[W].copy_from_slice(column),
            None => window[W] = [0.0; S],
        }
        let c = window[0];
        let d = guarded(c[0], floor);
        let inverse = 1.0 / d;
        for k in 1..S {
            for q in k..S {
                window[k][q - k] -= c[k] * c[q] * inverse;
            }
        }
        let column = &mut m.band[j * S..(j + 1) * S];
        column[0] = d;
        for k in 1..S {
            column[k] = c[k] * inverse;
        }
        for k in 1..S {
            window[k - 1] = window[k];
        }
    }
}

/// Right-looking elimination in place, of any shape.
fn eliminate(m: &mut Banded, floor: f64) {
    let (w, b) = (m.width, m.border);
    let stride = w + 1;
    for j in 0..m.inner {
        let (head, tail) = m.band.split_at_mut((j + 1) * stride);
        let column = &mut head[j * stride..];
        let d = guarded(column[0], floor);
        column[0] = d;
        let inverse = 1.0 / d;
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

/// Solves for interleaved right-hand sides one after the other.
fn solve_by_column(x: &mut [f64], columns: usize, solve: impl Fn(&mut [f64])) {
    if columns == 1 {
        return solve(x);
    }
    for c in 0..columns {
        let mut column: Vec<f64> = x[c..].iter().step_by(columns).copied().collect();
        solve(&mut column);
        for (x, y) in x[c..].iter_mut().step_by(columns).zip(column) {
            *x = y;
        }
    }
}

#[inline(always)]
fn guarded(d: f64, floor: f64) -> f64 {
    if d.abs() < floor { if d < 0.0 { -floor } else { floor } } else { d }
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
        let inverse = 1.0 / l[0];
        for q in 0..c {
            xj[q] *= inverse;
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

/// Substitution in an open chain of half-bandwidth W for C interleaved right-hand sides, the next W rows in registers.
fn substitute_open<const W: usize, const S: usize, const C: usize>(m: &Banded, x: &mut [f64]) {
    let n = m.inner;
    let row = |x: &[f64], j: usize| -> [f64; C] {
        x.get(j * C..(j + 1) * C).map_or([0.0; C], |r| r.try_into().unwrap_or([0.0; C]))
    };
    let mut window = [[0.0; C]; S];
    for k in 0..W {
        window[k] = row(x, k);
    }
    for (j, l) in m.band.chunks_exact(S).take(n).enumerate() {
        window[W] = row(x, j + W);
        let here = window[0];
        for k in 1..S {
            for q in 0..C {
                window[k - 1][q] = window[k][q] - l[k] * here[q];
            }
        }
        x[j * C..(j + 1) * C].copy_from_slice(&here);
    }
    let mut window = [[0.0; C]; S];
    for (j, l) in m.band.chunks_exact(S).take(n).enumerate().rev() {
        let inverse = 1.0 / l[0];
        let mut here = row(x, j);
        for value in &mut here {
            *value *= inverse;
        }
        for k in (1..S).rev() {
            for q in 0..C {
                here[q] -= l[k] * window[k][q];
            }
        }
        for k in (1..S).rev() {
            window[k] = window[k - 1];
        }
        window[1] = here;
        x[j * C..(j + 1) * C].copy_from_slice(&here);
    }
}
