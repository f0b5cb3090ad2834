//! Every spin along its great circle (slerp), each at a constant pace: the shortest path in the product of spheres, of length
//! √Σθ². K. Shoemake, SIGGRAPH 1985, doi:10.1145/325334.325242. Nearly opposite spins (3 rad apart or more) turn about one
//! axis, which makes their way longer by 2(π − θ) at the most.

use super::clock::{Ways, clocked, fraction};
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::geometry::Direction;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"geodesic": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
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
        Ok(self.along(&Ways::between(a, b), images, context))
    }
}

impl Geodesic {
    /// The path along ways that are known.
    pub(crate) fn along(&self, ways: &Ways, images: usize, context: &GuessContext) -> Path {
        let about = ways.about(self.axis.unwrap_or(context.default_axis));
        clocked(ways, &about, images, |k, _| fraction(k, images))
    }
}
