//! Eigenvalues of a dense symmetric matrix through its tridiagonal form: Householder reflections, then implicit QL steps.
//!
//! Golub, Van Loan, "Matrix Computations", 4th ed., Johns Hopkins 2013, §§8.3.1–8.3.4.

use super::slab;

/// Most QL steps for one eigenvalue.
const STEPS: usize = 60;

/// Eigenvalues of a symmetric n × n matrix (row by row), in no order, and, if wanted, the unit eigenvector of each.
pub fn eigen(matrix: &[f64], n: usize, vectors: bool) -> (Vec<f64>, Vec<Vec<f64>>) {
    let unit = |i: usize| (0..n).map(|k| f64::from(u8::from(i == k))).collect();
    let mut rows: Vec<Vec<f64>> = if vectors { (0..n).map(unit).collect() } else { Vec::new() };
    // of ordinary size, so that no square over- or underflows
    let size = slab::max_abs(matrix).max(f64::MIN_POSITIVE);
    let scaled: Vec<f64> = matrix.iter().map(|a| a / size).collect();
    let (mut diagonal, mut beside) = reduce(scaled, n, &mut rows);
    for first in 0..n {
        for _ in 0..STEPS {
            let last = (first..n - 1).find(|&k| small(&diagonal, &beside, k)).unwrap_or(n - 1);
            if last == first {
                break;
            }
            ql_step(&mut diagonal, &mut beside, first, last, &mut rows);
        }
    }
    slab::scale(&mut diagonal, size);
    (diagonal, rows)
}

/// Whether the entry beside diagonal k is nothing.
fn small(diagonal: &[f64], beside: &[f64], k: usize) -> bool {
    beside[k].abs() <= 0.5 * f64::EPSILON * (diagonal[k].abs() + diagonal[k + 1].abs())
}

/// The diagonal and the entries beside it of Qᵀ A Q; the reflections are applied to `rows`.
fn reduce(mut a: Vec<f64>, n: usize, rows: &mut [Vec<f64>]) -> (Vec<f64>, Vec<f64>) {
    let (mut v, mut p) = (vec![0.0; n], vec![0.0; n]);
    for k in 0..n.saturating_sub(2) {
        let column = k + 1..n;
        v.fill(0.0);
        column.clone().for_each(|i| v[i] = a[i * n + k]);
        let size = slab::norm(&v);
        if size == 0.0 {
            continue;
        }
        v[k + 1] += size.copysign(v[k + 1]);
        let squared = slab::dot(&v, &v);
        // A ← (1 − 2vvᵀ/v²) A (1 − 2vvᵀ/v²) = A − v wᵀ − w vᵀ,  w = p − (p·v/v²) v,  p = 2 A v/v²
        for i in k..n {
            p[i] = 2.0 * slab::dot(&a[i * n + k..(i + 1) * n], &v[k..]) / squared;
        }
        let half = slab::dot(&p[k..], &v[k..]) / squared;
        column.clone().for_each(|i| p[i] -= half * v[i]);
        for i in k..n {
            let row = &mut a[i * n + k..(i + 1) * n];
            for ((entry, p_j), v_j) in row.iter_mut().zip(&p[k..]).zip(&v[k..]) {
                *entry -= v[i] * p_j + p[i] * v_j;
            }
        }
        reflect(rows, &v, squared, k + 1);
    }
    let diagonal = (0..n).map(|i| a[i * n + i]).collect();
    let beside = (0..n).map(|i| if i + 1 < n { a[(i + 1) * n + i] } else { 0.0 }).collect();
    (diagonal, beside)
}

/// rows ← (1 − 2vvᵀ/v²) rows, v nothing before `first`.
fn reflect(rows: &mut [Vec<f64>], v: &[f64], squared: f64, first: usize) {
    if rows.is_empty() {
        return;
    }
    let mut mix = vec![0.0; v.len()];
    for (row, weight) in rows.iter().zip(v).skip(first) {
        slab::add_scaled(&mut mix, 2.0 * weight / squared, row);
    }
    for (row, weight) in rows.iter_mut().zip(v).skip(first) {
        slab::add_scaled(row, -weight, &mix);
    }
}

/// One implicit QL step with Wilkinson's shift on the block first … last.
fn ql_step(d: &mut [f64], e: &mut [f64], first: usize, last: usize, rows: &mut [Vec<f64>]) {
    let slope = (d[first + 1] - d[first]) / (2.0 * e[first]);
    let shift = d[first] - e[first] / (slope + (slope * slope + 1.0).sqrt().copysign(slope));
    let (mut sine, mut cosine, mut carried) = (1.0, 1.0, 0.0);
    let mut g = d[last] - shift;
    for i in (first..last).rev() {
        let (f, b) = (sine * e[i], cosine * e[i]);
        let r = (f * f + g * g).sqrt();
        e[i + 1] = r;
        if r == 0.0 {
            d[i + 1] -= carried;
            e[last] = 0.0;
            return;
        }
        (sine, cosine) = (f / r, g / r);
        g = d[i + 1] - carried;
        let t = (d[i] - g) * sine + 2.0 * cosine * b;
        carried = sine * t;
        d[i + 1] = g + carried;
        g = cosine * t - b;
        if let Some([low, high]) = rows.get_mut(i..i + 2) {
            for (x, y) in low.iter_mut().zip(high) {
                (*x, *y) = (cosine * *x - sine * *y, sine * *x + cosine * *y);
            }
        }
    }
    d[first] -= carried;
    e[first] = g;
    e[last] = 0.0;
}
