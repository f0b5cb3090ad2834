//! Block Lanczos on the inverse of a matrix, with full orthogonalisation: blocks of a few vectors, so that degenerate modes are all
//! found, until the wanted vectors are eigenvectors. (G. H. Golub, R. Underwood, Mathematical Software III, 361 (1977),
//! doi:10.1016/B978-0-12-587260-7.50018-2.)

use super::ritz::combination;
use super::{Factors, eigen_symmetric, slab};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Most vectors.
pub(super) const MOST: usize = 160;

/// Which modes are wanted of a matrix without negative directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Modes {
    /// Most of them, the lowest.
    pub count: usize,
    /// But for the first only those with lower eigenvalues.
    pub below: f64,
    /// How sharp their vectors are: |A⁻¹v − θv| in parts of θ.
    pub part: f64,
}

/// The space that the inverse spans from a block, and the inverse within it.
pub(super) struct Krylov<'a> {
    inverse: &'a Factors,
    known: &'a [Vec<f64>],
    block: usize,
    /// What the block is made of first; where that is too few, of anything.
    pub starts: Vec<Vec<f64>>,
    /// How often a vector is made orthogonal to those before it.
    pub passes: usize,
    random: ChaCha8Rng,
    /// Orthonormal.
    basis: Vec<Vec<f64>>,
    /// A⁻¹ of each.
    images: Vec<Vec<f64>>,
    /// basis · images, the lower half, row after row (the inverse is symmetric).
    products: Vec<Vec<f64>>,
}

