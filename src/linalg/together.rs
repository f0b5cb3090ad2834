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
use super::{Factors, Matrix, remove, slab};

/// Most factorisations.
const ROUNDS: usize = 24;
/// The first s is below zero by this part of the matrix's size.
const FAR: f64 = 1e-3;
/// s is below the lowest eigenvalue by at least this part, so that the inverse tells the modes above that one from rounding.
const APART: f64 = 1e-6;
/// Vectors of a block more than there are modes to begin with: as many as modes are often degenerate.
const SPARE: usize = 2;
/// Blocks before a nearer s is looked for, and how much nearer it must be.
const BLOCKS: usize = 9;
const NEARER: f64 = 0.5;
/// What is given is a mode if |Av − θv| is less than this part of |θ|.
const GIVEN: f64 = 1e-6;

/// The wanted modes of `matrix` in the space orthogonal to `known` (orthonormal, invariant), of which the lowest may be `given`,
/// orthonormal too, as vectors or roughly; and whether they are those, none missed.
pub(super) fn together(matrix: &Matrix, known: &[Vec<f64>], given: &[Vec<f64>], wanted: Modes) -> (Vec<Mode>, bool) {
    let mut search = Search::of(matrix, known, given, wanted);
    let mut memory = Matrix::default();
    for _ in 0..ROUNDS {
        memory.copy_from(matrix);
        memory.shift(-search.shift);
        let factors = memory.factor();
        if factors.negatives() > search.found_below() {
            search.lower();
        } else if let Some(complete) = search.look(&factors) {
            return (search.modes, complete);
        }
        memory = factors.into_memory();
    }
    (search.modes, false)
}

/// Where s is, and what is known of the modes.
struct Search<'a> {
    matrix: &'a Matrix,
    scale: f64,
    known: &'a [Vec<f64>],
    known_values: Vec<f64>,
    wanted: Modes,
    /// The lowest that are known, the first `sure` of them as modes.
    modes: Vec<Mode>,
    sure: usize,
    /// Those, and with them all that is known.
    apart: Vec<Vec<f64>>,
    /// No other eigenvalue lies below the one, some below the other.
    low: f64,
    high: f64,
    shift: f64,
    /// How far s goes down where it lies above some, and whether it has gone up by too much.
    down: f64,
    went_far: bool,
}

impl<'a> Search<'a> {
    fn of(matrix: &'a Matrix, known: &'a [Vec<f64>], given: &[Vec<f64>], wanted: Modes) -> Search<'a> {
        let scale = matrix.norm1().max(1e-280);
        let given = &given[..given.len().min(wanted.count)];
        let modes: Vec<Mode> = rayleigh_ritz(matrix, given);
        let is_sharp = |v: &&Vec<f64>| {
            let (theta, rest) = quotient(matrix, v, known);
            rest <= GIVEN * theta.abs()
        };
        let sure = given.iter().take_while(is_sharp).count();
        let down = FAR * scale;
        let shift = match modes.first() {
            Some(lowest) if sure == 0 => {
                let (theta, rest) = quotient(matrix, &lowest.vector, known);
                theta - rest.max(APART * scale)
            }
            _ => -down,
        };
        Search {
            matrix,
            scale,
            known,
            known_values: known.iter().map(|k| quotient(matrix, k, &[]).0).collect(),
            wanted,
            modes,
            sure,
            apart: [known, &given[..sure]].concat(),
            low: f64::NEG_INFINITY,
            high: f64::INFINITY,
            shift,
            down,
            went_far: false,
        }
    }

    /// How many eigenvalues below s are accounted for.
    fn found_below(&self) -> usize {
        self.sure + self.known_values.iter().filter(|v| **v < self.shift).count()
    }

    /// The next s, where others lie below this one.
    fn lower(&mut self) {
        self.high = self.shift;
        if self.sure > 0 && !std::mem::replace(&mut self.went_far, true) {
            // s may lie above the next mode
            self.shift = 0.5 * (self.modes[self.sure - 1].value + self.high);
            return;
        }
        if self.sure > 0 {
            // one of the modes below was missed: all of them once more
            (self.sure, self.low) = (0, f64::NEG_INFINITY);
            self.apart.truncate(self.known.len());
        }
        self.shift = if self.low.is_finite() { 0.5 * (self.low + self.high) } else { self.high - self.down };
        self.down *= 4.0;
    }

    /// Looks for modes above s, below which no other lies, until all are found, and then whether none is missed, or a nearer s is.
    fn look(&mut self, factors: &Factors) -> Option<bool> {
        let (wanted, sure) = (self.wanted, self.sure);
        (self.low, self.went_far) = (self.shift, false);
        // where all others lie below s, the lowest above it alone cannot be missed
        let is_last = wanted.count == sure + 1 && self.modes[..sure].iter().all(|mode| mode.value < self.shift);
        let block = if is_last { 1 } else { SPARE + self.modes.len() - sure };
        let mut krylov = Krylov::new(factors, &self.apart, block);
        krylov.starts = self.modes[sure..].iter().map(|mode| mode.vector.clone()).collect();
        let rest = Modes { count: wanted.count - sure, below: wanted.below - self.low, ..wanted };
        let mut most = BLOCKS * block.max(SPARE);
        let (found, shift) = loop {
            let (space, settled) = krylov.largest(rest, most);
            self.modes = rayleigh_ritz(self.matrix, &[&self.apart[self.known.len()..], &space].concat());
            let complete = settled && (is_last || none_is_missed(self.matrix, &self.modes, self.known, self.scale));
            if complete || krylov.is_full(MOST) || self.modes.len() <= sure {
                // the first of those beside the ones found may lie above the limit
                let within = self.modes.iter().skip(1).take_while(|mode| mode.value < wanted.below).count();
                self.modes.truncate(1 + within);
                return Some(complete);
            }
            if settled {
                // more are degenerate than the block has vectors: the next one has more
                self.shift = self.low;
                return None;
            }
            if let Some(next) = self.nearer_shift(&krylov.residuals(space.len())) {
                break next;
            }
            most = (2 * most).min(MOST);
        };
        self.shift = shift;
        if found > 0 {
            // below that one lie the modes that are found, and no other, as the next factors tell
            self.sure += found;
            let modes = &self.modes[self.apart.len() - self.known.len()..self.sure];
            self.apart.extend(modes.iter().map(|mode| mode.vector.clone()));
            self.high = f64::INFINITY;
        }
        None
    }

    /// A nearer s, if there is one, by the eigenvalues in the inverse and their residuals: between so many modes more that are found and the
    /// others, or below all of them.
    fn nearer_shift(&self, inverse: &[(f64, f64)]) -> Option<(usize, f64)> {
        let here = inverse.iter().take_while(|(theta, rest)| *rest <= self.wanted.part * theta.abs()).count();
        let below =
            |k: usize| inverse.get(k).and_then(|by| nearer(&self.modes, self.sure + k, *by, self.low, self.scale));
        let beyond = below(here).filter(|_| here > 0).map(|s| (here, s));
        beyond.or_else(|| below(0).filter(|s| *s < self.high).map(|s| (0, s)))
    }
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
