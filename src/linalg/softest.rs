//! The lowest modes of a matrix without its factors, where something inverts it roughly: a block of vectors, what that makes of their
//! residuals, and the directions in which they moved last; the lowest within the space of all these is the next block (LOBPCG).
//!
//! ```text
//! r = Ax − θx,   w = M⁻¹r,   x ← the lowest Ritz vectors of A in span(x, w, p),   p: what of x came from w and p
//! ```
//! A. V. Knyazev, SIAM J. Sci. Comput. 23, 517 (2001), doi:10.1137/S1064827500366124.

use super::krylov::Inverse;
use super::ritz::{Mode, combination, none_is_missed, rayleigh_ritz};
use super::{Matrix, eigen_symmetric, slab};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

/// Vectors of the block more than there are modes wanted: as many as are often degenerate.
const SPARE: usize = 2;
/// A vector with |Ax − θx| ≤ this part of θ is an eigenvector. A descent begins along one, and what else is in it may grow on the way: a
/// wall that leaves a film may tilt.
const RESIDUAL: f64 = 1e-10;
/// A residual of so many roundings of the matrix's size is as small as it becomes.
const NOISE: f64 = 32.0;
/// Most rounds: modes that are apart take half as many.
const ROUNDS: usize = 48;
/// Vectors of which no more is left beside others than this part depend on them.
const DEPENDENT: f64 = 1e-10;

/// The `count` lowest modes of `matrix` in the space orthogonal to `known` (orthonormal, invariant), ascending, none missed; by what
/// `nearly` makes of residuals, a symmetric positive map. Nothing where they are not found soon, as where many are all but equal. Where it
/// is to `stop`, some vectors, to be thrown away.
pub fn softest(
    matrix: &Matrix,
    count: usize,
    known: &[Vec<f64>],
    nearly: &(dyn Inverse + Sync),
    stop: &dyn Fn() -> bool,
) -> Option<Vec<Mode>> {
    let block = count + SPARE;
    if count == 0 || 4 * block > matrix.order().saturating_sub(known.len()) {
        return None;
    }
    let noise = NOISE * f64::EPSILON * matrix.norm1();
    let mut space = Space { matrix, known, vectors: Vec::new(), images: Vec::new() };
    let mut random = ChaCha8Rng::seed_from_u64(0x50f7);
    for _ in 0..2 * block {
        if space.vectors.len() == block {
            break;
        }
        let mut v: Vec<f64> = (0..matrix.order()).map(|_| random.random_range(-1.0..1.0)).collect();
        nearly.solve(&mut v, 1);
        space.add(v, None);
    }
    if space.vectors.len() < block {
        return None;
    }
    let mut from_x = 0;
    for _ in 0..ROUNDS {
        let moved = space.settle(block, from_x);
        let mut residuals: Vec<Vec<f64>> = Vec::with_capacity(block);
        let mut settled = 0;
        for (k, (x, image)) in space.vectors.iter().zip(&space.images).enumerate() {
            let mut r = image.clone();
            let theta = slab::dot(x, image);
            slab::add_scaled(&mut r, -theta, x);
            slab::without(&mut r, known);
            let is_one = slab::norm(&r) <= (RESIDUAL * theta.abs()).max(noise);
            settled += usize::from(is_one && settled == k);
            residuals.push(r);
        }
        if settled >= count || stop() {
            let modes = rayleigh_ritz(matrix, &space.vectors[..count]);
            return (stop() || none_is_missed(matrix, &modes, known, matrix.norm1())).then_some(modes);
        }
        from_x = block;
        residuals.drain(..settled);
        residuals.par_iter_mut().for_each(|w| nearly.solve(w, 1));
        residuals.into_iter().for_each(|w| space.add(w, None));
        for (p, image) in moved.into_iter().skip(settled) {
            space.add(p, Some(image));
        }
    }
    None
}

/// Orthonormal vectors, and the matrix times each.
struct Space<'a> {
    matrix: &'a Matrix,
    known: &'a [Vec<f64>],
    vectors: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
}

impl Space<'_> {
    /// Takes in what is new of a vector, if there is any, with its image, if that is known.
    fn add(&mut self, mut v: Vec<f64>, mut image: Option<Vec<f64>>) {
        let size = slab::norm(&v);
        if !(size > 0.0 && size.is_finite()) {
            return;
        }
        let scale = |v: &mut Vec<f64>, image: &mut Option<Vec<f64>>, by: f64| {
            slab::scale(v, by);
            image.iter_mut().for_each(|image| slab::scale(image, by));
        };
        scale(&mut v, &mut image, 1.0 / size);
        for _ in 0..2 {
            slab::without(&mut v, self.known);
            let parts: Vec<f64> = slab::overlaps(&self.vectors, &v).iter().map(|o| -o).collect();
            slab::add_all(&mut v, &parts, &self.vectors);
            if let Some(image) = &mut image {
                slab::add_all(image, &parts, &self.images);
            }
            let rest = slab::norm(&v);
            if rest.is_nan() || rest <= DEPENDENT {
                return;
            }
            scale(&mut v, &mut image, 1.0 / rest);
        }
        let image = image.unwrap_or_else(|| {
            let mut image = vec![0.0; v.len()];
            self.matrix.multiply(&v, &mut image);
            image
        });
        self.vectors.push(v);
        self.images.push(image);
    }

    /// Leaves the lowest `block` Ritz vectors; what of each came from the vectors after the first so many, with its image.
    fn settle(&mut self, block: usize, first: usize) -> Vec<(Vec<f64>, Vec<f64>)> {
        let k = self.vectors.len();
        let mut small = vec![0.0; k * k];
        for j in 0..k {
            for (i, v) in slab::overlaps(&self.vectors[..=j], &self.images[j]).into_iter().enumerate() {
                (small[i * k + j], small[j * k + i]) = (v, v);
            }
        }
        let (_, weights) = eigen_symmetric(&small, k);
        let lowest = &weights[..block];
        let combined = |vectors: &[Vec<f64>], from: usize| -> Vec<Vec<f64>> {
            lowest.par_iter().map(|w| combination(&w[from..], &vectors[from..])).collect()
        };
        let moved = if first == 0 || first == k {
            Vec::new()
        } else {
            combined(&self.vectors, first).into_iter().zip(combined(&self.images, first)).collect()
        };
        (self.vectors, self.images) = (combined(&self.vectors, 0), combined(&self.images, 0));
        moved
    }
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
        let nearly: Factors = positive.factor();
        let direct = lowest_modes(&a, 4, &[]);
        for (count, known) in [(1, vec![]), (3, vec![]), (2, vec![direct[0].vector.clone(), direct[1].vector.clone()])]
        {
            let modes = softest(&a, count, &known, &nearly, &|| false).expect("they are found");
            assert_eq!(modes.len(), count);
            for (mode, exact) in modes.iter().zip(&direct[known.len()..]) {
                assert!((mode.value - exact.value).abs() < 1e-10 * exact.value.abs(), "{mode:?}");
                assert!((slab::dot(&mode.vector, &exact.vector) - 1.0).abs() < 1e-8);
            }
        }
    }
}
