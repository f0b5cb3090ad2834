//! The interaction of an open row as a sum of few exponentials, K(n) ≈ Σ_k w_k q_kⁿ for all n beyond the nearest shells.
//!
//! The integral of [`super::series`] over u, by the trapezoidal rule in ln u, converges exponentially: its nodes are decays
//! q = e^(−u), its weights of one sign, some eighty for full accuracy. Seen as the impulse response of a symmetric linear
//! system, x ← diag(q) x, b = √w, the sum is balanced as it stands, so the eigenvectors of its Gramian (over the length of the
//! row) that matter span a system of a third of the size, which is diagonal again in other decays: balanced truncation, Moore,
//! IEEE Trans. Autom. Control 26, 17 (1981), doi:10.1109/TAC.1981.1102568.
//!
//! With such a sum the Hessian of the row is factorised in O(N), with its exact inertia; the nearest shells, where the sum is
//! not accurate, are put right one by one.

use super::{Kernel, Shape};
use crate::linalg::{eigen_symmetric, slab};
use std::f64::consts::PI;

/// Steps in ln u that are tried.
const STEPS: [f64; 8] = [0.8, 0.6, 0.45, 0.33, 0.27, 0.22, 0.16, 0.1];
/// Numbers of nearest shells that are tried.
const SHELLS: [usize; 12] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64];
/// Numbers of shells that are compared, the smallest that will do first.
const COMPARED: usize = 2;
/// No node lies above: e^(−46) is 1e-20.
const LARGEST: f64 = 46.0;

/// A sum of exponentials in place of a kernel.
#[derive(Clone, Debug, Default)]
pub struct Exponentials {
    /// Shells 1 … `shells` are to be put right.
    pub shells: usize,
    /// q of every term of xx, yy and zz.
    pub decays: [Vec<f64>; 3],
    /// w of every term.
    pub weights: [Vec<f64>; 3],
    /// Largest Σ_n |K(n) − Σ_k w_k q_kⁿ| over the shells beyond, of the three components.
    pub error: f64,
}

impl Exponentials {
    /// The cheapest sum with an error of at most `tolerance` times Σ_n |K(n)|, or else the most accurate one.
    pub fn new(kernel: &Kernel, tolerance: f64) -> Exponentials {
        let sites = kernel.table[0].len();
        let goal = tolerance * (0..3).map(|c| kernel.table[c].iter().map(|k| k.abs()).sum()).fold(0.0, f64::max);
        let mut sums: Vec<Exponentials> = Vec::new();
        let nodes = STEPS.map(|h| nodes(kernel.shape, h));
        for shells in SHELLS.into_iter().filter(|r| *r < sites) {
            let sum = Exponentials::beyond(kernel, &nodes, shells, goal);
            if sums.last().is_some_and(|last| last.error > goal) {
                sums.clear();
            }
            sums.push(sum);
            if sums[0].error <= goal && sums.len() >= COMPARED {
                break;
            }
        }
        let accurate = sums.iter().filter(|s| s.error <= goal).min_by_key(|s| s.cost());
        let best = accurate.or(sums.iter().min_by(|a, b| a.error.total_cmp(&b.error)));
        let mut best = best.cloned().unwrap_or_default();
        best.error = (0..3).map(|c| best.error_of(c, kernel, 1)).fold(0.0, f64::max);
        best
    }

