//! The values of a swept key: a list, or a range with both ends.

use crate::units::AnyQuantity;
use crate::words::{quoted, rounded};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::Value;
use std::borrow::Cow;
use std::fmt;

/// Most points of a range.
const MOST: usize = 100_000;
/// Digits that a value of a range has: 0.1, 0.2, 0.3 and not 0.30000000000000004.
const DIGITS: usize = 12;

/// The values of a key.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Values {
    /// One after the other, as a config has them.
    pub(super) list: Vec<Value>,
    /// Spaced by equal factors.
    pub(super) log: bool,
    /// Written as a range.
    pub(super) range: bool,
}

/// `{"from": "0.1 meV", "to": "1 meV", "points": 10, "scale": "log"}`.
#[derive(Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
struct Range {
    /// The first value.
    from: End,
    /// The last, in any unit of the same kind.
    to: End,
    /// How many values there are.
    #[serde(deserialize_with = "points")]
    #[schemars(range(min = 2, max = 100_000))]
    points: usize,
    /// Whether neighbours differ by equal steps or by equal factors.
    #[serde(default)]
    scale: Scale,
}

/// How the values of a range are spaced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Scale {
    /// By equal steps.
    #[default]
    Linear,
    /// By equal factors.
    Log,
}

fn points<'de, D: Deserializer<'de>>(d: D) -> Result<usize, D::Error> {
    match usize::deserialize(d)? {
        n if (2..=MOST).contains(&n) => Ok(n),
        n => Err(D::Error::custom(format!("found {n}, but a range has 2 to {MOST} points"))),
    }
}

/// An end of a range.
#[derive(Clone, Debug, PartialEq)]
enum End {
    Number(f64),
    Quantity(AnyQuantity),
}

impl JsonSchema for End {
    fn schema_name() -> Cow<'static, str> {
        "End".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({"anyOf": [{"type": "number"}, generator.subschema_for::<AnyQuantity>()]})
    }
}

impl JsonSchema for Values {
    fn schema_name() -> Cow<'static, str> {
        "Values".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "the values that the key takes: a list, or a range with both ends",
            "oneOf": [{"type": "array", "minItems": 1, "uniqueItems": true}, generator.subschema_for::<Range>()],
        })
    }
}

impl<'de> Deserialize<'de> for End {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Seen;
        impl Visitor<'_> for Seen {
            type Value = End;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a number, or a quantity with its unit, such as \"0.1 meV\"")
            }
            fn visit_f64<E: Error>(self, x: f64) -> Result<End, E> {
                Ok(End::Number(x))
            }
            fn visit_i64<E: Error>(self, x: i64) -> Result<End, E> {
                Ok(End::Number(x as f64))
            }
            fn visit_u64<E: Error>(self, x: u64) -> Result<End, E> {
                Ok(End::Number(x as f64))
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<End, E> {
                AnyQuantity::new(text).map(End::Quantity).map_err(E::custom)
            }
        }
        d.deserialize_any(Seen)
    }
}

impl Range {
    fn values(&self) -> Result<Vec<Value>, String> {
        let (from, to) = match (&self.from, &self.to) {
            (End::Number(a), End::Number(b)) => (*a, *b),
            (End::Quantity(a), End::Quantity(b)) => (a.value, b.value_as(a).map_err(|e| e.to_string())?),
            _ => return Err("one end of the range is a number and the other has a unit".into()),
        };
        if from == to {
            return Err("the range ends where it begins".into());
        }
        if self.scale == Scale::Log && from * to <= 0.0 {
            return Err("a range on a logarithmic scale has both ends above 0, or both below".into());
        }
        let last = (self.points - 1) as f64;
        let at = |k: usize| match (k as f64 / last, self.scale) {
            (0.0, _) => from,
            (1.0, _) => to,
            (t, Scale::Linear) => rounded(from + (to - from) * t, DIGITS),
            (t, Scale::Log) => rounded(from * libm::exp(libm::log(to / from) * t), DIGITS),
        };
        Ok((0..self.points).map(|k| self.shown(at(k))).collect())
    }

    /// A number, or a quantity in the unit of the first end.
    fn shown(&self, x: f64) -> Value {
        match &self.from {
            End::Quantity(q) => q.with_value(x).into(),
            // what is whole may be a count
            End::Number(_) if x.fract() == 0.0 && x.abs() < 2f64.powi(53) => (x as i64).into(),
            End::Number(_) => x.into(),
        }
    }
}

