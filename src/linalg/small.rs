//! Dense matrices of a few rows: the Schur complements that stand beside a banded factorisation.

use super::tridiagonal;

/// From this order on, a tridiagonal form pays.
const TRIDIAGONAL: usize = 5;

/// Eigenvalues of a symmetric n × n matrix (row by row), ascending.
pub fn eigenvalues_symmetric(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut values = if n < TRIDIAGONAL { jacobi(matrix, n).0 } else { tridiagonal::eigen(matrix, n, false).0 };
    values.sort_by(f64::total_cmp);
    values
}

/// Eigenvalues (ascending) and orthonormal eigenvectors of a symmetric n × n matrix (row by row); vector k is `.1[k]`.
pub fn eigen_symmetric(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let (values, mut vectors) = if n < TRIDIAGONAL { jacobi(matrix, n) } else { tridiagonal::eigen(matrix, n, true) };
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&i, &j| values[i].total_cmp(&values[j]));
    let sorted = order.iter().map(|&i| std::mem::take(&mut vectors[i])).collect();
    (order.iter().map(|&i| values[i]).collect(), sorted)
}

/// By cyclic rotations, of which each clears one entry.
fn jacobi(matrix: &[f64], n: usize) -> (Vec<f64>, Vec<Vec<f64>>) {
    let mut a = matrix.to_vec();
    let mut v: Vec<f64> = (0..n * n).map(|k| if k / n == k % n { 1.0 } else { 0.0 }).collect();
    let scale: f64 = a.iter().map(|v| v * v).sum();
    for _ in 0..60 {
        let off: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i * n + j] * a[i * n + j]).sum();
        if off <= 1e-34 * scale {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, &mut v, n, p, q);
            }
        }
    }
    let vectors = (0..n).map(|i| (0..n).map(|k| v[k * n + i]).collect()).collect();
    ((0..n).map(|i| a[i * n + i]).collect(), vectors)
}

/// One Jacobi rotation that clears the entry (p, q); the same rotation is applied to the columns of `v`.
fn rotate(a: &mut [f64], v: &mut [f64], n: usize, p: usize, q: usize) {
    let apq = a[p * n + q];
    if apq == 0.0 {
        return;
    }
    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    let t = if theta >= 0.0 { 1.0 } else { -1.0 } / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let turn = |m: &mut [f64], i: usize, j: usize| (m[i], m[j]) = (c * m[i] - s * m[j], s * m[i] + c * m[j]);
    for k in 0..n {
        turn(a, k * n + p, k * n + q);
        turn(v, k * n + p, k * n + q);
    }
    for k in 0..n {
        turn(a, p * n + k, q * n + k);
    }
    // but for rounding, which would be turned about for ever
    (a[p * n + q], a[q * n + p]) = (0.0, 0.0);
}

/// Solves A x = b (A row by row) by Gaussian elimination with partial pivoting; `None` if A is singular.
pub fn solve_dense(matrix: &[f64], b: &[f64], n: usize) -> Option<Vec<f64>> {
    solve_dense_all(matrix, b.to_vec(), n)
}

/// A⁻¹, row after row; `None` if A is singular.
pub fn invert_dense(matrix: &[f64], n: usize) -> Option<Vec<f64>> {
    solve_dense_all(matrix, (0..n * n).map(|k| f64::from(u8::from(k / n == k % n))).collect(), n)
}

/// Solves A X = B, both row by row.
fn solve_dense_all(matrix: &[f64], mut x: Vec<f64>, n: usize) -> Option<Vec<f64>> {
    let mut a = matrix.to_vec();
    let columns = x.len() / n.max(1);
    for j in 0..n {
        let p = (j..n).max_by(|&r, &s| a[r * n + j].abs().total_cmp(&a[s * n + j].abs()))?;
        if a[p * n + j] == 0.0 || !a[p * n + j].is_finite() {
            return None;
        }
        for k in 0..n {
            a.swap(j * n + k, p * n + k);
        }
        for c in 0..columns {
            x.swap(j * columns + c, p * columns + c);
        }
        for i in j + 1..n {
            let l = a[i * n + j] / a[j * n + j];
            for k in j..n {
                a[i * n + k] -= l * a[j * n + k];
            }
            for c in 0..columns {
                x[i * columns + c] -= l * x[j * columns + c];
            }
        }
    }
    for i in (0..n).rev() {
        for c in 0..columns {
            let sum: f64 = (i + 1..n).map(|k| a[i * n + k] * x[k * columns + c]).sum();
            x[i * columns + c] = (x[i * columns + c] - sum) / a[i * n + i];
        }
    }
    Some(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        for n in [1, 2, 7, 40] {
            let a: Vec<f64> = (0..n * n).map(|_| r.random_range(-1.0..1.0)).collect();
            let inverse = invert_dense(&a, n).unwrap();
            for k in 0..n * n {
                let entry: f64 = (0..n).map(|l| a[k / n * n + l] * inverse[l * n + k % n]).sum();
                assert!((entry - f64::from(u8::from(k / n == k % n))).abs() < 1e-10, "{n}: {entry}");
            }
        }
        assert_eq!(invert_dense(&[1.0, 2.0, 2.0, 4.0], 2), None);
    }

    #[test]
    fn eigenvectors_are_orthonormal_and_make_the_matrix_again() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        for n in [1, 2, 4, 5, 6, 13, 40] {
            for degenerate in [false, true] {
                let mut a = vec![0.0; n * n];
                for i in 0..n {
                    for j in 0..=i {
                        let v = if degenerate { f64::from(u8::from(i == j)) } else { r.random_range(-1.0..1.0) };
                        (a[i * n + j], a[j * n + i]) = (v, v);
                    }
                }
                let (values, vectors) = eigen_symmetric(&a, n);
                assert!(values.is_sorted());
                for (l, m) in values.iter().zip(eigenvalues_symmetric(&a, n)) {
                    assert!((l - m).abs() < 1e-13);
                }
                for i in 0..n {
                    for j in 0..n {
                        let product: f64 = (0..n).map(|k| vectors[i][k] * vectors[j][k]).sum();
                        assert!((product - f64::from(u8::from(i == j))).abs() < 1e-13);
                        let entry: f64 = (0..n).map(|k| values[k] * vectors[k][i] * vectors[k][j]).sum();
                        assert!((entry - a[i * n + j]).abs() < 1e-13);
                    }
                }
            }
        }
    }
}
