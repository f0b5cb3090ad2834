//! What a chain is made of: one format for atomistic and micromagnetic models.

use crate::energy::TermSpec;
use crate::error::{Error, Result};
use crate::profile::Profile;
use crate::units::{Magnetisation, Moment};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, DeserializeSeed, IntoDeserializer, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

/// A material: its moment (or magnetisation) and its energy terms.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[allow(non_snake_case)]
pub struct Material {
    /// What people call it.
    pub name: String,
    /// What they also call it.
    #[serde(default)]
    pub also: Vec<String>,
    /// Where the numbers come from.
    #[serde(default)]
    pub source: Option<String>,
    /// How well they are known.
    #[serde(default)]
    pub status: Option<String>,
    /// Anything else.
    #[serde(default)]
    pub comment: Option<String>,
    /// Where each quantity comes from, by its key: `"Ms"`, `"A"`, `"K"` ….
    #[serde(default)]
    pub references: BTreeMap<String, Reference>,
    /// Magnetic moment of a site.
    #[serde(default)]
    pub moment: Option<Profile<Moment>>,
    /// Saturation magnetisation; with the lattice's cell it gives the moment of a site.
    #[serde(default)]
    pub Ms: Option<Profile<Magnetisation>>,
    /// Its energy terms.
    #[serde(default)]
    pub energy: Vec<TermSpec>,
}

/// Where a quantity comes from.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Reference {
    /// The paper, with its DOI where it has one.
    pub source: String,
    /// `read`, or `quoted in …`: where the number was seen.
    pub status: String,
    /// What other sources say.
    #[serde(default)]
    pub comment: Option<String>,
}

impl Material {
    /// One moment or magnetisation for each site.
    pub fn fits(&self, sites: usize) -> Result<()> {
        let moment = self.moment.as_ref().map(|m| ("moment", m.values(sites, "site", |m, _| Ok(m.0))));
        let ms = self.Ms.as_ref().map(|m| ("Ms", m.values(sites, "site", |m, _| Ok(m.0))));
        for (key, values) in moment.into_iter().chain(ms) {
            if values.map_err(|e| e.within(key))?.iter().any(|m| *m < 0.0) {
                let message = "a negative value is drawn: make the deviation smaller, or the distribution log_normal";
                return Err(Error::invalid(key, message));
            }
        }
        Ok(())
    }

    /// A moment that makes sense, given in one way.
    pub fn validate(&self) -> Result<()> {
        if self.moment.is_some() && self.Ms.is_some() {
            return Err(Error::invalid("Ms", "\"moment\" and \"Ms\" are two ways to say the same: keep one"));
        }
        let negative = |written: Vec<f64>| written.iter().any(|m| *m < 0.0);
        let moment = self.moment.as_ref().map(|m| m.written().iter().map(|m| m.0).collect());
        let ms = self.Ms.as_ref().map(|m| m.written().iter().map(|m| m.0).collect());
        match [("moment", moment), ("Ms", ms)].into_iter().find(|(_, m)| m.clone().is_some_and(negative)) {
            Some((key, _)) => Err(Error::invalid(
                key,
                "found a negative value: a spin is the direction of its moment, so this is not negative",
            )),
            None => Ok(()),
        }
    }
}

/// A config's `material`: a file, a library material, the material itself, or one of these for each region.
#[derive(Clone, Debug, PartialEq)]
pub enum MaterialChoice {
    /// A path relative to the config, or the name of a library material.
    Named(String),
    /// The material.
    Inline(Box<Material>),
    /// One for each of the lattice's regions, and as `default` for all other sites. No map of regions is in it.
    Regions(BTreeMap<String, MaterialChoice>),
}

/// The key of the material of sites in no region.
pub(super) const DEFAULT: &str = "default";

impl JsonSchema for MaterialChoice {
    fn schema_name() -> Cow<'static, str> {
        "MaterialChoice".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let named =
            json!({"type": "string", "description": "a file, looked for beside the config, or a name of the library"});
        let own = generator.subschema_for::<Material>();
        let one = json!({"oneOf": [named, own]});
        let regions = json!({
            "type": "object",
            "description": "a material for each of the lattice's regions, and one for all other sites",
            "properties": {DEFAULT: {"allOf": [one], "description": "That of all sites in no region."}},
            "required": [DEFAULT],
            "additionalProperties": one,
        });
        json_schema!({"oneOf": [named, own, regions]})
    }
}

impl<'de> Deserialize<'de> for MaterialChoice {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = MaterialChoice;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a material: its name in the library (\"permalloy\"), its file, such as \"materials/toy.json\", an object with its energy terms, or one for each region, {\"default\": \"permalloy\", \"top\": \"fept\"}")
            }
            fn visit_str<E: de::Error>(self, name: &str) -> std::result::Result<MaterialChoice, E> {
                Ok(MaterialChoice::Named(name.into()))
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> std::result::Result<MaterialChoice, A::Error> {
                let first: Option<String> = map.next_key()?;
                if first.as_deref() == Some(DEFAULT) {
                    return regions(map).map(MaterialChoice::Regions);
                }
                let map = Again { first, map };
                Material::deserialize(MapAccessDeserializer::new(map)).map(|m| MaterialChoice::Inline(Box::new(m)))
            }
        }
        d.deserialize_any(Seen)
    }
}

/// The materials of regions, from the value of `default` on.
fn regions<'de, A: MapAccess<'de>>(mut map: A) -> std::result::Result<BTreeMap<String, MaterialChoice>, A::Error> {
    let mut all = BTreeMap::new();
    let mut next = Some(DEFAULT.to_string());
    while let Some(key) = next {
        let choice: MaterialChoice = map.next_value()?;
        if matches!(choice, MaterialChoice::Regions(_)) {
            return Err(de::Error::custom("a region is made of one material: it has no regions of its own"));
        }
        all.insert(key, choice);
        next = map.next_key()?;
    }
    Ok(all)
}

/// A map whose first key, already read, comes again.
struct Again<A> {
    first: Option<String>,
    map: A,
}

impl<'de, A: MapAccess<'de>> MapAccess<'de> for Again<A> {
    type Error = A::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> std::result::Result<Option<K::Value>, A::Error> {
        match self.first.take() {
            Some(key) => seed.deserialize(IntoDeserializer::<A::Error>::into_deserializer(key)).map(Some),
            None => self.map.next_key_seed(seed),
        }
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> std::result::Result<V::Value, A::Error> {
        self.map.next_value_seed(seed)
    }
}
