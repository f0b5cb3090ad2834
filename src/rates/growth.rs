//! Langer's λ₊: how fast a deviation from the saddle grows under the linearised Landau–Lifshitz–Gilbert equation.
//!
//! ```text
//! −Γ (α + R) H v /(1 + α²) = λ v   ⇔   M(λ) v = 0,   M(λ) = H + λ B,   B = (α − R) Γ⁻¹
//! ```
//! A saddle with one negative mode has one eigenvalue with a positive real part, and it is real: det M(σ) changes its sign at
//! σ = λ₊ alone (σ > 0). Inverse iteration x ← M(σ)⁻¹ B x gives λ ≈ σ − 1/μ, μ the growth of x, and the next shift; the sign of the
//! determinant, free with each factorisation, keeps it in a bracket. In a row the matrix is a band.
//!
//! Where sites are coupled every way or all with all, M(σ) y = b is solved by iteration, with the factors of one symmetric matrix that
//! is positive:
//!
//! ```text
//! S = H + t Γ⁻¹,  t ≥ 2|λ₁|:      (1 + S⁻¹(σB − tΓ⁻¹)) y = S⁻¹ b
//! ```
//! To all but the soft modes that is the identity. There is no determinant then, and none is needed: of all eigenvalues λ₊ is the nearest to
//! any σ > λ₊/2, for the others have no positive real part; and what is found is λ₊ if it is positive.

use super::Unstable;
use crate::energy::Evaluator;
use crate::linalg::{Factors, General, Matrix, gmres, slab};
use crate::stationary::State;

/// Most factorisations; halving alone would need about fifty.
const ROUNDS: usize = 200;
/// Most products of one solution by iteration, and the part of a right-hand side that it may leave.
const PRODUCTS: usize = 500;
const LEFT: f64 = 1e-13;
/// A shift by iteration lies above the estimate by this part, where the matrix is far enough from singular.
const ABOVE: f64 = 1e-3;

/// The linearised equation at a saddle, in units of the largest Γ.
struct Linearised<'a> {
    h: Evaluator<'a>,
    saddle: &'a State,
    /// Where each site stands in the band.
    places: Vec<usize>,
    /// 1/Γ of each site, in units of 1/max Γ.
    slowness: Vec<f64>,
    damping: f64,
}

/// λ₊ (rad/s) at a saddle of index one; `gyration` is Γ (rad/s per meV), a number a site. Nothing if it cannot be told from zero, or
/// the run is stopped.
pub fn growth_rate(h: Evaluator, saddle: &State, unstable: &Unstable, gyration: &[f64], damping: f64) -> Option<f64> {
    let scale = gyration.iter().fold(0.0f64, |s, g| s.max(*g));
    let slowness = gyration.iter().map(|g| scale / g).collect();
    let places = if by_iteration(saddle) { (0..h.sites()).collect() } else { h.lattice().places() };
    let lin = Linearised { h, saddle, places, slowness, damping };
    lin.eigenvalue(&unstable.mode, unstable.eigenvalue_mev).map(|rate| scale * rate)
}

/// Whether x was an eigenvector already, and its eigenvalue changes by rounding only; its last two changes.
fn is_settled(aligned: f64, [before, change]: [f64; 2], rounding: f64, eigenvalue: f64) -> bool {
    let is_sharp = change <= rounding * eigenvalue || (change <= 1e-6 * eigenvalue && change >= 0.5 * before);
    aligned < 1e-9 && is_sharp
}

/// Whether the sites around a saddle are coupled every way or all with all, so that no band is narrow.
fn by_iteration(saddle: &State) -> bool {
    !matches!(saddle.hessian, Matrix::Band(..))
}

impl Linearised<'_> {
    fn eigenvalue(&self, mode: &[f64], lambda1: f64) -> Option<f64> {
        let start = self.guess(mode, lambda1)?;
        // the descending curvature is known to the rounding error of the Hessian, and λ₊ goes with it
        let rounding = (4.0 * f64::EPSILON * self.saddle.hessian.norm1() / -lambda1).clamp(1e-13, 1e-2);
        if by_iteration(self.saddle) { self.iterated(start, lambda1, rounding) } else { self.banded(start, rounding) }
    }

    fn iterated(&self, (guess, mut x): (f64, Vec<f64>), lambda1: f64, rounding: f64) -> Option<f64> {
        let shift = guess.max(-2.0 * lambda1);
        let factors = self.positive(shift);
        let solved = |mut b: Vec<f64>| {
            factors.solve(&mut b, 1);
            b
        };
        // rather above than below
        let (mut sigma, mut last, mut before) = (4.0 * guess, f64::INFINITY, f64::INFINITY);
        for _ in 0..ROUNDS {
            let product = |v: &[f64]| {
                let mut sum = self.weighted(v);
                slab::scale(&mut sum, sigma);
                let slow = sum.iter_mut().zip(v).enumerate();
                slow.for_each(|(k, (s, v))| *s -= shift * self.slowness[k / 2] * v);
                let mut sum = solved(sum);
                slab::add_scaled(&mut sum, 1.0, v);
                (!self.h.is_stopped()).then_some(sum)
            };
            let mut y = gmres(product, &solved(self.weighted(&x)), LEFT, PRODUCTS)?;
            let (growth, size) = (slab::dot(&x, &y), slab::norm(&y));
            let next = sigma - 1.0 / growth;
            let (aligned, change) = ((growth.abs() / size - 1.0).abs(), (next - last).abs());
            if is_settled(aligned, [before, change], rounding, next) && next > 0.0 {
                return Some(next);
            }
            slab::scale(&mut y, 1.0 / size);
            (x, last, before) = (y, next, change);
            sigma = ((1.0 + ABOVE) * next).clamp(sigma / 4.0, 4.0 * sigma);
            // no growth that could be told from none
            if sigma < f64::EPSILON * guess {
                return None;
            }
        }
        None
    }

    /// The factors of H + t Γ⁻¹.
    fn positive(&self, t: f64) -> Factors {
        let mut matrix = self.saddle.hessian.clone();
        (0..matrix.order()).for_each(|k| matrix.add(k, k, t * self.slowness[k / 2]));
        matrix.factor()
    }

    fn banded(&self, (mut sigma, mut x): (f64, Vec<f64>), rounding: f64) -> Option<f64> {
        let hessian = self.hessian();
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut before = f64::INFINITY;
        for _ in 0..ROUNDS {
            if self.h.is_stopped() {
                return None;
            }
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
            let settled = is_settled(aligned, [before, change], rounding, sigma);
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

    /// All pairs of sites that are coupled, each once, however many bonds join them.
    fn pairs(&self) -> Vec<[usize; 2]> {
        let bonds = self.h.constant_blocks().bond.iter().flat_map(|bonds| bonds.family.bonds());
        let mut pairs: Vec<[usize; 2]> = bonds.map(|[i, j]| [i.min(j), i.max(j)]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
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
        let pairs = self.pairs();
        let spread = pairs.iter().map(|&[i, j]| self.places[i].abs_diff(self.places[j])).max().unwrap_or(0);
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
        pairs.into_iter().for_each(|[i, j]| {
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
