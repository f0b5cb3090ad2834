//! What a chain is made of: one format for atomistic and micromagnetic models.

use crate::energy::TermSpec;
use crate::error::{Error, Result};
use crate::units::{Magnetisation, Moment};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;

/// A material: its moment (or magnetisation) and its energy terms.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct Material {
    /// What people call it.
    pub name: String,
    /// Where the numbers come from.
    #[serde(default)]
    pub source: Option<String>,
    /// How well they are known.
    #[serde(default)]
    pub status: Option<String>,
    /// Anything else.
    #[serde(default)]
    pub comment: Option<String>,
    /// Magnetic moment of a site.
    #[serde(default)]
    pub moment: Option<Moment>,
    /// Saturation magnetisation; with the lattice's cell it gives the moment of a site.
    #[serde(default)]
    pub Ms: Option<Magnetisation>,
    /// Its energy terms.
    #[serde(default)]
    pub energy: Vec<TermSpec>,
}

impl Material {
    /// A moment that makes sense, given in one way.
    pub fn validate(&self) -> Result<()> {
        if self.moment.is_some() && self.Ms.is_some() {
            return Err(Error::invalid("Ms", "\"moment\" and \"Ms\" are two ways to say the same: keep one"));
        }
        let given = [("moment", self.moment.map(|m| m.0)), ("Ms", self.Ms.map(|m| m.0))];
        match given.iter().find(|(_, value)| value.is_some_and(|v| v < 0.0)) {
            Some((key, _)) => Err(Error::invalid(
                *key,
                "found a negative value: a spin is the direction of its moment, so this is not negative",
            )),
            None => Ok(()),
        }
    }
}

/// A config's `material`: the name of a file or the material itself.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialChoice {
    /// A path relative to the config.
    Named(String),
    /// The material.
    Inline(Box<Material>),
}

impl JsonSchema for MaterialChoice {
    fn schema_name() -> Cow<'static, str> {
        "MaterialChoice".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let named = json!({"type": "string", "description": "a file, looked for beside the config"});
        json_schema!({"oneOf": [named, generator.subschema_for::<Material>()]})
    }
}

impl<'de> Deserialize<'de> for MaterialChoice {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = MaterialChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a material: its file, such as \"materials/toy.json\", or an object with its energy terms")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> std::result::Result<MaterialChoice, E> {
                Ok(MaterialChoice::Named(name.into()))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> std::result::Result<MaterialChoice, A::Error> {
                Material::deserialize(MapAccessDeserializer::new(map)).map(|m| MaterialChoice::Inline(Box::new(m)))
            }
        }
        d.deserialize_any(Seen)
    }
}
