//! Magnetostatics of uniformly magnetised cells: spacing × width × thickness each, one a site, all pairs.
//!
//! ```text
//! E = ½ μ₀ V Σ_ij M_i·N(|i − j|) M_j          N: Newell's tensors, trace 1 for i = j and 0 else
//! ```
//! The cells lie along the chain's direction. With the default, +x, their width is along y and their thickness along z; another
//! direction takes these with it by the smallest rotation from x. A ring is the straight chain that repeats itself.

use super::EnergyTerm;
use super::magnetostatics::{Magnetostatics, Row, Shape};
use super::spec::{Medium, TermBuilder};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::registry::Described;
use serde::Deserialize;

/// Most that width and thickness may differ from the spacing, as a factor: beyond, the closed forms lose their digits.
const SLENDER: f64 = 1000.0;

/// `{}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DemagSpec {}

impl Described for DemagSpec {
    const NAME: &'static str = "demag";
    const SUMMARY: &'static str = "demagnetising field of uniformly magnetised cells (Newell tensors), all pairs";
    const EXAMPLE: &'static str = r#"{"demag": {}}"#;
}

impl TermBuilder for DemagSpec {
    fn build(&self, medium: &Medium) -> Result<Box<dyn EnergyTerm>> {
        let [width, thickness] = medium.edges_nm()?;
        let spacing = medium.spacing_nm()?;
        for edge in [width, thickness] {
            if !(1.0 / SLENDER..=SLENDER).contains(&(edge / spacing)) {
                let message = format!(
                    "a cell is {spacing} nm × {width} nm × {thickness} nm: the edges of a cell may differ by a factor of {SLENDER} \
                     from the spacing, not more"
                );
                return Err(Error::invalid("", message));
            }
        }
        let row = Row {
            shape: Shape::Cells { width: width / spacing, thickness: thickness / spacing },
            volume_nm3: spacing * width * thickness,
            periodic: medium.chain.periodic,
            direction: medium.chain.direction.unwrap_or(Direction::X),
        };
        Ok(Box::new(Magnetostatics::new(DemagSpec::NAME, &row, medium.acting_moments_mub()?)))
    }
}
