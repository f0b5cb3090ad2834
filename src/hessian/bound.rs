//! How negative a direction may be that is not known, told without factors: by Lanczos on the pencil (H, B⁻¹) in a part of the tangent
//! space, B what stands in for the inverse of the Hessian (see [`StandIn`]). H has as many negative directions as the pencil (Sylvester),
//! whose spectrum is short, so that so many steps tell as much on any lattice.
//!
//! ```text
//! P(θ₁ < θ − ε (θₙ − θ₁)) ≤ 1.648 √n exp(−(2k − 1) √ε)        θ: lowest Ritz value after k steps, θ₁, θₙ: the ends of the spectrum
//! ```
//! for a start that is uniform in directions (J. Kuczyński, H. Woźniakowski, SIAM J. Matrix Anal. Appl. 13, 1094 (1992),
//! doi:10.1137/0613066). The start is noise that B has smoothed, which has more of soft directions than that. There is no
//! orthogonalisation against all vectors before, for which no memory would do: rounding makes copies of Ritz values that are found, none
//! that are lower.

use super::{Place, StandIn};
use crate::field::project;
use crate::linalg::{multigrid, remove, slab};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Steps.
const STEPS: usize = 500;
/// How likely the bound may be wrong.
const PROBABILITY: f64 = 1e-12;
/// Steps after which the lowest Ritz value is looked at.
const LOOK: usize = 25;
/// A Ritz value below zero by this part of the highest is negative.
const NEGATIVE: f64 = 1e-9;

/// No direction v but those known has vᵀHv < −part · vᵀB⁻¹v: B⁻¹ is the stiffness between spins and of each on its own.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bound {
    /// The part.
    pub part: f64,
    /// Steps of Lanczos.
    pub steps: usize,
    /// The probability that it does not hold.
    pub probability: f64,
}

/// The bound for H + s in the complement of `border` (orthonormal tangent fields of 3N numbers); none where a direction there is
/// negative, or where it is to `stop`.
pub fn bound(at: Place, border: &[Vec<f64>], stand_in: &StandIn, stop: &dyn Fn() -> bool) -> Option<Bound> {
    let Place { h, m, g, shift, .. } = at;
    let mut room = multigrid::Room::default();
    let clean = |v: &mut Vec<f64>| {
        project(m, v);
        h.hold_frozen(v);
        remove(v, border);
    };
    let mut invert = |w: &[f64], v: &mut Vec<f64>| {
        stand_in.solve(shift, w, v, &mut room);
        clean(v);
    };
    // v: directions, orthonormal by B⁻¹; w = B⁻¹ v
    let mut w = noise(m.len());
    clean(&mut w);
    let (mut v, mut before, mut image) = (vec![0.0; m.len()], vec![0.0; m.len()], vec![0.0; m.len()]);
    invert(&w, &mut v);
    let mut size = slab::dot(&v, &w).sqrt();
    let (mut diagonal, mut beside) = (Vec::new(), Vec::new());
    while diagonal.len() < STEPS && size > 0.0 {
        slab::scale(&mut v, 1.0 / size);
        slab::scale(&mut w, 1.0 / size);
        h.hessian_product(m, g, &v, &mut image);
        slab::add_scaled(&mut image, shift, &v);
        let own = slab::dot(&image, &v);
        slab::add_scaled(&mut image, -own, &w);
        if let Some(&size) = beside.last() {
            let size: f64 = size;
            slab::add_scaled(&mut image, -size, &before);
        }
        clean(&mut image);
        diagonal.push(own);
        if diagonal.len() % LOOK == 0 && (stop() || is_negative(&diagonal, &beside)) {
            return None;
        }
        std::mem::swap(&mut before, &mut w);
        std::mem::swap(&mut w, &mut image);
        invert(&w, &mut v);
        let square = slab::dot(&v, &w);
        // the directions are exhausted
        size = if square > f64::EPSILON.powi(2) * own.abs().max(1.0) { square.sqrt() } else { 0.0 };
        beside.push(size);
    }
    if diagonal.iter().any(|a: &f64| a.is_nan()) || is_negative(&diagonal, &beside) {
        return None;
    }
    let (k, n) = (diagonal.len(), 2 * m.len() / 3);
    let needed = libm::log(1.648 * (n as f64).sqrt() / PROBABILITY);
    // where the directions are exhausted all that the start has something of, which is everything, was met
    let part = if size > 0.0 { (needed / (2 * k - 1) as f64).powi(2) } else { NEGATIVE };
    Some(Bound { part: part * highest(&diagonal, &beside), steps: k, probability: PROBABILITY })
}

