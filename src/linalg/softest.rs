//! The lowest modes of a matrix without its factors, where something inverts it roughly: a block of vectors, what that makes of their
//! residuals, and the directions in which they moved last; the lowest within the space of all these is the next block (LOBPCG).
//!
//! ```text
//! r = Ax − θx,   w ≈ (A − θ)⁻¹r,   x ← the lowest Ritz vectors of A in span(x, w, p),   p: what of x came from w and p
//! ```
//! A. V. Knyazev, SIAM J. Sci. Comput. 23, 517 (2001), doi:10.1137/S1064827500366124.

use super::ritz::{Mode, none_is_missed, rayleigh_ritz};
use super::{Matrix, blocks, eigen_symmetric, slab};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Vectors of the block more than there are modes wanted: as many as are often degenerate. As many more as are wanted each time
/// that so many rounds have not done: spin waves of a wide film are alike in eights.
const SPARE: usize = 2;
const PATIENCE: usize = 12;
/// Most rounds.
const ROUNDS: usize = 48;
/// So many times as many where there are no factors.
const LONGER: usize = 6;
/// A vector with |Ax − θx| ≤ this part of θ is an eigenvector. A descent begins along one, and what else is in it may grow on the way: a
/// wall that leaves a film may tilt.
const SHARP: f64 = 1e-10;
/// An eigenvalue as exact as this part of it, where no more is wanted: |Ax − θx|² over the distance to the others is its error.
const EXACT: f64 = 1e-12;
const ROUGH: f64 = 1e-3;
/// A residual of so many roundings of the matrix's size is as small as it becomes.
const NOISE: f64 = 32.0;
/// Vectors of which no more is left beside others than this part depend on them.
const DEPENDENT: f64 = 1e-10;
/// Those of which more than this part is left beside others are orthogonal to these to rounding.
const LEFT: f64 = 0.1;

/// What of modes is wanted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wanted {
    /// Their vectors.
    Vectors,
    /// Their eigenvalues alone.
    Values,
    /// How large these are.
    Size,
}

impl Wanted {
    /// The part of an eigenvalue by which it may be wrong.
    pub(super) fn part(self) -> f64 {
        match self {
            Wanted::Vectors => 0.0,
            Wanted::Values => EXACT,
            Wanted::Size => ROUGH,
        }
    }
}

/// What is known before, and what is done for it.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// What is wanted.
    pub wanted: Wanted,
    /// Vectors of some of the lowest modes, perhaps roughly.
    pub given: &'a [Vec<f64>],
    /// Whether factors may tell that no mode is missed, and take over where the modes are not found soon.
    pub by_factors: bool,
}