impl<'de> Deserialize<'de> for Values {
    fn deserialize<D: Deserializer<'de>>(d: D) -> Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = Values;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(
                    "a list of values like [\"0.1 meV\", \"0.2 meV\"] or a range like {\"from\": \"0.1 meV\", \"to\": \
                     \"1 meV\", \"points\": 10}",
                )
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> Result<Values, A::Error> {
                let mut list: Vec<Value> = Vec::new();
                while let Some(value) = s.next_element()? {
                    if let Some(earlier) = list.iter().find(|earlier| is_same(earlier, &value)) {
                        let shown = |v: &Value| v.as_str().map_or_else(|| quoted(&v.to_string()), quoted);
                        let [value, earlier] = [&value, earlier].map(shown);
                        let as_what = if value == earlier { String::new() } else { format!(", first as {earlier}") };
                        return Err(A::Error::custom(format!("the value {value} is listed twice{as_what}")));
                    }
                    list.push(value);
                }
                match list.is_empty() {
                    true => Err(A::Error::custom("found an empty list: give the values that the key takes")),
                    false => Ok(Values { list, log: false, range: false }),
                }
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Values, A::Error> {
                let range = Range::deserialize(MapAccessDeserializer::new(map))?;
                let list = range.values().map_err(A::Error::custom)?;
                Ok(Values { list, log: range.scale == Scale::Log, range: true })
            }
        }
        d.deserialize_any(Seen)
    }
}

/// Whether two values are one: as numbers, or as quantities in whatever unit, to the digits that a range has.
fn is_same(a: &Value, b: &Value) -> bool {
    let alike = |x: f64, y: f64| rounded(x, DIGITS) == rounded(y, DIGITS);
    let quantity = |v: &Value| v.as_str().and_then(|text| AnyQuantity::new(text).ok());
    if let (Some(x), Some(y)) = (a.as_f64(), b.as_f64()) {
        return x == y;
    }
    match (quantity(a), quantity(b)) {
        (Some(p), Some(q)) => q.value_as(&p).is_ok_and(|q| alike(p.value, q)),
        _ => a == b,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn values(v: Value) -> Result<Vec<Value>, String> {
        serde_json::from_value::<Values>(v).map(|v| v.list).map_err(|e| e.to_string())
    }

    #[test]
    fn a_range_has_both_ends_and_short_numbers_between() {
        let linear = values(json!({"from": "0.1 meV", "to": "0.5 meV", "points": 5})).unwrap();
        assert_eq!(linear, ["0.1 meV", "0.2 meV", "0.3 meV", "0.4 meV", "0.5 meV"]);
        let log = values(json!({"from": "10 mT", "to": "-10 T", "points": 4})).unwrap();
        assert_eq!(log.len(), 4);
        let log = values(json!({"from": "10 mT", "to": "10 T", "points": 4, "scale": "log"})).unwrap();
        assert_eq!(log, ["10 mT", "100 mT", "1000 mT", "10000 mT"]);
        assert_eq!(values(json!({"from": 10, "to": 40, "points": 4})).unwrap(), [10, 20, 30, 40]);
        assert_eq!(values(json!({"from": 0.0, "to": 0.5, "points": 2})).unwrap(), [json!(0), json!(0.5)]);
    }

    #[test]
    fn a_range_that_cannot_be_is_refused_in_words() {
        for (range, words) in [
            (
                json!({"from": "1 meV", "to": "1 T", "points": 3}),
                "\"1 T\" is a magnetic field, but \"1 meV\" is an energy",
            ),
            (json!({"from": 1, "to": "1 T", "points": 3}), "one end of the range is a number"),
            (json!({"from": 1, "to": 2, "points": 1}), "found 1, but a range has 2 to"),
            (json!({"from": -1, "to": 2, "points": 3, "scale": "log"}), "both ends above 0"),
            (json!({"from": 1, "to": 1, "points": 3}), "ends where it begins"),
            (json!({"from": 1, "to": 2, "point": 3}), "unknown field `point`"),
            (json!({"from": 1, "to": 2, "points": 3, "scale": "cubic"}), "unknown variant `cubic`"),
            (json!([]), "found an empty list"),
            (json!([1, 2, 1]), "listed twice"),
            (json!([1, 2, 1.0]), "listed twice"),
            (json!(["1 T", "0.3 T", "1000 mT"]), "\"1000 mT\" is listed twice, first as \"1 T\""),
            (json!(["0.3 T", "300 mT"]), "listed twice"),
            (json!("1 meV"), "a list of values"),
        ] {
            let said = values(range).unwrap_err();
            assert!(said.contains(words), "{said}");
        }
    }
}
