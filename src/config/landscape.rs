//! The landscape that is asked for: `spinneb landscape` reads it, `run` does not.

use super::rates::{RatesConfig, Temperatures};
use super::{Config, Loaded};
use crate::drive::survey::{IMAGES, Label, SurveyProblem};
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
    /// How long minima and saddles are looked for. none: not at all; the others until 8 (quick), 40 (normal) or 400 (thorough) searches in
    /// a row brought no news, or 1, 3 and 10 for each pass that is known, where those are more.
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

/// `{"axis": [0, 0, 1], "from": 0.5}`: states whose mean spin along the axis is at least and at most so large; or `{"charge": -1}`: states
/// of a film or crystal whose topological charge is nearest to that.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupConfig {
    /// Along this direction.
    pub axis: Option<Direction>,
    /// With this charge.
    pub charge: Option<i32>,
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
    fn label(self, name: &str) -> Result<Label> {
        let GroupConfig { axis, charge, from, to } = self;
        let path = || format!("landscape.groups.{name}");
        let axis = match (axis, charge) {
            (None, Some(charge)) if (from, to) == (lowest(), highest()) => return Ok(Label::Charge(charge)),
            (Some(axis), None) => axis,
            _ => {
                let message = "a group takes an axis with from and to, or a charge, such as {\"charge\": -1}";
                return Err(Error::invalid(path(), message));
            }
        };
        if from > to || !(-1.0..=1.0).contains(&from) || !(-1.0..=1.0).contains(&to) {
            let message =
                format!("found {} to {}, but mean spins are from -1 to 1, the smaller first", number(from), number(to));
            return Err(Error::invalid(path(), message));
        }
        Ok(Label::MeanSpin { axis, from: from - 1e-9, to: to + 1e-9 })
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
        let groups = own.groups.iter().map(|(name, group)| match group.label(name)? {
            Label::Charge(_) if self.lattice.triangles().corners.is_empty() => {
                let message = "found a charge, but only films and crystals of layers have one";
                Err(Error::invalid(format!("landscape.groups.{name}.charge"), message))
            }
            label => Ok((name.clone(), label)),
        });
        let groups = groups.collect::<Result<Vec<_>>>().map_err(here)?;
        let rates = self.config.landscape_rates(&own);
        let (problem, seeds, rates) = self.seeded_problem(&own.states, rates.as_ref())?;
        let window_mev = own.energy_window.map_or(f64::INFINITY, |e| e.0);
        Ok(SurveyProblem { problem, seeds, window_mev, effort: own.effort, groups, rates, shares: 1, images: IMAGES })
    }
}
