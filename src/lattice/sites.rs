//! Sites that are not as the others, as written in a config.

use super::selection::Selection;
use crate::geometry::Direction;
use crate::profile::Profile;
use crate::units::{Length, Magnetisation, Moment};
use schemars::JsonSchema;
use serde::Deserialize;

/// Sites with a moment of their own.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct SiteMoment {
    /// Which ones.
    pub sites: Selection,
    /// The moment of each.
    #[serde(default)]
    pub moment: Option<Profile<Moment>>,
    /// The saturation magnetisation of each, in place of the moment.
    #[serde(default)]
    pub Ms: Option<Profile<Magnetisation>>,
}

/// Sites with a cross-section of their own.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SiteSection {
    /// Which ones.
    pub sites: Selection,
    /// Width of each; that of the chain if not given.
    #[serde(default)]
    pub width: Option<Profile<Length>>,
    /// Thickness of each; that of the chain if not given.
    #[serde(default)]
    pub thickness: Option<Profile<Length>>,
}

/// Spins that never move.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Frozen {
    /// Which ones.
    pub sites: Selection,
    /// Where they point; as in the initial state if not given.
    #[serde(default)]
    pub direction: Option<Direction>,
}
