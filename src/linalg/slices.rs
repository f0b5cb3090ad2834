//! The lowest eigenvalues of a banded matrix one after the other: Rayleigh-quotient iteration inside brackets that the inertia
//! gives.
//!
//! ```text
//! x ← (A − s)⁻¹ x,   s = xᵀAx inside the bracket, else its middle
//! ```
//! Every factorisation of A − s tells how many eigenvalues lie below s (Sylvester's law of inertia), so that the brackets narrow
//! as the iteration goes on, and nothing below the last eigenvalue can be missed: the lowest bracket that holds more eigenvalues
//! than were found in it comes next. Parlett, "The Symmetric Eigenvalue Problem", SIAM 1998, doi:10.1137/1.9781611971163, §§3.3, 4.6.

use super::ritz::{APART, Mode, rayleigh_ritz};
use super::{Factors, Matrix, slab};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::mem::take;

/// A vector whose residual is this part of its eigenvalue is an eigenvector: the eigenvalue is right to the square of it.
const RESIDUAL: f64 = 1e-8;
/// Most factorisations for one eigenvalue.
const ROUNDS: usize = 60;
/// From so many on, every other shift is the middle of the bracket.
const SLOW: usize = 8;
/// So many eigenvalues more than asked for are found at most, before those between them are.
const SPARE: usize = 4;

/// The `count` lowest modes in the space orthogonal to `known` (orthonormal, invariant), ascending, but for the first only those
/// below a limit. Nothing where the iteration does not converge.
pub fn sliced(matrix: &Matrix, count: usize, known: &[Vec<f64>], limit: f64) -> Option<Vec<Mode>> {
    let mut slices = Slices::new(matrix, known);
    if !slices.scale.is_finite() {
        return None;
    }
    let wanted = if limit.is_finite() { slices.below(limit).clamp(1, count) } else { count };
    while slices.found.len() < wanted + SPARE {
        if slices.found.len() >= wanted && slices.is_complete(wanted) {
            let mut modes = rayleigh_ritz(matrix, &slices.vectors);
            modes.truncate(wanted);
            return Some(modes);
        }
        slices.find()?;
    }
    None
}

struct Slices<'a> {
    matrix: &'a Matrix,
    scale: f64,
    known: &'a [Vec<f64>],
    /// Eigenvalues of the known vectors.
    known_values: Vec<f64>,
    /// Shifts with the number of eigenvalues below them, the known ones apart; ascending.
    points: Vec<(f64, usize)>,
    found: Vec<f64>,
    /// Orthonormal.
    vectors: Vec<Vec<f64>>,
    random: ChaCha8Rng,
    /// Memory for A − s and its factors.
    memory: Matrix,
}

