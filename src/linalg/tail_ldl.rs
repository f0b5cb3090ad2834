//! A = L D Lᵀ of a band with a [`super::Tail`], in O(N).
//!
//! Everything that site i receives from the sites before it passes through a state of a fixed number of entries: a register
//! of the last R sites (the band) and the decaying sums (the tail).
//!
//! ```text
//! A_ij = C_i Φ_{i−1} … Φ_{j+1} G_j  (i > j)                 L_ij = C_i Φ_{i−1} … Φ_{j+1} W_j,  W of G's shape
//! D_i = A_ii − C_i P_i C_iᵀ,   W_i = (G_i − Φ_i P_i C_iᵀ) D_i⁻¹,   P_{i+1} = Φ_i P_i Φ_iᵀ + W_i D_i W_iᵀ,   P_0 = 0
//! ```
//! Φ is diagonal: q for the sums, 1 for the registers, 0 for the register that is used again. The signs of the eigenvalues of
//! the 2 × 2 pivots D_i are those of A's (Sylvester). The recursion is that of Chandrasekaran et al., SIAM J. Matrix Anal.
//! Appl. 27, 341 (2005), doi:10.1137/S0895479802405884, for sequentially semiseparable matrices.

use super::pivot::guarded;
use super::{TailedBand, eigen_symmetric};
use multiversion::multiversion;

/// Rows of P are padded to a multiple of this.
const LANES: usize = 4;

/// The factors of a band with a tail.
#[derive(Clone, Debug, Default)]
pub struct TailLdl {
    /// Entries of the state, padded.
    size: usize,
    /// Registers of two entries.
    slots: usize,
    /// Where the decaying sums of the three axes begin, and where they end.
    first: [usize; 4],
    /// W_i, two runs of `size` a site.
    w: Vec<f64>,
    /// C_i, two runs of `size` a site.
    c: Vec<f64>,
    /// q of every entry of the state: 1 in the registers.
    phi: Vec<f64>,
    /// D_i⁻¹: (0,0), (1,0), (1,1).
    inverse: Vec<[f64; 3]>,
    /// Eigenvalues of all pivots.
    pivots: Vec<f64>,
}

impl TailLdl {
    /// The factors of `a`. A pivot smaller than `floor` is replaced by that size, sign kept.
    pub fn of(a: &TailedBand, floor: f64) -> TailLdl {
        let TailedBand { band, tail } = a;
        let (sites, slots) = (tail.rows.len(), band.width / 2);
        let mut phi = vec![1.0; 2 * slots];
        let mut first = [2 * slots; 4];
        for (c, q) in tail.decays.q.iter().enumerate() {
            phi.extend(q);
            first[c + 1] = phi.len();
        }
        let size = phi.len().next_multiple_of(LANES);
        phi.resize(size, 0.0);
        let mut f = TailLdl {
            size,
            slots,
            first,
            w: vec![0.0; 2 * sites * size],
            c: vec![0.0; 2 * sites * size],
            phi,
            inverse: Vec::with_capacity(sites),
            pivots: Vec::with_capacity(2 * sites),
        };
        for i in 0..sites {
            f.set_outputs(a, i);
        }
        let mut p = vec![0.0; size * size];
        let mut pc = vec![0.0; 2 * size];
        let mut v = vec![0.0; 2 * size];
        let mut g = vec![0.0; 2 * size];
        let mut phi = f.phi.clone();
        for i in 0..sites {
            let c = &f.c[2 * i * size..2 * (i + 1) * size];
            let (c0, c1) = c.split_at(size);
            let (p0, p1) = pc.split_at(size);
            let cross = 0.5 * (plain_dot(c0, p1) + plain_dot(c1, p0));
            let d = [
                band.get(2 * i, 2 * i) - plain_dot(c0, p0),
                band.get(2 * i + 1, 2 * i) - cross,
                band.get(2 * i + 1, 2 * i + 1) - plain_dot(c1, p1),
            ];
            let (inverse, eigen) = guarded_inverse(d, floor);
            f.inverse.push(inverse);
            f.pivots.extend(eigen);
            f.enter(tail.rows[i], i, &mut g, &mut phi);
            for a in 0..2 {
                for s in 0..size {
                    v[a * size + s] = g[a * size + s] - phi[s] * pc[a * size + s];
                }
            }
            let w = &mut f.w[2 * i * size..2 * (i + 1) * size];
            for s in 0..size {
                w[s] = v[s] * inverse[0] + v[size + s] * inverse[1];
                w[size + s] = v[s] * inverse[1] + v[size + s] * inverse[2];
            }
            if i + 1 < sites {
                let next = &f.c[2 * (i + 1) * size..2 * (i + 2) * size];
                advance(&mut p, &phi, &v, w, next, &mut pc);
            }
        }
        f
    }

