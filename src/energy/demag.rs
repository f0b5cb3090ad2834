//! Magnetostatics of uniformly magnetised cells: spacing × width × thickness each, one a site, all pairs.
//!
//! ```text
//! E = ½ μ₀ V Σ_ij M_i·N(|i − j|) M_j          N: Newell's tensors, trace 1 for i = j and 0 else
//! ```
//! Cells of unequal cross-sections (tapers, notches) have a tensor a pair instead of one a distance; up to 1024 sites may have them.
//!
//! The cells lie along the chain's direction. With the default, +x, their width is along y and their thickness along z; another
//! direction takes these with it by the smallest rotation from x. A ring is the straight chain that repeats itself.

use super::EnergyTerm;
use super::magnetostatics::{Magnetostatics, Row, Shape};
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::registry::Described;
use serde::Deserialize;

/// Most that width and thickness may differ from the spacing, as a factor: beyond, the closed forms lose their digits.
const SLENDER: f64 = 1000.0;

/// Most sites of a chain of unequal cells: their Hessian is dense.
const MOST_UNEQUAL: usize = 1024;

/// `{}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DemagSpec {}

impl Described for DemagSpec {
    const NAME: &'static str = "demag";
    const SUMMARY: &'static str = "demagnetising field of uniformly magnetised cells (Newell tensors), all pairs";
    const EXAMPLE: &'static str = r#"{"demag": {}}"#;
}

impl TermBuilder for DemagSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        medium.in_a_chain()?;
        let sections = medium.lattice.known_sections_nm()?;
        let spacing = medium.lattice.known_spacing_nm()?;
        for edges in sections {
            if edges.iter().any(|edge| !(1.0 / SLENDER..=SLENDER).contains(&(edge / spacing))) {
                let [width, thickness] = edges;
                let message = format!(
                    "a cell is {spacing} nm × {width} nm × {thickness} nm: the edges of a cell may differ by a factor of {SLENDER} \
                     from the spacing, not more"
                );
                return Err(Error::invalid("", message));
            }
        }
        let direction = medium.lattice.direction();
        let (moments, periodic) = (medium.acting_moments_mub()?, medium.lattice.is_ring());
        let [width, thickness] = sections[0];
        if sections.iter().all(|s| *s == sections[0]) {
            let shape = Shape::Cells { width: width / spacing, thickness: thickness / spacing };
            let row = Row { shape, volume_nm3: spacing * width * thickness, periodic, direction };
            return Ok(Box::new(Magnetostatics::new(DemagSpec::NAME, &row, moments)));
        }
        let sites = sections.len();
        if sites > MOST_UNEQUAL {
            let message = format!(
                "cells of unequal cross-sections act on each other pair by pair, which is for at most {MOST_UNEQUAL} sites; there \
                 are {sites}: make the cells longer and fewer, or give all one cross-section and let \"Ms\" vary instead"
            );
            return Err(Error::invalid("", message));
        }
        let sections: Vec<_> = sections.iter().map(|s| s.map(|edge| edge / spacing)).collect();
        let term = Magnetostatics::unequal(DemagSpec::NAME, spacing, &sections, periodic, direction, moments);
        Ok(Box::new(term))
    }
}
