//! Which sites or bonds something is for.

use super::shape::{Corners, Disc, Ellipse, Ring};
use super::{Lattice, Picture, Shape};
use crate::error::{Error, Result};
use crate::units::Extent;
use crate::words::{nearest, quoted};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use serde_json::json;
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Some sites or bonds: a list, or a range with both ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Selection {
    /// `[3, 4, 9]`.
    List(Vec<usize>),
    /// `{"from": 3, "to": 9, "step": 2}`: every `step`th, both ends included where the steps meet them.
    Range {
        /// First.
        from: usize,
        /// Last.
        to: usize,
        /// From one to the next; 1 if not given.
        step: usize,
    },
    /// `"top"`: the sites of one of the lattice's regions, or of a species.
    Region(String),
    /// `{"disc": {"radius": 8}}`: the sites inside.
    Shape(Shape),
}

impl Selection {
    /// The chosen sites of a lattice.
    pub fn sites(&self, lattice: &Lattice) -> Result<Vec<usize>> {
        match self {
            Selection::Region(name) => lattice.named(name),
            Selection::Shape(shape) => {
                let inside = shape.inside(lattice)?;
                let sites: Vec<usize> = (0..lattice.sites).filter(|i| inside[*i]).collect();
                match sites.is_empty() {
                    true => Err(Error::invalid("", "no site is inside this shape")),
                    false => Ok(sites),
                }
            }
            _ => self.indices(lattice.sites, "site"),
        }
    }

    /// The chosen indices, each below `count`; `what` names them in the error.
    pub fn indices(&self, count: usize, what: &str) -> Result<Vec<usize>> {
        match self {
            Selection::List(list) if list.is_empty() => {
                Err(Error::invalid("", format!("found an empty list, which chooses no {what}")))
            }
            Selection::List(list) => {
                let mut seen = vec![false; count];
                for (k, &i) in list.iter().enumerate() {
                    if i >= count {
                        return Err(out_of_range(format!("[{k}]"), i, count, what));
                    }
                    if std::mem::replace(&mut seen[i], true) {
                        return Err(Error::invalid(format!("[{k}]"), format!("{what} {i} is listed twice")));
                    }
                }
                Ok(list.clone())
            }
            Selection::Range { from, to, step } => {
                if *step == 0 {
                    return Err(Error::invalid("step", "found 0, but a step leads from one to the next: 1 or more"));
                }
                if *to >= count {
                    return Err(out_of_range("to".into(), *to, count, what));
                }
                if from > to {
                    return Err(Error::invalid(
                        "from",
                        format!("the range from {from} to {to} is empty: exchange the two"),
                    ));
                }
                Ok((*from..=*to).step_by(*step).collect())
            }
            Selection::Shape(_) => {
                Err(Error::invalid("", format!("{what}s are chosen here by number, [3, 4], not by a shape")))
            }
            Selection::Region(name) => {
                let name = quoted(name);
                Err(Error::invalid(
                    "",
                    format!("found {name}, but {what}s are chosen here by number, [3, 4], not by a region"),
                ))
            }
        }
    }
}

/// The sites of a region.
pub(super) fn region<'a>(
    regions: &'a BTreeMap<String, Vec<usize>>,
    species: &[String],
    name: &str,
) -> Result<&'a [usize]> {
    regions.get(name).map(Vec::as_slice).ok_or_else(|| {
        let way_out = match nearest(name, regions.keys().chain(species).map(String::as_str)) {
            Some(near) => format!("did you mean {}?", quoted(near)),
            None if regions.is_empty() && species.is_empty() => {
                format!("give the lattice \"regions\": {{{}: {{\"from\": 3, \"to\": 9}}}}", quoted(name))
            }
            None => {
                let names: Vec<String> = regions.keys().chain(species).map(|name| quoted(name)).collect();
                format!("there are {}", names.join(", "))
            }
        };
        Error::invalid("", format!("no region {} in the lattice: {way_out}", quoted(name)))
    })
}

fn out_of_range(place: String, found: usize, count: usize, what: &str) -> Error {
    let message = match count {
        0 => format!("found {what} {found}, but there is no {what} here"),
        _ => format!("found {what} {found}, but {what}s are counted from 0 to {}", count - 1),
    };
    Error::invalid(place, message)
}

