//! A front that passes over the lattice: a wall that enters at one side and leaves at the other. See
//! [`front`](super::front) for its equation.

use super::clock::Ways;
use super::difference::Difference;
use super::front::{Fold, Front, MOVES, Turning};
use super::outline::Outline;
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, angle, vector};
use crate::lattice::Lattice;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::{Angle, Extent};
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::SeqAccessDeserializer;
use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use std::borrow::Cow;
use std::fmt;
use std::ops::Range;

/// Where a front enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// At small x; in a chain at site 0.
    Left,
    /// At large x; in a chain at the last site.
    Right,
    /// In the middle of what moves, outwards all ways.
    Center,
    /// At both ends of a chain, inwards; of other lattices at all edges.
    Ends,
    /// At all edges at once, inwards.
    Edges,
    /// At all corners at once, inwards.
    Corners,
    /// On the side that is in this direction.
    From(Direction),
}

impl Edge {
    /// Those with a name.
    const NAMED: [(&'static str, Edge); 6] = [
        ("left", Edge::Left),
        ("right", Edge::Right),
        ("center", Edge::Center),
        ("ends", Edge::Ends),
        ("edges", Edge::Edges),
        ("corners", Edge::Corners),
    ];
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match (self, Edge::NAMED.iter().find(|(_, edge)| edge == self)) {
            (_, Some((name, _))) => f.write_str(name),
            (Edge::From(direction), None) => direction.fmt(f),
            (_, None) => Ok(()),
        }
    }
}

impl JsonSchema for Edge {
    fn schema_name() -> Cow<'static, str> {
        "Edge".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let direction = generator.subschema_for::<Direction>();
        json_schema!({"oneOf": [{"type": "string", "enum": Edge::NAMED.map(|(name, _)| name)}, direction]})
    }
}

impl<'de> Deserialize<'de> for Edge {
    fn deserialize<D: Deserializer<'de>>(d: D) -> std::result::Result<Self, D::Error> {
        struct Seen;
        impl<'de> Visitor<'de> for Seen {
            type Value = Edge;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("the name of a side or its direction, such as [1, 1, 0]")
            }
            fn visit_str<E: de::Error>(self, word: &str) -> std::result::Result<Edge, E> {
                let known = &["left", "right", "center", "ends", "edges", "corners"];
                let found = Edge::NAMED.iter().find(|(name, _)| *name == word);
                found.map(|(_, edge)| *edge).ok_or_else(|| E::unknown_variant(word, known))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, s: A) -> std::result::Result<Edge, A::Error> {
                Direction::deserialize(SeqAccessDeserializer::new(s)).map(Edge::From)
            }
        }
        d.deserialize_any(Seen)
    }
}

/// `{"sweep": {"from": "left"}}`.
#[derive(Clone, Debug, PartialEq, serde::Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sweep {
    /// Where the front enters: "left", "right", "center", "ends", "edges" or "corners", or the direction of the side.
    pub from: Edge,
    /// Its width in sites; four times δ of the material if absent.
    #[serde(default)]
    pub width: Option<Extent>,
    /// Axis about which opposite spins turn.
    #[serde(default)]
    pub axis: Option<Direction>,
    /// In place of an axis: opposite spins turn by way of the direction at this angle to the way of the front.
    #[serde(default)]
    pub helicity: Option<Angle>,
    /// All spins turn as one about the axis (that of the best rotation if absent), not each along its own great circle.
    #[serde(default)]
    pub rigid: bool,
}

impl From<Edge> for Sweep {
    fn from(from: Edge) -> Sweep {
        Sweep { from, width: None, axis: None, helicity: None, rigid: false }
    }
}

impl Described for Sweep {
    const NAME: &'static str = "sweep";
    const SUMMARY: &'static str =
        "a front enters from a side (left, right or any direction), from the center, from all edges or corners";
    const EXAMPLE: &'static str = r#"{"sweep": {"from": "left", "width": 4}}"#;
}

impl FirstGuess for Sweep {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        self.along(&Ways::between(a, b), images, context)
    }
}

impl Sweep {
    /// The path along ways that are known.
    pub(crate) fn along(&self, ways: &Ways, images: usize, context: &GuessContext) -> Result<Path> {
        let turning = Turning { axis: self.axis, helicity: self.helicity, rigid: self.rigid };
        self.front(ways, context.states.lattice)?.path(self.width, turning, ways, images, context)
    }

