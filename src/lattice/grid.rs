//! Cells in a box.

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
        self.size[1..] == [1, 1] && self.periodic[1..] == [false; 2]
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

    /// The number of the cell in a place.
    pub fn number(&self, [x, y, z]: [usize; 3]) -> usize {
        x + self.size[0] * (y + self.size[1] * z)
    }

    /// The cell a shift on, if there is one.
    pub fn shifted(&self, cell: [usize; 3], shift: Shift) -> Option<[usize; 3]> {
        let [x, y, z] = [0, 1, 2].map(|d| self.step(cell[d], shift[d], d));
        Some([x?, y?, z?])
    }

    /// So many cells on along one direction, if there is one.
    pub(super) fn step(&self, from: usize, by: isize, direction: usize) -> Option<usize> {
        let (to, size) = (from as isize + by, self.size[direction]);
        match self.periodic[direction] {
            true => Some(to.rem_euclid(size as isize) as usize),
            false => usize::try_from(to).ok().filter(|to| *to < size),
        }
    }

    /// Whether there is more than one place along a direction, the images over a periodic border counted.
    pub fn extends(&self, direction: usize) -> bool {
        self.size[direction] > 1 || self.periodic[direction]
    }

    /// Whether any cell has another one a shift on.
    pub fn holds(&self, shift: Shift) -> bool {
        (0..3).all(|d| self.periodic[d] || shift[d].unsigned_abs() < self.size[d])
    }

    /// Whether a cell is its own partner a shift on.
    pub fn closes(&self, shift: Shift) -> bool {
        (0..3).all(|d| shift[d] % self.size[d] as isize == 0 && (self.periodic[d] || shift[d] == 0))
    }
}
