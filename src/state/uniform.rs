//! All spins along one direction.

use super::{StateBuilder, StateContext};
use crate::error::Result;
use crate::geometry::{Direction, Vector};
use crate::registry::Described;
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"uniform": {"direction": [0, 0, 1]}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Uniform {
    /// Where the spins point.
    pub direction: Direction,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Uniform {
    const NAME: &'static str = "uniform";
    const SUMMARY: &'static str = "all spins along one direction";
    const EXAMPLE: &'static str = r#"{"uniform": {"direction": [0, 0, 1]}}"#;
}

impl StateBuilder for Uniform {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        Ok(vec![self.direction.vector(); context.lattice.sites])
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
