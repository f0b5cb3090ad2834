//! States side by side, one for each of some regions of the lattice and one for the rest.

use super::parts::{self, DEFAULT, Part};
use super::{StateBuilder, StateContext, StateSpec};
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::registry::Described;
use crate::words::quoted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// `{"regions": {"default": {"uniform": {"direction": [0, 0, 1]}}, "island": {"uniform": {"direction": [0, 0, -1]}}}}`.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(transparent)]
pub struct Regions {
    /// The states by the names of their regions, and that of all other sites by the name `default`.
    pub states: BTreeMap<String, StateSpec>,
}

impl Described for Regions {
    const NAME: &'static str = "regions";
    const SUMMARY: &'static str = "a state for each of some regions of the lattice, and one for the rest";
    const EXAMPLE: &'static str = r#"{"regions": {"default": {"uniform": {"direction": [0, 0, 1]}}, "island": {"uniform": {"direction": [0, 0, -1]}}}}"#;
}

impl JsonSchema for Regions {
    fn schema_name() -> Cow<'static, str> {
        "Regions".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let state = generator.subschema_for::<StateSpec>();
        json_schema!({
            "type": "object",
            "description": "states by the names of the lattice's regions; \"default\" is that of all other sites",
            "properties": {DEFAULT: {"allOf": [state], "description": "That of all sites in no region."}},
            "required": [DEFAULT],
            "additionalProperties": state,
        })
    }
}

impl Regions {
    /// Which sites a state is for.
    fn sites(&self, name: &str, context: &StateContext) -> Result<Vec<usize>> {
        if name != DEFAULT {
            return context.lattice.named(name).map_err(|e| e.within(name));
        }
        let mut free = vec![true; context.lattice.sites];
        for name in self.states.keys().filter(|name| *name != DEFAULT) {
            for i in self.sites(name, context)? {
                if !std::mem::replace(&mut free[i], false) {
                    let message = format!("site {i} is in the region {} and in another one here", quoted(name));
                    return Err(Error::invalid(name.clone(), message));
                }
            }
        }
        Ok((0..free.len()).filter(|i| free[*i]).collect())
    }

    /// The states and their sites, what is in no region first; states by region in a region are parts themselves.
    pub(super) fn parts(&self, context: &StateContext) -> Result<Vec<Part<'_>>> {
        let Some(rest) = self.states.get(DEFAULT) else {
            let message = "the state of all sites that are in no region is missing: add \"default\": {\"uniform\": …}";
            return Err(Error::invalid("", message));
        };
        let others = self.states.iter().filter(|(name, _)| *name != DEFAULT).map(|(name, spec)| (name.as_str(), spec));
        let mut parts = Vec::new();
        for (name, spec) in [(DEFAULT, rest)].into_iter().chain(others) {
            let (sites, place) = (self.sites(name, context)?, format!("{name}.{}", spec.name()));
            match spec {
                StateSpec::Regions(inner) => {
                    let inner = inner.parts(context).map_err(|e| e.within(&place))?;
                    parts.extend(inner.into_iter().map(|part| part.inside(name, &place, &sites)));
                }
                _ => parts.push(Part { name: name.into(), place, spec, sites }),
            }
        }
        Ok(parts)
    }
}

impl StateBuilder for Regions {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        Ok(parts::settled(self.parts(context)?, context)?.0)
    }

    fn staggered(&self) -> bool {
        false
    }
}
