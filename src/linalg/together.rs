//! The lowest modes of a matrix whose factors are dear, all of them by few factors.
//!
//! ```text
//! block Lanczos on (A − s)⁻¹:   θ = uᵀ(A − s)⁻¹u,   ρ = |(A − s)⁻¹u − θu|,   the next s: s + 1/(θ + ρ)
//! ```
//! The inertia of A − s proves that no eigenvalue lies below s. The nearer s is to the lowest one, the fewer vectors the modes take: so
//! the space of a few gives the next s, where that is much nearer; and where some modes are found, the next s lies between them and the
//! others, which may be as close together as spin waves of a wide film. (Parlett, "The Symmetric Eigenvalue Problem", SIAM 1998,
//! doi:10.1137/1.9781611971163, §§4.5, 4.6.)

use super::krylov::{Krylov, MOST, Modes};
use super::ritz::{Mode, none_is_missed, rayleigh_ritz};
use super::{Matrix, remove, slab};

/// Most factorisations.
const ROUNDS: usize = 24;
/// The first s is below zero by this part of the matrix's size.
const FAR: f64 = 1e-3;
/// s is below the lowest eigenvalue by at least this part, so that the inverse tells the modes above that one from rounding.
const APART: f64 = 1e-6;
/// Vectors of a block more than there are modes to begin with: as many as modes are often degenerate.
const SPARE: usize = 2;
/// Blocks before a nearer s is looked for, and how much nearer it must be.
const BLOCKS: usize = 4;
const NEARER: f64 = 0.5;
/// What is given is a mode if |Av − θv| is less than this part of |θ|.
const GIVEN: f64 = 1e-6;

/// The wanted modes of `matrix` in the space orthogonal to `known` (orthonormal, invariant), of which the lowest may be `given`,
/// orthonormal too, as vectors or roughly; and whether they are those, none missed.
pub(super) fn together(matrix: &Matrix, known: &[Vec<f64>], given: &[Vec<f64>], wanted: Modes) -> (Vec<Mode>, bool) {
    let scale = matrix.norm1().max(1e-280);
    let known_values: Vec<f64> = known.iter().map(|k| quotient(matrix, k, &[]).0).collect();
    let given = &given[..given.len().min(wanted.count)];
    let mut modes: Vec<Mode> = rayleigh_ritz(matrix, given);
    let is_sharp = |v: &&Vec<f64>| {
        let (theta, rest) = quotient(matrix, v, known);
        rest <= GIVEN * theta.abs()
    };
    // the lowest ones that are found, and with them all that is known
    let mut sure = given.iter().take_while(is_sharp).count();
    let mut apart = [known, &given[..sure]].concat();
    // no other eigenvalue below the one, some below the other
    let (mut low, mut high, mut down) = (f64::NEG_INFINITY, f64::INFINITY, FAR * scale);
    let (mut shift, mut memory) = (-down, Matrix::default());
    let mut went_far = false;
    if sure == 0
        && let Some(lowest) = modes.first()
    {
        let (theta, rest) = quotient(matrix, &lowest.vector, known);
        shift = theta - rest.max(APART * scale);
    }
    for _ in 0..ROUNDS {
        memory.copy_from(matrix);
        memory.shift(-shift);
        let factors = memory.factor();
        if factors.negatives() > sure + known_values.iter().filter(|v| **v < shift).count() {
            memory = factors.into_memory();
            high = shift;
            if sure > 0 && !std::mem::replace(&mut went_far, true) {
                // s may lie above the next mode
                shift = 0.5 * (modes[sure - 1].value + high);
                continue;
            }
            if sure > 0 {
                // one of the modes below was missed: all of them once more
                (sure, low) = (0, f64::NEG_INFINITY);
                apart.truncate(known.len());
            }
            shift = if low.is_finite() { 0.5 * (low + high) } else { high - down };
            down *= 4.0;
            continue;
        }
        (low, went_far) = (shift, false);
        // where all others lie below s, the lowest above it alone cannot be missed
        let is_last = wanted.count == sure + 1 && modes[..sure].iter().all(|mode| mode.value < shift);
        let mut krylov = Krylov::new(&factors, &apart, SPARE + modes.len() - sure);
        krylov.starts = modes[sure..].iter().map(|mode| mode.vector.clone()).collect();
        let rest = Modes { count: wanted.count - sure, below: wanted.below - low, ..wanted };
        let mut most = (BLOCKS + 1) * (SPARE + wanted.count);
        loop {
            let (space, settled) = krylov.largest(rest, most);
            modes = rayleigh_ritz(matrix, &[&apart[known.len()..], &space].concat());
            let complete = settled && (is_last || none_is_missed(matrix, &modes, known, scale));
            if complete || krylov.is_full(MOST) || modes.len() <= sure {
                // the first of those beside the ones found may lie above the limit
                let within = modes.iter().skip(1).take_while(|mode| mode.value < wanted.below).count();
                modes.truncate(1 + within);
                return (modes, complete);
            }
            if settled {
                // more are degenerate than the block has vectors: the next one has more
                shift = low;
                break;
            }
            let inverse = krylov.residuals(space.len());
            let here = inverse.iter().take_while(|(theta, rest)| *rest <= wanted.part * theta.abs()).count();
            let below = |k: usize| inverse.get(k).and_then(|by| nearer(&modes, sure + k, *by, low, scale));
            let next = below(0).filter(|s| *s < high);
            let beyond = below(here).filter(|_| here > 0);
            if let Some(nearer) = beyond {
                // below that one lie the modes that are found, and no other, as the next factors tell
                sure += here;
                apart.extend(modes[apart.len() - known.len()..sure].iter().map(|mode| mode.vector.clone()));
                (shift, high) = (nearer, f64::INFINITY);
                break;
            }
            if let Some(nearer) = next {
                shift = nearer;
                break;
            }
            most = (2 * most).min(MOST);
        }
        memory = factors.into_memory();
    }
    (modes, false)
}

/// s below mode k, above the modes before it, and much nearer to it than `low` is: by its eigenvalue θ in (A − low)⁻¹ and the residual
/// there, since that of A is mostly of modes far above.
fn nearer(modes: &[Mode], k: usize, (theta, rest): (f64, f64), low: f64, scale: f64) -> Option<f64> {
    let value = modes.get(k)?.value;
    let shift = (low + 1.0 / (theta + rest)).min(value - APART * scale);
    let above = k.checked_sub(1).is_none_or(|before| modes[before].value < shift);
    (theta > 0.0 && above && value - shift < NEARER * (value - low)).then_some(shift)
}

/// uᵀAu and the size of what else Au has, known vectors apart.
fn quotient(matrix: &Matrix, u: &[f64], known: &[Vec<f64>]) -> (f64, f64) {
    let mut image = vec![0.0; u.len()];
    matrix.multiply(u, &mut image);
    let theta = slab::dot(u, &image);
    slab::add_scaled(&mut image, -theta, u);
    remove(&mut image, known);
    (theta, slab::norm(&image))
}
