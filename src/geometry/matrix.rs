//! Matrices of three rows: orthogonal ones are rotations (determinant 1) and reflections (−1).

use super::vector::{Vector, dot, scale};

/// A 3 × 3 matrix, row by row.
pub type Matrix = [Vector; 3];

/// 1.
pub const UNIT: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// A v.
#[inline]
pub fn times(a: &Matrix, v: Vector) -> Vector {
    a.map(|row| dot(row, v))
}

/// A B.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    let columns = transposed(b);
    a.map(|row| columns.map(|column| dot(row, column)))
}

/// Aᵀ.
pub fn transposed(a: &Matrix) -> Matrix {
    [0, 1, 2].map(|c| a.map(|row| row[c]))
}

/// −A.
pub fn opposite(a: &Matrix) -> Matrix {
    a.map(|row| scale(-1.0, row))
}

/// det A.
pub fn determinant([a, b, c]: &Matrix) -> f64 {
    dot(*a, super::vector::cross(*b, *c))
}

/// The largest difference of two entries.
pub fn apart(a: &Matrix, b: &Matrix) -> f64 {
    a.iter().flatten().zip(b.iter().flatten()).fold(0.0, |most, (x, y)| f64::max(most, (x - y).abs()))
}
