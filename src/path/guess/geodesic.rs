//! Every spin along its great circle, all at the same pace: the shortest path in the product of spheres.

use super::clock::clocked;
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::geometry::Direction;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use serde::Deserialize;

/// `{"geodesic": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Geodesic {
    /// Axis about which opposite spins turn.
    #[serde(default)]
    pub axis: Option<Direction>,
}

impl Described for Geodesic {
    const NAME: &'static str = "geodesic";
    const SUMMARY: &'static str = "every spin along its great circle (slerp), opposite ones about one axis";
    const EXAMPLE: &'static str = r#"{"geodesic": {"axis": [1, 0, 0]}}"#;
}

impl FirstGuess for Geodesic {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        Ok(clocked(a, b, images, self.axis.unwrap_or(context.default_axis), |t, _| t))
    }
}