impl<'a> Krylov<'a> {
    pub fn new(inverse: &'a Factors, known: &'a [Vec<f64>], block: usize) -> Krylov<'a> {
        let (starts, random) = (Vec::new(), ChaCha8Rng::seed_from_u64(0x5eed));
        let (basis, images, products) = (Vec::new(), Vec::new(), Vec::new());
        Krylov { inverse, known, block, starts, passes: 2, random, basis, images, products }
    }

    /// Dimensions of the space that A acts in, known vectors apart.
    fn room(&self) -> usize {
        self.inverse.order() - self.known.len()
    }

    /// Whether there are as many vectors as `most`, or as there can be.
    pub fn is_full(&self, most: usize) -> bool {
        self.basis.len() >= most.min(self.room())
    }

    /// The wanted eigenvectors, those to which the inverse is largest, orthonormal, from about `most` vectors at most; and whether
    /// they are that.
    pub fn largest(&mut self, wanted: Modes, most: usize) -> (Vec<Vec<f64>>, bool) {
        let mut look = wanted.count + 2 * self.block;
        loop {
            let last = !self.grow() || self.is_full(most);
            if last || self.basis.len() >= look {
                if let Some(vectors) = self.settled(wanted, false) {
                    return (vectors, true);
                }
                if last {
                    let all = self.basis.len() == self.room();
                    return (self.settled(wanted, true).unwrap_or_default(), all);
                }
                // looking costs the cube of the size
                look = look * 4 / 3;
            }
        }
    }

    /// One block more; whether there was room.
    pub fn grow(&mut self) -> bool {
        let (old, last) = (self.basis.len(), self.images.len().saturating_sub(self.block));
        let wanted = self.block.min(self.room().saturating_sub(old));
        for k in 0..wanted {
            // the inverse of a block has nothing of the blocks before the last two but rounding
            let (next, recent) = match self.images.get(last + k) {
                Some(image) if old > 0 => (image.clone(), old.saturating_sub(2 * self.block)),
                _ => (self.starts.pop().unwrap_or_else(|| self.anything()), 0),
            };
            if let Some(v) = self.new_direction(next, recent) {
                self.basis.push(v);
            }
        }
        let columns = self.basis.len() - old;
        if columns == 0 {
            return false;
        }
        let mut images = Vec::new();
        slab::interleave(&self.basis[old..], &mut images);
        self.inverse.solve(&mut images, columns);
        for k in old..self.basis.len() {
            let mut image = Vec::new();
            slab::one_of(&images, columns, k - old, &mut image);
            self.products.push(slab::overlaps(&self.basis[..=k], &image));
            self.images.push(image);
        }
        true
    }

    fn anything(&mut self) -> Vec<f64> {
        (0..self.inverse.order()).map(|_| self.random.random_range(-1.0..1.0)).collect()
    }

    /// The part of `v` that is new, or of something random where nothing is; of the basis, `v` has something of the vectors from
    /// `recent` on.
    fn new_direction(&mut self, mut v: Vec<f64>, mut recent: usize) -> Option<Vec<f64>> {
        for _ in 0..4 {
            slab::normalise(&mut v);
            for pass in 0..self.passes {
                let first = if pass + 1 < self.passes { recent } else { 0 };
                for space in [self.known, &self.basis[first..]] {
                    slab::without(&mut v, space);
                }
            }
            let rest = slab::norm(&v);
            if rest > 1e-10 {
                slab::scale(&mut v, 1.0 / rest);
                return Some(v);
            }
            (v, recent) = (self.anything(), 0);
        }
        None
    }

    fn projected(&self) -> Vec<f64> {
        let k = self.basis.len();
        (0..k * k).map(|e| self.products[(e / k).max(e % k)][(e / k).min(e % k)]).collect()
    }

    /// The wanted vectors, orthonormal, if they are eigenvectors, or at `last`.
    fn settled(&self, wanted: Modes, last: bool) -> Option<Vec<Vec<f64>>> {
        let (values, weights) = eigen_symmetric(&self.projected(), self.basis.len());
        let mut vectors = Vec::with_capacity(wanted.count);
        for (theta, w) in values.iter().zip(&weights).rev().take(wanted.count) {
            if !vectors.is_empty() && *theta < 1.0 / wanted.below {
                break;
            }
            let v = combination(w, &self.basis);
            if !last && !self.is_eigenvector(*theta, w, &v, wanted.part) {
                return None;
            }
            vectors.push(v);
        }
        Some(vectors)
    }

    /// The `count` vectors to which the inverse is negative, nearest zero first, if they are eigenvectors to this part of their
    /// values; where none are, the one to which it is largest.
    pub fn negative(&self, count: usize, part: f64) -> Option<Vec<Vec<f64>>> {
        let (values, weights) = eigen_symmetric(&self.projected(), self.basis.len());
        let wanted = if count == 0 { values.len().checked_sub(1)?..values.len() } else { 0..count };
        if wanted.end > values.len() || values[wanted.end - 1] > 0.0 && count > 0 {
            return None;
        }
        let vector = |k: usize| {
            let v = combination(&weights[k], &self.basis);
            self.is_eigenvector(values[k], &weights[k], &v, part).then_some(v)
        };
        wanted.rev().map(vector).collect()
    }

    /// The eigenvalues θ of the inverse that belong to the first `count` vectors of [`largest`](Self::largest), and |A⁻¹v − θv|.
    pub fn residuals(&self, count: usize) -> Vec<(f64, f64)> {
        let (values, weights) = eigen_symmetric(&self.projected(), self.basis.len());
        let rest = |(theta, w): (&f64, &Vec<f64>)| (*theta, self.residual(*theta, w, &combination(w, &self.basis)));
        values.iter().zip(&weights).rev().take(count).map(rest).collect()
    }

    /// Whether v = Σ w_k b_k is an eigenvector of the inverse, to a part of its eigenvalue θ.
    fn is_eigenvector(&self, theta: f64, w: &[f64], v: &[f64], part: f64) -> bool {
        self.residual(theta, w, v) <= part * theta.abs()
    }

    /// |A⁻¹v − θv| of v = Σ w_k b_k.
    fn residual(&self, theta: f64, w: &[f64], v: &[f64]) -> f64 {
        let mut rest = combination(w, &self.images);
        slab::add_scaled(&mut rest, -theta, v);
        slab::without(&mut rest, self.known);
        slab::norm(&rest)
    }
}
