//! Spins that turn about an axis from site to site along a direction n.
//!
//! ```text
//! m_i = cos φ_i u + sin φ_i (k × u),   φ_i = 2π r_i·n/period + phase       (along a chain r_i·n is the number i of the site)
//! ```
//! u is the part normal to k of z, or of x where k lies along z.

use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::registry::Described;
use crate::units::{Angle, Extent};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;

/// `{"spiral": {"axis": [0, 1, 0], "period": 20}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spiral {
    /// Axis k of the turn.
    pub axis: Direction,
    /// Sites a full turn; negative turns the other way.
    pub period: Extent,
    /// Where the turn goes; +x if absent, in a chain along the chain.
    #[serde(default)]
    pub along: Option<Direction>,
    /// Angle at the origin.
    #[serde(default)]
    pub phase: Option<Angle>,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Spiral {
    const NAME: &'static str = "spiral";
    const SUMMARY: &'static str = "spins that turn about an axis, a full turn in `period` sites";
    const EXAMPLE: &'static str = r#"{"spiral": {"axis": [0, 1, 0], "period": 20, "phase": "30 deg"}}"#;
}

impl StateBuilder for Spiral {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let period = context.lattice.spacings(self.period).map_err(|e| e.within("period"))?;
        if period == 0.0 {
            return Err(Error::invalid(
                "period",
                format!("found {}, but a period is a number of sites other than 0", self.period),
            ));
        }
        let k = self.axis.vector();
        let start = if k[2].abs() < 0.999_999 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let u = vector::unit_or(vector::normal_part(start, k), start);
        let w = vector::cross(k, u);
        let phase = self.phase.map_or(0.0, |a| a.0);
        let at = |x: f64| {
            let (sin, cos) = libm::sincos(phase + TAU * ((x / period) % 1.0));
            vector::add(vector::scale(cos, u), vector::scale(sin, w))
        };
        Ok(context.lattice.coordinates(self.along).into_iter().map(at).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
