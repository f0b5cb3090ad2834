//! Cells of a continuum: spacing × width × thickness each.
//!
//! A bond between cells of unequal cross-sections S has their harmonic mean, 2 S_i S_j/(S_i + S_j): between the two centres the
//! flux A S dm/dx of the exchange is continuous, so half a spacing of each are springs in series. (S. V. Patankar, Numerical Heat
//! Transfer and Fluid Flow, 1980, §4.2-3, for fluxes in general.) D S, weighted with the angles that these springs turn by, has
//! the same mean.

use super::Lattice;
use crate::error::{Error, Result};

impl Lattice {
    /// Distance of neighbours (nm); an error where it is not given.
    pub fn known_spacing_nm(&self) -> Result<f64> {
        let missing = || Error::invalid("", "a continuum quantity needs the lattice's \"spacing\" (\"2 nm\")");
        self.spacing_nm.ok_or_else(missing)
    }

    /// Width and thickness of every cell (nm); an error where they are not given.
    pub fn known_sections_nm(&self) -> Result<&[[f64; 2]]> {
        let missing =
            || Error::invalid("", "a continuum quantity needs the lattice's \"cross_section\" ([\"20 nm\", \"5 nm\"])");
        self.sections_nm.as_deref().ok_or_else(missing)
    }

    /// Volume of cell i (nm³).
    pub fn volume_nm3(&self, i: usize) -> Result<f64> {
        let [width, thickness] = self.known_sections_nm()?[i];
        Ok(width * thickness * self.known_spacing_nm()?)
    }

    /// Cross-section between the centres of two neighbours (nm²).
    pub fn bond_section_nm2(&self, sites: [usize; 2]) -> Result<f64> {
        let sections = self.known_sections_nm()?;
        let [s, t] = sites.map(|i| sections[i][0] * sections[i][1]);
        Ok(if s == t { s } else { 2.0 * s * t / (s + t) })
    }

    /// Area of the cross-section (nm²), where given: the middle one of all by size.
    pub fn middle_section_nm2(&self) -> Option<f64> {
        let mut areas: Vec<f64> = self.sections_nm.as_ref()?.iter().map(|[w, t]| w * t).collect();
        areas.sort_by(f64::total_cmp);
        areas.get(areas.len() / 2).copied()
    }
}
