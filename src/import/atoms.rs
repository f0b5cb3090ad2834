//! Which atom stands where.

use crate::geometry::matrix::{Matrix, determinant, times};
use crate::geometry::{Vector, vector};
use crate::lattice::Shift;

/// Σ f_k a_k.
pub fn place(vectors: &Matrix, f: Vector) -> Vector {
    let [a, b, c] = *vectors;
    vector::add(vector::scale(f[0], a), vector::add(vector::scale(f[1], b), vector::scale(f[2], c)))
}

/// The reciprocal vectors without 2π, a_j·b_k = δ_jk: b₁ = (a₂ × a₃)/det. The vectors span a cell.
pub fn reciprocal(vectors: &Matrix) -> Matrix {
    let [a, b, c] = *vectors;
    let volume = determinant(vectors);
    [vector::cross(b, c), vector::cross(c, a), vector::cross(a, b)].map(|normal| vector::scale(1.0 / volume, normal))
}

/// The f of Σ f_k a_k = r.
pub fn coordinates(vectors: &Matrix, r: Vector) -> Vector {
    times(&reciprocal(vectors), r)
}

/// The atom at r, within `tolerance` in the unit of the vectors, and how many cells on: the nearest one.
pub fn atom_at(vectors: &Matrix, atoms: &[Vector], r: Vector, tolerance: f64) -> Option<(usize, Shift)> {
    let f = coordinates(vectors, r);
    let near = atoms.iter().enumerate().map(|(k, at)| {
        let off = vector::sub(f, *at);
        let cell = off.map(f64::round);
        let distance = vector::norm(place(vectors, vector::sub(off, cell)));
        (distance, k, cell.map(|c| c as isize))
    });
    let nearest = near.min_by(|a, b| a.0.total_cmp(&b.0))?;
    // so far away numbers have no place in a cell left
    let near_enough = nearest.0 <= tolerance && nearest.2.iter().all(|cell| cell.unsigned_abs() < 1 << 24);
    near_enough.then_some((nearest.1, nearest.2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_atom_is_found_in_whatever_cell_it_stands() {
        let vectors = [[1.0, 0.0, 0.0], [0.5, 0.9, 0.0], [0.1, 0.0, 1.2]];
        let atoms = [[0.0; 3], [0.25, 0.5, 0.5]];
        let r = place(&vectors, [-2.0 + 0.25, 3.5, 0.5 + 1.0]);
        assert_eq!(atom_at(&vectors, &atoms, r, 1e-9), Some((1, [-2, 3, 1])));
        assert_eq!(atom_at(&vectors, &atoms, [0.4, 0.1, 0.0], 1e-3), None);
    }
}
