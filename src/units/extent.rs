//! Lengths and places in a lattice, as configs have them: numbers count the lattice's own lengths, strings carry a unit.

use super::Length;
use crate::words::number;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{self, Deserialize, Deserializer, IntoDeserializer, Visitor};
use std::borrow::Cow;
use std::fmt;

/// A length or a coordinate: `4.5` spacings, or `"12 nm"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Extent {
    /// So many spacings of the lattice: sites of a chain, cells of a grid.
    Spacings(f64),
    /// A length.
    Length(Length),
}

/// A place: two or three coordinates.
#[derive(Clone, Debug, PartialEq)]
pub struct Place(pub Vec<Extent>);

impl From<f64> for Extent {
    fn from(spacings: f64) -> Extent {
        Extent::Spacings(spacings)
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Extent::Spacings(x) => f.write_str(&number(shown(*x))),
            Extent::Length(length) => length.fmt(f),
        }
    }
}

/// Without the digits that rounding left.
fn shown(x: f64) -> f64 {
    let scale = 1e6;
    if x.abs() < 1e3 && x.abs() > 1e-3 { (x * scale).round() / scale } else { x }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let coordinates: Vec<String> = self.0.iter().map(Extent::to_string).collect();
        write!(f, "[{}]", coordinates.join(", "))
    }
}

impl JsonSchema for Extent {
    fn schema_name() -> Cow<'static, str> {
        "Extent".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let length = generator.subschema_for::<Length>();
        json_schema!({"anyOf": [{"type": "number", "description": "in spacings of the lattice"}, length]})
    }
}

impl JsonSchema for Place {
    fn schema_name() -> Cow<'static, str> {
        "Place".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let coordinate = generator.subschema_for::<Extent>();
        json_schema!({
            "type": "array",
            "description": "x, y and (if it matters) z of a place",
            "items": coordinate,
            "minItems": 2,
            "maxItems": 3,
            "components": ["x", "y", "z"],
        })
    }
}

impl<'de> Deserialize<'de> for Extent {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Seen;
        impl Visitor<'_> for Seen {
            type Value = Extent;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number of spacings, such as 4.5, or a length with its unit, such as \"12 nm\"")
            }
            fn visit_f64<E: de::Error>(self, x: f64) -> Result<Extent, E> {
                Ok(Extent::Spacings(x))
            }
            fn visit_i64<E: de::Error>(self, x: i64) -> Result<Extent, E> {
                Ok(Extent::Spacings(x as f64))
            }
            fn visit_u64<E: de::Error>(self, x: u64) -> Result<Extent, E> {
                Ok(Extent::Spacings(x as f64))
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Extent, E> {
                Length::deserialize(text.into_deserializer()).map(Extent::Length)
            }
        }
        d.deserialize_any(Seen)
    }
}

impl<'de> Deserialize<'de> for Place {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        let coordinates = Vec::<Extent>::deserialize(d)?;
        match coordinates.len() {
            2 | 3 => Ok(Place(coordinates)),
            n => Err(de::Error::custom(format!("found {n} coordinates, but a place is [x, y] or [x, y, z]"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_is_shown_without_what_rounding_left() {
        let place = Place([0.1 + 0.2, 3.0 * 2f64.sqrt(), 1.25e-7].map(Extent::Spacings).to_vec());
        assert_eq!(place.to_string(), "[0.3, 4.242641, 1.25e-7]");
    }

    #[test]
    fn a_number_counts_spacings_and_a_string_carries_its_unit() {
        let of = |text: &str| serde_json::from_str::<Extent>(text);
        assert_eq!(of("4").unwrap(), Extent::Spacings(4.0));
        assert_eq!(of("-4.5").unwrap(), Extent::Spacings(-4.5));
        assert_eq!(of("\"12 nm\"").unwrap(), Extent::Length(Length(12.0)));
        assert!(of("\"12 meV\"").unwrap_err().to_string().contains("meV"));
        assert!(of("\"12\"").unwrap_err().to_string().contains("unit"));
        assert!(of("[1]").unwrap_err().to_string().contains("a number of spacings"));
    }

    #[test]
    fn a_place_has_two_or_three_coordinates() {
        let of = |text: &str| serde_json::from_str::<Place>(text);
        assert_eq!(of("[1, \"2 nm\"]").unwrap().0.len(), 2);
        assert_eq!(of("[1, 2, 3]").unwrap().0.len(), 3);
        assert!(of("[1]").unwrap_err().to_string().contains("found 1 coordinates"));
        assert!(of("[1, 2, 3, 4]").is_err());
    }
}
