//! What all boxes of cells have in common, and how they become lattices.

use super::sites::Periodic;
use super::{Atom, Grid, Lattice, MAX_SITES};
use crate::error::{Error, Result};
use crate::geometry::matrix::determinant;
use crate::geometry::{Direction, Vector, vector};

/// Vectors that span less than this part of a box of their lengths are refused.
const FLAT: f64 = 1e-3;
/// sin 60°.
pub const SIXTY: f64 = 0.866_025_403_784_438_6;

/// A unit cell: its vectors, in units of the lattice constant, and its atoms.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitCell {
    pub vectors: [Vector; 3],
    pub atoms: Vec<UnitAtom>,
}

/// An atom of a unit cell.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnitAtom {
    /// In units of the vectors.
    pub at: Vector,
    pub species: Option<String>,
    /// (μ_B), where it has one of its own.
    pub moment_mub: Option<f64>,
}

impl UnitCell {
    /// Of atoms all alike.
    pub fn new(vectors: [Vector; 3], atoms: &[Vector]) -> UnitCell {
        let atom = |at: &Vector| UnitAtom { at: *at, ..UnitAtom::default() };
        UnitCell { vectors, atoms: atoms.iter().map(atom).collect() }
    }

    /// The directions of a film: along x and 60° from it, or at right angles.
    pub fn film(second: [f64; 2], atoms: &[[f64; 2]]) -> UnitCell {
        let [x, y] = second;
        let atoms: Vec<Vector> = atoms.iter().map(|[p, q]| [*p, *q, 0.0]).collect();
        UnitCell::new([[1.0, 0.0, 0.0], [x, y, 0.0], [0.0, 0.0, 1.0]], &atoms)
    }

    /// The cube, with these atoms.
    pub fn cube(atoms: &[Vector]) -> UnitCell {
        UnitCell::new([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], atoms)
    }

    /// Number of sites in so many cells, if that can be.
    pub fn sites(&self, cells: &[usize]) -> Result<usize> {
        if let Some(d) = cells.iter().position(|n| *n == 0) {
            return Err(Error::invalid(format!("cells[{d}]"), "found 0, but there is at least 1 cell a direction"));
        }
        let count = cells.iter().try_fold(self.atoms.len(), |product, n| product.checked_mul(*n));
        count.filter(|sites| *sites <= MAX_SITES).ok_or_else(|| {
            Error::invalid("cells", format!("found {cells:?}, but a lattice has at most {MAX_SITES} sites"))
        })
    }

    /// So many cells, periodic along some directions, `scale` (nm, or 1 where no length is given) for the unit of the vectors.
    pub fn resolve(&self, kind: &'static str, cells: &[usize], periodic: &Periodic, scale: f64) -> Result<Lattice> {
        self.sites(cells)?;
        let [a, b, c] = self.vectors;
        if determinant(&[a, b, c]).abs() <= FLAT * vector::norm(a) * vector::norm(b) * vector::norm(c) {
            return Err(Error::invalid("vectors", "the three vectors lie in a plane, or nearly so: they span no cell"));
        }
        let size = [0, 1, 2].map(|d| cells.get(d).copied().unwrap_or(1));
        let grid = Grid { size, periodic: periodic.flags(cells.len())? };
        let step = |v: Vector| Ok((scale * vector::norm(v), Direction::new(v)?));
        let steps = [step(a)?, step(b)?, step(c)?];
        let species = self.species()?;
        let number = |atom: &UnitAtom| species.iter().position(|s| Some(s) == atom.species.as_ref()).unwrap_or(0);
        let atoms = self.atoms.iter().map(|atom| Atom { at: atom.at, species: number(atom) }).collect();
        let mut lattice = Lattice { species, ..Lattice::of_atoms(kind, grid, steps, atoms) };
        for i in 0..lattice.sites {
            lattice.moments_mub[i] = self.atoms[lattice.cell(i).0].moment_mub;
        }
        Ok(lattice)
    }