    /// C_i: the band's entries to the last sites, and the tail's weights.
    fn set_outputs(&mut self, TailedBand { band, tail }: &TailedBand, i: usize) {
        let (size, slots, first) = (self.size, self.slots, self.first);
        let c = &mut self.c[2 * i * size..2 * (i + 1) * size];
        for row in 0..2 {
            let c = &mut c[row * size..(row + 1) * size];
            for n in 1..=slots.min(i) {
                let slot = (i - n) % slots;
                for column in 0..2 {
                    c[2 * slot + column] = band.get(2 * i + row, 2 * (i - n) + column);
                }
            }
            for (axis, weights) in tail.decays.weights.iter().enumerate() {
                for (c, w) in c[first[axis]..first[axis + 1]].iter_mut().zip(weights) {
                    *c = tail.rows[i][row][axis] * w;
                }
            }
        }
    }

    /// G_i and Φ_i: what site i leaves in the state, and what stays there of the others.
    fn enter(&self, rows: [[f64; 3]; 2], i: usize, g: &mut [f64], phi: &mut [f64]) {
        let (size, slots) = (self.size, self.slots);
        g.fill(0.0);
        phi.copy_from_slice(&self.phi);
        for (row, r) in rows.iter().enumerate() {
            let g = &mut g[row * size..(row + 1) * size];
            if slots > 0 {
                let slot = i % slots;
                (phi[2 * slot], phi[2 * slot + 1]) = (0.0, 0.0);
                g[2 * slot + row] = 1.0;
            }
            for (axis, value) in r.iter().enumerate() {
                for s in self.first[axis]..self.first[axis + 1] {
                    g[s] = self.phi[s] * value;
                }
            }
        }
    }

    /// The eigenvalues of all pivots.
    pub fn pivots(&self) -> &[f64] {
        &self.pivots
    }

    /// Solves A x = b in place.
    pub fn solve(&self, x: &mut [f64]) {
        let (size, slots) = (self.size, self.slots);
        let mut s = vec![0.0; size];
        for (i, pair) in x.chunks_exact_mut(2).enumerate() {
            let (c0, c1) = self.c[2 * i * size..2 * (i + 1) * size].split_at(size);
            pair[0] -= plain_dot(c0, &s);
            pair[1] -= plain_dot(c1, &s);
            self.forget(&mut s, i, slots);
            let (w0, w1) = self.w[2 * i * size..2 * (i + 1) * size].split_at(size);
            accumulate(&mut s, w0, pair[0], w1, pair[1]);
        }
        for (pair, d) in x.chunks_exact_mut(2).zip(&self.inverse) {
            (pair[0], pair[1]) = (d[0] * pair[0] + d[1] * pair[1], d[1] * pair[0] + d[2] * pair[1]);
        }
        s.fill(0.0);
        for (i, pair) in x.chunks_exact_mut(2).enumerate().rev() {
            let (w0, w1) = self.w[2 * i * size..2 * (i + 1) * size].split_at(size);
            pair[0] -= plain_dot(w0, &s);
            pair[1] -= plain_dot(w1, &s);
            self.forget(&mut s, i, slots);
            let (c0, c1) = self.c[2 * i * size..2 * (i + 1) * size].split_at(size);
            accumulate(&mut s, c0, pair[0], c1, pair[1]);
        }
    }

    /// s ← Φ_i s.
    fn forget(&self, s: &mut [f64], i: usize, slots: usize) {
        for (s, phi) in s.iter_mut().zip(&self.phi) {
            *s *= phi;
        }
        if slots > 0 {
            let slot = i % slots;
            (s[2 * slot], s[2 * slot + 1]) = (0.0, 0.0);
        }
    }
}

#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn plain_dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    for (a, b) in a.chunks_exact(LANES).zip(b.chunks_exact(LANES)) {
        for l in 0..LANES {
            lanes[l] += a[l] * b[l];
        }
    }
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3])
}

/// s ← s + a u + b v.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn accumulate(s: &mut [f64], u: &[f64], a: f64, v: &[f64], b: f64) {
    let n = s.len();
    let (u, v) = (&u[..n], &v[..n]);
    for k in 0..n {
        s[k] += a * u[k] + b * v[k];
    }
}

