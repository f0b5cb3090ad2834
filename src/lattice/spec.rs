//! A lattice as written in a config.

use super::Lattice;
use super::chain::Chain;
use crate::error::Result;
use schemars::JsonSchema;
use serde::Deserialize;

/// `{"chain": {…}}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Lattice")]
pub enum LatticeSpec {
    /// A row of equally spaced sites.
    Chain(Chain),
}

impl LatticeSpec {
    /// Number of sites, if that can be.
    pub fn sites(&self) -> Result<usize> {
        let LatticeSpec::Chain(chain) = self;
        chain.checked_sites().map_err(|e| e.within("chain"))
    }

    /// The lattice; an error, with its place, where something cannot be.
    pub fn resolve(&self) -> Result<Lattice> {
        let LatticeSpec::Chain(chain) = self;
        chain.resolve().map_err(|e| e.within("chain"))
    }
}