impl JsonSchema for Selection {
    fn schema_name() -> Cow<'static, str> {
        "Selection".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let index = json!({"type": "integer", "minimum": 0});
        json_schema!({
            "description": "indices like [3, 4], a range like {\"from\": 3, \"to\": 9, \"step\": 2} with both ends, a shape, or a name",
            "oneOf": [
                {"type": "array", "items": index, "uniqueItems": true},
                {
                    "type": "object",
                    "properties": {
                        "from": {"type": "integer", "minimum": 0, "description": "The first."},
                        "to": {"type": "integer", "minimum": 0, "description": "The last, which is one of them."},
                        "step": {"type": "integer", "minimum": 1, "default": 1, "description": "Every so many of them."},
                    },
                    "required": ["from", "to"],
                    "additionalProperties": false,
                },
                {"type": "string", "description": "the name of one of the lattice's regions, or a species"},
                generator.subschema_for::<Shape>(),
            ],
        })
    }
}

/// All that may be in an object that chooses sites.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Keys {
    from: Option<usize>,
    to: Option<usize>,
    step: Option<usize>,
    r#box: Option<Corners>,
    disc: Option<Disc>,
    ellipse: Option<Ellipse>,
    polygon: Option<Vec<[Extent; 2]>>,
    ring: Option<Ring>,
    image: Option<Picture>,
    all: Option<Vec<Shape>>,
    any: Option<Vec<Shape>>,
    not: Option<Box<Shape>>,
}

impl Keys {
    /// A range with both ends, or one shape.
    fn selection<E: serde::de::Error>(self) -> std::result::Result<Selection, E> {
        let shapes = [
            self.r#box.map(Shape::Box),
            self.disc.map(Shape::Disc),
            self.ellipse.map(Shape::Ellipse),
            self.polygon.map(Shape::Polygon),
            self.ring.map(Shape::Ring),
            self.image.map(Shape::Image),
            self.all.map(Shape::All),
            self.any.map(Shape::Any),
            self.not.map(Shape::Not),
        ];
        let mut shapes = shapes.into_iter().flatten();
        match (shapes.next(), shapes.next(), (self.from, self.to, self.step)) {
            (Some(shape), None, (None, None, None)) => Ok(Selection::Shape(shape)),
            (None, _, (Some(from), Some(to), step)) => Ok(Selection::Range { from, to, step: step.unwrap_or(1) }),
            (None, _, (None, ..)) => Err(E::missing_field("from")),
            (None, ..) => Err(E::missing_field("to")),
            _ => Err(E::custom("found more than one choice: take one shape, or join several with \"all\" or \"any\"")),
        }
    }
}

impl<'de> Deserialize<'de> for Selection {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = Selection;
            fn expecting(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
                f.write_str(
                    "a list of indices like [3, 4], a range like {\"from\": 3, \"to\": 9}, a shape like {\"disc\": {\"radius\": 8}} or the name of a region",
                )
            }
            fn visit_str<E: serde::de::Error>(self, name: &str) -> std::result::Result<Selection, E> {
                Ok(Selection::Region(name.into()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut s: A) -> std::result::Result<Selection, A::Error> {
                let mut list = Vec::new();
                while let Some(i) = s.next_element()? {
                    list.push(i);
                }
                Ok(Selection::List(list))
            }
            fn visit_map<A: MapAccess<'de>>(self, m: A) -> std::result::Result<Selection, A::Error> {
                Keys::deserialize(serde::de::value::MapAccessDeserializer::new(m))?.selection()
            }
        }
        d.deserialize_any(Seen)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_selection_is_a_list_or_a_range_with_both_ends() {
        let list: Selection = serde_json::from_str("[3, 1]").unwrap();
        assert_eq!(list.indices(4, "site").unwrap(), [3, 1]);
        let range: Selection = serde_json::from_str(r#"{"from": 1, "to": 3}"#).unwrap();
        assert_eq!(range.indices(4, "site").unwrap(), [1, 2, 3]);
        assert!(range.indices(3, "site").unwrap_err().to_string().contains("counted from 0 to 2"));
        assert!(serde_json::from_str::<Selection>(r#"{"from": 1}"#).is_err());
    }

    #[test]
    fn a_range_with_a_step_chooses_every_other_site() {
        let range: Selection = serde_json::from_str(r#"{"from": 1, "to": 10, "step": 3}"#).unwrap();
        assert_eq!(range.indices(11, "site").unwrap(), [1, 4, 7, 10]);
        let short: Selection = serde_json::from_str(r#"{"from": 1, "to": 9, "step": 3}"#).unwrap();
        assert_eq!(short.indices(10, "site").unwrap(), [1, 4, 7]);
        let none: Selection = serde_json::from_str(r#"{"from": 1, "to": 9, "step": 0}"#).unwrap();
        assert!(none.indices(10, "site").unwrap_err().to_string().starts_with("step: found 0"));
    }
}
