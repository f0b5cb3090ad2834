//! Directions spread evenly over the sphere, from a seed: z even on [−1, 1], azimuth even (Archimedes).

use super::{StateBuilder, StateContext};
use crate::error::Result;
use crate::geometry::Vector;
use crate::registry::Described;
use rand::{RngExt, SeedableRng};
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::TAU;

/// `{"random": {"seed": 1}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Random {
    /// Seed of the ChaCha8 generator.
    pub seed: u64,
    /// Reverse odd sites.
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
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(self.seed);
        let mut one = || {
            let z: f64 = r.random_range(-1.0..1.0);
            let (sin, cos) = libm::sincos(r.random_range(0.0..TAU));
            let across = (1.0 - z * z).sqrt();
            [across * cos, across * sin, z]
        };
        Ok((0..context.chain.sites).map(|_| one()).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}
