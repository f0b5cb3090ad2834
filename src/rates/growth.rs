//! Langer's λ₊: how fast a deviation from the saddle grows under the linearised Landau–Lifshitz–Gilbert equation.
//!
//! ```text
//! −Γ (α + R) H v /(1 + α²) = λ v   ⇔   M(λ) v = 0,   M(λ) = H + λ B,   B = (α − R) Γ⁻¹
//! ```
//! A saddle with one negative mode has one eigenvalue with a positive real part, and it is real: det M(σ) changes its sign at
//! σ = λ₊ alone (σ > 0). Inverse iteration x ← M(σ)⁻¹ B x gives λ ≈ σ − 1/μ, μ the growth of x, and the next shift; the sign of the
//! determinant, free with each factorisation, keeps it in a bracket. In the lattice's order of elimination the matrix is a band.

use super::Unstable;
use crate::energy::Hamiltonian;
use crate::linalg::{General, slab};
use crate::stationary::State;

/// Most factorisations; halving alone would need about fifty.
const ROUNDS: usize = 200;

/// The linearised equation at a saddle, in units of the largest Γ.
struct Linearised<'a> {
    h: &'a Hamiltonian,
    saddle: &'a State,
    /// Where each site stands in the band.
    places: Vec<usize>,
    /// 1/Γ of each site, in units of 1/max Γ.
    slowness: Vec<f64>,
    damping: f64,
}

/// λ₊ (rad/s) at a saddle of index one; `gyration` is Γ (rad/s per meV), a number a site. Nothing if it cannot be told from zero.
pub fn growth_rate(
    h: &Hamiltonian,
    saddle: &State,
    unstable: &Unstable,
    gyration: &[f64],
    damping: f64,
) -> Option<f64> {
    let scale = gyration.iter().fold(0.0f64, |s, g| s.max(*g));
    let slowness = gyration.iter().map(|g| scale / g).collect();
    let lin = Linearised { h, saddle, places: h.lattice().places(), slowness, damping };
    lin.eigenvalue(&unstable.mode, unstable.eigenvalue_mev).map(|rate| scale * rate)
}

