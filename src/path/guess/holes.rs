//! Holes of a lattice: places without spins with sites all round, by which a texture may leave as it does over an edge.

use crate::geometry::{Vector, vector};
use crate::lattice::{Lattice, Shift};

/// The middles of all holes (in spacings); what is open to an edge is none.
pub(super) fn holes(lattice: &Lattice) -> Vec<Vector> {
    if lattice.slots.are_all() && !(0..lattice.sites).any(|i| lattice.vacant[i]) {
        return Vec::new();
    }
    let empty = Empty { lattice, atoms: lattice.atoms.len() };
    let mut seen = vec![false; empty.atoms * lattice.grid.cells()];
    let all = 0..seen.len();
    all.filter_map(|slot| if seen[slot] { None } else { empty.hole(slot, &mut seen) }).collect()
}

/// Slots without a spin.
struct Empty<'l> {
    lattice: &'l Lattice,
    atoms: usize,
}

impl Empty<'_> {
    fn is_empty(&self, slot: usize) -> bool {
        self.lattice.slots.site(slot).is_none_or(|i| self.lattice.vacant[i])
    }

    fn place(&self, slot: usize) -> Vector {
        let (lattice, cells) = (self.lattice, self.lattice.grid.cells());
        let (cell, at) = (lattice.grid.cell(slot % cells), lattice.atoms[slot / cells].at);
        let there = lattice.to([0, 1, 2].map(|d| cell[d] as f64 + at[d]));
        vector::scale(1.0 / lattice.spacing_nm.unwrap_or(1.0), there)
    }

    /// The middle of the hole that a slot is in, if it is in one; all of its slots are seen after that.
    fn hole(&self, slot: usize, seen: &mut [bool]) -> Option<Vector> {
        let (grid, periods) = (&self.lattice.grid, self.lattice.periods());
        if !self.is_empty(slot) {
            return None;
        }
        let (first, cells) = (self.place(slot), grid.cells());
        let (mut front, mut is_open, mut sum, mut count) = (vec![slot], false, [0.0; 3], 0.0);
        seen[slot] = true;
        while let Some(here) = front.pop() {
            (sum, count) = (vector::add(sum, periods.shortest(vector::sub(self.place(here), first))), count + 1.0);
            for shift in steps(grid.size) {
                let Some(cell) = grid.shifted(grid.cell(here % cells), shift) else {
                    is_open = true;
                    continue;
                };
                for next in (0..self.atoms).map(|atom| atom * cells + grid.number(cell)) {
                    if !seen[next] && self.is_empty(next) {
                        seen[next] = true;
                        front.push(next);
                    }
                }
            }
        }
        (!is_open).then(|| vector::add(first, vector::scale(1.0 / count, sum)))
    }
}

/// To the cells beside one, itself among them; along a direction of a single cell nowhere.
fn steps(size: [usize; 3]) -> impl Iterator<Item = Shift> {
    let ways = [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    ways.into_iter().filter(move |way: &Shift| (0..3).all(|d| way[d] == 0 || size[d] > 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::lattice;

    #[test]
    fn a_hole_has_sites_all_round() {
        let cases: [(&str, &[[f64; 2]]); 6] = [
            (r#"{"square": {"cells": [12, 10]}}"#, &[]),
            (
                r#"{"square": {"cells": [12, 10], "vacant": {"disc": {"center": [6, 5], "radius": 1.1}}}}"#,
                &[[6.0, 5.0]],
            ),
            // open to an edge
            (r#"{"square": {"cells": [12, 10], "vacant": {"disc": {"center": [0, 5], "radius": 1.1}}}}"#, &[]),
            // over a border
            (r#"{"square": {"cells": [12, 10], "periodic": true, "vacant": [0, 11]}}"#, &[[-0.5, 0.0]]),
            // a disc lies in a box whose corners are none
            (r#"{"square": {"cells": [12, 12], "shape": {"disc": {"radius": 4}}}}"#, &[]),
            (r#"{"square": {"cells": [12, 12], "vacant": [39, 100]}}"#, &[[3.0, 3.0], [4.0, 8.0]]),
        ];
        for (text, expected) in cases {
            let lattice = lattice(text);
            let found = holes(&lattice);
            assert_eq!(found.len(), expected.len(), "{text}: {found:?}");
            for (hole, [x, y]) in found.iter().zip(expected) {
                let way = lattice.periods().shortest(vector::sub(*hole, [*x, *y, hole[2]]));
                assert!(vector::norm(way) < 1e-9, "{text}: {hole:?}");
            }
        }
    }
}
