//! Places along the directions of a lattice, whichever cells it is made of.

use super::Lattice;

/// Atoms that are nearer than this along a vector of the cell (in units of it) are at one place along it.
const SAME: f64 = 1e-6;

impl Lattice {
    /// How many places for atoms there are along each vector of a cell: as many as different ones are taken, or, where atoms leave
    /// most of these free, as many as atoms spread evenly would take.
    pub fn places_in_cell(&self) -> [usize; 3] {
        let taken = |d: usize| {
            let mut at: Vec<f64> = self.atoms.iter().map(|atom| atom.at[d]).collect();
            at.sort_by(f64::total_cmp);
            at.dedup_by(|a, b| (*a - *b).abs() < SAME);
            at.len()
        };
        let taken = [0, 1, 2].map(taken);
        let all: f64 = taken.iter().map(|n| *n as f64).product();
        let directions = taken.iter().filter(|n| **n > 1).count().max(1);
        let part = libm::pow((self.atoms.len() as f64 / all).min(1.0), 1.0 / directions as f64);
        taken.map(|n| ((n as f64 * part).round() as usize).max(1))
    }

    /// Whether there is more than one place along each direction, the images over a periodic border counted.
    pub fn extents(&self) -> [bool; 3] {
        let places = self.places_in_cell();
        [0, 1, 2].map(|d| self.grid.extends(d) || places[d] > 1)
    }

    /// In how many directions it extends: 1 in a row, 2 in a film, and 1 at least.
    pub fn directions(&self) -> usize {
        self.extents().into_iter().filter(|extends| *extends).count().max(1)
    }

    /// Where site i is, in steps along each direction.
    pub fn steps_to(&self, i: usize) -> [f64; 3] {
        let (atom, cell) = self.cell(i);
        [0, 1, 2].map(|d| cell[d] as f64 + self.atoms[atom].at[d])
    }
}

#[cfg(test)]
mod tests {
    use crate::energy::test_terms::lattice;

    #[test]
    fn a_cell_has_as_many_places_as_its_atoms_take_or_could_take() {
        let basis = |at: &[[f64; 2]]| {
            let atoms: Vec<String> = at.iter().map(|[x, y]| format!(r#"{{"at": [{x}, {y}, 0]}}"#)).collect();
            lattice(&format!(
                r#"{{"crystal": {{"vectors": [[3, 0, 0], [0, 3, 0], [0, 0, 1]], "basis": [{}], "cells": [1, 1, 1]}}}}"#,
                atoms.join(", ")
            ))
        };
        let grid: Vec<[f64; 2]> = (0..6).map(|i| [(i % 3) as f64 / 3.0, (i / 3) as f64 / 2.0]).collect();
        // no two in one row
        let spread: Vec<[f64; 2]> = (0..9).map(|i| [i as f64 / 9.0, (4 * i % 9) as f64 / 9.0]).collect();
        for (lattice, places, extents) in [
            (lattice(r#"{"square": {"cells": [4, 1]}}"#), [1, 1, 1], [true, false, false]),
            (lattice(r#"{"honeycomb": {"cells": [4, 3]}}"#), [1, 1, 1], [true, true, false]),
            (basis(&grid), [3, 2, 1], [true, true, false]),
            (basis(&spread), [3, 3, 1], [true, true, false]),
            (lattice(r#"{"cubic": {"cells": [2, 3, 2]}}"#), [1, 1, 1], [true; 3]),
        ] {
            assert_eq!((lattice.places_in_cell(), lattice.extents()), (places, extents));
            assert_eq!(lattice.directions(), extents.into_iter().filter(|extends| *extends).count());
        }
    }
}
