//! Models from the files of other codes: cell, moments, bonds, anisotropies and field, in this program's convention.
//!
//! ```text
//! E = Σ_bonds m_iᵀ M m_j − Σ K (m·e)² + Σ K_c (α₁²α₂² + α₂²α₃² + α₃²α₁²) − Σ μ m·B          each bond once, unit vectors m
//! M = −(J 1 + T) + [D]×:   −J m_i·m_j + D·(m_i × m_j) − m_iᵀ T m_j
//! ```
//! One file a format: it reads its files into a [`Model`], which [`Model::config`] writes as a config without ends and
//! [`Model::report`] tells of. What a format has and a config has not is refused, so that no part of an energy is lost in silence.

mod atoms;
mod bonds;
mod config;
mod energies;
mod keywords;
mod report;
mod spirit;
mod tb2j;
mod text;
mod told;
mod uppasd;
mod vampire;

pub use bonds::Bond;
pub use energies::Spiral;
pub use told::Told;

use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, matrix, vector};
use crate::lattice::Hop;
use std::path::{Path, PathBuf};

/// A format.
pub struct Format {
    /// Its name on the command line.
    pub name: &'static str,
    /// What is read, in a line.
    pub summary: &'static str,
    /// Reads the files.
    pub read: fn(&[PathBuf], Told) -> Result<Model>,
}

/// All formats.
pub const FORMATS: &[Format] = &[uppasd::FORMAT, vampire::FORMAT, tb2j::FORMAT, spirit::FORMAT];

/// What the files of another code say.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// The code.
    pub code: &'static str,
    /// The files that were read.
    pub files: Vec<String>,
    /// The vectors of the cell.
    pub vectors: [Vector; 3],
    /// The length of 1 in these vectors (nm), where it is known.
    pub spacing_nm: Option<f64>,
    /// The atoms of the cell.
    pub atoms: Vec<Atom>,
    /// The bonds of the cell.
    pub bonds: Vec<Bond>,
    /// Field (T).
    pub field_t: Vector,
    /// Cells along each vector, where the files say so.
    pub cells: Option<[usize; 3]>,
    /// Whether each direction is periodic, where the files say so.
    pub periodic: Option<[bool; 3]>,
    /// The convention that was applied, a line each.
    pub convention: Vec<String>,
    /// What else the user should know.
    pub notes: Vec<String>,
}

/// An atom of the cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Atom {
    /// Its place, in units of the vectors.
    pub at: Vector,
    /// What it is, as far as the files say.
    pub species: String,
    /// Its moment (μ_B).
    pub moment_mub: f64,
    /// Its anisotropies.
    pub anisotropies: Vec<Anisotropy>,
}

/// An anisotropy of a site.
#[derive(Clone, Debug, PartialEq)]
pub enum Anisotropy {
    /// −K (m·e)².
    Uniaxial {
        /// K (meV).
        k: f64,
        /// e.
        axis: Direction,
    },
    /// K (α₁²α₂² + α₂²α₃² + α₃²α₁²) about x, y and z.
    Cubic {
        /// K (meV).
        k: f64,
    },
}

impl Model {
    /// From one end of a bond to the other, in the unit of the vectors.
    pub fn along(&self, hop: Hop) -> Vector {
        let [from, to] = hop.atoms.map(|atom| self.atoms[atom].at);
        self.place([0, 1, 2].map(|d| hop.shift[d] as f64 + (to[d] - from[d])))
    }

    /// A place in units of the vectors.
    fn place(&self, at: Vector) -> Vector {
        atoms::place(&self.vectors, at)
    }

    /// So many cells in place of the files' own.
    pub fn with_cells(mut self, cells: Option<[usize; 3]>) -> Model {
        self.cells = cells.or(self.cells);
        self
    }

