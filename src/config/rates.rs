//! What rates are asked for.

use super::schema::names_schema;
use crate::rates::{RateSettings, Theory, checked_damping, checked_g_factor, checked_temperature};
use crate::units::Temperature;
use crate::words::{nearest, quoted};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;

/// Most temperatures of a range.
const MOST: usize = 100_000;

/// `"rates": {"temperatures": ["300 K"], "damping": 0.1, "g_factor": 2.0, "theory": ["htst", "langer"]}`.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RatesConfig {
    /// At which temperatures.
    pub temperatures: Temperatures,
    /// Gilbert damping.
    #[serde(default = "damping_default", deserialize_with = "damping")]
    #[schemars(range(min = 0))]
    pub damping: f64,
    /// g factor.
    #[serde(default = "g_factor_default", deserialize_with = "g_factor")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub g_factor: f64,
    /// Which theories.
    #[serde(default = "all_theories", deserialize_with = "theories")]
    #[schemars(schema_with = "theory_names")]
    pub theory: Vec<Theory>,
}

/// A list of temperatures, or a range of evenly spaced ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Temperatures(pub Vec<Temperature>);

impl RatesConfig {
    /// At these temperatures, everything else as by default.
    pub fn at(temperatures: Vec<Temperature>) -> RatesConfig {
        let temperatures = Temperatures(temperatures);
        RatesConfig { temperatures, damping: damping_default(), g_factor: g_factor_default(), theory: all_theories() }
    }

    /// As the theories take it, with the moment of each site (μ_B).
    pub fn settings(&self, moments_mub: Vec<f64>) -> RateSettings {
        RateSettings {
            temperatures_k: self.temperatures.0.iter().map(|t| t.0).collect(),
            damping: self.damping,
            g_factor: self.g_factor,
            theories: self.theory.clone(),
            moments_mub,
        }
    }
}

fn damping_default() -> f64 {
    0.1
}

fn g_factor_default() -> f64 {
    2.0
}

fn all_theories() -> Vec<Theory> {
    Theory::ALL.to_vec()
}

/// The theory of this name.
pub fn theory(name: &str) -> Result<Theory, String> {
    let names = || Theory::ALL.iter().map(|t| t.name());
    Theory::ALL.into_iter().find(|t| t.name() == name).ok_or_else(|| {
        let hint = nearest(name, names()).map(|n| format!(": did you mean \"{n}\"?")).unwrap_or_default();
        let known: Vec<&str> = names().collect();
        format!("unknown theory {}{hint} (known theories: {})", quoted(name), known.join(", "))
    })
}

fn damping<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    checked_damping(f64::deserialize(d)?).map_err(D::Error::custom)
}

fn g_factor<'de, D: Deserializer<'de>>(d: D) -> Result<f64, D::Error> {
    checked_g_factor(f64::deserialize(d)?).map_err(D::Error::custom)
}

fn theories<'de, D: Deserializer<'de>>(d: D) -> Result<Vec<Theory>, D::Error> {
    let names = Vec::<String>::deserialize(d)?;
    if names.is_empty() {
        return Err(D::Error::custom("found an empty list: name a theory, such as \"langer\""));
    }
    let mut found = Vec::new();
    for name in &names {
        let one = theory(name).map_err(D::Error::custom)?;
        if found.contains(&one) {
            return Err(D::Error::custom(format!("{} is listed twice", quoted(name))));
        }
        found.push(one);
    }
    Ok(found)
}

/// A temperature of a list or an end of a range.
#[derive(Clone, Copy)]
struct Positive(Temperature);

impl<'de> Deserialize<'de> for Positive {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        checked_temperature(Temperature::deserialize(d)?).map(Positive).map_err(D::Error::custom)
    }
}

/// `{"from": "4 K", "to": "300 K", "points": 38}`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Range {
    from: Positive,
    to: Positive,
    #[serde(deserialize_with = "points")]
    points: usize,
}

fn points<'de, D: Deserializer<'de>>(d: D) -> Result<usize, D::Error> {
    match usize::deserialize(d)? {
        n if (2..=MOST).contains(&n) => Ok(n),
        n => Err(D::Error::custom(format!("found {n}, but a range has 2 to {MOST} points"))),
    }
}

impl JsonSchema for Temperatures {
    fn schema_name() -> Cow<'static, str> {
        "Temperatures".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let one = generator.subschema_for::<Temperature>();
        let end = |words: &str| json!({"allOf": [one], "description": words});
        json_schema!({
            "description": "a list of temperatures, or a range of evenly spaced ones with both ends",
            "oneOf": [
                {"type": "array", "items": one, "minItems": 1},
                {
                    "type": "object",
                    "properties": {
                        "from": end("The first temperature."),
                        "to": end("The last."),
                        "points": {"type": "integer", "minimum": 2, "maximum": MOST, "description": "How many there are."},
                    },
                    "required": ["from", "to", "points"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

/// The names of the theories.
fn theory_names(_: &mut SchemaGenerator) -> Schema {
    names_schema(Theory::ALL.iter().map(|t| t.name()))
}

impl<'de> Deserialize<'de> for Temperatures {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = Temperatures;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a list of temperatures like [\"4 K\", \"300 K\"] or a range like {\"from\": \"4 K\", \"to\": \"300 K\", \
                     \"points\": 38}",
                )
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> Result<Temperatures, A::Error> {
                let mut list = Vec::new();
                while let Some(Positive(t)) = s.next_element()? {
                    list.push(t);
                }
                match list.is_empty() {
                    true => Err(A::Error::custom("found an empty list: give a temperature, such as \"300 K\"")),
                    false => Ok(Temperatures(list)),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Temperatures, A::Error> {
                let Range { from: Positive(from), to: Positive(to), points } =
                    Range::deserialize(MapAccessDeserializer::new(map))?;
                let last = (points - 1) as f64;
                let at = |k: usize| Temperature(from.0 + (to.0 - from.0) * (k as f64 / last));
                Ok(Temperatures((0..points).map(at).collect()))
            }
        }
        d.deserialize_any(Seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_both_ends_and_even_steps() {
        let range: Temperatures = serde_json::from_str(r#"{"from": "4 K", "to": "300 K", "points": 38}"#).unwrap();
        assert_eq!((range.0.len(), range.0[0].0, range.0[1].0, range.0[37].0), (38, 4.0, 12.0, 300.0));
    }

    #[test]
    fn only_the_temperatures_are_required() {
        let config: RatesConfig = serde_json::from_str(r#"{"temperatures": ["300 K", "0.5 K"]}"#).unwrap();
        assert_eq!(config, RatesConfig::at(vec![Temperature(300.0), Temperature(0.5)]));
        let settings = config.settings(vec![2.0; 3]);
        assert_eq!((settings.damping, settings.g_factor, settings.theories.len()), (0.1, 2.0, 2));
    }
}
