//! The lowest eigenvalues of a banded matrix: a shift from the inertia, then inverse subspace iteration.

use super::{Banded, eigen_symmetric, slab};
use rand::{RngExt, SeedableRng};

/// Extra vectors that speed the iteration up.
const GUARD: usize = 4;
/// Most iterations.
const ROUNDS: usize = 60;

/// An eigenvalue with its unit eigenvector.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Eigenvalue.
    pub value: f64,
    /// Unit eigenvector.
    pub vector: Vec<f64>,
}

/// The `count` lowest modes of `matrix` in the space orthogonal to `known` (orthonormal vectors, invariant under it),
/// ascending. Fewer where the space is smaller. Deterministic.
pub fn lowest_modes(matrix: &Banded, count: usize, known: &[Vec<f64>]) -> Vec<Mode> {
    let n = matrix.order();
    let size = (count + GUARD).min(n.saturating_sub(known.len()));
    if size == 0 {
        return Vec::new();
    }
    let scale = matrix.norm1().max(1e-280);
    let mut shifted = matrix.clone();
    shifted.shift(shift_below(matrix, scale));
    let factors = shifted.factor();
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(0x5eed);
    let mut space: Vec<Vec<f64>> =
        (0..size).map(|_| (0..n).map(|_| random.random_range(-1.0..1.0)).collect()).collect();
    let mut modes: Vec<Mode> = Vec::new();
    for _ in 0..ROUNDS {
        for v in &mut space {
            factors.solve(v, 1);
        }
        orthonormalise(&mut space, known);
        let before: Vec<f64> = modes.iter().map(|m| m.value).collect();
        modes = rayleigh_ritz(matrix, &space);
        space = modes.iter().map(|m| m.vector.clone()).collect();
        let wanted = count.min(modes.len());
        let settled = before.len() == modes.len()
            && (0..wanted).all(|k| (modes[k].value - before[k]).abs() <= 1e-13 * scale + 1e-10 * before[k].abs());
        if settled {
            break;
        }
    }
    modes.truncate(count);
    modes
}

/// s with A + s·1 positive definite, or nearly so: twice the size of the most negative eigenvalue, from the inertia.
fn shift_below(matrix: &Banded, scale: f64) -> f64 {
    let positive = |s: f64| {
        let mut a = matrix.clone();
        a.shift(s);
        a.factor().negatives() == 0
    };
    let mut s = 1e-11 * scale;
    while !positive(s) && s < 4.0 * scale {
        s *= 4.0;
    }
    s
}

fn orthonormalise(space: &mut Vec<Vec<f64>>, known: &[Vec<f64>]) {
    let mut done: Vec<Vec<f64>> = Vec::with_capacity(space.len());
    for mut v in space.drain(..) {
        let size = slab::norm(&v);
        slab::scale(&mut v, 1.0 / size.max(f64::MIN_POSITIVE));
        for _ in 0..2 {
            for b in known.iter().chain(&done) {
                let overlap = slab::dot(b, &v);
                slab::add_scaled(&mut v, -overlap, b);
            }
        }
        let rest = slab::norm(&v);
        if rest > 1e-10 {
            slab::scale(&mut v, 1.0 / rest);
            done.push(v);
        }
    }
    *space = done;
}

/// The eigenvalues of `matrix` within the span of orthonormal vectors, ascending, with their vectors.
pub fn rayleigh_ritz(matrix: &Banded, space: &[Vec<f64>]) -> Vec<Mode> {
    let (n, k) = (matrix.order(), space.len());
    let images: Vec<Vec<f64>> = space
        .iter()
        .map(|v| {
            let mut y = vec![0.0; n];
            matrix.multiply(v, &mut y);
            y
        })
        .collect();
    let mut small = vec![0.0; k * k];
    for i in 0..k {
        for j in 0..=i {
            let v = 0.5 * (slab::dot(&space[i], &images[j]) + slab::dot(&space[j], &images[i]));
            (small[i * k + j], small[j * k + i]) = (v, v);
        }
    }
    let (values, vectors) = eigen_symmetric(&small, k);
    let lift = |weights: &Vec<f64>| {
        let mut v = vec![0.0; n];
        for (w, s) in weights.iter().zip(space) {
            slab::add_scaled(&mut v, *w, s);
        }
        v
    };
    values.into_iter().zip(&vectors).map(|(value, w)| Mode { value, vector: lift(w) }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_modes_of_a_vibrating_string_are_found_with_and_without_a_known_one() {
        let n = 200;
        let mut a = Banded::zeros(n, 1, 0);
        for i in 0..n {
            a.add(i, i, 2.0);
            if i > 0 {
                a.add(i, i - 1, -1.0);
            }
        }
        a.shift(-0.01);
        let exact = |k: usize| 2.0 - 2.0 * libm::cos(k as f64 * std::f64::consts::PI / (n as f64 + 1.0)) - 0.01;
        let modes = lowest_modes(&a, 6, &[]);
        for (k, m) in modes.iter().enumerate() {
            assert!((m.value - exact(k + 1)).abs() < 1e-10, "{k}: {} {}", m.value, exact(k + 1));
        }
        let rest = lowest_modes(&a, 2, &[modes[0].vector.clone()]);
        assert!((rest[0].value - exact(2)).abs() < 1e-10);
    }

    #[test]
    fn a_matrix_of_one_unknown_has_one_mode() {
        let mut a = Banded::zeros(1, 0, 0);
        a.add(0, 0, -3.0);
        let modes = lowest_modes(&a, 4, &[]);
        assert_eq!(modes.len(), 1);
        assert_eq!(modes[0].value, -3.0);
    }
}
