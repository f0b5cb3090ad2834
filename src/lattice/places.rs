//! Where sites are: cells and atoms, positions, and the way back.

use super::{Lattice, Shift};
use crate::geometry::{Vector, vector};

impl Lattice {
    /// The atom that site i is, and its cell.
    #[inline]
    pub fn cell(&self, i: usize) -> (usize, [usize; 3]) {
        let (slot, cells) = (self.slots.slot(i), self.grid.cells());
        (slot / cells, self.grid.cell(slot % cells))
    }

    /// The site of an atom of a cell, if it is there.
    #[inline]
    pub fn site(&self, atom: usize, cell: [usize; 3]) -> Option<usize> {
        self.slots.site(atom * self.grid.cells() + self.grid.number(cell))
    }

    /// The like atom so many cells on, if it is there.
    pub fn shifted(&self, i: usize, shift: Shift) -> Option<usize> {
        let (atom, cell) = self.cell(i);
        self.site(atom, self.grid.shifted(cell, shift)?)
    }

    /// The like atom so many cells on along one direction, if it is there.
    pub fn step_from(&self, i: usize, direction: usize, by: isize) -> Option<usize> {
        let mut shift = [0; 3];
        shift[direction] = by;
        self.shifted(i, shift)
    }

    /// The site so many sites on along a ring.
    pub fn along_ring(&self, i: usize, by: isize) -> usize {
        self.grid.step(i, by, 0).unwrap_or(i)
    }

    /// Whether site i is one of those that a staggered state reverses: with one atom a cell those an odd number of steps from the
    /// first cell, with several every other atom of each cell.
    pub fn is_odd(&self, i: usize) -> bool {
        let (atom, cell) = self.cell(i);
        if self.atoms.len() > 1 { atom % 2 == 1 } else { cell.iter().sum::<usize>() % 2 == 1 }
    }

    /// Where a site is, and in which unit [`unit`](Self::unit). A cell of a continuum is where its center is.
    pub fn position(&self, i: usize) -> Vector {
        let (atom, cell) = self.cell(i);
        let at = self.atoms[atom].at;
        self.to([0, 1, 2].map(|d| cell[d] as f64 + at[d]))
    }

    /// So many steps along each direction, from the origin, in the unit of [`position`](Self::position).
    pub fn to(&self, steps: Vector) -> Vector {
        let along = |d: usize| vector::scale(self.steps[d].0 * steps[d], self.steps[d].1.vector());
        vector::add(vector::add(along(0), along(1)), along(2))
    }

    /// The unit of positions: nanometres, or lattice constants.
    pub fn unit(&self) -> &'static str {
        match self.spacing_nm {
            Some(_) => "nm",
            None if self.is_row() => "sites",
            None => "lattice constants",
        }
    }

    /// Where the first site of a row stands, in spacings from the origin.
    pub fn first(&self) -> f64 {
        self.atoms[0].at[0]
    }
}