/// P ← ΦPΦ + V Wᵀ, and PCᵀ with the next site's C in the same pass; rows two by two, which share what they read.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn advance(p: &mut [f64], phi: &[f64], v: &[f64], w: &[f64], c: &[f64], pc: &mut [f64]) {
    let n = phi.len();
    let (w0, w1) = w.split_at(n);
    let (c0, c1) = c.split_at(n);
    let [phis, w0, w1, c0, c1] = [phi, w0, w1, c0, c1].map(|a| a.as_chunks::<LANES>().0);
    let columns = phis.len();
    assert!([w0, w1, c0, c1].iter().all(|a| a.len() == columns));
    for (pair, rows) in p.chunks_exact_mut(2 * n).enumerate() {
        let (upper, lower) = rows.split_at_mut(n);
        let [upper, lower] = [upper, lower].map(|row| row.as_chunks_mut::<LANES>().0);
        assert!(upper.len() == columns && lower.len() == columns);
        let of = |row: usize| [phi[row], v[row], v[n + row]];
        let ([d, a, b], [e, f, g]) = (of(2 * pair), of(2 * pair + 1));
        let mut sums = [[0.0; LANES]; 4];
        for k in 0..columns {
            for l in 0..LANES {
                let (phi, w0, w1) = (phis[k][l], w0[k][l], w1[k][l]);
                let x = d * phi * upper[k][l] + (a * w0 + b * w1);
                let y = e * phi * lower[k][l] + (f * w0 + g * w1);
                (upper[k][l], lower[k][l]) = (x, y);
                sums[0][l] += x * c0[k][l];
                sums[1][l] += x * c1[k][l];
                sums[2][l] += y * c0[k][l];
                sums[3][l] += y * c1[k][l];
            }
        }
        let [first, second, third, fourth] = sums.map(|s| (s[0] + s[2]) + (s[1] + s[3]));
        (pc[2 * pair], pc[n + 2 * pair]) = (first, second);
        (pc[2 * pair + 1], pc[n + 2 * pair + 1]) = (third, fourth);
    }
}

/// The inverse and the eigenvalues of [d₀ d₁; d₁ d₂], eigenvalues of less than `floor` replaced by ±floor.
fn guarded_inverse(d: [f64; 3], floor: f64) -> ([f64; 3], [f64; 2]) {
    let (values, vectors) = eigen_symmetric(&[d[0], d[1], d[1], d[2]], 2);
    let eigen = [guarded(values[0], floor), guarded(values[1], floor)];
    if eigen == [values[0], values[1]] {
        let determinant = d[0] * d[2] - d[1] * d[1];
        let product = eigen[0] * eigen[1];
        // the product of the eigenvalues has the right sign where the determinant cancels
        let det = if determinant * product > 0.0 { determinant } else { product };
        return ([d[2] / det, -d[1] / det, d[0] / det], eigen);
    }
    let mut inverse = [0.0; 3];
    for (e, v) in eigen.iter().zip(&vectors) {
        inverse[0] += v[0] * v[0] / e;
        inverse[1] += v[0] * v[1] / e;
        inverse[2] += v[1] * v[1] / e;
    }
    (inverse, eigen)
}

#[cfg(test)]
mod tests {
    use crate::linalg::{Banded, Decays, Matrix, Tail, eigenvalues_symmetric};
    use rand::{RngExt, SeedableRng};
    use std::sync::Arc;

    #[test]
    fn a_band_with_a_tail_agrees_with_dense_arithmetic() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        for (sites, reach, terms) in [(1, 0, 1), (2, 1, 1), (9, 1, 2), (12, 3, 4), (20, 2, 0), (15, 0, 5), (30, 5, 3)] {
            let mut a = Matrix::from(Banded::zeros(2 * sites, 2 * reach + 1));
            for i in 0..2 * sites {
                for j in 0..=i {
                    if i / 2 - j / 2 <= reach {
                        a.add(i, j, r.random_range(-1.0..1.0));
                    }
                }
            }
            let q = [0, 1, 2].map(|c| (0..terms + c).map(|_| r.random_range(0.0..0.99)).collect());
            let weights = [0, 1, 2].map(|c| (0..terms + c).map(|_| r.random_range(-1.0..1.0)).collect());
            let rows = (0..sites).map(|_| [(); 2].map(|()| [(); 3].map(|()| r.random_range(-1.0..1.0)))).collect();
            a.set_tail(Tail { decays: Arc::new(Decays { q, weights }), rows, norm: 0.0 });
            let n = 2 * sites;
            let full: Vec<f64> = (0..n * n).map(|k| a.get(k / n, k % n)).collect();
            let x: Vec<f64> = (0..2 * n).map(|_| r.random_range(-1.0..1.0)).collect();
            let mut b = vec![0.0; 2 * n];
            for c in 0..2 {
                let column: Vec<f64> = x[c..].iter().step_by(2).copied().collect();
                let mut y = vec![0.0; n];
                a.multiply(&column, &mut y);
                for i in 0..n {
                    let direct: f64 = (0..n).map(|j| full[i * n + j] * column[j]).sum();
                    assert!((direct - y[i]).abs() < 1e-13, "{sites}: {direct} {}", y[i]);
                    b[2 * i + c] = y[i];
                }
            }
            let eigen = eigenvalues_symmetric(&full, n);
            let smallest = eigen.iter().fold(f64::MAX, |s, l| s.min(l.abs()));
            let factors = a.factor();
            assert_eq!(factors.negatives(), eigen.iter().filter(|l| **l < 0.0).count(), "{sites} {reach} {terms}");
            let log: f64 = eigen.iter().map(|l| l.abs().ln()).sum();
            assert!((factors.log_abs_determinant() - log).abs() < 1e-8 * (1.0 + log.abs()));
            factors.solve(&mut b, 2);
            for (p, q) in b.iter().zip(&x) {
                assert!((p - q).abs() < 1e-10 / smallest, "{p} {q} {smallest}");
            }
        }
    }
}
