//! The sense in which a state turns, where it is free to choose: the cheapest for the energy.
//!
//! ```text
//! u = x̂ made normal to the domains (ŷ where x̂ is within 0.1 of them),  v = from × u:   by way of +u, −u, +v or −v
//! ```
//! Energies of the states as built, not relaxed, are compared, of each part of a state by itself, see
//! [`parts`](super::parts); of those that are equal to rounding the first is taken. Two
//! energies of N sites are equal to rounding where they are no further apart than 32 ε N κ, with the machine's ε = 2⁻⁵² and
//! κ the largest stiffness or torque that a site can feel ([`Hamiltonian::stiffness_mev`]): what N densities, each a few
//! products of κ and unit vectors, can be wrong by.

use crate::energy::Hamiltonian;
use crate::error::Error;
use crate::geometry::{Direction, Vector, vector};
use crate::linalg::slab;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use std::fmt;

/// Rounding errors of a site's energy, in units of ε κ.
const ROUNDING: f64 = 32.0;

/// The least sine between the domains' line and a direction for that to be a way across it.
const ACROSS: f64 = 0.1;

/// A turn out of one direction by way of another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sense {
    /// The direction that is left.
    pub from: Vector,
    /// The direction on the way, normal to the domains.
    pub through: Vector,
}

impl Sense {
    /// By way of +u, −u, +v and −v, in this order; `line` is that of the domains, `from` one of them. u is the part of `along`
    /// normal to the line, or that of ŷ, or of x̂, where that before is within 0.1 of the line.
    pub fn across(from: Vector, line: Vector, along: Vector) -> [Sense; 4] {
        let mut ways =
            [along, [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]].map(|axis| vector::normal_part(axis, line)).into_iter();
        let u = vector::unit_or(ways.find(|way| vector::norm(*way) > ACROSS).unwrap_or(along), line);
        let v = vector::cross(from, u);
        [u, vector::scale(-1.0, u), v, vector::scale(-1.0, v)].map(|through| Sense { from, through })
    }
}

/// The senses that the parts of a state have taken, by the parts' names.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Senses(Vec<(String, Sense)>);

impl Senses {
    /// With that of one more part.
    pub(super) fn add(&mut self, part: &str, sense: Sense) {
        self.0.push((part.to_owned(), sense));
    }

    /// That of the first part that had a choice.
    pub fn first(&self) -> Option<Sense> {
        self.0.first().map(|(_, sense)| *sense)
    }

    /// What a part of another state takes over, of the senses that are open to it: that of the part of its name, or the one on which
    /// all parts agree that have one of these.
    pub fn among(&self, part: &str, open: &[Sense]) -> Option<Sense> {
        let mut fit = self.0.iter().filter(|(_, sense)| open.contains(sense));
        let namesake = fit.clone().find(|(name, _)| name == part);
        let (_, first) = namesake.or(fit.next())?;
        (namesake.is_some() || fit.all(|(_, sense)| sense == first)).then_some(*first)
    }
}

/// Which of some states, told by the energy densities of the sites that count, has the lowest energy; the first of those equal to
/// rounding.
pub(super) fn cheapest(h: &Hamiltonian, densities: impl Iterator<Item = Vec<f64>>) -> usize {
    let (mut first, mut above) = (Vec::new(), Vec::new());
    for density in densities {
        if above.is_empty() {
            first.clone_from(&density);
        }
        above.push(slab::sum_of_differences(&density, &first));
    }
    let rounding = ROUNDING * f64::EPSILON * first.len() as f64 * h.stiffness_mev();
    let lowest = above.iter().copied().fold(f64::INFINITY, f64::min);
    above.into_iter().position(|e| e <= lowest + rounding).unwrap_or(0)
}

/// Reads `"auto"`, which is nothing, or a direction.
pub(super) fn auto_or_direction<'de, D: Deserializer<'de>>(d: D) -> std::result::Result<Option<Direction>, D::Error> {
    struct Seen;
    impl<'de> Visitor<'de> for Seen {
        type Value = Option<Direction>;
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("\"auto\" or a direction, such as [1, 0, 0]")
        }
        fn visit_str<E: de::Error>(self, word: &str) -> std::result::Result<Self::Value, E> {
            match word {
                "auto" => Ok(None),
                _ => Err(E::invalid_value(de::Unexpected::Str(word), &self)),
            }
        }
        fn visit_unit<E: de::Error>(self) -> std::result::Result<Self::Value, E> {
            Ok(None)
        }
        fn visit_seq<A: SeqAccess<'de>>(self, s: A) -> std::result::Result<Self::Value, A::Error> {
            Direction::deserialize(SeqAccessDeserializer::new(s)).map(Some)
        }
    }
    d.deserialize_any(Seen)
}

/// The schema of [`auto_or_direction`].
pub(super) fn auto_or_direction_schema(generator: &mut SchemaGenerator) -> Schema {
    let direction = Direction::json_schema(generator);
    json_schema!({"oneOf": [{"const": "auto"}, direction], "default": "auto"})
}

/// A sense or direction that is no way out of a domain.
pub(super) fn along_a_domain(what: &str) -> Error {
    let message = format!("the {what} is to pass through a domain's own direction: give a direction across it");
    Error::invalid("through", message)
}