/// Normally distributed numbers.
fn noise(n: usize) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(0xb0d);
    let mut one = || {
        let (a, b): (f64, f64) = (random.random_range(f64::MIN_POSITIVE..1.0), random.random_range(0.0..TAU));
        (-2.0 * libm::log(a)).sqrt() * libm::cos(b)
    };
    (0..n).map(|_| one()).collect()
}

fn is_negative(diagonal: &[f64], beside: &[f64]) -> bool {
    below(diagonal, beside, -NEGATIVE * highest(diagonal, beside)) > 0
}

/// At least the highest eigenvalue of a symmetric tridiagonal matrix (Gershgorin).
fn highest(diagonal: &[f64], beside: &[f64]) -> f64 {
    let at = |k: usize| beside.get(k).copied().unwrap_or(0.0);
    let row = |(k, a): (usize, &f64)| {
        a + if k > 0 { at(k - 1) } else { 0.0 } + if k + 1 < diagonal.len() { at(k) } else { 0.0 }
    };
    diagonal.iter().enumerate().map(row).fold(0.0, f64::max)
}

/// How many eigenvalues of a symmetric tridiagonal matrix lie below `limit` (Sturm).
fn below(diagonal: &[f64], beside: &[f64], limit: f64) -> usize {
    let (mut pivot, mut count) = (1.0, 0);
    for (k, a) in diagonal.iter().enumerate() {
        let off = if k > 0 { beside[k - 1] } else { 0.0 };
        pivot = a - limit - off * off / pivot;
        if pivot == 0.0 {
            pivot = f64::MIN_POSITIVE;
        }
        count += usize::from(pivot < 0.0);
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice, posed};
    use crate::hessian::{TangentBasis, assemble};
    use crate::linalg::lowest_modes;

    #[test]
    fn eigenvalues_of_tridiagonal_matrices_are_counted() {
        // 2 − 2 cos(kπ/(n + 1))
        let (diagonal, beside) = (vec![2.0; 30], vec![1.0; 29]);
        let value = |k: usize| 2.0 - 2.0 * libm::cos(k as f64 * std::f64::consts::PI / 31.0);
        for k in 1..30 {
            assert_eq!(below(&diagonal, &beside, 0.5 * (value(k) + value(k + 1))), k);
        }
        assert!((value(30)..=4.0).contains(&highest(&diagonal, &beside)));
    }

    /// A wall in the middle of a film with a field along its axis: its slide and its turn are negative.
    #[test]
    fn negative_directions_are_met_until_all_of_them_are_known_and_then_the_rest_is_bounded() {
        for (cells, easy) in [("[24, 16]", 0.1), ("[40, 30]", 0.05)] {
            let square = lattice(&format!(r#"{{"square": {{"cells": {cells}}}}}"#));
            let terms = [
                r#"{"exchange": {"J": ["1 meV"]}}"#.to_string(),
                format!(r#"{{"anisotropy": {{"K": "{easy} meV", "axis": [0, 0, 1]}}}}"#),
                r#"{"anisotropy": {"K": "0.01 meV", "axis": [0, 1, 0]}}"#.to_string(),
            ];
            let h = hamiltonian(&square, &terms.each_ref().map(String::as_str));
            let middle = 0.5 * (0..h.sites()).map(|i| square.position(i)[0]).fold(0.0, f64::max);
            let width = f64::sqrt(2.0 * easy);
            let spin = |p: [f64; 3]| {
                let x = width * (p[0] - middle);
                [1.0 / x.cosh(), 0.0, x.tanh()]
            };
            let (m, g) = posed(&h, spin);
            let basis = TangentBasis::at(m.as_slice());
            let modes = lowest_modes(&assemble(&h, m.as_slice(), &g, &basis), 6, &[]);
            let negative = modes.iter().filter(|mode| mode.value < 0.0).count();
            assert!((2..6).contains(&negative), "{modes:?}");
            let field = |k: usize| {
                let mut v = vec![0.0; 3 * h.sites()];
                basis.field(&modes[k].vector, &mut v);
                v
            };
            let (at, stand_in) = (
                Place { h: &h, m: m.as_slice(), g: &g, shift: 0.0, pull: 0.0 },
                StandIn::about(&h, m.as_slice(), &g, 0.01),
            );
            for known in 0..=negative {
                let border: Vec<Vec<f64>> = (0..known).map(field).collect();
                let found = bound(at, &border, &stand_in, &|| false);
                assert_eq!(found.is_some(), known == negative, "{known} of {negative}: {found:?}");
                if let Some(found) = found {
                    assert!(found.part > 0.0 && found.part < 0.01 && found.steps <= STEPS, "{found:?}");
                }
            }
            assert!(bound(at, &[], &stand_in, &|| true).is_none());
        }
    }
}
