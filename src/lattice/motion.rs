//! Sites in other places of their lattice.
//!
//! ```text
//! p = (s, c_o)          a place: atom s of the cell c_o along the open directions; one for each cell c along the periodic ones
//! (p, c) ↦ (π(p), M c + t_p)          r' = Q r + const.
//! ```
//! Along open directions a place is a place, whichever atom of whichever cell it is: a cluster may be one cell with all its sites or
//! many cells with one each. Only periodic directions have cells that go on and on: M is a matrix of whole numbers for those.

use super::{Grid, Lattice, Shift};
use crate::geometry::Matrix;
use crate::geometry::matrix::{UNIT, product};
use std::sync::Arc;

/// Whole numbers, row by row.
pub(super) type Whole = [[isize; 3]; 3];
pub(super) const STAY: Whole = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/// Entries of matrices that differ by less are the same.
const SAME: f64 = 1e-6;
/// What stands for the place of no site.
const NONE: u32 = u32::MAX;

/// Where all sites go.
#[derive(Clone, Debug)]
pub struct Motion {
    /// Q; of sites in one plane or line, one of those that do the same.
    turn: Matrix,
    /// M, in the rows and columns of periodic directions; the others are those of 1.
    cells: Whole,
    /// π(p) of every place; none where no site is.
    to: Arc<[u32]>,
    /// t_p of every place; empty where no direction is periodic.
    by: Arc<[Shift]>,
}

impl PartialEq for Motion {
    fn eq(&self, other: &Motion) -> bool {
        self.cells == other.cells && self.to == other.to && self.by == other.by
    }
}

impl Motion {
    /// Turned by Q, with M, and each place that is one to another, so many cells on. None if one goes where no site is.
    pub(super) fn of_places(
        lattice: &Lattice,
        turn: Matrix,
        cells: Whole,
        to: impl Fn(usize) -> Option<(usize, Shift)>,
    ) -> Option<Motion> {
        let (taken, periodic) = (lattice.places_taken(), lattice.grid.periodic);
        let is_whole = |r: usize, c: usize| periodic[r] && periodic[c];
        let cells = [0, 1, 2].map(|r| [0, 1, 2].map(|c| if is_whole(r, c) { cells[r][c] } else { STAY[r][c] }));
        let (mut places, mut by) = (vec![NONE; taken.len()], vec![[0; 3]; taken.len()]);
        for p in (0..taken.len()).filter(|p| taken[*p]) {
            let (image, shift) = to(p).filter(|(image, _)| taken[*image])?;
            (places[p], by[p]) = (image as u32, shift);
        }
        by.truncate(if periodic == [false; 3] { 0 } else { taken.len() });
        Some(Motion::normal(turn, cells, places, by, &lattice.grid))
    }

    /// No more cells on along a periodic direction than there are, and none along the others.
    fn normal(turn: Matrix, cells: Whole, to: Vec<u32>, mut by: Vec<Shift>, grid: &Grid) -> Motion {
        let along = |n: isize, d: usize| if grid.periodic[d] { n.rem_euclid(grid.size[d] as isize) } else { 0 };
        by.iter_mut().for_each(|t| *t = [0, 1, 2].map(|d| along(t[d], d)));
        Motion { turn, cells, to: to.into(), by: by.into() }
    }

    /// So many cells on along periodic directions.
    pub fn shift(lattice: &Lattice, by: Shift) -> Motion {
        let taken = lattice.places_taken();
        let to = taken.iter().enumerate().map(|(p, taken)| if *taken { p as u32 } else { NONE }).collect();
        let shifts = taken.iter().map(|taken| if *taken { by } else { [0; 3] });
        let by = if lattice.grid.periodic == [false; 3] { Vec::new() } else { shifts.collect() };
        Motion::normal(UNIT, STAY, to, by, &lattice.grid)
    }

    /// Every site where it is.
    pub fn none(lattice: &Lattice) -> Motion {
        Motion::shift(lattice, [0; 3])
    }

    /// Whether every site stays.
    pub fn is_none(&self) -> bool {
        self.shifts_by() == Some([0; 3])
    }

    /// How many cells on all sites go, where they are shifted only.
    pub fn shifts_by(&self) -> Option<Shift> {
        if self.cells != STAY || self.to.iter().enumerate().any(|(p, to)| *to != NONE && *to as usize != p) {
            return None;
        }
        let mut shifts = self.to.iter().zip(self.by.iter()).filter(|(to, _)| **to != NONE).map(|(_, by)| *by);
        let first = shifts.next().unwrap_or_default();
        shifts.all(|by| by == first).then_some(first)
    }