    /// The names of the species, as they are met.
    fn species(&self) -> Result<Vec<String>> {
        let mut names: Vec<String> = Vec::new();
        for (k, atom) in self.atoms.iter().enumerate() {
            match (&atom.species, &self.atoms[0].species) {
                (Some(name), Some(_)) if !names.contains(name) => names.push(name.clone()),
                (Some(_), Some(_)) | (None, None) => {}
                _ => {
                    let message = "some atoms have a \"species\" and some have none: give it to all or to none";
                    return Err(Error::invalid(format!("basis[{k}]"), message));
                }
            }
        }
        Ok(names)
    }
}

impl Periodic {
    /// A flag for each of so many directions, none for those beyond.
    fn flags(&self, directions: usize) -> Result<[bool; 3]> {
        match self {
            Periodic::All(flag) => Ok([0, 1, 2].map(|d| *flag && d < directions)),
            Periodic::Each(flags) if flags.len() == directions => {
                Ok([0, 1, 2].map(|d| flags.get(d).copied().unwrap_or(false)))
            }
            Periodic::Each(flags) => {
                let message =
                    format!("found {} flags for {directions} directions: give one each, or one for all", flags.len());
                Err(Error::invalid("periodic", message))
            }
        }
    }
}

/// Defines a kind of lattice that is a box of cells with a lattice constant: what all of these have, and what is its own.
macro_rules! cells_of {
    ($(#[$meta:meta])* $kind:ident[$directions:literal] { $($(#[$own_meta:meta])* $own:ident: $type:ty),* $(,)? }) => {
        $(#[$meta])*
        #[derive(Clone, Debug, PartialEq, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $kind {
            /// Cells along each direction.
            pub cells: [usize; $directions],
            $($(#[$own_meta])* pub $own: $type,)*
            /// The lattice constant |a₁|; needed only where lengths are.
            #[serde(default)]
            pub spacing: Option<$crate::units::Length>,
            /// Whether the last cell in a direction is followed by the first: a flag a direction, or one for all.
            #[serde(default)]
            pub periodic: $crate::lattice::Periodic,
            /// Sites outside do not exist; all are there if not given.
            #[serde(default)]
            pub shape: Option<$crate::lattice::Shape>,
            /// Spins that never move.
            #[serde(default)]
            pub frozen: Vec<$crate::lattice::Frozen>,
            /// Sites without a spin: nothing acts on them, and they on nothing.
            #[serde(default)]
            pub vacant: Option<$crate::lattice::Selection>,
            /// Sites whose moment is not the material's.
            #[serde(default)]
            pub moments: Vec<$crate::lattice::SiteMoment>,
            /// Sites with a name, to be chosen by it, and to be made of another material.
            #[serde(default)]
            pub regions: std::collections::BTreeMap<String, $crate::lattice::Selection>,
        }

        impl $crate::lattice::LatticeKind for $kind {
            fn checked_sites(&self) -> $crate::error::Result<usize> {
                self.unit_cell()?.sites(&self.cells)
            }

            fn resolve(&self) -> $crate::error::Result<$crate::lattice::Lattice> {
                let name = <$kind as $crate::registry::Described>::NAME;
                let common = $crate::lattice::kind::common!(self);
                let nm = common.spacing_nm(self.spacing)?;
                let cell = self.unit_cell()?;
                let mut lattice = cell.resolve(name, &self.cells, &self.periodic, nm.unwrap_or(1.0))?;
                lattice.spacing_nm = nm;
                let mut lattice = lattice.cut(self.shape.as_ref())?;
                common.name_regions(&mut lattice)?;
                common.complete(lattice)
            }
        }
    };
}
pub(super) use cells_of;

/// What a kind of lattice has in common with others.
macro_rules! common {
    ($kind:expr) => {
        $crate::lattice::sites::Common {
            frozen: &$kind.frozen,
            vacant: $kind.vacant.as_ref(),
            moments: &$kind.moments,
            regions: &$kind.regions,
        }
    };
}
pub(super) use common;