    /// The model with a box: what the files say, or the smallest periodic one in which no bond meets itself. Bonds that leave the box
    /// over an open border are taken away, as no code has them.
    pub fn in_its_box(mut self) -> Result<Model> {
        let reach = [0, 1, 2].map(|d| self.bonds.iter().map(|b| b.hop.shift[d].unsigned_abs()).max().unwrap_or(0));
        let mut chosen = Vec::new();
        let cells = *self.cells.get_or_insert_with(|| {
            chosen.push("cells");
            reach.map(|reach| 2 * reach + 1)
        });
        let periodic = *self.periodic.get_or_insert_with(|| {
            chosen.push("periodic");
            reach.map(|reach| reach > 0)
        });
        if !chosen.is_empty() {
            let words =
                "not in the files: the smallest box in which no bond meets itself, periodic where bonds lead on";
            self.notes.push(format!("lattice.{} {words}; change it as needed", chosen.join(" and lattice.")));
        }
        let before = self.bonds.len();
        self.bonds.retain(|b| (0..3).all(|d| periodic[d] || b.hop.shift[d].unsigned_abs() < cells[d]));
        if self.bonds.len() < before {
            let words = "bonds of a cell lead over an open border everywhere, and are left out";
            self.notes.push(format!("{} of {before} {words}", before - self.bonds.len()));
        }
        // one row of single atoms is a chain, whose bonds reach less than half way round
        let row = self.atoms.len() == 1 && cells[1..] == [1, 1] && !periodic[1] && !periodic[2];
        let closes = |hop: Hop| match row {
            true => periodic[0] && 2 * hop.shift[0].unsigned_abs() >= cells[0],
            false => {
                hop.atoms[0] == hop.atoms[1]
                    && (0..3).all(|d| hop.shift[d] % cells[d] as isize == 0 && (periodic[d] || hop.shift[d] == 0))
            }
        };
        if let Some(bond) = self.bonds.iter().find(|bond| closes(bond.hop)) {
            let message = format!(
                "in a box of {cells:?} cells that is periodic along {periodic:?} the bond {:?} cells on leads round to its own \
                 atom: give more, --cells {}",
                bond.hop.shift,
                [0, 1, 2].map(|d| cells[d].max(2 * reach[d] + 1).to_string()).join(",")
            );
            return Err(Error::invalid("--cells", message));
        }
        Ok(self)
    }

    /// The unit of lengths so that |a₁| is 1, for codes that write lengths in Å.
    fn scaled_to_first(mut self, angstrom: f64) -> Model {
        let first = vector::norm(self.vectors[0]);
        self.vectors = self.vectors.map(|v| vector::scale(1.0 / first, v));
        self.spacing_nm = Some(0.1 * angstrom * first);
        self
    }

    /// What can be wrong with any model, whatever its files.
    fn checked(self, file: &Path) -> Result<Model> {
        let [a, b, c] = self.vectors;
        let volume = matrix::determinant(&self.vectors).abs();
        if volume.is_nan() || volume <= 1e-3 * vector::norm(a) * vector::norm(b) * vector::norm(c) {
            return Err(Error::invalid(
                file.display().to_string(),
                "the vectors of the cell lie in a plane, or nearly so",
            ));
        }
        if self.bonds.is_empty() {
            return Err(Error::invalid(
                file.display().to_string(),
                "no pair of atoms interacts: there is nothing to import",
            ));
        }
        Ok(self)
    }
}

/// The file of a format that a path leads to: itself, or one of these names in it if it is a folder.
fn found(path: &Path, names: &[&str]) -> PathBuf {
    match path.is_dir() {
        true => {
            let there = names.iter().map(|name| path.join(name)).find(|file| file.exists());
            there.unwrap_or_else(|| path.join(names[0]))
        }
        false => path.into(),
    }
}

/// The only path of a format that has one.
fn only<'a>(paths: &'a [PathBuf], what: &str) -> Result<&'a Path> {
    match paths {
        [path] => Ok(path),
        _ => Err(Error::invalid("PATH", format!("found {} paths, expected one: {what}", paths.len()))),
    }
}

/// A file that another one names, looked for beside it.
fn beside(file: &Path, named: &str) -> PathBuf {
    let named = named.trim_matches(['"', '\'']);
    file.parent().unwrap_or(Path::new("")).join(named.strip_prefix("./").unwrap_or(named))
}
