//! What the places of the sites alone are symmetric under: mirrors, and shifts along periodic directions. Whether an energy is too
//! is for the energy to tell.

use super::{Grid, Lattice};

/// The cells of a grid in another order: x ↦ by ± x along each direction, around the border where there is none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Motion {
    /// Where x ↦ by − x.
    pub reversed: [bool; 3],
    /// Less than the grid's size.
    pub by: [usize; 3],
}

impl Motion {
    /// A mirror image along some directions, end for end.
    pub fn mirror(grid: &Grid, reversed: [bool; 3]) -> Motion {
        Motion { reversed, by: [0, 1, 2].map(|d| if reversed[d] { grid.size[d] - 1 } else { 0 }) }
    }

    /// So many cells on along one direction.
    pub fn shift(direction: usize, by: usize) -> Motion {
        Motion { reversed: [false; 3], by: [0, 1, 2].map(|d| if d == direction { by } else { 0 }) }
    }

    /// Whether every cell stays.
    pub fn is_none(&self) -> bool {
        *self == Motion::default()
    }

    /// Where it takes site i.
    #[inline]
    pub fn of(&self, grid: &Grid, i: usize) -> usize {
        if grid.is_row() {
            return self.along(grid, 0, i);
        }
        let cell = grid.cell(i);
        let [x, y, z] = [0, 1, 2].map(|d| self.along(grid, d, cell[d]));
        x + grid.size[0] * (y + grid.size[1] * z)
    }

    #[inline]
    fn along(&self, grid: &Grid, d: usize, x: usize) -> usize {
        let n = grid.size[d];
        let to = self.by[d] + if self.reversed[d] { n - x } else { x };
        if to >= n { to - n } else { to }
    }

    /// What takes i to self(first(i)).
    pub fn after(&self, first: &Motion, grid: &Grid) -> Motion {
        Motion {
            reversed: [0, 1, 2].map(|d| self.reversed[d] != first.reversed[d]),
            by: [0, 1, 2].map(|d| self.along(grid, d, first.by[d])),
        }
    }
}

impl Lattice {
    /// The site so many sites on along a ring.
    pub fn along_ring(&self, i: usize, by: isize) -> usize {
        self.grid.step(i, by, 0).unwrap_or(i)
    }
}
