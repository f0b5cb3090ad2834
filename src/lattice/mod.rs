//! Where the spins are: sites in cells of a box, the bonds between them, and what each site is.
//!
//! ```text
//! r = Σ_k (c_k + f_k) a_k          atom at f of cell c, the corner of cell (0, 0, 0) at the origin
//! i = c₁ + n₁ (c₂ + n₂ (c₃ + n₃ s))          atom s of cell c of n₁ × n₂ × n₃: the first direction fastest, the atoms slowest
//! ```
//! So all bonds from one atom of a cell to one so many cells on join i to i + a constant, but for those over a periodic border; where
//! sites are left out, to i + another constant from each row on. One file a kind of lattice; a kind says its vectors and its atoms,
//! all the rest follows from these.
//!
//! Across a periodic border each image of a site is a neighbour of its own: where a direction is so short that two sites meet twice,
//! their two bonds count both. A bond of a site with an image of itself is refused, and so is a shell that wraps onto itself in a
//! ring.

mod bonds;
mod cells;
mod chain;
mod grid;
mod kind;
#[cfg(test)]
mod ladder;
mod measure;
mod motion;
mod order;
mod picture;
mod places;
mod points;
mod rows;
mod selection;
mod shape;
mod shells;
mod sites;
mod slots;
mod spec;
mod symmetry;
mod triangles;
mod words;

mod bcc;
mod crystal;
mod cubic;
mod fcc;
mod hcp;
mod hexahedra;
mod honeycomb;
mod kagome;
mod mesh;
mod square;
mod triangular;

pub use bcc::Bcc;
pub use bonds::{Bond, BondFamily, Segment, at};
pub use chain::{Chain, MAX_SITES};
pub use crystal::{BasisAtom, Crystal};
pub use cubic::Cubic;
pub use fcc::Fcc;
pub use grid::{Grid, Shift};
pub use hcp::Hcp;
pub use honeycomb::Honeycomb;
pub use kagome::Kagome;
pub use measure::Periods;
pub use mesh::Mesh;
pub use motion::Motion;
pub use picture::{DATA, Picture};
pub use selection::Selection;
pub use shape::{Corners, Disc, Ellipse, Ring, Shape};
pub use shells::Hop;
pub use sites::{Frozen, Periodic, SiteMoment, SiteSection};
pub use slots::Slots;
pub use spec::{LatticeKind, LatticeSpec};
pub use square::Square;
pub use triangles::Triangles;
pub use triangular::Triangular;

use crate::error::Result;
use crate::geometry::{Direction, Vector};
use std::collections::BTreeMap;

/// Sites, each of which has (or lacks) a spin. Made by [`LatticeSpec::resolve`], so that everything in it makes sense: lists over
/// sites have one entry a site, indices are those of sites, lengths and volumes are greater than 0.
///
/// ```
/// use spinneb::lattice::{Chain, LatticeSpec};
///
/// let ring = LatticeSpec::Chain(Chain { periodic: true, ..Chain::open(12) }).resolve()?;
/// let film: LatticeSpec = serde_json::from_str(r#"{"square": {"cells": [9, 9], "shape": {"disc": {"radius": 4}}}}"#).unwrap();
/// let disc = film.resolve()?;
/// assert!(ring.is_ring() && ring.sites == 12 && disc.sites == 49);
/// # Ok::<(), spinneb::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Lattice {
    /// The name of its kind.
    pub kind: &'static str,
    /// Number of sites.
    pub sites: usize,
    /// The cells.
    pub grid: Grid,
    /// From a cell to the next, by direction: how far (nm, or lattice constants where no length is given) and where to. What stands
    /// for a direction of one cell is of no account.
    pub steps: [(f64, Direction); 3],
    /// What is in a cell.
    pub atoms: Vec<Atom>,
    /// Which atoms of which cells there are.
    pub slots: Slots,
    /// Names of the species.
    pub species: Vec<String>,
    /// The lattice constant (nm): the distance of neighbouring cells along the first direction, where it is given.
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

/// An atom of a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atom {
    /// Where it is, in units of the vectors of the cell.
    pub at: Vector,
    /// Which of the species it is of; 0 where there are none.
    pub species: usize,
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
    /// One atom in each cell of a grid, so far with nothing else to it.
    pub fn bare(grid: Grid, steps: [(f64, Direction); 3]) -> Lattice {
        Lattice::of_atoms("chain", grid, steps, vec![Atom { at: [0.0; 3], species: 0 }])
    }

    /// The atoms of all cells of a grid, so far with nothing else to them.
    pub fn of_atoms(kind: &'static str, grid: Grid, steps: [(f64, Direction); 3], atoms: Vec<Atom>) -> Lattice {
        let sites = grid.cells() * atoms.len();
        Lattice {
            kind,
            sites,
            grid,
            steps,
            atoms,
            slots: Slots::default(),
            species: Vec::new(),
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

    /// Whether it is one row of cells with an atom each, none left out.
    pub fn is_row(&self) -> bool {
        self.grid.is_row() && self.atoms.len() == 1 && self.slots.are_all()
    }

    /// Whether it is a closed row of sites.
    pub fn is_ring(&self) -> bool {
        self.is_row() && self.grid.periodic[0]
    }

    /// Which sites never move.
    pub fn is_frozen(&self) -> Vec<bool> {
        let mut frozen = vec![false; self.sites];
        self.frozen.iter().flat_map(|f| &f.sites).for_each(|i| frozen[*i] = true);
        frozen
    }

    /// The sites of a region, or of a species.
    pub fn named(&self, name: &str) -> Result<Vec<usize>> {
        if let Some(species) = self.species.iter().position(|s| s == name) {
            return Ok((0..self.sites).filter(|i| self.atoms[self.cell(*i).0].species == species).collect());
        }
        selection::region(&self.regions, &self.species, name).map(<[usize]>::to_vec)
    }

    /// The same lattice with its vacant sites frozen, their idle spins along `direction`.
    pub fn with_vacancies_frozen(mut self, direction: Direction) -> Lattice {
        let sites: Vec<usize> = (0..self.sites).filter(|i| self.vacant[*i]).collect();
        if !sites.is_empty() {
            self.frozen.push(FrozenSites { sites, direction: Some(direction) });
        }
        self
    }
}
