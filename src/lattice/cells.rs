//! Cells of a continuum: spacing × width × thickness each.
//!
//! A bond between cells of unequal cross-sections S has their harmonic mean, 2 S_i S_j/(S_i + S_j): between the two centres the
//! flux A S dm/dx of the exchange is continuous, so half a spacing of each are springs in series. (S. V. Patankar, Numerical Heat
//! Transfer and Fluid Flow, 1980, §4.2-3, for fluxes in general.) D S, weighted with the angles that these springs turn by, has
//! the same mean.

use super::{BondFamily, Hop, Lattice};
use crate::error::{Error, Result};
use crate::geometry::vector;

impl Lattice {
    /// Distance of neighbours (nm); an error where it is not given.
    pub fn known_spacing_nm(&self) -> Result<f64> {
        let missing = || Error::invalid("", "a continuum quantity needs the lattice's \"spacing\" (\"2 nm\")");
        self.spacing_nm.ok_or_else(missing)
    }

    /// Width and thickness of every cell (nm); an error where they are not given.
    pub fn known_sections_nm(&self) -> Result<&[[f64; 2]]> {
        let missing = || {
            let message = "a continuum quantity needs cells: the lattice \"grid\", or a \"chain\" with its \"cross_section\" \
                           ([\"20 nm\", \"5 nm\"])";
            Error::invalid("", message)
        };
        self.sections_nm.as_deref().ok_or_else(missing)
    }

    /// Volume of cell i (nm³).
    pub fn volume_nm3(&self, i: usize) -> Result<f64> {
        let [width, thickness] = self.known_sections_nm()?[i];
        Ok(width * thickness * self.known_spacing_nm()?)
    }

    /// Area between the centres of two cells that share a face (nm²).
    pub fn bond_section_nm2(&self, family: &BondFamily, sites: [usize; 2]) -> Result<f64> {
        let sections = self.known_sections_nm()?;
        let across = match family.hop.shift.map(|n| n != 0) {
            [_, false, false] => [None, None],
            [false, true, false] => [Some(self.known_spacing_nm()?), None],
            _ => [None, Some(self.known_spacing_nm()?)],
        };
        let [s, t] = sites.map(|i| across[0].unwrap_or(sections[i][0]) * across[1].unwrap_or(sections[i][1]));
        Ok(if s == t { s } else { 2.0 * s * t / (s + t) })
    }

    /// Distance of the two ends of a bond (nm).
    pub fn bond_length_nm(&self, family: &BondFamily) -> Result<f64> {
        let spacing = self.known_spacing_nm()?;
        Ok(if self.is_row() { spacing } else { vector::norm(family.along) })
    }

    /// The bonds of cells that share a face: nearest neighbours of a chain, those along each direction of a grid; an error where
    /// there are no cells.
    pub fn faces(&self) -> Result<Vec<BondFamily>> {
        if self.is_row() {
            self.admits(1)?;
            return Ok(self.shell(1));
        }
        if self.sections_nm.is_none() {
            let message =
                format!("a quantity of a continuum needs cells: give the lattice as a \"grid\", not a {:?}", self.kind);
            return Err(Error::invalid("", message));
        }
        let hop = |d: usize| Hop { atoms: [0; 2], shift: [0, 1, 2].map(|k| isize::from(k == d)) };
        // a cell that is its own neighbour costs nothing
        Ok((0..3).filter(|d| self.grid.size[*d] > 1).map(|d| BondFamily::new(self, 1, hop(d))).collect())
    }

    /// Area of the cross-section (nm²), where given: the middle one of all by size.
    pub fn middle_section_nm2(&self) -> Option<f64> {
        let mut areas: Vec<f64> = self.sections_nm.as_ref()?.iter().map(|[w, t]| w * t).collect();
        areas.sort_by(f64::total_cmp);
        areas.get(areas.len() / 2).copied()
    }
}
