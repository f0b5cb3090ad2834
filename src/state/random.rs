//! Directions spread evenly over the sphere, from a seed.

use super::{StateBuilder, StateContext};
use crate::error::Result;
use crate::geometry::Vector;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"random": {"seed": 1}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Random {
    /// Seed of the ChaCha8 generator.
    pub seed: u64,
    /// Reverse odd sites, of a cell with several atoms every other one.
    #[serde(default)]
    pub staggered: bool,
}

impl Described for Random {
    const NAME: &'static str = "random";
    const SUMMARY: &'static str = "directions spread evenly over the sphere, from a seed";
    const EXAMPLE: &'static str = r#"{"random": {"seed": 1}}"#;
}

impl StateBuilder for Random {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        Ok(Spins::random(context.lattice.sites, self.seed).vectors())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
