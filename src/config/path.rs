//! The first path of a config: how many images, from which guess.

use crate::drive::{Images, checked_smoothing};
use crate::path::guess::{GuessSpec, NoiseSpec};
use crate::words::quoted;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Visitor};
use serde::{Deserialize, Deserializer};
use std::borrow::Cow;
use std::fmt;

/// `"path": {"images": 20, "guess": {"geodesic": {}}, "smooth": 0.3}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct PathConfig {
    /// How many images, both ends counted.
    pub images: ImageCount,
    /// The first path; all natural ones are tried if absent.
    pub guess: Option<GuessSpec>,
    /// Noise on the guess.
    pub noise: Option<NoiseSpec>,
    /// Smoothing of the guess, 0 (none) to 1.
    #[serde(deserialize_with = "smooth")]
    #[schemars(range(min = 0, max = 1))]
    pub smooth: Option<f64>,
}

/// `"auto"` or a whole number from 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImageCount(pub Images);

impl Default for ImageCount {
    fn default() -> Self {
        ImageCount(Images::Auto)
    }
}

impl JsonSchema for ImageCount {
    fn schema_name() -> Cow<'static, str> {
        "ImageCount".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "how many images, both ends counted",
            "oneOf": [{"const": "auto"}, {"type": "integer", "minimum": 3}],
        })
    }
}

impl<'de> Deserialize<'de> for ImageCount {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Seen;
        impl Visitor<'_> for Seen {
            type Value = ImageCount;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("\"auto\" or a whole number from 3, both ends counted")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> Result<ImageCount, E> {
                match word {
                    "auto" => Ok(ImageCount::default()),
                    _ => Err(E::custom(format!("found {}, expected \"auto\" or a whole number from 3", quoted(word)))),
                }
            }
            fn visit_u64<E: de::Error>(self, n: u64) -> Result<ImageCount, E> {
                match usize::try_from(n) {
                    Ok(n @ Images::LEAST..) => Ok(ImageCount(Images::Count(n))),
                    Ok(n) => Err(E::custom(format!(
                        "found {n}, but a path has at least 3 images: its two ends, which are counted, and one between"
                    ))),
                    Err(_) => Err(E::custom(format!("found {n}, which is too large"))),
                }
            }
        }
        d.deserialize_any(Seen)
    }
}

fn smooth<'de, D: Deserializer<'de>>(d: D) -> Result<Option<f64>, D::Error> {
    Option::<f64>::deserialize(d)?.map(checked_smoothing).transpose().map_err(de::Error::custom)
}
