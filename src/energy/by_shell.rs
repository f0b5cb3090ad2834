//! Values of the bonds of one shell, or a list with those of each.

use crate::error::{Error, Result};
use crate::profile::Profile;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// `"2 meV"` or `["2 meV", "0.3 meV"]`.
#[derive(Clone, Debug, PartialEq)]
pub enum ByShell<T> {
    /// Of nearest neighbours.
    One(Profile<T>),
    /// Of the nearest, next … neighbours.
    List(Vec<Profile<T>>),
}

impl<T: Copy> ByShell<T> {
    /// The shells, each with the place of its values below that of the whole.
    pub fn shells(&self, key: &str) -> Result<Vec<(usize, String, &Profile<T>)>> {
        match self {
            ByShell::One(profile) => Ok(vec![(1, key.into(), profile)]),
            ByShell::List(list) if list.is_empty() => {
                Err(Error::invalid(key, "the list is empty: give one energy a neighbour shell, [\"2 meV\"]"))
            }
            ByShell::List(list) => {
                Ok(list.iter().enumerate().map(|(k, profile)| (k + 1, format!("{key}[{k}]"), profile)).collect())
            }
        }
    }

    /// A list read as one value a bond; nothing where it cannot be.
    pub fn by_bond(&self) -> Option<Profile<T>> {
        let ByShell::List(list) = self else { return None };
        let one = |profile: &Profile<T>| match profile {
            Profile::Same(value) => Some(*value),
            _ => None,
        };
        list.iter().map(one).collect::<Option<Vec<T>>>().map(Profile::List)
    }
}

impl<T: JsonSchema> JsonSchema for ByShell<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("ByShell_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Profile<T>>();
        json_schema!({
            "description": "values for nearest neighbours, or a list with those of each shell",
            "anyOf": [one, {"type": "array", "items": one}],
        })
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for ByShell<T> {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Seen<T> {
            type Value = ByShell<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a quantity, a list of them by shell, a ramp {\"from\": …, \"to\": …} or {\"random\": …}")
            }
            fn visit_str<E: serde::de::Error>(self, v: &str) -> std::result::Result<ByShell<T>, E> {
                Profile::deserialize(StrDeserializer::new(v)).map(ByShell::One)
            }
            fn visit_f64<E: serde::de::Error>(self, v: f64) -> std::result::Result<ByShell<T>, E> {
                Profile::deserialize(serde::de::value::F64Deserializer::new(v)).map(ByShell::One)
            }
            fn visit_i64<E: serde::de::Error>(self, v: i64) -> std::result::Result<ByShell<T>, E> {
                Profile::deserialize(serde::de::value::I64Deserializer::new(v)).map(ByShell::One)
            }
            fn visit_u64<E: serde::de::Error>(self, v: u64) -> std::result::Result<ByShell<T>, E> {
                Profile::deserialize(serde::de::value::U64Deserializer::new(v)).map(ByShell::One)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> std::result::Result<ByShell<T>, A::Error> {
                let mut list = Vec::new();
                while let Some(profile) = s.next_element()? {
                    list.push(profile);
                }
                Ok(ByShell::List(list))
            }
            fn visit_map<A: MapAccess<'de>>(self, m: A) -> std::result::Result<ByShell<T>, A::Error> {
                Profile::deserialize(MapAccessDeserializer::new(m)).map(ByShell::One)
            }
        }
        d.deserialize_any(Seen(PhantomData))
    }
}
