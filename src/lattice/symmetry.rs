//! What the places of the sites alone are symmetric under: mirrors, and shifts along periodic directions. Whether an energy is too
//! is for the energy to tell.

use super::Lattice;

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