impl Linearised<'_> {
    fn eigenvalue(&self, mode: &[f64], lambda1: f64) -> Option<f64> {
        let (mut sigma, mut x) = self.guess(mode, lambda1)?;
        let hessian = self.hessian();
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut before = f64::INFINITY;
        // the descending curvature is known to the rounding error of the Hessian, and λ₊ goes with it
        let rounding = (4.0 * f64::EPSILON * self.saddle.hessian.norm1() / -lambda1).clamp(1e-13, 1e-2);
        for _ in 0..ROUNDS {
            let factors = self.shifted(&hessian, sigma).factor();
            if factors.sign() > 0.0 {
                high = sigma;
            } else {
                low = sigma;
            }
            let mut y = self.weighted(&x);
            factors.solve(&mut y);
            let (growth, size) = (slab::dot(&x, &y), slab::norm(&y));
            if !(size.is_finite() && size > 0.0) {
                return None;
            }
            let next = sigma - 1.0 / growth;
            let (aligned, change) = ((growth.abs() / size - 1.0).abs(), (next - sigma).abs());
            // x was an eigenvector already, and its eigenvalue changes by rounding only
            let settled =
                aligned < 1e-9 && (change <= rounding * sigma || (change <= 1e-6 * sigma && change >= 0.5 * before));
            before = change;
            if settled || high - low <= 4.0 * f64::EPSILON * low {
                return Some(if next > 0.0 && settled { next } else { sigma });
            }
            x = y;
            slab::scale(&mut x, 1.0 / size);
            sigma = self.next_shift(next, low, high);
        }
        None
    }

    /// The estimate where it lies in the bracket; else its middle, by ratio where both ends are positive.
    fn next_shift(&self, estimate: f64, low: f64, high: f64) -> f64 {
        if estimate > low && estimate < high {
            estimate
        } else if high.is_infinite() {
            4.0 * low
        } else if low > 0.0 && high > 2.0 * low {
            (low * high).sqrt()
        } else {
            0.5 * (low + high)
        }
    }

    /// λ₊ in the plane of e₁ and R e₁, exact for one spin, and a vector to start with.
    fn guess(&self, mode: &[f64], lambda1: f64) -> Option<(f64, Vec<f64>)> {
        let turned = rotated(mode);
        let mut image = vec![0.0; mode.len()];
        self.saddle.hessian.multiply(&turned, &mut image);
        let across = slab::dot(&turned, &image).max(0.0);
        let slow: f64 = mode.iter().enumerate().map(|(k, e)| e * e * self.slowness[k / 2]).sum();
        let a = slow * slow * (1.0 + self.damping * self.damping);
        let b = self.damping * slow * (lambda1 + across);
        let c = lambda1 * across;
        let root = (b * b - 4.0 * a * c).sqrt();
        let sigma = if b > 0.0 { -2.0 * c / (b + root) } else { (root - b) / (2.0 * a) };
        let mut x = mode.to_vec();
        slab::add_scaled(&mut x, 0.1, &turned);
        let size = slab::norm(&x);
        slab::scale(&mut x, 1.0 / size);
        (sigma > 0.0 && sigma.is_finite()).then_some((sigma, self.placed(&x)))
    }

    fn sites(&self) -> usize {
        self.h.sites()
    }

    /// All pairs of sites that are coupled, each once.
    fn pairs(&self) -> Box<dyn Iterator<Item = [usize; 2]> + '_> {
        match self.h.coupling().pairs() {
            Some(_) => Box::new((0..self.sites()).flat_map(|i| (0..i).map(move |j| [i, j]))),
            None => Box::new(self.h.constant_blocks().bond.iter().flat_map(|bonds| bonds.family.bonds())),
        }
    }

    /// A vector by site, in the order of the band.
    fn placed(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for i in 0..self.sites() {
            let p = self.places[i];
            (y[2 * p], y[2 * p + 1]) = (x[2 * i], x[2 * i + 1]);
        }
        y
    }

    /// H, in the order of the band.
    fn hessian(&self) -> General {
        let n = self.sites();
        let spread = self.pairs().map(|[i, j]| self.places[i].abs_diff(self.places[j])).max().unwrap_or(0);
        let mut matrix = General::zeros(2 * n, 2 * spread + 1);
        let mut add = |i: usize, j: usize| {
            for (a, b) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let v = self.saddle.hessian.get(2 * i + a, 2 * j + b);
                if v != 0.0 {
                    matrix.add(2 * self.places[i] + a, 2 * self.places[j] + b, v);
                }
            }
        };
        (0..n).for_each(|i| add(i, i));
        self.pairs().for_each(|[i, j]| {
            add(i, j);
            add(j, i);
        });
        matrix
    }

    /// M(σ) from H.
    fn shifted(&self, hessian: &General, sigma: f64) -> General {
        let mut matrix = hessian.clone();
        for i in 0..self.sites() {
            let (p, s) = (2 * self.places[i], sigma * self.slowness[i]);
            matrix.add(p, p, s * self.damping);
            matrix.add(p + 1, p + 1, s * self.damping);
            matrix.add(p, p + 1, s);
            matrix.add(p + 1, p, -s);
        }
        matrix
    }

    /// B x, in the order of the band.
    fn weighted(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for i in 0..self.sites() {
            let (p, s) = (2 * self.places[i], self.slowness[i]);
            y[p] = s * (self.damping * x[p] + x[p + 1]);
            y[p + 1] = s * (self.damping * x[p + 1] - x[p]);
        }
        y
    }
}

/// R v: m × v in tangent coordinates whose basis is right-handed.
fn rotated(v: &[f64]) -> Vec<f64> {
    v.chunks_exact(2).flat_map(|pair| [-pair[1], pair[0]]).collect()
}
