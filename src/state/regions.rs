//! States side by side, one for each of some regions of the lattice and one for the rest.

use super::sense::Sense;
use super::{StateBuilder, StateContext, StateSpec};
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::registry::Described;
use crate::words::quoted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::Deserialize;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The key of what is in no region.
const DEFAULT: &str = "default";

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
    const EXAMPLE: &'static str = r#"{"regions": {"default": {"uniform": {"direction": [0, 0, 1]}}}}"#;
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
}

impl StateBuilder for Regions {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        let Some(rest) = self.states.get(DEFAULT) else {
            let message = "the state of all sites that are in no region is missing: add \"default\": {\"uniform\": …}";
            return Err(Error::invalid("", message));
        };
        self.sites(DEFAULT, context)?;
        let within = |name: &str, spec: &StateSpec, e: Error| e.within(&format!("{name}.{}", spec.name()));
        let mut all = rest.arranged(context).map_err(|e| within(DEFAULT, rest, e))?;
        for (name, spec) in self.states.iter().filter(|(name, _)| *name != DEFAULT) {
            let own = spec.arranged(context).map_err(|e| within(name, spec, e))?;
            self.sites(name, context)?.into_iter().for_each(|i| all[i] = own[i]);
        }
        Ok(all)
    }

    fn staggered(&self) -> bool {
        false
    }

    /// Those of all its states: each takes the one that is chosen, if it is open to it, and else its first.
    fn senses(&self, context: &StateContext) -> Vec<Sense> {
        let mut open: Vec<Sense> = Vec::new();
        for sense in self.states.values().flat_map(|spec| spec.member().senses(context)) {
            if !open.contains(&sense) {
                open.push(sense);
            }
        }
        open
    }

    fn may_miss_senses(&self) -> bool {
        self.states.values().any(|spec| spec.member().may_miss_senses())
    }
}
