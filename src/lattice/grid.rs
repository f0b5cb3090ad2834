//! Cells in a box.

use std::cmp::Ordering;

/// So many cells on in each direction.
pub type Shift = [isize; 3];

/// A box of cells, counted with the first direction fastest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Cells in each direction, at least 1.
    pub size: [usize; 3],
    /// Whether the last cell in a direction is followed by the first.
    pub periodic: [bool; 3],
}

impl Grid {
    /// A row of cells.
    pub fn row(cells: usize, periodic: bool) -> Grid {
        Grid { size: [cells, 1, 1], periodic: [periodic, false, false] }
    }

    /// Whether it is one row.
    pub fn is_row(&self) -> bool {
        self.size[1..] == [1, 1]
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.size.iter().product()
    }

    /// The place of cell i.
    pub fn cell(&self, i: usize) -> [usize; 3] {
        let [x, y, _] = self.size;
        [i % x, i / x % y, i / x / y]
    }

    /// Whether it is an odd number of steps from the first cell to cell i.
    pub fn is_odd(&self, i: usize) -> bool {
        self.cell(i).iter().sum::<usize>() % 2 == 1
    }

    /// The cell a shift on from cell i, if there is one.
    pub fn shifted(&self, i: usize, shift: Shift) -> Option<usize> {
        let cell = self.cell(i);
        let [x, y, z] = [0, 1, 2].map(|d| self.step(cell[d], shift[d], d));
        Some(x? + self.size[0] * (y? + self.size[1] * z?))
    }

    /// The cell so many on from cell i along one direction, if there is one.
    pub fn step_from(&self, i: usize, direction: usize, by: isize) -> Option<usize> {
        let mut shift = [0; 3];
        shift[direction] = by;
        self.shifted(i, shift)
    }

    /// So many cells on along one direction, if there is one.
    pub(super) fn step(&self, from: usize, by: isize, direction: usize) -> Option<usize> {
        let (to, size) = (from as isize + by, self.size[direction]);
        match self.periodic[direction] {
            true => Some(to.rem_euclid(size as isize) as usize),
            false => usize::try_from(to).ok().filter(|to| *to < size),
        }
    }

    /// All shifts of at most `most` cells in each direction that stay in the box, of each and its opposite one.
    pub(super) fn shifts(&self, most: usize) -> Vec<Shift> {
        let [x, y, z] = self.size.map(|n| most.min(n - 1) as isize);
        let all = (-z..=z).flat_map(|c| (-y..=y).flat_map(move |b| (-x..=x).map(move |a| [a, b, c])));
        all.filter(|[a, b, c]| [c, b, a].cmp(&[&0, &0, &0]) == Ordering::Greater).collect()
    }
}