/// The `count` lowest modes of `matrix` in the space orthogonal to `known` (orthonormal, invariant), ascending, none missed; by what
/// `nearly` makes of a residual and its θ, a symmetric positive map. The vectors of some may be given. Nothing where they are not found
/// soon. Where it is to `stop`, some vectors, to be thrown away.
pub fn softest(
    matrix: &Matrix,
    count: usize,
    known: &[Vec<f64>],
    Asked { wanted, given, by_factors }: Asked,
    nearly: &(dyn Fn(&mut [f64], f64) + Sync),
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Mode>> {
    let mut block = count + SPARE;
    if count == 0 || 4 * block > matrix.order().saturating_sub(known.len()) {
        return None;
    }
    let noise = NOISE * f64::EPSILON * matrix.norm1();
    let mut space =
        Space { matrix, known, vectors: Vec::new(), images: Vec::new(), small: Vec::new(), room: Vec::new() };
    let mut random = ChaCha8Rng::seed_from_u64(0x50f7);
    space.add(given.iter().take(count).cloned().collect());
    for _ in 0..2 {
        let missing = block - space.vectors.len();
        let mut start: Vec<Vec<f64>> =
            (0..missing).map(|_| (0..matrix.order()).map(|_| random.random_range(-1.0..1.0)).collect()).collect();
        start.par_iter_mut().for_each(|v| nearly(v, 0.0));
        space.add(start);
    }
    if space.vectors.len() < block {
        return None;
    }
    let mut settled = 0;
    for round in 0..if by_factors { ROUNDS } else { LONGER * ROUNDS } {
        let before = block;
        block = (count * (1 + round.min(ROUNDS - 1) / PATIENCE) + SPARE).min(space.vectors.len());
        space.settle(block, if round == 0 { None } else { Some((before, settled)) });
        let mut residuals = space.residuals(block);
        let highest = residuals.last().map_or(0.0, |(_, theta)| *theta);
        let is_sharp = |(r, theta): &(Vec<f64>, f64)| {
            let (r, size) = (slab::norm(r), theta.abs());
            let by_value = r * r <= wanted.part() * size * (highest - theta);
            by_value || r <= (SHARP * size).max(noise)
        };
        settled = residuals.iter().take_while(|r| is_sharp(r)).count();
        if settled >= count || stop() {
            let modes = rayleigh_ritz(matrix, &space.vectors[..count]);
            let complete = stop() || !by_factors || none_is_missed(matrix, &modes, known, matrix.norm1());
            return complete.then_some(modes);
        }
        residuals.drain(..settled);
        residuals.par_iter_mut().for_each(|(r, theta)| nearly(r, *theta));
        space.add(residuals.into_iter().map(|(w, _)| w).collect());
    }
    None
}

/// Orthonormal vectors, and the matrix times each.
struct Space<'a> {
    matrix: &'a Matrix,
    known: &'a [Vec<f64>],
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    /// The matrix within the space, row by row.
    small: Vec<f64>,
    /// Vectors that are done with.
    room: Vec<Vec<f64>>,
}

impl Space<'_> {
    /// Takes in what is new of some vectors, if there is any.
    fn add(&mut self, mut new: Vec<Vec<f64>>) {
        new.retain_mut(|v| has_become_unit(v));
        blocks::without(&mut new, self.known);
        blocks::without(&mut new, &self.vectors);
        let before = self.vectors.len();
        for mut v in new {
            slab::without(&mut v, &self.vectors[before..]);
            let rest = slab::norm(&v);
            if rest > DEPENDENT && (rest > LEFT || self.leaves_anything_of(&mut v)) {
                let rest = slab::norm(&v);
                slab::scale(&mut v, 1.0 / rest);
                self.vectors.push(v);
            }
        }
        let length = self.matrix.order();
        self.images.extend((before..self.vectors.len()).map(|_| self.room.pop().unwrap_or_else(|| vec![0.0; length])));
        let (vectors, images) = (&self.vectors[before..], &mut self.images[before..]);
        vectors.par_iter().zip(images).for_each(|(v, image)| self.matrix.multiply(v, image));
        self.extend(before);
    }

    /// Whether anything is left of a vector beside the others, which is left of it then: all but rounding.
    fn leaves_anything_of(&self, v: &mut [f64]) -> bool {
        for _ in 0..2 {
            if !has_become_unit(v) {
                return false;
            }
            slab::without(v, self.known);
            slab::without(v, &self.vectors);
            let rest = slab::norm(v);
            if rest.is_nan() || rest <= DEPENDENT {
                return false;
            }
        }
        true
    }

    /// The rows and columns of the vectors from `before` on.
    fn extend(&mut self, before: usize) {
        let (k, new) = (self.vectors.len(), self.vectors.len() - before);
        let mut small = vec![0.0; k * k];
        for i in 0..before {
            small[i * k..i * k + before].copy_from_slice(&self.small[i * before..(i + 1) * before]);
        }
        for (at, v) in blocks::products(&self.vectors, &self.images[before..]).into_iter().enumerate() {
            let (i, j) = (at / new, before + at % new);
            if i <= j {
                (small[i * k + j], small[j * k + i]) = (v, v);
            }
        }
        self.small = small;
    }

    /// Ax − θx of the first so many, without what is known, and θ.
    fn residuals(&mut self, block: usize) -> Vec<(Vec<f64>, f64)> {
        // in the memory of vectors that are done with, of which there would be more with every round
        let room: Vec<Vec<f64>> = (0..block).map(|_| self.room.pop().unwrap_or_default()).collect();
        let residual = |((x, image), mut r): ((&Vec<f64>, &Vec<f64>), Vec<f64>)| {
            r.clone_from(image);
            let theta = slab::dot(x, image);
            slab::add_scaled(&mut r, -theta, x);
            slab::without(&mut r, self.known);
            (r, theta)
        };
        self.vectors[..block].par_iter().zip(&self.images[..block]).zip(room).map(residual).collect()
    }

    /// Leaves the lowest `block` Ritz vectors, and behind them, orthogonal to them all, the directions in which they moved: what came
    /// from the vectors after the first `from`, of all but the first `still`. All combinations are of small vectors, of weights.
    fn settle(&mut self, block: usize, moved: Option<(usize, usize)>) {
        let k = self.vectors.len();
        let (_, mut weights) = eigen_symmetric(&self.small, k);
        weights.truncate(block);
        if let Some((from, still)) = moved {
            for j in still..block {
                let mut p = weights[j].clone();
                p[..from].fill(0.0);
                for _ in 0..2 {
                    slab::without(&mut p, &weights);
                    let rest = slab::norm(&p);
                    slab::scale(&mut p, if rest > DEPENDENT { 1.0 / rest } else { 0.0 });
                }
                if slab::norm(&p) > LEFT {
                    weights.push(p);
                }
            }
        }
        self.small = within(&self.small, &weights);
        for vectors in [&mut self.vectors, &mut self.images] {
            let mut combined: Vec<Vec<f64>> =
                weights.iter().map(|_| self.room.pop().unwrap_or_else(|| vec![0.0; vectors[0].len()])).collect();
            blocks::combine(&mut combined, &weights, vectors);
            self.room.append(vectors);
            *vectors = combined;
        }
    }
}

