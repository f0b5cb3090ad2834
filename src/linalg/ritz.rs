//! Modes of a matrix, and those within a space (Rayleigh, Ritz).

use super::{Matrix, eigen_symmetric, slab};

/// An eigenvalue as much lower as this part of the matrix's size is another.
pub(super) const APART: f64 = 1e-10;

/// An eigenvalue with its unit eigenvector.
#[derive(Clone, Debug)]
pub struct Mode {
    /// Eigenvalue.
    pub value: f64,
    /// Unit eigenvector.
    pub vector: Vec<f64>,
}

/// The eigenvalues of `matrix` within the span of orthonormal vectors, ascending, with their vectors, whose largest component
/// is positive.
pub fn rayleigh_ritz(matrix: &Matrix, space: &[Vec<f64>]) -> Vec<Mode> {
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
    let mode = |(value, weights): (f64, &Vec<f64>)| {
        let mut vector = combination(weights, space);
        let largest = vector.iter().fold(0.0f64, |m, x| if x.abs() > m.abs() { *x } else { m });
        slab::scale(&mut vector, 1f64.copysign(largest));
        Mode { value, vector }
    };
    values.into_iter().zip(&vectors).map(mode).collect()
}

/// Σ w_k v_k.
pub fn combination(weights: &[f64], vectors: &[Vec<f64>]) -> Vec<f64> {
    let mut v = vec![0.0; vectors[0].len()];
    slab::add_all(&mut v, weights, vectors);
    v
}

/// Whether no eigenvalue below the last of these modes was left out.
pub(super) fn none_is_missed(matrix: &Matrix, modes: &[Mode], known: &[Vec<f64>], scale: f64) -> bool {
    let Some(last) = modes.last().filter(|_| modes.len() > 1) else { return true };
    let below = last.value - APART * scale;
    let mut shifted = matrix.clone();
    shifted.shift(-below);
    let counted = rayleigh_ritz(matrix, known).iter().chain(modes).filter(|mode| mode.value < below).count();
    shifted.factor().negatives() <= counted
}
