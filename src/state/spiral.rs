//! Spins that turn about an axis from site to site.
//!
//! ```text
//! m_i = cos φ_i u + sin φ_i (k × u),   φ_i = 2π i/period + phase
//! ```
//! u is the part normal to k of z, or of x where k lies along z.

use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::registry::Described;
use crate::units::Angle;
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
    pub period: f64,
    /// Angle of site 0.
    #[serde(default)]
    pub phase: Option<Angle>,
    /// Reverse odd sites.
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
        if !self.period.is_finite() || self.period == 0.0 {
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
        let at = |i: usize| {
            let (sin, cos) = libm::sincos(phase + TAU * ((i as f64 / self.period) % 1.0));
            vector::add(vector::scale(cos, u), vector::scale(sin, w))
        };
        Ok((0..context.lattice.sites).map(at).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