    /// The shortest sum that reaches the goal beyond `shells`, or the most accurate one.
    fn beyond(kernel: &Kernel, nodes: &[Vec<Node>], shells: usize, goal: f64) -> Exponentials {
        let sites = kernel.table[0].len();
        let mut all = Exponentials::default();
        for nodes in nodes {
            all = Exponentials::trapezoidal(nodes, shells, sites, 0.01 * goal);
            all.error = (0..3).map(|c| all.error_of(c, kernel, 8)).fold(0.0, f64::max);
            if all.error <= 0.3 * goal {
                break;
            }
        }
        let mut short = Exponentials { shells, ..Exponentials::default() };
        for c in 0..3 {
            if c == 2 && kernel.is_axial() {
                (short.decays[2], short.weights[2]) = (short.decays[1].clone(), short.weights[1].clone());
                continue;
            }
            let gramian = Gramian::new(&all.decays[c], &all.weights[c], shells, sites);
            for size in gramian.least(0.1 * goal)..=gramian.vectors.len() {
                (short.decays[c], short.weights[c]) = gramian.truncated(size);
                if short.error_of(c, kernel, 8) <= 0.7 * goal {
                    break;
                }
            }
        }
        short.error = (0..3).map(|c| short.error_of(c, kernel, 8)).fold(0.0, f64::max);
        if short.error <= goal.max(all.error) { short } else { all }
    }

    /// The nodes that matter beyond `shells`.
    fn trapezoidal(nodes: &[Node], shells: usize, sites: usize, negligible: f64) -> Exponentials {
        let matters = |n: &&Node| {
            let rest = (1.0 - libm::exp(-n.u * sites as f64)) / (1.0 - libm::exp(-n.u));
            let sum = libm::exp(-n.u * (shells + 1) as f64) * rest;
            n.weight.iter().any(|w| w.abs() * sum > negligible)
        };
        let kept: Vec<&Node> = nodes.iter().filter(matters).collect();
        let decays: Vec<f64> = kept.iter().map(|n| libm::exp(-n.u)).collect();
        Exponentials {
            shells,
            decays: [decays.clone(), decays.clone(), decays],
            weights: [0, 1, 2].map(|c: usize| kept.iter().map(|n| n.weight[c]).collect()),
            error: f64::INFINITY,
        }
    }

    /// Entries of the state that a site's couplings pass through.
    pub fn cost(&self) -> usize {
        2 * self.shells + self.decays.iter().map(Vec::len).sum::<usize>()
    }

    /// Σ_k w_k qⁿ.
    pub fn at(&self, n: usize) -> [f64; 3] {
        let term = |(w, q): (&f64, &f64)| w * libm::pow(*q, n as f64);
        [0, 1, 2].map(|c: usize| self.weights[c].iter().zip(&self.decays[c]).map(term).sum())
    }

    /// Σ_n |K(n) − Σ_k w_k q_kⁿ| of a component, from shells at most 1/`grain` of their distance apart.
    fn error_of(&self, c: usize, kernel: &Kernel, grain: usize) -> f64 {
        let sites = kernel.table[0].len();
        let (decays, weights) = (&self.decays[c], &self.weights[c]);
        let terms_at = |n: usize| weights.iter().zip(decays).map(|(w, q)| w * libm::pow(*q, n as f64)).collect();
        let (mut error, mut n) = (0.0, self.shells + 1);
        let mut terms: Vec<f64> = terms_at(n);
        while n < sites {
            let step = if grain == 1 { 1 } else { (n / grain).max(1) };
            error += step as f64 * (kernel.table[c][n] - terms.iter().sum::<f64>()).abs();
            n += step;
            if step == 1 && !n.is_multiple_of(16) {
                terms.iter_mut().zip(decays).for_each(|(t, q)| *t *= q);
            } else {
                terms = terms_at(n);
            }
        }
        error
    }
}

/// The balanced system of a sum: its decay rates, its input b, and the eigenvectors of its Gramian, largest first.
struct Gramian {
    rates: Vec<f64>,
    input: Vec<f64>,
    values: Vec<f64>,
    vectors: Vec<Vec<f64>>,
    sign: f64,
    shells: usize,
}