    /// Its front.
    pub(super) fn front<'l>(&self, ways: &Ways, lattice: &'l Lattice) -> Result<Front<'l>> {
        if lattice.is_row() { Ok(self.along_row(ways, lattice)) } else { self.over(ways, lattice) }
    }

    fn along_row<'l>(&self, ways: &Ways, lattice: &'l Lattice) -> Front<'l> {
        let (along, fold) = (
            lattice.direction(),
            match self.from {
                Edge::From(side) => return Front::straight(side, lattice),
                Edge::Left | Edge::Right => None,
                Edge::Center => Some(Fold::Outwards),
                Edge::Ends | Edge::Edges | Edge::Corners => Some(Fold::Inwards),
            },
        );
        let sign = if self.from == Edge::Right || fold == Some(Fold::Inwards) { -1.0 } else { 1.0 };
        let moving = moving(ways.a, ways.b);
        let middle = 0.5 * (moving.start + moving.end - 1) as f64;
        let way = move |i: usize| {
            let side = if fold.is_some() && (i as f64) < middle { -sign } else { sign };
            vector::scale(side, along.vector())
        };
        let mut places: Vec<f64> = (0..lattice.sites).map(|i| i as f64).collect();
        if self.from == Edge::Right {
            places.iter_mut().for_each(|x| *x = -*x);
        }
        Front { fold, ..Front::new(places, way) }
    }

    fn over<'l>(&self, ways: &Ways, lattice: &'l Lattice) -> Result<Front<'l>> {
        let sites = lattice.sites;
        let outline = || match Outline::of(lattice) {
            Outline { edges, .. } if edges.is_empty() => Err(Error::invalid(
                "from",
                "all directions of the lattice are periodic: it has no edges and no corners",
            )),
            outline => Ok(outline),
        };
        Ok(match self.from {
            Edge::Left => Front::straight(Direction::X.reversed(), lattice),
            Edge::Right => Front::straight(Direction::X, lattice),
            Edge::From(side) => Front::straight(side, lattice),
            Edge::Center => {
                let difference = Difference::between(ways.a, ways.b, lattice);
                let hollow = difference.hollow(difference.middle, lattice);
                Front::round(difference.from(hollow, lattice), false, sites)
            }
            Edge::Ends | Edge::Edges => {
                let edges = outline()?.edges;
                let furthest = |e: &Vector| {
                    (0..sites).map(|i| vector::dot(lattice.place(i), *e)).fold(f64::NEG_INFINITY, f64::max)
                };
                let edges: Vec<(f64, Vector)> = edges.into_iter().map(|e| (furthest(&e), e)).collect();
                let nearest = move |i: usize| {
                    let inside =
                        |(at, e): &(f64, Vector)| (at - vector::dot(lattice.place(i), *e), vector::scale(-1.0, *e));
                    edges.iter().map(inside).fold((f64::INFINITY, [0.0; 3]), |a, b| if b.0 < a.0 { b } else { a })
                };
                let places = (0..sites).map(|i| nearest(i).0).collect();
                Front::new(places, move |i| nearest(i).1)
            }
            Edge::Corners => {
                let corners: Vec<Vector> = outline()?.corners.into_iter().map(|i| lattice.place(i)).collect();
                let periods = lattice.periods();
                let nearest = move |i: usize| {
                    let from = corners.iter().map(|c| periods.shortest(vector::sub(lattice.place(i), *c)));
                    from.fold([f64::INFINITY; 3], |a, b| if vector::norm(b) < vector::norm(a) { b } else { a })
                };
                Front::round(nearest, false, sites)
            }
        })
    }
}

/// How far it is from the first to the last site that moves from a to b, each of them counted: in sites of a row, in spacings along
/// x, y or z, whichever is most, of any other lattice. All of it if none moves.
pub fn moving_sites(a: &Spins, b: &Spins, lattice: &Lattice) -> usize {
    if lattice.is_row() {
        return moving(a, b).len();
    }
    let moves = |i: &usize| angle(a.get(*i), b.get(*i)) > MOVES;
    let found: Vec<usize> = (0..a.sites()).filter(moves).collect();
    let all = || (0..a.sites()).collect();
    let sites: Vec<usize> = if found.is_empty() { all() } else { found };
    let along = |c: usize| {
        let x = || sites.iter().map(|i| lattice.place(*i)[c]);
        x().fold(f64::NEG_INFINITY, f64::max) - x().fold(f64::INFINITY, f64::min) + 1.0
    };
    (0..3).map(along).fold(1.0, f64::max).round() as usize
}

/// From the first to the last site of a row that moves; all of them if none does.
fn moving(a: &Spins, b: &Spins) -> Range<usize> {
    let moves = |i: &usize| angle(a.get(*i), b.get(*i)) > MOVES;
    let ends = (0..a.sites()).find(moves).zip((0..a.sites()).rfind(moves));
    ends.map_or(0..a.sites(), |(first, last)| first..last + 1)
}
