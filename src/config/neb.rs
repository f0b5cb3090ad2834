//! How the band is relaxed, and what is done with its saddles.

use crate::drive::{NebSettings, checked_evaluations, checked_tolerance};
use crate::optimise::OptimiserSpec;
use schemars::JsonSchema;
use serde::de::Error;
use serde::{Deserialize, Deserializer};

/// `"neb": {"climb": true, "tolerance": 1e-6, "max_evaluations": 20000, "optimiser": {"implicit": {}}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct NebConfig {
    /// Let the maxima climb.
    pub climb: bool,
    /// Largest predicted remaining rotation of any spin (rad).
    #[serde(deserialize_with = "tolerance")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub tolerance: f64,
    /// Most evaluations of the whole band.
    #[serde(deserialize_with = "evaluations")]
    #[schemars(range(min = 1))]
    pub max_evaluations: usize,
    /// The method.
    pub optimiser: OptimiserSpec,
}

impl Default for NebConfig {
    fn default() -> Self {
        let NebSettings { climb, tolerance, max_evaluations, optimiser } = NebSettings::default();
        NebConfig { climb, tolerance, max_evaluations, optimiser }
    }
}

impl NebConfig {
    /// As the drive takes it.
    pub fn settings(&self) -> NebSettings {
        let NebConfig { climb, tolerance, max_evaluations, ref optimiser } = *self;
        NebSettings { climb, tolerance, max_evaluations, optimiser: optimiser.clone() }
    }
}

/// `"saddle": {"refine": true, "certify": true}`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SaddleConfig {
    /// Refine each maximum of the band to the saddle itself.
    pub refine: bool,
    /// Prove that saddles and ends are what they are said to be.
    pub certify: bool,
}

impl Default for SaddleConfig {
    fn default() -> Self {
        SaddleConfig { refine: true, certify: true }
    }
}

fn tolerance<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    checked_tolerance(f64::deserialize(d)?).map_err(D::Error::custom)
}

fn evaluations<'de, D: Deserializer<'de>>(d: D) -> Result<usize, D::Error> {
    checked_evaluations(usize::deserialize(d)?).map_err(D::Error::custom)
}