impl<'a> Slices<'a> {
    fn new(matrix: &'a Matrix, known: &'a [Vec<f64>]) -> Slices<'a> {
        let known_values = rayleigh_ritz(matrix, known).iter().map(|mode| mode.value).collect();
        Slices {
            matrix,
            scale: matrix.norm1().max(1e-280),
            known,
            known_values,
            points: Vec::new(),
            found: Vec::new(),
            vectors: Vec::new(),
            random: ChaCha8Rng::seed_from_u64(0x5eed),
            memory: Matrix::default(),
        }
    }

    /// Takes A − s apart, which tells how many eigenvalues are below s; x ← (A − s)⁻¹ x, where there is an x.
    fn factor(&mut self, s: f64, x: &mut [f64]) {
        let mut shifted = take(&mut self.memory);
        shifted.copy_from(self.matrix);
        shifted.shift(-s);
        let factors = Factors::solving_sized(shifted, self.scale, x, usize::from(!x.is_empty()));
        let known = self.known_values.iter().filter(|v| **v < s).count();
        let at = self.points.partition_point(|p| p.0 < s);
        self.points.insert(at, (s, factors.negatives().saturating_sub(known)));
        self.memory = factors.into_memory();
    }

    /// Number of eigenvalues below s.
    fn below(&mut self, s: f64) -> usize {
        self.factor(s, &mut []);
        self.points.iter().find(|p| p.0 == s).map_or(0, |p| p.1)
    }

    fn found_below(&self, s: f64) -> usize {
        self.found.iter().filter(|v| **v < s).count()
    }

    /// Whether an eigenvalue below a shift was not found yet; those found at the shift itself may lie on either side of it.
    fn lacks(&self, (s, below): (f64, usize)) -> bool {
        below > self.found_below(s + 0.1 * APART * self.scale)
    }

    /// Whether the `wanted` lowest that were found have none among them that was not.
    fn is_complete(&mut self, wanted: usize) -> bool {
        let mut values = self.found.clone();
        values.sort_by(f64::total_cmp);
        let s = values[wanted - 1] - APART * self.scale;
        self.below(s) <= self.found_below(s)
    }

    /// The lowest interval between shifts in which an eigenvalue was not found yet.
    fn bracket(&mut self) -> (f64, f64) {
        let least = 1e-11 * self.scale;
        let mut outer = least;
        while self.points.first().is_none_or(|p| p.1 > 0) && outer < 16.0 * self.scale {
            self.factor(-outer, &mut []);
            outer *= 16.0;
        }
        outer = self.points.last().map_or(least, |p| p.0.max(least));
        while self.points.last().is_none_or(|p| !self.lacks(*p)) && outer < 16.0 * self.scale {
            outer *= 4.0;
            self.factor(outer, &mut []);
        }
        let end = self.points.iter().position(|p| self.lacks(*p)).unwrap_or(self.points.len() - 1);
        (self.points[end.saturating_sub(1)].0, self.points[end].0)
    }

    /// Between two shifts: in steps of size where the sign is settled.
    fn middle(&self, a: f64, b: f64) -> f64 {
        let least = 1e-11 * self.scale;
        if a * b > 0.0 {
            return if b / a > 4.0 || a / b > 4.0 { (a * b).sqrt().copysign(a) } else { 0.5 * (a + b) };
        }
        if a < -2.0 * least {
            -least
        } else if b > 2.0 * least {
            least
        } else {
            0.5 * (a + b)
        }
    }

    /// One eigenvalue more.
    fn find(&mut self) -> Option<()> {
        let mut x: Vec<f64> = (0..self.matrix.order()).map(|_| self.random.random_range(-1.0..1.0)).collect();
        let mut image = vec![0.0; x.len()];
        let mut quotient = f64::NAN;
        for round in 0..ROUNDS {
            let (a, b) = self.bracket();
            let inside = a < quotient && quotient < b;
            let shift = if inside && (round < SLOW || round % 2 == 0) { quotient } else { self.middle(a, b) };
            self.factor(shift, &mut x);
            self.clear(&mut x)?;
            self.matrix.multiply(&x, &mut image);
            quotient = slab::dot(&x, &image);
            slab::add_scaled(&mut image, -quotient, &x);
            // what the vectors found before lack in accuracy is not this one's
            slab::without(&mut image, self.known);
            slab::without(&mut image, &self.vectors);
            let noise = 32.0 * f64::EPSILON * self.scale;
            if slab::norm(&image) <= (RESIDUAL * quotient.abs()).max(noise) {
                self.found.push(quotient);
                self.vectors.push(x);
                return Some(());
            }
        }
        None
    }

    /// A unit vector orthogonal to all that is known and found; nothing if there is no such part.
    fn clear(&self, x: &mut [f64]) -> Option<()> {
        for _ in 0..2 {
            let largest = slab::max_abs(x);
            if !(largest > 0.0 && largest.is_finite()) {
                return None;
            }
            slab::scale(x, 1.0 / largest);
            slab::without(x, self.known);
            slab::without(x, &self.vectors);
            let size = slab::norm(x);
            if size == 0.0 {
                return None;
            }
            slab::scale(x, 1.0 / size);
        }
        Some(())
    }
}