/// Whether a vector has a direction; its length is 1 then.
fn has_become_unit(v: &mut [f64]) -> bool {
    let size = slab::norm(v);
    slab::scale(v, 1.0 / size);
    size > 0.0 && size.is_finite()
}

/// wᵢᵀ S wⱼ, row by row.
fn within(s: &[f64], weights: &[Vec<f64>]) -> Vec<f64> {
    let images: Vec<Vec<f64>> =
        weights.iter().map(|w| s.chunks(w.len()).map(|row| slab::dot(row, w)).collect()).collect();
    weights.iter().flat_map(|w| images.iter().map(|image| slab::dot(w, image))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::sparse::samples::Lattice;
    use crate::linalg::{Factors, lowest_modes};

    #[test]
    fn modes_found_without_factors_are_those_found_with_them() {
        let mut r = ChaCha8Rng::seed_from_u64(21);
        let lattice = Lattice::grid([14, 12, 1], [true, false, false], 1.0, &mut r);
        let mut sparse = lattice.random(&mut r);
        sparse.shift(6.0);
        let a = Matrix::Sparse(sparse);
        let mut positive = a.clone();
        positive.shift(0.3 * a.norm1());
        let factors: Factors = positive.factor();
        let nearly = |x: &mut [f64], _: f64| factors.solve(x, 1);
        let direct = lowest_modes(&a, 4, &[]);
        for (count, known) in [(1, vec![]), (3, vec![]), (2, vec![direct[0].vector.clone(), direct[1].vector.clone()])]
        {
            let asked = Asked { wanted: Wanted::Vectors, given: &[], by_factors: true };
            let modes = softest(&a, count, &known, asked, &nearly, &|| false).expect("they are found");
            assert_eq!(modes.len(), count);
            for (mode, exact) in modes.iter().zip(&direct[known.len()..]) {
                assert!((mode.value - exact.value).abs() < 1e-10 * exact.value.abs(), "{mode:?}");
                assert!((slab::dot(&mode.vector, &exact.vector) - 1.0).abs() < 1e-8);
            }
        }
    }
}
