//! What fills the space between the sites of a crystal.

use super::Lattice;
use crate::geometry::vector;

/// The corners of a cell: around its bottom, then around its top.
const CORNERS: [[isize; 3]; 8] =
    [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];

impl Lattice {
    /// The hexahedra between eight neighbouring sites, bottom and top counterclockwise seen from above; none where a cell has several
    /// atoms, across a periodic border, and where a corner is missing.
    pub fn hexahedra(&self) -> Vec<[usize; 8]> {
        if self.atoms.len() > 1 || (0..3).any(|d| self.grid.size[d] < 2) {
            return Vec::new();
        }
        let [a, b, c] = self.cell_vectors();
        let is_left_handed = vector::dot(a, vector::cross(b, c)) < 0.0;
        let all = |i: usize| {
            let (_, cell) = self.cell(i);
            let is_last = (0..3).any(|d| cell[d] + 1 == self.grid.size[d]);
            let mut corners = [i; 8];
            for (corner, shift) in corners.iter_mut().zip(CORNERS) {
                *corner = self.shifted(i, shift).filter(|i| !is_last && !self.vacant[*i])?;
            }
            if is_left_handed {
                corners.rotate_left(4);
            }
            Some(corners)
        };
        (0..self.sites).filter_map(all).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::vector;
    use crate::lattice::{Lattice, LatticeSpec};

    fn lattice(text: &str) -> Lattice {
        serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap()
    }

    #[test]
    fn hexahedra_fill_what_is_between_the_sites_of_one_atom_a_cell() {
        let crystal = |c: f64| {
            format!(
                r#"{{"crystal": {{"vectors": [[1, 0, 0], [0.5, 0.8, 0], [0.2, 0.1, {c}]], "basis": [{{"at": [0, 0, 0]}}], "cells": [3, 4, 5]}}}}"#
            )
        };
        for (text, count, volume) in [
            (r#"{"cubic": {"cells": [4, 3, 2]}}"#, 6, 1.0),
            (r#"{"cubic": {"cells": [4, 3, 2], "periodic": true}}"#, 6, 1.0),
            (r#"{"cubic": {"cells": [4, 3, 3], "vacant": [0]}}"#, 11, 1.0),
            (r#"{"grid": {"cells": [3, 3, 3], "cell": ["2 nm", "1 nm", "3 nm"]}}"#, 8, 6.0),
            (&crystal(2.0), 24, 1.6),
            (&crystal(-2.0), 24, 1.6),
            (r#"{"cubic": {"cells": [4, 3, 1]}}"#, 0, 0.0),
            (r#"{"bcc": {"cells": [3, 3, 3]}}"#, 0, 0.0),
            (r#"{"chain": {"sites": 9}}"#, 0, 0.0),
        ] {
            let lattice = lattice(text);
            let found = lattice.hexahedra();
            assert_eq!(found.len(), count, "{text}");
            for corners in found {
                let edge = |to: usize| vector::sub(lattice.position(corners[to]), lattice.position(corners[0]));
                let size = vector::dot(edge(4), vector::cross(edge(1), edge(3)));
                assert!((size - volume).abs() < 1e-12, "{text}: {size}");
                let [diagonal, sum] = [edge(6), vector::add(edge(4), vector::add(edge(1), edge(3)))];
                assert!(vector::norm(vector::sub(diagonal, sum)) < 1e-12, "{text}");
            }
        }
    }
}
