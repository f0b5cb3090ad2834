//! Symmetric matrices with a band and, for rings, a rim.
//!
//! ```text
//!   ⎡ T   Rᵀ ⎤   T: n × n, half-bandwidth w          (the open chain)
//!   ⎣ R   C  ⎦   R: b × n dense, C: b × b             (the sites that close a ring)
//! ```
//! The factorisation A = L D Lᵀ without pivoting costs O(n (w + b)²) and gives solutions, the inertia (Sylvester: the
//! signs of D are those of the eigenvalues) and ln|det|.

/// A symmetric matrix of `inner` banded unknowns followed by `border` unknowns coupled to all.
#[derive(Clone, Debug)]
pub struct Banded {
    inner: usize,
    width: usize,
    border: usize,
    /// Column by column, diagonal first: band[j (w+1) + k] = A[j+k][j].
    band: Vec<f64>,
    /// rim[j b + r] = A[n+r][j].
    rim: Vec<f64>,
    /// corner[r b + s] = A[n+r][n+s], lower half used.
    corner: Vec<f64>,
}

impl Banded {
    /// The zero matrix.
    pub fn zeros(inner: usize, width: usize, border: usize) -> Banded {
        Banded {
            inner,
            width,
            border,
            band: vec![0.0; (inner + width) * (width + 1)],
            rim: vec![0.0; inner * border],
            corner: vec![0.0; border * border],
        }
    }

    /// Number of unknowns.
    pub fn order(&self) -> usize {
        self.inner + self.border
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        self.band.fill(0.0);
        self.rim.fill(0.0);
        self.corner.fill(0.0);
    }

    /// Adds `v` to the entry (i, j) and, off the diagonal, to its mirror image. The entry must lie in the band or the rim.
    #[inline]
    pub fn add(&mut self, i: usize, j: usize, v: f64) {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        if i < self.inner {
            debug_assert!(i - j <= self.width);
            self.band[j * (self.width + 1) + i - j] += v;
        } else if j < self.inner {
            self.rim[j * self.border + i - self.inner] += v;
        } else {
            self.corner[(i - self.inner) * self.border + j - self.inner] += v;
        }
    }

    /// Entry (i, j); zero outside the band.
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let (i, j) = if i >= j { (i, j) } else { (j, i) };
        if i < self.inner {
            if i - j <= self.width { self.band[j * (self.width + 1) + i - j] } else { 0.0 }
        } else if j < self.inner {
            self.rim[j * self.border + i - self.inner]
        } else {
            self.corner[(i - self.inner) * self.border + j - self.inner]
        }
    }

    /// A ← A + s·1.
    pub fn shift(&mut self, s: f64) {
        for j in 0..self.inner {
            self.band[j * (self.width + 1)] += s;
        }
        for r in 0..self.border {
            self.corner[r * self.border + r] += s;
        }
    }

    /// y ← A x.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let (n, w, b) = (self.inner, self.width, self.border);
        y.fill(0.0);
        for j in 0..n {
            let column = &self.band[j * (w + 1)..(j + 1) * (w + 1)];
            let reach = w.min(n - 1 - j);
            let mut sum = column[0] * x[j];
            for k in 1..=reach {
                sum += column[k] * x[j + k];
                y[j + k] += column[k] * x[j];
            }
            for r in 0..b {
                let a = self.rim[j * b + r];
                sum += a * x[n + r];
                y[n + r] += a * x[j];
            }
            y[j] += sum;
        }
        for r in 0..b {
            for s in 0..=r {
                let a = self.corner[r * b + s];
                y[n + r] += a * x[n + s];
                if s != r {
                    y[n + s] += a * x[n + r];
                }
            }
        }
    }

    /// The largest column sum of absolute values, ‖A‖₁.
    pub fn norm1(&self) -> f64 {
        let (n, w, b) = (self.inner, self.width, self.border);
        let mut sums = vec![0.0; n + b];
        for j in 0..n {
            for k in 0..=w.min(n - 1 - j) {
                let a = self.band[j * (w + 1) + k].abs();
                sums[j] += a;
                if k > 0 {
                    sums[j + k] += a;
                }
            }
            for r in 0..b {
                let a = self.rim[j * b + r].abs();
                sums[j] += a;
                sums[n + r] += a;
            }
        }
        for r in 0..b {
            for s in 0..=r {
                let a = self.corner[r * b + s].abs();
                sums[n + r] += a;
                if s != r {
                    sums[n + s] += a;
                }
            }
        }
        sums.into_iter().fold(0.0, f64::max)
    }

    /// A = L D Lᵀ. A pivot smaller than the rounding error of the matrix is replaced by that error's size, sign kept.
    pub fn factor(mut self) -> Ldl {
        let floor = 4.0 * f64::EPSILON * self.norm1().max(1e-280);
        match (self.width, self.border) {
            (1, 0) => eliminate(&mut self, 1, 0, floor),
            (3, 0) => eliminate(&mut self, 3, 0, floor),
            (3, 2) => eliminate(&mut self, 3, 2, floor),
            (5, 0) => eliminate(&mut self, 5, 0, floor),
            (w, b) => eliminate(&mut self, w, b, floor),
        }
        Ldl { a: self }
    }
}

/// Right-looking elimination in place; `w` and `b` are passed so that constants propagate.
#[inline(always)]
fn eliminate(m: &mut Banded, w: usize, b: usize, floor: f64) {
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
    for j in 0..b {
        let d = guarded(m.corner[j * b + j], floor);
        m.corner[j * b + j] = d;
        for r in j + 1..b {
            let l = m.corner[r * b + j] / d;
            for s in j + 1..=r {
                m.corner[r * b + s] -= l * m.corner[s * b + j];
            }
        }
        for r in j + 1..b {
            m.corner[r * b + j] /= d;
        }
    }
}

