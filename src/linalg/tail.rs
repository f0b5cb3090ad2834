//! A long-ranged part of a chain's matrix: for sites i > j, two unknowns each,
//!
//! ```text
//! A_ij = Σ_c r_ic [Σ_k w_ck q_ck^(i−j)] r_jcᵀ          r_i: 2 × 3, c = 1, 2, 3
//! ```
//! plus its transpose; nothing on the diagonal. Sums along the chain with decaying memory, s ← q (s + r_j x_j), make products
//! with it O(N), and its factorisation too (see [`super::TailLdl`]).

use super::Banded;
use std::sync::Arc;

/// Decays and weights, the same for all sites.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Decays {
    /// q_ck.
    pub q: [Vec<f64>; 3],
    /// w_ck.
    pub weights: [Vec<f64>; 3],
}

/// A sum of exponentials between all pairs of sites.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tail {
    /// Decays and weights.
    pub decays: Arc<Decays>,
    /// r of every site: two rows of three.
    pub rows: Vec<[[f64; 3]; 2]>,
    /// An estimate of the largest column sum of absolute values.
    pub norm: f64,
}

/// A band of two unknowns a site, and a tail besides.
#[derive(Clone, Debug, Default)]
pub struct TailedBand {
    /// The band.
    pub band: Banded,
    /// What reaches further.
    pub tail: Tail,
}

impl TailedBand {
    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.band.get(i, j) + self.tail.get(i, j)
    }
}

impl Tail {
    /// y ← y + A x.
    pub fn add_product(&self, x: &[f64], y: &mut [f64]) {
        let memory = || self.decays.q.each_ref().map(|q| vec![0.0; q.len()]);
        let mut s = memory();
        for i in 0..self.rows.len() {
            self.step(&mut s, i, x, y);
        }
        let mut s = memory();
        for i in (0..self.rows.len()).rev() {
            self.step(&mut s, i, x, y);
        }
    }

    /// Adds to site i what the sites passed so far do to it, and takes it into the memory.
    fn step(&self, s: &mut [Vec<f64>; 3], i: usize, x: &[f64], y: &mut [f64]) {
        let r = &self.rows[i];
        for c in 0..3 {
            let own = r[0][c] * x[2 * i] + r[1][c] * x[2 * i + 1];
            let mut field = 0.0;
            for ((s, q), w) in s[c].iter_mut().zip(&self.decays.q[c]).zip(&self.decays.weights[c]) {
                field += w * *s;
                *s = q * (*s + own);
            }
            y[2 * i] += r[0][c] * field;
            y[2 * i + 1] += r[1][c] * field;
        }
    }

    /// Entry (i, j).
    pub fn get(&self, i: usize, j: usize) -> f64 {
        let apart = (i / 2).abs_diff(j / 2);
        if apart == 0 {
            return 0.0;
        }
        let Decays { q, weights } = &*self.decays;
        let kernel =
            |c: usize| -> f64 { q[c].iter().zip(&weights[c]).map(|(q, w)| w * libm::pow(*q, apart as f64)).sum() };
        let (p, r) = (self.rows[i / 2][i % 2], self.rows[j / 2][j % 2]);
        (0..3).map(|c| p[c] * kernel(c) * r[c]).sum()
    }
}
