//! The lowest mode of a matrix from a vector near it, for matrices that change little from one to the next.
//!
//! ```text
//! θ = uᵀAu,  ρ = |Au − θu|;   s = θ − ρ,   u ← (A − s)⁻¹u
//! ```
//! Some eigenvalue lies within ρ of θ, and so above s. Where the inertia of A − s counts none below s, that one is the lowest, and
//! the iteration converges to it, ever faster as ρ falls: the count is the proof. Where it counts one, u belongs to another mode, and
//! something of all modes is added to it. (Parlett, "The Symmetric Eigenvalue Problem", SIAM 1998,
//! doi:10.1137/1.9781611971163, §§4.5, 4.6.)

use super::{Factors, Matrix, remove, slab};
use std::mem::take;

/// Most factorisations.
const ROUNDS: usize = 40;

/// Makes `u` the lowest mode of `matrix`, whose entries are of size `scale`, in the space orthogonal to `known` (orthonormal vectors,
/// invariant or nearly so), and returns its eigenvalue: |Au − θu| and what may lie below θ are within a part `tolerance` of the scale.
/// `u` may be anything at first, nothing too. The memory of `room` is used.
pub fn lowest_from(
    matrix: &Matrix,
    scale: f64,
    known: &[Vec<f64>],
    tolerance: f64,
    u: &mut Vec<f64>,
    room: &mut Matrix,
) -> f64 {
    let mut image = vec![0.0; matrix.order()];
    let values: Vec<f64> = known.iter().map(|k| quotient(matrix, k, &[], &mut image).0).collect();
    u.resize(matrix.order(), 0.0);
    if !normalise(u, known) {
        stir(u, 1.0);
        normalise(u, known);
    }
    let (mut theta, mut rest) = quotient(matrix, u, known, &mut image);
    // no eigenvalue below the one, some below the other
    let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
    let mut down = 1e-3 * scale;
    for _ in 0..ROUNDS {
        let mut shift = (theta - rest.max(f64::EPSILON * scale)).max(low);
        if shift >= high {
            shift = if low.is_finite() { 0.5 * (low + high) } else { high - down };
            down *= 4.0;
        }
        let mut shifted = take(room);
        shifted.copy_from(matrix);
        shifted.shift(-shift);
        let factors = Factors::solving_sized(shifted, scale, u, 1);
        let is_lowest = factors.negatives() <= values.iter().filter(|v| **v < shift).count();
        *room = factors.into_memory();
        normalise(u, known);
        if is_lowest {
            low = shift;
        } else {
            if high.is_infinite() {
                // u may have nothing of that mode
                stir(u, 0.1);
                normalise(u, known);
            }
            high = shift;
        }
        (theta, rest) = quotient(matrix, u, known, &mut image);
        if is_lowest && rest.max(theta - shift) <= tolerance * scale {
            break;
        }
    }
    theta
}

/// uᵀAu and the size of what else Au has, known vectors apart.
fn quotient(matrix: &Matrix, u: &[f64], known: &[Vec<f64>], image: &mut [f64]) -> (f64, f64) {
    matrix.multiply(u, image);
    let theta = slab::dot(u, image);
    slab::add_scaled(image, -theta, u);
    remove(image, known);
    (theta, slab::norm(image))
}

/// Makes u a unit vector orthogonal to all that is known; whether there is such a part of it.
fn normalise(u: &mut [f64], known: &[Vec<f64>]) -> bool {
    let largest = slab::max_abs(u);
    if !(largest > 0.0 && largest.is_finite()) {
        u.fill(0.0);
        return false;
    }
    slab::scale(u, 1.0 / largest);
    remove(u, known);
    let size = slab::norm(u);
    slab::scale(u, 1.0 / size.max(f64::MIN_POSITIVE));
    size > 1e-9
}

/// Adds so much of a vector that has a part of every mode: the multiples of the golden ratio, less their whole parts.
fn stir(u: &mut [f64], part: f64) {
    let each = part * (12.0 / u.len() as f64).sqrt();
    for (k, u) in u.iter_mut().enumerate() {
        *u += each * (((k + 1) as f64 * 0.618_033_988_749_894_9).fract() - 0.5);
    }
}
