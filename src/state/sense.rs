//! The sense in which a state turns, where it is free to choose: the cheapest for the energy.
//!
//! ```text
//! u = x̂ made normal to the domains (ŷ where x̂ is within 0.1 of them),  v = from × u:   by way of +u, −u, +v or −v
//! ```
//! Energies of the states as built, not relaxed, are compared; of those that are equal to rounding the first is taken. Two
//! energies of N sites are equal to rounding where they are no further apart than 32 ε N κ, with the machine's ε = 2⁻⁵² and
//! κ the largest stiffness or torque that a site can feel ([`Hamiltonian::stiffness_mev`]): what N densities, each a few
//! products of κ and unit vectors, can be wrong by.

use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::linalg::slab;
use crate::spins::Spins;
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

/// Which of these states, each made when it is asked for, has the lowest energy; the first of those equal to rounding. Where some may
/// be missing, one that cannot be made is none of them, unless none can.
pub(super) fn cheapest(
    h: &Hamiltonian,
    count: usize,
    may_miss: bool,
    state: impl Fn(usize) -> Result<Spins>,
) -> Result<usize> {
    let mut first = Vec::new();
    let mut above: Vec<(usize, f64)> = Vec::new();
    let mut wrong = None;
    for k in 0..count {
        let density = match state(k) {
            Ok(state) => h.density(state.as_slice()),
            Err(e) if may_miss => {
                wrong = wrong.or(Some(e));
                continue;
            }
            Err(e) => return Err(e),
        };
        if above.is_empty() {
            first.clone_from(&density);
        }
        above.push((k, slab::sum_of_differences(&density, &first)));
    }
    let rounding = ROUNDING * f64::EPSILON * h.sites() as f64 * h.stiffness_mev();
    let lowest = above.iter().map(|(_, e)| *e).fold(f64::INFINITY, f64::min);
    match (above.into_iter().find(|(_, e)| *e <= lowest + rounding), wrong) {
        (Some((k, _)), _) => Ok(k),
        (None, Some(e)) => Err(e),
        (None, None) => Ok(0),
    }
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
