//! Geodesics through given states, images at equal distances.

use super::clock::clocked;
use super::{FirstGuess, GuessContext};
use crate::error::Result;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::state::StateSpec;
use serde::Deserialize;

/// `{"waypoints": {"states": [{"domain_wall": {"center": 3}}]}}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Waypoints {
    /// The states on the way, in order; the two ends are not repeated.
    pub states: Vec<StateSpec>,
}

impl Described for Waypoints {
    const NAME: &'static str = "waypoints";
    const SUMMARY: &'static str = "geodesics through given states";
    const EXAMPLE: &'static str =
        r#"{"waypoints": {"states": [{"domain_wall": {"center": 3}}, {"domain_wall": {"center": 7}}]}}"#;
}

impl FirstGuess for Waypoints {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let mut stops = vec![a.clone()];
        for (k, state) in self.states.iter().enumerate() {
            stops.push(state.build(&context.states).map_err(|e| e.within(&format!("states[{k}]")))?);
        }
        stops.push(b.clone());
        let mut row = vec![a.clone()];
        for leg in stops.windows(2) {
            let part = clocked(&leg[0], &leg[1], images.max(3), context.default_axis, |t, _| t);
            row.extend((1..part.images()).map(|k| part.spins(k)));
        }
        Ok(Path::new(&row).resampled(images))
    }
}
