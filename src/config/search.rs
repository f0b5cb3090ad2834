//! How long passes below the best of the first paths are looked for.

use super::Config;
use crate::error::{Error, Result};
use crate::landscape::Effort;
use schemars::JsonSchema;
use serde::Deserialize;

/// `"search": {"effort": "normal"}`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct SearchConfig {
    /// none: not at all; the others look until 8 (quick), 24 for each direction of the lattice, and 16 more for each saddle found up to
    /// 100, and to 100 more for each time that the route became lower (normal), or 400 or as many (thorough) searches in a row brought no
    /// news.
    pub effort: Effort,
}

impl Config {
    /// How long is looked: a path whose guess is written, or whose ends are kept, is the one that is asked for.
    pub fn effort(&self) -> Result<Effort> {
        let own = self.path.guess.is_some() || !self.relax_ends;
        match self.search {
            Some(SearchConfig { effort }) if !self.relax_ends && effort != Effort::None => Err(Error::invalid(
                "search",
                "found a search, but the ends are kept (relax_ends is false), and what is found lies between minima: leave it \
                 out, or relax the ends",
            )),
            Some(SearchConfig { effort }) => Ok(effort),
            None => Ok(if own { Effort::None } else { Effort::default() }),
        }
    }
}
