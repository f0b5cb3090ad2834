//! A parameter over the sites or bonds of a lattice: one value, a list, a ramp, or random values.
//!
//! ```text
//! "0.5 meV"                                                   the same for all chosen sites (or bonds)
//! ["0.5 meV", "0.4 meV", …]                                   one value each
//! {"from": "1 meV", "to": "0.2 meV", "shape": "linear"}       from the first chosen one of a chain to the last, elsewhere along x
//! {"random": {"mean": "0.5 meV", "relative_deviation": 0.1, "seed": 1}}          drawn for each of them
//! ```
//! With t from 0 to 1 over the chosen ones a ramp is from + (to − from) s(t): linear s = t; step s = 0 below ½, else 1;
//! tanh s = ½ + ½ tanh(6t − 3)/tanh 3, two thirds of whose rise lie within a quarter of the length.

mod places;
mod random;

pub use places::Places;
pub use random::{Deviation, Distribution, Random};

use crate::error::{Error, Result};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde_json::json;
use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;

/// A value for every site or bond.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile<T> {
    /// The same everywhere.
    Same(T),
    /// One each.
    List(Vec<T>),
    /// From one value to another.
    Ramp {
        /// At the first.
        from: T,
        /// At the last.
        to: T,
        /// How.
        shape: RampShape,
    },
    /// Drawn from a distribution.
    Random(Random<T>),
}

/// How a ramp rises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RampShape {
    /// Evenly.
    #[default]
    Linear,
    /// Smoothly, most of it in the middle.
    Tanh,
    /// At once, in the middle.
    Step,
}

impl RampShape {
    /// s(t).
    fn at(self, t: f64) -> f64 {
        match self {
            RampShape::Linear => t,
            RampShape::Tanh => 0.5 + 0.5 * libm::tanh(6.0 * t - 3.0) / libm::tanh(3.0),
            RampShape::Step => f64::from(u8::from(t >= 0.5)),
        }
    }
}

impl<T> From<T> for Profile<T> {
    fn from(value: T) -> Profile<T> {
        Profile::Same(value)
    }
}

impl<T: Copy> Profile<T> {
    /// The values that are written.
    pub fn written(&self) -> Vec<T> {
        match self {
            Profile::Same(value) => vec![*value],
            Profile::List(list) => list.clone(),
            Profile::Ramp { from, to, .. } => vec![*from, *to],
            Profile::Random(random) => vec![random.mean],
        }
    }

    /// The numbers for all sites or bonds (`what`) that stand at some places, or for so many in a row, each value made a number by
    /// `convert`, which is told of which of them.
    pub fn values(
        &self,
        places: impl Into<Places>,
        what: &str,
        convert: impl Fn(T, usize) -> Result<f64>,
    ) -> Result<Vec<f64>> {
        let places = places.into();
        let count = places.count();
        match self {
            Profile::Same(value) => (0..count).map(|k| convert(*value, k)).collect(),
            Profile::List(list) if list.len() == count => {
                let item = |(k, value): (usize, &T)| convert(*value, k).map_err(|e| e.within(&format!("[{k}]")));
                list.iter().enumerate().map(item).collect()
            }
            Profile::List(list) => Err(Error::invalid(
                "",
                format!("found {} values for {count} {what}s: give one each, or one for all", list.len()),
            )),
            Profile::Ramp { from, to, shape } => {
                let value = |k: usize| {
                    let a = convert(*from, k).map_err(|e| e.within("from"))?;
                    let b = convert(*to, k).map_err(|e| e.within("to"))?;
                    Ok(a + (b - a) * shape.at(places.share(k)))
                };
                (0..count).map(value).collect()
            }
            Profile::Random(random) => {
                let value = |k: usize| random.value(places.grain(k, random.length), |value| convert(value, k));
                (0..count).map(value).collect()
            }
        }
    }
}

