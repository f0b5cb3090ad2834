//! Vectors as listed, one a site.

use super::{StateBuilder, StateContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector};
use crate::registry::Described;
use crate::words::counted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;

/// `{"vectors": [[0, 0, 1], [0, 0, -1]]}`, or `{"vectors": {"spins": […], "staggered": true}}`.
#[derive(Clone, Debug, PartialEq)]
pub struct Vectors {
    /// One direction a site; any length but zero.
    pub spins: Vec<Direction>,
    /// Reverse odd sites, of a cell with several atoms every other one.
    pub staggered: bool,
}

impl Described for Vectors {
    const NAME: &'static str = "vectors";
    const SUMMARY: &'static str = "vectors as listed, one a site";
    const EXAMPLE: &'static str = r#"{"vectors": [[0, 0, 1], [1, 0, 1], [0, 0, -1]]}"#;
}

impl StateBuilder for Vectors {
    fn vectors(&self, context: &StateContext) -> Result<Vec<Vector>> {
        if self.spins.len() != context.lattice.sites {
            return Err(Error::invalid(
                "",
                format!(
                    "found {} for {}",
                    counted(self.spins.len(), "vector", "vectors"),
                    counted(context.lattice.sites, "site", "sites")
                ),
            ));
        }
        Ok(self.spins.iter().map(|d| d.vector()).collect())
    }

    fn staggered(&self) -> bool {
        self.staggered
    }
}

impl JsonSchema for Vectors {
    fn schema_name() -> Cow<'static, str> {
        "Vectors".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let list = json!({"type": "array", "items": generator.subschema_for::<Direction>()});
        json_schema!({
            "description": "one direction a site",
            "oneOf": [
                list,
                {
                    "type": "object",
                    "properties": {
                        "spins": {"allOf": [list], "description": "A direction a site, in the order of the sites."},
                        "staggered": {"type": "boolean", "default": false, "description": "Reverse odd sites, of a cell with several atoms every other one."},
                    },
                    "required": ["spins"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl<'de> Deserialize<'de> for Vectors {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Listed;
        impl<'de> Visitor<'de> for Listed {
            type Value = Vectors;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str("a list of vectors, [[0, 0, 1], …]")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> std::result::Result<Vectors, A::Error> {
                let mut spins = Vec::new();
                while let Some(v) = s.next_element()? {
                    spins.push(v);
                }
                Ok(Vectors { spins, staggered: false })
            }
            fn visit_map<A: MapAccess<'de>>(self, m: A) -> std::result::Result<Vectors, A::Error> {
                #[derive(Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Keys {
                    spins: Vec<Direction>,
                    #[serde(default)]
                    staggered: bool,
                }
                let k = Keys::deserialize(serde::de::value::MapAccessDeserializer::new(m))?;
                Ok(Vectors { spins: k.spins, staggered: k.staggered })
            }
        }
        d.deserialize_any(Listed)
    }
}