impl Gramian {
    /// Of Σ_k w_k q_kⁿ, n = shells + 1 … sites − 1; all weights have one sign.
    fn new(decays: &[f64], weights: &[f64], shells: usize, sites: usize) -> Gramian {
        let rates: Vec<f64> = decays.iter().map(|q| -libm::log(*q)).collect();
        let first = (shells + 1) as f64;
        let input: Vec<f64> =
            rates.iter().zip(weights).map(|(u, w)| w.abs().sqrt() * libm::exp(-0.5 * first * u)).collect();
        // half the length: the Gramian belongs to pairs of times whose sum is a distance
        let horizon = ((sites.saturating_sub(shells)) / 2).max(1) as f64;
        let k = decays.len();
        let entry = |i: usize, j: usize| {
            let u = rates[i] + rates[j];
            input[i] * input[j] * libm::expm1(-u * horizon) / libm::expm1(-u)
        };
        let (values, vectors) = principal(k, entry);
        let sign = if weights.iter().sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
        Gramian { rates, input, values, vectors, sign, shells }
    }

    /// A size below which no truncation has an error of less than `goal`: the first whose next eigenvalue is small enough.
    fn least(&self, goal: f64) -> usize {
        self.values.iter().take_while(|v| **v > goal).count().min(self.vectors.len()).max(1)
    }

    /// The system in the space of the first `size` eigenvectors: decays and weights.
    fn truncated(&self, size: usize) -> (Vec<f64>, Vec<f64>) {
        let space = &self.vectors[..size];
        // 1 − q, not q: the slow decays differ from 1 by little
        let lost: Vec<f64> = self.rates.iter().map(|u| -libm::expm1(-u)).collect();
        let scaled: Vec<Vec<f64>> = space.iter().map(|v| v.iter().zip(&lost).map(|(v, l)| v * l).collect()).collect();
        let matrix: Vec<f64> = (0..size * size)
            .map(|x| {
                0.5 * (slab::dot(&space[x / size], &scaled[x % size]) + slab::dot(&space[x % size], &scaled[x / size]))
            })
            .collect();
        let input: Vec<f64> = space.iter().map(|v| slab::dot(v, &self.input)).collect();
        let (values, vectors) = eigen_symmetric(&matrix, size);
        let first = (self.shells + 1) as f64;
        let term = |(lost, vector): (&f64, &Vec<f64>)| {
            let q = (1.0 - lost).clamp(1e-12, 1.0);
            let b = slab::dot(vector, &input);
            (q, self.sign * b * b * libm::pow(q, -first))
        };
        values.iter().zip(&vectors).map(term).unzip()
    }
}

/// Eigenvalues and eigenvectors, largest first, of a positive matrix of k rows as far as they are above rounding: pivoted
/// Cholesky factors, W = LLᵀ, of few columns; then W in the orthonormalised columns.
fn principal(k: usize, entry: impl Fn(usize, usize) -> f64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut rest: Vec<f64> = (0..k).map(|i| entry(i, i)).collect();
    let negligible = 1e-19 * rest.iter().sum::<f64>();
    let mut columns: Vec<Vec<f64>> = Vec::new();
    while let Some(p) = (0..k).max_by(|i, j| rest[*i].total_cmp(&rest[*j])).filter(|p| rest[*p] > negligible) {
        let root = rest[p].sqrt();
        let mut column: Vec<f64> = (0..k).map(|i| entry(i, p)).collect();
        for c in &columns {
            slab::add_scaled(&mut column, -c[p], c);
        }
        slab::scale(&mut column, 1.0 / root);
        rest.iter_mut().zip(&column).for_each(|(r, c)| *r -= c * c);
        rest[p] = 0.0;
        columns.push(column);
        if columns.len() == k {
            break;
        }
    }
    let mut space: Vec<Vec<f64>> = Vec::new();
    for column in &columns {
        let mut v = column.clone();
        for _ in 0..2 {
            for s in &space {
                let overlap = slab::dot(s, &v);
                slab::add_scaled(&mut v, -overlap, s);
            }
            slab::normalise(&mut v);
        }
        space.push(v);
    }
    let n = space.len();
    let parts: Vec<Vec<f64>> = space.iter().map(|s| columns.iter().map(|c| slab::dot(s, c)).collect()).collect();
    let matrix: Vec<f64> = (0..n * n).map(|x| slab::dot(&parts[x / n], &parts[x % n])).collect();
    let (mut values, small) = eigen_symmetric(&matrix, n);
    let lift = |weights: &Vec<f64>| {
        let mut v = vec![0.0; k];
        weights.iter().zip(&space).for_each(|(w, s)| slab::add_scaled(&mut v, *w, s));
        v
    };
    let mut vectors: Vec<Vec<f64>> = small.iter().map(lift).collect();
    values.reverse();
    vectors.reverse();
    (values, vectors)
}

