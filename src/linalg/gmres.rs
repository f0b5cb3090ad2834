//! Linear equations whose matrix is known by its products alone and is not symmetric: generalised minimal residuals, without restarts.
//! (Y. Saad, M. H. Schultz, SIAM J. Sci. Stat. Comput. 7, 856 (1986), doi:10.1137/0907058.)

use super::slab;

/// x with |A x − b| ≤ `part`·|b|, from products with A; nothing where `most` of them are not enough, or one says so by giving nothing.
pub fn gmres(multiply: impl Fn(&[f64]) -> Option<Vec<f64>>, b: &[f64], part: f64, most: usize) -> Option<Vec<f64>> {
    let size = slab::norm(b);
    if size == 0.0 {
        return Some(vec![0.0; b.len()]);
    }
    let mut basis = vec![b.iter().map(|v| v / size).collect::<Vec<f64>>()];
    // A · basis = basis · Hessenberg, whose columns are turned to a triangle as they come
    let (mut columns, mut turns, mut rest) = (Vec::<Vec<f64>>::new(), Vec::<[f64; 2]>::new(), vec![size]);
    while columns.len() < most.min(b.len()) {
        let mut next = multiply(&basis[columns.len()])?;
        let mut column = vec![0.0; basis.len()];
        // once more, for what rounding left
        for _ in 0..2 {
            let parts = slab::without(&mut next, &basis);
            slab::add_scaled(&mut column, 1.0, &parts);
        }
        let beyond = slab::norm(&next);
        for (k, [c, s]) in turns.iter().enumerate() {
            (column[k], column[k + 1]) = (c * column[k] + s * column[k + 1], c * column[k + 1] - s * column[k]);
        }
        let last = column.len() - 1;
        let radius = column[last].hypot(beyond);
        if radius == 0.0 || !radius.is_finite() {
            return None;
        }
        let [c, s] = [column[last] / radius, beyond / radius];
        column[last] = radius;
        rest.push(-s * rest[last]);
        rest[last] *= c;
        turns.push([c, s]);
        columns.push(column);
        if rest[last + 1].abs() <= part * size {
            return Some(combined(&basis, &columns, rest));
        }
        slab::scale(&mut next, 1.0 / beyond);
        basis.push(next);
    }
    None
}

/// basis · y of the triangle's solution y.
fn combined(basis: &[Vec<f64>], columns: &[Vec<f64>], mut y: Vec<f64>) -> Vec<f64> {
    y.truncate(columns.len());
    for k in (0..y.len()).rev() {
        y[k] /= columns[k][k];
        let solved = y[k];
        y[..k].iter_mut().zip(&columns[k]).for_each(|(left, entry)| *left -= solved * entry);
    }
    let mut x = vec![0.0; basis[0].len()];
    slab::add_all(&mut x, &y, &basis[..y.len()]);
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn solutions_agree_with_dense_arithmetic_and_few_products_are_not_enough() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(7);
        for n in [1, 2, 9, 40] {
            let a: Vec<f64> = (0..n * n).map(|_| r.random_range(-1.0..1.0)).collect();
            let b: Vec<f64> = (0..n).map(|_| r.random_range(-1.0..1.0)).collect();
            let product = |x: &[f64]| Some(a.chunks(n).map(|row| slab::dot(row, x)).collect());
            let x = gmres(product, &b, 1e-13, n).unwrap();
            let expected = solve_dense(&a, &b, n).unwrap();
            let size = expected.iter().fold(1.0f64, |m, v| m.max(v.abs()));
            assert!(x.iter().zip(&expected).all(|(p, q)| (p - q).abs() < 1e-9 * size), "{n}");
            assert_eq!(gmres(product, &b, 1e-13, n / 2), None);
            assert_eq!(gmres(|_| None, &b, 1e-13, n), None);
            assert_eq!(gmres(product, &vec![0.0; n], 1e-13, n), Some(vec![0.0; n]));
        }
    }
}