impl<T: JsonSchema> JsonSchema for Profile<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Profile_of_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (one, shape) = (generator.subschema_for::<T>(), generator.subschema_for::<RampShape>());
        let random = generator.subschema_for::<Random<T>>();
        let end = |words: &str| json!({"allOf": [one], "description": words});
        let shape = json!({"allOf": [shape], "description": "How the values go from one end to the other.", "default": "linear"});
        let random = json!({"allOf": [random], "description": "Drawn from a distribution, for each site or bond, or for grains of them."});
        json_schema!({
            "description": "one value, a list of them, a ramp, or random values",
            "anyOf": [
                one,
                {"type": "array", "items": one},
                {
                    "type": "object",
                    "description": "a ramp, from the value of the first site or bond to that of the last",
                    "properties": {"from": end("The value of the first site or bond."), "to": end("The value of the last."), "shape": shape},
                    "required": ["from", "to"],
                    "additionalProperties": false,
                },
                {"type": "object", "properties": {"random": random}, "required": ["random"], "additionalProperties": false},
            ],
        })
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Profile<T> {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Seen<T> {
            type Value = Profile<T>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a quantity, a list of them, a ramp {\"from\": …, \"to\": …, \"shape\": \"linear\"} or {\"random\": {\"mean\": …}}",
                )
            }
            fn visit_str<E: de::Error>(self, v: &str) -> std::result::Result<Profile<T>, E> {
                T::deserialize(v.into_deserializer()).map(Profile::Same)
            }
            fn visit_f64<E: de::Error>(self, v: f64) -> std::result::Result<Profile<T>, E> {
                T::deserialize(v.into_deserializer()).map(Profile::Same)
            }
            fn visit_i64<E: de::Error>(self, v: i64) -> std::result::Result<Profile<T>, E> {
                T::deserialize(v.into_deserializer()).map(Profile::Same)
            }
            fn visit_u64<E: de::Error>(self, v: u64) -> std::result::Result<Profile<T>, E> {
                T::deserialize(v.into_deserializer()).map(Profile::Same)
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> std::result::Result<Profile<T>, A::Error> {
                let mut list = Vec::new();
                while let Some(value) = s.next_element()? {
                    list.push(value);
                }
                Ok(Profile::List(list))
            }
            fn visit_map<A: MapAccess<'de>>(self, m: A) -> std::result::Result<Profile<T>, A::Error> {
                #[derive(serde::Deserialize)]
                #[serde(deny_unknown_fields)]
                struct Keys<T> {
                    from: Option<T>,
                    to: Option<T>,
                    shape: Option<RampShape>,
                    random: Option<Random<T>>,
                }
                match Keys::deserialize(de::value::MapAccessDeserializer::new(m))? {
                    Keys { from: None, to: None, shape: None, random: Some(random) } => Ok(Profile::Random(random)),
                    Keys { random: Some(_), .. } => {
                        Err(de::Error::custom("\"random\" stands alone: a ramp has \"from\" and \"to\" instead"))
                    }
                    Keys { from: Some(from), to: Some(to), shape, .. } => {
                        Ok(Profile::Ramp { from, to, shape: shape.unwrap_or_default() })
                    }
                    Keys { from: None, .. } => Err(de::Error::missing_field("from")),
                    Keys { .. } => Err(de::Error::missing_field("to")),
                }
            }
        }
        d.deserialize_any(Seen(PhantomData))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Energy;

    fn read(text: &str, count: usize) -> Result<Vec<f64>> {
        let profile: Profile<Energy> = serde_json::from_str(text).map_err(|e| Error::Numerical(e.to_string()))?;
        profile.values(count, "site", |e, _| Ok(e.0))
    }

    #[test]
    fn a_profile_is_a_value_a_list_or_a_ramp() {
        assert_eq!(read(r#""2 meV""#, 3).unwrap(), [2.0; 3]);
        assert_eq!(read(r#"["2 meV", "1 eV"]"#, 2).unwrap(), [2.0, 1000.0]);
        assert_eq!(read(r#"{"from": "1 meV", "to": "3 meV"}"#, 5).unwrap(), [1.0, 1.5, 2.0, 2.5, 3.0]);
        assert_eq!(read(r#"{"from": "1 meV", "to": "3 meV", "shape": "step"}"#, 4).unwrap(), [1.0, 1.0, 3.0, 3.0]);
        let smooth = read(r#"{"from": "1 meV", "to": "3 meV", "shape": "tanh"}"#, 9).unwrap();
        assert_eq!((smooth[0], smooth[4], smooth[8]), (1.0, 2.0, 3.0));
        assert!(smooth.windows(2).all(|w| w[1] > w[0]) && smooth[5] - smooth[3] > 1.2);
    }

    #[test]
    fn in_space_a_ramp_goes_along_x_and_a_grain_is_a_cube() {
        let at: Vec<[f64; 3]> = (0..24).map(|k| [(k % 6) as f64, (k / 6) as f64, 0.0]).collect();
        let of = |text: &str| {
            let profile: Profile<Energy> = serde_json::from_str(text).unwrap();
            profile.values(at.clone(), "site", |e, _| Ok(e.0)).unwrap()
        };
        let ramp = of(r#"{"from": "1 meV", "to": "6 meV"}"#);
        assert!(ramp.iter().enumerate().all(|(k, e)| (e - 1.0 - (k % 6) as f64).abs() < 1e-14), "{ramp:?}");
        let grains = of(r#"{"random": {"mean": "1 meV", "deviation": "0.1 meV", "seed": 1, "length": 2}}"#);
        let grain = |k: usize| (k % 6 / 2, k / 12);
        for (k, l) in (0..24).flat_map(|k| (0..k).map(move |l| (k, l))) {
            assert_eq!(grains[k] == grains[l], grain(k) == grain(l), "{k} {l}");
        }
        // single sites draw as in a row
        let each = r#"{"random": {"mean": "1 meV", "deviation": "0.1 meV", "seed": 1}}"#;
        assert_eq!(of(each), read(each, 24).unwrap());
    }

    #[test]
    fn a_list_of_the_wrong_length_and_a_number_without_a_unit_are_refused_in_words() {
        let message = |text: &str| read(text, 3).unwrap_err().to_string();
        assert!(message(r#"["2 meV"]"#).contains("found 1 values for 3 sites"));
        assert!(message("2").contains("unit") || message("2").contains("meV"), "{}", message("2"));
        assert!(message(r#"{"from": "1 meV"}"#).contains("to"));
        assert!(message(r#"{"from": "1 meV", "to": "2 meV", "form": "step"}"#).contains("form"));
    }
}