/// A node u with its weights h u ρ(u), K(n) = ∫ ρ e^(−nu) du.
struct Node {
    u: f64,
    weight: [f64; 3],
}

fn nodes(shape: Shape, h: f64) -> Vec<Node> {
    let first = (-18.0 / h).floor() as i32;
    let last = (libm::log(LARGEST) / h).floor() as i32;
    let node = |k: i32| {
        let u = libm::exp(f64::from(k) * h);
        Node { u, weight: density(shape, u).map(|d| h * u * d) }
    };
    (first..=last).map(node).collect()
}

/// ρ(u) for xx, yy, zz.
fn density(shape: Shape, u: f64) -> [f64; 3] {
    match shape {
        Shape::Dipoles => [-0.25 * u * u / PI, 0.125 * u * u / PI, 0.125 * u * u / PI],
        Shape::Cells { width, thickness } => {
            let half = libm::sinh(0.5 * u);
            let scale = width * thickness / PI * half * half;
            let [across, through] = angular_means(0.5 * u * width, 0.5 * u * thickness);
            [-scale * (across + through), scale * across, scale * through]
        }
    }
}

/// ⟨S cos²φ⟩ and ⟨S sin²φ⟩, S = sinc²(a cos φ) sinc²(b sin φ), by the trapezoidal rule.
fn angular_means(a: f64, b: f64) -> [f64; 2] {
    let sinc = |x: f64| if x.abs() < 1e-9 { 1.0 } else { libm::sin(x) / x };
    let points = 16 + (2.0 * a.max(b)).ceil() as usize;
    let mut sums = [0.0; 2];
    for j in 0..points {
        let (sin, cos) = libm::sincos(0.5 * PI * (j as f64 + 0.5) / points as f64);
        let s = sinc(a * cos) * sinc(b * sin);
        sums[0] += s * s * cos * cos;
        sums[1] += s * s * sin * sin;
    }
    sums.map(|s| s / points as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sum_is_the_kernel_beyond_its_nearest_shells() {
        let square = Shape::Cells { width: 1.0, thickness: 1.0 };
        let strip = Shape::Cells { width: 4.0, thickness: 1.0 };
        let wire = Shape::Cells { width: 0.1, thickness: 0.2 };
        for (shape, most) in [(Shape::Dipoles, 110), (square, 110), (strip, 140), (wire, 110)] {
            for sites in [30, 130, 1000, 20_000] {
                let kernel = Kernel::new(shape, sites, false);
                let sum = |c: usize| kernel.table[c].iter().map(|k| k.abs()).sum::<f64>();
                let scale = sum(0).max(sum(1)).max(sum(2));
                for tolerance in [1e-15, 1e-6] {
                    let e = Exponentials::new(&kernel, tolerance);
                    assert!(e.error <= tolerance * scale, "{shape:?} {sites} {tolerance:e}: {:e}", e.error / scale);
                    assert!(e.cost() <= most, "{shape:?} {sites}: {}", e.cost());
                    for n in [e.shells + 1, e.shells + 5, sites - 1] {
                        for c in 0..3 {
                            assert!((e.at(n)[c] - kernel.table[c][n]).abs() <= tolerance * scale);
                        }
                    }
                }
            }
        }
    }
}
