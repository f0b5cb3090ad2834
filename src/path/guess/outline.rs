//! Edges and corners of a lattice: where fronts enter.
//!
//! A box of cells has two edges (faces) along each open direction and a corner wherever these meet. A lattice with sites left out, or
//! of the atoms of one cell, has one of each every 30° around, in three dimensions one in each of the 26 directions to the faces, edges
//! and corners of a cube.

use crate::geometry::{Vector, vector};
use crate::lattice::Lattice;
use std::f64::consts::TAU;

/// Edges of a film of any shape.
const AROUND: usize = 12;

/// Edges and corners.
pub(super) struct Outline {
    /// Unit normals of the edges, outwards.
    pub(super) edges: Vec<Vector>,
    /// Sites at the corners.
    pub(super) corners: Vec<usize>,
}

impl Outline {
    /// Of a lattice; without edges where all its directions are periodic.
    pub(super) fn of(lattice: &Lattice) -> Outline {
        let cells = lattice.cell_vectors();
        let extents = lattice.extents();
        let extended: Vec<usize> = (0..3).filter(|d| extents[*d]).collect();
        let open: Vec<usize> = extended.iter().copied().filter(|d| !lattice.grid.periodic[*d]).collect();
        let normal = |d: usize| {
            let others: Vec<Vector> = extended.iter().filter(|k| **k != d).map(|k| cells[*k]).collect();
            let across = orthonormal(&others).iter().fold(cells[d], |v, e| vector::normal_part(v, *e));
            vector::unit_or(across, cells[d])
        };
        let normals: Vec<Vector> = open.iter().map(|d| normal(*d)).collect();
        let both = |n: &Vector| [vector::scale(-1.0, *n), *n];
        // atoms of a single cell may have any shape
        let of_a_box = lattice.slots.are_all() && extended.iter().all(|d| lattice.grid.extends(*d));
        let edges: Vec<Vector> = match of_a_box || open.len() != extended.len() || open.len() < 2 {
            true => normals.iter().flat_map(both).collect(),
            false => all_around(&orthonormal(&open.iter().map(|d| cells[*d]).collect::<Vec<_>>())),
        };
        let towards: Vec<Vector> = match of_a_box || open.len() != extended.len() {
            true => signs(normals.len()).map(|signs| weighted(&normals, &signs, lattice)).collect(),
            false => edges.clone(),
        };
        let mut corners: Vec<usize> = Vec::new();
        for corner in towards.iter().filter(|v| vector::norm(**v) > 0.0).map(|v| furthest(lattice, *v)) {
            if !corners.contains(&corner) {
                corners.push(corner);
            }
        }
        Outline { edges, corners }
    }
}

/// Vectors made normal to each other and of unit length; those that depend on the ones before left out.
pub(super) fn orthonormal(vectors: &[Vector]) -> Vec<Vector> {
    let mut found: Vec<Vector> = Vec::new();
    for v in vectors {
        let across = found.iter().fold(*v, |v, e| vector::normal_part(v, *e));
        if vector::norm(across) > 1e-6 * vector::norm(*v) {
            found.extend(vector::unit(across));
        }
    }
    found
}

/// Directions all around, in the plane of two axes or in space.
fn all_around(axes: &[Vector]) -> Vec<Vector> {
    if let [x, y] = axes {
        let at = |k: usize| {
            let (sin, cos) = libm::sincos(TAU * k as f64 / AROUND as f64);
            vector::add(vector::scale(cos, *x), vector::scale(sin, *y))
        };
        return (0..AROUND).map(at).collect();
    }
    let step = |k: usize, d: u32| (k / 3usize.pow(d) % 3) as f64 - 1.0;
    let all =
        (0..27).map(|k| (0..3).fold([0.0; 3], |v, d| vector::add(v, vector::scale(step(k, d), axes[d as usize]))));
    all.filter_map(vector::unit).collect()
}

/// All rows of so many signs.
fn signs(count: usize) -> impl Iterator<Item = Vec<f64>> {
    (0..1usize << count).map(move |k| (0..count).map(|d| if k >> d & 1 == 0 { -1.0 } else { 1.0 }).collect())
}

/// A direction that grows by as much over the whole lattice along each of some normals.
fn weighted(normals: &[Vector], signs: &[f64], lattice: &Lattice) -> Vector {
    let along = |n: &Vector| {
        let x = || (0..lattice.sites).map(|i| vector::dot(lattice.place(i), *n));
        x().fold(f64::MIN, f64::max) - x().fold(f64::MAX, f64::min)
    };
    let parts = normals.iter().zip(signs).map(|(n, sign)| vector::scale(sign / along(n).max(1.0), *n));
    parts.fold([0.0; 3], vector::add)
}

/// The site furthest out in a direction, the first of equal ones.
fn furthest(lattice: &Lattice, direction: Vector) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for i in 0..lattice.sites {
        let x = vector::dot(lattice.place(i), direction);
        if x > best.1 + 1e-9 {
            best = (i, x);
        }
    }
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Direction;
    use crate::lattice::Grid;

    fn boxed(size: [usize; 3], periodic: [bool; 3]) -> Lattice {
        let second = Direction::new([0.5, 0.75f64.sqrt(), 0.0]).unwrap();
        Lattice::bare(Grid { size, periodic }, [(1.0, Direction::X), (1.0, second), (1.0, Direction::Z)])
    }

    #[test]
    fn a_box_has_edges_and_corners_where_it_is_open() {
        let count = |size, periodic| {
            let outline = Outline::of(&boxed(size, periodic));
            (outline.edges.len(), outline.corners.len())
        };
        assert_eq!(count([6, 5, 1], [false; 3]), (4, 4));
        assert_eq!(count([6, 5, 1], [true, false, false]), (2, 2));
        assert_eq!(count([6, 5, 1], [true, true, false]), (0, 0));
        assert_eq!(count([6, 5, 4], [false; 3]), (6, 8));
        assert_eq!(count([6, 5, 4], [true, true, false]), (2, 2));
    }

    #[test]
    fn the_edges_of_a_rhombus_are_along_its_sides() {
        let rhombus = boxed([6, 5, 1], [false; 3]);
        let Outline { edges, corners } = Outline::of(&rhombus);
        let sides = rhombus.cell_vectors();
        for (k, edge) in edges.iter().enumerate() {
            let side = sides[1 - k / 2];
            assert!(vector::dot(*edge, side).abs() < 1e-15 && (vector::norm(*edge) - 1.0).abs() < 1e-15);
        }
        assert_eq!(corners, [0, 5, 24, 29]);
    }
}
