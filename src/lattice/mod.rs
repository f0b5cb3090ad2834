//! Where the spins are: sites in cells of a box, the bonds between them, and what each site is.
//!
//! ```text
//! i = x + n_x (y + n_y z)          cell (x, y, z) of n_x × n_y × n_z, one site each, the first direction fastest
//! ```
//! So all bonds that lead so many cells on join i to i + a constant, but for those over a periodic border. One file a kind of
//! lattice; a kind says its box, its steps and its sites, all the rest follows from these.

mod bonds;
mod cells;
mod chain;
mod grid;
#[cfg(test)]
mod ladder;
mod measure;
mod order;
mod selection;
mod sites;
mod spec;
mod symmetry;

pub use bonds::{Bond, BondFamily, Segment, at};
pub use chain::{Chain, MAX_SITES};
pub use grid::{Grid, Shift};
pub use measure::shortest;
pub use selection::Selection;
pub use sites::{Frozen, SiteMoment, SiteSection};
pub use spec::LatticeSpec;
pub use symmetry::Motion;

use crate::error::Result;
use crate::geometry::{Direction, Vector, vector};
use std::collections::BTreeMap;

/// Sites, each of which has (or lacks) a spin. Made by [`LatticeSpec::resolve`], so that everything in it makes sense: lists over
/// sites have one entry a site, indices are those of sites, lengths and volumes are greater than 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// Number of sites.
    pub sites: usize,
    /// Their cells.
    pub grid: Grid,
    /// From a cell to the next, by direction: how far (nm, or spacings where no length is given) and where to. What stands for a
    /// direction of one cell is of no account.
    pub steps: [(f64, Direction); 3],
    /// Distance of neighbours along the first direction (nm), where it is given.
    pub spacing_nm: Option<f64>,
    /// Width and thickness of every cell (nm), where the lattice has cells with a volume.
    pub sections_nm: Option<Vec<[f64; 2]>>,
    /// Spins that never move.
    pub frozen: Vec<FrozenSites>,
    /// Which sites are vacant.
    pub vacant: Vec<bool>,
    /// Moments of the sites that have one of their own (μ_B).
    pub moments_mub: Vec<Option<f64>>,
    /// Sites with a name.
    pub regions: BTreeMap<String, Vec<usize>>,
}

/// Spins that never move.
#[derive(Clone, Debug, PartialEq)]
pub struct FrozenSites {
    /// Which ones.
    pub sites: Vec<usize>,
    /// Where they point; as in the initial state if not given.
    pub direction: Option<Direction>,
}

impl Lattice {
    /// Sites in the cells of a grid, so far with nothing else to them.
    pub fn bare(grid: Grid, steps: [(f64, Direction); 3]) -> Lattice {
        let sites = grid.cells();
        Lattice {
            sites,
            grid,
            steps,
            spacing_nm: None,
            sections_nm: None,
            frozen: Vec::new(),
            vacant: vec![false; sites],
            moments_mub: vec![None; sites],
            regions: BTreeMap::new(),
        }
    }

    /// Where its rows point.
    pub fn direction(&self) -> Direction {
        self.steps[0].1
    }

    /// Whether it is a closed row of sites.
    pub fn is_ring(&self) -> bool {
        self.grid.is_row() && self.grid.periodic[0]
    }

    /// Which sites never move.
    pub fn is_frozen(&self) -> Vec<bool> {
        let mut frozen = vec![false; self.sites];
        self.frozen.iter().flat_map(|f| &f.sites).for_each(|i| frozen[*i] = true);
        frozen
    }

    /// The sites of a region.
    pub fn region(&self, name: &str) -> Result<&[usize]> {
        selection::region(&self.regions, name)
    }

    /// The same lattice with its vacant sites frozen, their idle spins along `direction`.
    pub fn with_vacancies_frozen(mut self, direction: Direction) -> Lattice {
        let sites: Vec<usize> = (0..self.sites).filter(|i| self.vacant[*i]).collect();
        if !sites.is_empty() {
            self.frozen.push(FrozenSites { sites, direction: Some(direction) });
        }
        self
    }

    /// Where a site is, and in which unit [`unit`](Self::unit): atoms begin at the origin, and so does the first cell of a
    /// continuum, whose center is half a cell further on.
    pub fn position(&self, i: usize) -> Vector {
        let cell = self.grid.cell(i);
        let along = |d: usize| {
            let ((length, direction), cells) =
                (self.steps[d], cell[d] as f64 + if d == 0 { self.first() } else { 0.0 });
            vector::scale(length * cells, direction.vector())
        };
        (1..3).filter(|d| self.grid.size[*d] > 1).fold(along(0), |sum, d| vector::add(sum, along(d)))
    }

    /// The unit of positions.
    pub fn unit(&self) -> &'static str {
        self.spacing_nm.map_or("sites", |_| "nm")
    }

    /// Where the first site stands, in spacings from the origin.
    pub fn first(&self) -> f64 {
        if self.sections_nm.is_some() { 0.5 } else { 0.0 }
    }
}