    /// The atom and the cell that site i goes to.
    #[inline]
    pub fn place(&self, lattice: &Lattice, i: usize) -> (usize, [usize; 3]) {
        let (atom, cell) = lattice.cell(i);
        let p = lattice.place_number(atom, cell);
        let (to, mut image) = lattice.numbered_place(self.to[p] as usize);
        if let Some(by) = self.by.get(p) {
            for d in (0..3).filter(|d| lattice.grid.periodic[*d]) {
                let on = (0..3).filter(|k| lattice.grid.periodic[*k]).map(|k| self.cells[d][k] * cell[k] as isize);
                image[d] = (by[d] + on.sum::<isize>()).rem_euclid(lattice.grid.size[d] as isize) as usize;
            }
        }
        (to, image)
    }

    /// Where it takes site i, if there is a site.
    #[inline]
    pub fn of(&self, lattice: &Lattice, i: usize) -> Option<usize> {
        if self.by.is_empty() {
            return lattice.slots.site(self.to[lattice.slots.slot(i)] as usize);
        }
        let (atom, cell) = self.place(lattice, i);
        lattice.site(atom, cell)
    }

    /// What takes i to self(first(i)).
    pub fn after(&self, first: &Motion, lattice: &Lattice) -> Motion {
        if first.is_none() {
            return self.clone();
        }
        if self.is_none() {
            return first.clone();
        }
        let times = |r: usize, c: usize| (0..3).map(|k| self.cells[r][k] * first.cells[k][c]).sum();
        let cells = [0, 1, 2].map(|r| [0, 1, 2].map(|c| times(r, c)));
        let image = |p: &u32| if *p == NONE { NONE } else { self.to[*p as usize] };
        let both = |(between, by): (&u32, &Shift)| match *between {
            NONE => [0; 3],
            p => [0, 1, 2].map(|r| self.by[p as usize][r] + (0..3).map(|k| self.cells[r][k] * by[k]).sum::<isize>()),
        };
        let by = first.to.iter().zip(first.by.iter()).map(both).collect();
        let to = first.to.iter().map(image).collect();
        Motion::normal(product(&self.turn, &first.turn), cells, to, by, &lattice.grid)
    }

    /// A shift, so many times.
    pub fn times(&self, count: usize, lattice: &Lattice) -> Motion {
        let by = self.by.iter().map(|by| by.map(|n| n * count as isize)).collect();
        Motion::normal(self.turn, self.cells, self.to.to_vec(), by, &lattice.grid)
    }

    /// By how many sites a row is shifted, or shifted after it was mirrored end for end.
    pub fn beside_mirror(&self, lattice: &Lattice) -> usize {
        let by = self.by.first().map_or(0, |by| by[0] + isize::from(self.cells[0][0] < 0));
        by.rem_euclid(lattice.grid.size[0] as isize) as usize
    }

    /// Q.
    pub fn turn(&self) -> &Matrix {
        &self.turn
    }
}

/// Where a turn stands among others: those come first that leave x, then y, then z where it is.
pub(super) fn in_order(turn: &Matrix) -> [[i64; 3]; 3] {
    turn.map(|row| row.map(|x| -(x / SAME).round() as i64))
}

impl Lattice {
    /// The cells along the open directions.
    fn open_cells(&self) -> Grid {
        let size = [0, 1, 2].map(|d| if self.grid.periodic[d] { 1 } else { self.grid.size[d] });
        Grid { size, periodic: [false; 3] }
    }

    /// The number of the place of an atom of a cell.
    #[inline]
    pub(super) fn place_number(&self, atom: usize, cell: [usize; 3]) -> usize {
        let open = self.open_cells();
        let cell = [0, 1, 2].map(|d| if self.grid.periodic[d] { 0 } else { cell[d] });
        atom * open.cells() + open.number(cell)
    }

    /// The atom and the cell, the first along periodic directions, of a place.
    #[inline]
    pub(super) fn numbered_place(&self, p: usize) -> (usize, [usize; 3]) {
        let open = self.open_cells();
        (p / open.cells(), open.cell(p % open.cells()))
    }

    /// Which places there are sites at.
    pub(super) fn places_taken(&self) -> Vec<bool> {
        let mut taken = vec![self.slots.are_all(); self.atoms.len() * self.open_cells().cells()];
        if !self.slots.are_all() {
            for (atom, cell) in (0..self.sites).map(|i| self.cell(i)) {
                taken[self.place_number(atom, cell)] = true;
            }
        }
        taken
    }
}
