//! The landscape that is asked for: `spinneb landscape` reads it, `run` does not.

use super::rates::{RatesConfig, Temperatures};
use super::{Config, Loaded};
use crate::drive::survey::{MeanSpin, SurveyProblem};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::landscape::Effort;
use crate::state::StateSpec;
use crate::units::Energy;
use crate::words::number;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// `"landscape": {"effort": "normal", "energy_window": "20 meV", "states": [{"domain_wall": {"center": 10}}]}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct LandscapeConfig {
    /// How long minima and saddles are looked for.
    pub effort: Effort,
    /// States above the lowest minimum by more than this are left out; none if absent.
    pub energy_window: Option<Energy>,
    /// States to start from, besides the ends, uniform ones and random ones.
    pub states: Vec<StateSpec>,
    /// Groups of minima by name, for lifetimes; each of the lowest minima by itself if there are none.
    pub groups: BTreeMap<String, GroupConfig>,
    /// Temperatures of lifetimes, in place of those of `rates`.
    pub temperatures: Option<Temperatures>,
}

/// `{"axis": [0, 0, 1], "from": 0.5}`: states whose mean spin along the axis is at least and at most so large.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupConfig {
    /// Along this direction.
    pub axis: Direction,
    /// At least.
    #[serde(default = "lowest")]
    pub from: f64,
    /// At most.
    #[serde(default = "highest")]
    pub to: f64,
}

fn lowest() -> f64 {
    -1.0
}

fn highest() -> f64 {
    1.0
}

impl GroupConfig {
    /// A hair wider than it is written: a uniform state's mean spin is 1 but for rounding.
    fn label(self, name: &str) -> Result<MeanSpin> {
        let GroupConfig { axis, from, to } = self;
        if from > to || !(-1.0..=1.0).contains(&from) || !(-1.0..=1.0).contains(&to) {
            let message =
                format!("found {} to {}, but mean spins are from -1 to 1, the smaller first", number(from), number(to));
            return Err(Error::invalid(format!("landscape.groups.{name}"), message));
        }
        Ok(MeanSpin { axis, from: from - 1e-9, to: to + 1e-9 })
    }
}

impl Config {
    /// Temperatures and theory of a landscape's lifetimes.
    fn landscape_rates(&self, own: &LandscapeConfig) -> Option<RatesConfig> {
        match (&own.temperatures, &self.rates) {
            (Some(Temperatures(list)), None) => Some(RatesConfig::at(list.clone())),
            (Some(temperatures), Some(rates)) => {
                Some(RatesConfig { temperatures: temperatures.clone(), ..rates.clone() })
            }
            (None, rates) => rates.clone(),
        }
    }
}

impl Loaded {
    /// The survey that the config asks for; an error, with its place, where something cannot be.
    pub fn survey(&self) -> Result<SurveyProblem> {
        let here = |e: Error| self.text.locate(e);
        let own = self.config.landscape.clone().unwrap_or_default();
        if let Some(window) = own.energy_window.filter(|e| e.0 <= 0.0) {
            let message = format!("found {window}, but a window reaches above the lowest minimum, such as \"20 meV\"");
            return Err(here(Error::invalid("landscape.energy_window", message)));
        }
        let groups = own.groups.iter().map(|(name, group)| Ok((name.clone(), group.label(name)?)));
        let groups = groups.collect::<Result<Vec<_>>>().map_err(here)?;
        let rates = self.config.landscape_rates(&own);
        let (problem, seeds, rates) = self.seeded_problem(&own.states, rates.as_ref())?;
        let window_mev = own.energy_window.map_or(f64::INFINITY, |e| e.0);
        Ok(SurveyProblem { problem, seeds, window_mev, effort: own.effort, groups, rates })
    }
}
