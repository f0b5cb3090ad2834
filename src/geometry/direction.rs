//! A direction in space: a unit vector that was checked when it was made.

use super::vector::{Vector, unit};
use crate::error::{Error, Result};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize};
use std::borrow::Cow;
use std::fmt;

/// A unit vector. Any vector of non-zero length serves to make one; it is normalised.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Direction(Vector);

impl Direction {
    /// +x.
    pub const X: Direction = Direction([1.0, 0.0, 0.0]);
    /// +y.
    pub const Y: Direction = Direction([0.0, 1.0, 0.0]);
    /// +z.
    pub const Z: Direction = Direction([0.0, 0.0, 1.0]);

    /// The direction of `v`; an error where `v` has none (zero or not finite).
    pub fn new(v: Vector) -> Result<Direction> {
        unit(v)
            .map(Direction)
            .ok_or_else(|| Error::invalid("", format!("{v:?} has no direction: give three numbers, not all zero")))
    }

    /// The opposite direction.
    pub fn reversed(self) -> Direction {
        Direction([-self.0[0], -self.0[1], -self.0[2]])
    }

    /// The unit vector.
    pub fn vector(self) -> Vector {
        self.0
    }
}

impl JsonSchema for Direction {
    fn schema_name() -> Cow<'static, str> {
        "Direction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "array",
            "description": "x, y, z of a direction; any length but zero",
            "items": {"type": "number"},
            "minItems": 3,
            "maxItems": 3,
            "components": ["x", "y", "z"],
            "examples": [[0, 0, 1]],
        })
    }
}

impl fmt::Display for Direction {
    /// "+x", "−z", or the three numbers.
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        for (axis, name) in [(Direction::X, "x"), (Direction::Y, "y"), (Direction::Z, "z")] {
            if *self == axis {
                return write!(f, "+{name}");
            }
            if *self == axis.reversed() {
                return write!(f, "−{name}");
            }
        }
        let [x, y, z] = self.0;
        write!(f, "[{x:.3}, {y:.3}, {z:.3}]")
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        let v = <[f64; 3]>::deserialize(d)?;
        Direction::new(v).map_err(serde::de::Error::custom)
    }
}
