//! Dense matrices of a few rows: the Schur complements that stand beside a banded factorisation.

/// Eigenvalues of a symmetric n × n matrix (row by row), ascending, by cyclic Jacobi rotations.
pub fn eigenvalues_symmetric(matrix: &[f64], n: usize) -> Vec<f64> {
    let mut a = matrix.to_vec();
    let scale: f64 = a.iter().map(|v| v * v).sum();
    for _ in 0..60 {
        let off: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| a[i * n + j] * a[i * n + j]).sum();
        if off <= 1e-34 * scale {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(&mut a, n, p, q);
            }
        }
    }
    let mut values: Vec<f64> = (0..n).map(|i| a[i * n + i]).collect();
    values.sort_by(f64::total_cmp);
    values
}

/// One Jacobi rotation that clears the entry (p, q).
fn rotate(a: &mut [f64], n: usize, p: usize, q: usize) {
    let apq = a[p * n + q];
    if apq == 0.0 {
        return;
    }
    let theta = (a[q * n + q] - a[p * n + p]) / (2.0 * apq);
    let t = if theta >= 0.0 { 1.0 } else { -1.0 } / (theta.abs() + (theta * theta + 1.0).sqrt());
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    for k in 0..n {
        let (akp, akq) = (a[k * n + p], a[k * n + q]);
        a[k * n + p] = c * akp - s * akq;
        a[k * n + q] = s * akp + c * akq;
    }
    for k in 0..n {
        let (apk, aqk) = (a[p * n + k], a[q * n + k]);
        a[p * n + k] = c * apk - s * aqk;
        a[q * n + k] = s * apk + c * aqk;
    }
}

/// Solves A x = b (A row by row) by Gaussian elimination with partial pivoting; `None` if A is singular.
pub fn solve_dense(matrix: &[f64], b: &[f64], n: usize) -> Option<Vec<f64>> {
    let mut a = matrix.to_vec();
    let mut x = b.to_vec();
    for j in 0..n {
        let p = (j..n).max_by(|&r, &s| a[r * n + j].abs().total_cmp(&a[s * n + j].abs()))?;
        if a[p * n + j] == 0.0 || !a[p * n + j].is_finite() {
            return None;
        }
        for k in 0..n {
            a.swap(j * n + k, p * n + k);
        }
        x.swap(j, p);
        for i in j + 1..n {
            let l = a[i * n + j] / a[j * n + j];
            for k in j..n {
                a[i * n + k] -= l * a[j * n + k];
            }
            x[i] -= l * x[j];
        }
    }
    for i in (0..n).rev() {
        let sum: f64 = (i + 1..n).map(|k| a[i * n + k] * x[k]).sum();
        x[i] = (x[i] - sum) / a[i * n + i];
    }
    Some(x)
}