#[inline(always)]
fn guarded(d: f64, floor: f64) -> f64 {
    if d.abs() < floor { if d < 0.0 { -floor } else { floor } } else { d }
}

/// The factors L and D of a [`Banded`] matrix.
#[derive(Clone, Debug)]
pub struct Ldl {
    a: Banded,
}

impl Ldl {
    fn pivots(&self) -> impl Iterator<Item = f64> + '_ {
        let (s, b) = (self.a.width + 1, self.a.border);
        let band = (0..self.a.inner).map(move |j| self.a.band[j * s]);
        band.chain((0..b).map(move |r| self.a.corner[r * b + r]))
    }

    /// Number of negative eigenvalues of A.
    pub fn negatives(&self) -> usize {
        self.pivots().filter(|d| *d < 0.0).count()
    }

    /// ln|det A|.
    pub fn log_abs_determinant(&self) -> f64 {
        self.pivots().map(|d| libm::log(d.abs())).sum()
    }

    /// Solves A X = B in place for `columns` right-hand sides, interleaved: x[j columns + c].
    pub fn solve(&self, x: &mut [f64], columns: usize) {
        let (w, b) = (self.a.width, self.a.border);
        match (w, b, columns) {
            (3, 0, 1) => substitute(&self.a, 3, 0, 1, x),
            (3, 0, 2) => substitute(&self.a, 3, 0, 2, x),
            (3, 0, 3) => substitute(&self.a, 3, 0, 3, x),
            (5, 0, 1) => substitute(&self.a, 5, 0, 1, x),
            (5, 0, 2) => substitute(&self.a, 5, 0, 2, x),
            (3, 2, 1) => substitute(&self.a, 3, 2, 1, x),
            _ => substitute(&self.a, w, b, columns, x),
        }
    }
}

#[inline(always)]
fn substitute(m: &Banded, w: usize, b: usize, c: usize, x: &mut [f64]) {
    let n = m.inner;
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
    for r in (0..b).rev() {
        for s in r + 1..b {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::{eigenvalues_symmetric, solve_dense};
    use rand::{Rng, RngExt, SeedableRng};

    fn random(r: &mut impl Rng, inner: usize, width: usize, border: usize) -> Banded {
        let mut a = Banded::zeros(inner, width, border);
        for j in 0..inner + border {
            for i in j..inner + border {
                if i >= inner || i - j <= width {
                    a.add(i, j, r.random_range(-1.0..1.0));
                }
            }
        }
        a
    }

    fn dense(a: &Banded) -> Vec<f64> {
        let n = a.order();
        (0..n * n).map(|k| a.get(k / n, k % n)).collect()
    }

    #[test]
    fn solution_inertia_determinant_and_product_agree_with_dense_arithmetic() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(1);
        for (inner, width, border) in
            [(1, 1, 0), (2, 1, 0), (9, 3, 0), (12, 5, 0), (8, 3, 2), (10, 5, 4), (6, 0, 0), (7, 7, 1)]
        {
            for columns in 1..4 {
                let a = random(&mut r, inner, width, border);
                let n = a.order();
                let full = dense(&a);
                let x: Vec<f64> = (0..n * columns).map(|_| r.random_range(-1.0..1.0)).collect();
                let mut b = vec![0.0; n * columns];
                for c in 0..columns {
                    let xc: Vec<f64> = (0..n).map(|j| x[j * columns + c]).collect();
                    let mut y = vec![0.0; n];
                    a.multiply(&xc, &mut y);
                    for i in 0..n {
                        let direct: f64 = (0..n).map(|j| full[i * n + j] * xc[j]).sum();
                        assert!((direct - y[i]).abs() < 1e-14);
                        b[i * columns + c] = y[i];
                    }
                }
                let eigen = eigenvalues_symmetric(&full, n);
                let f = a.clone().factor();
                assert_eq!(f.negatives(), eigen.iter().filter(|l| **l < 0.0).count());
                let log: f64 = eigen.iter().map(|l| l.abs().ln()).sum();
                assert!((f.log_abs_determinant() - log).abs() < 1e-8 * (1.0 + log.abs()));
                f.solve(&mut b, columns);
                let smallest = eigen.iter().fold(f64::MAX, |s, l| s.min(l.abs()));
                for (p, q) in b.iter().zip(&x) {
                    assert!((p - q).abs() < 1e-11 / smallest, "{p} {q} {smallest}");
                }
                let single: Vec<f64> = (0..n).map(|j| full[j * n]).collect();
                let unit = solve_dense(&full, &single, n).expect("regular");
                assert!((unit[0] - 1.0).abs() < 1e-10 / smallest);
            }
        }
    }

    #[test]
    fn norm1_is_the_largest_column_sum() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(2);
        let a = random(&mut r, 7, 3, 2);
        let n = a.order();
        let full = dense(&a);
        let direct = (0..n).map(|j| (0..n).map(|i| full[i * n + j].abs()).sum::<f64>()).fold(0.0, f64::max);
        assert!((a.norm1() - direct).abs() < 1e-14);
    }

    #[test]
    fn a_singular_matrix_gives_finite_numbers() {
        let f = Banded::zeros(4, 1, 0).factor();
        let mut x = vec![1.0; 4];
        f.solve(&mut x, 1);
        assert!(x.iter().all(|v| !v.is_nan()));
    }
}
