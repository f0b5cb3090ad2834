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

/// A mirror image of the lattice.
#[derive(Clone, Debug, PartialEq)]
pub struct SiteSymmetry {
    /// What it is called; nothing if all sites stay.
    pub name: String,
    /// From where each site takes its spin.
    pub sites: Vec<usize>,
}

impl Lattice {
    /// The lattice as it is, and its mirror images along each direction that has more than one cell, and along several.
    pub fn mirrors(&self) -> Vec<SiteSymmetry> {
        let size = self.grid.size;
        let wanted = |k: u32| (0..3).all(|d| k >> d & 1 == 0 || size[d] > 1);
        let mirror = |k: u32| {
            let along = |i: usize, d: usize| {
                let x = self.grid.cell(i)[d];
                if k >> d & 1 == 1 { size[d] - 1 - x } else { x }
            };
            let name = match (k, self.grid.is_row()) {
                (0, _) => String::new(),
                (_, true) => "mirrored chain".into(),
                _ => format!("lattice mirrored along {:?}", (0..3).filter(|d| k >> d & 1 == 1).collect::<Vec<_>>()),
            };
            let sites = (0..self.sites).map(|i| along(i, 0) + size[0] * (along(i, 1) + size[1] * along(i, 2)));
            SiteSymmetry { name, sites: sites.collect() }
        };
        (0..8).filter(|k| wanted(*k)).map(mirror).collect()
    }

    /// The site so many sites on along a ring.
    pub fn along_ring(&self, i: usize, by: isize) -> usize {
        self.grid.step(i, by, 0).unwrap_or(i)
    }
}
