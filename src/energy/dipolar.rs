//! Point dipoles, all pairs.
//!
//! ```text
//! E = (μ₀/4π) Σ_{i<j} μ_i μ_j [m_i·m_j − 3 (m_i·e)(m_j·e)]/r_ij³          e: the chain's direction
//! ```
//! A ring is the straight chain that repeats itself: the sums over its images are Hurwitz zeta functions, so they are complete.

use super::EnergyTerm;
use super::magnetostatics::{Magnetostatics, Row, Shape};
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::registry::Described;
use serde::Deserialize;

/// `{}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DipolarSpec {}

impl Described for DipolarSpec {
    const NAME: &'static str = "dipolar";
    const SUMMARY: &'static str = "point dipoles, exact for all pairs and, in rings, all images";
    const EXAMPLE: &'static str = r#"{"dipolar": {}}"#;
}

impl TermBuilder for DipolarSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        medium.in_a_chain()?;
        let Some(spacing) = medium.lattice.spacing_nm else {
            return Err(Error::invalid(
                "",
                "dipoles need their distance: give the lattice a \"spacing\" (\"0.25 nm\")",
            ));
        };
        let row = Row {
            shape: Shape::Dipoles,
            volume_nm3: spacing * spacing * spacing,
            periodic: medium.lattice.is_ring(),
            direction: medium.lattice.direction(),
        };
        Ok(Box::new(Magnetostatics::new(DipolarSpec::NAME, &row, medium.acting_moments_mub()?)))
    }
}
