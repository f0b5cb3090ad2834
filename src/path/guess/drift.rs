//! What differs between two states is [carried](super::carried) off over an edge, as it is; in the other sense it comes in there. It is
//! that of the state in which neighbours differ more. Onto a hole it is carried as far as its middle, and all its spins turn there.

use super::carried::Carried;
use super::difference::{Difference, is_rougher};
use super::holes::holes;
use super::outline::Outline;
use super::waypoints::through;
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use crate::units::Place;
use schemars::JsonSchema;
use serde::Deserialize;

/// Stops on the way onto a hole.
const STOPS: usize = 8;
/// Holes that are natural to go to.
const NEAREST: usize = 2;

/// `{"drift": {"direction": [1, 0, 0]}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Where it goes; to the nearest edge if absent.
    #[serde(default)]
    pub direction: Option<Direction>,
    /// In place of a direction: the middle of a hole, or any place, where it goes out.
    #[serde(default)]
    pub onto: Option<Place>,
}

impl Described for Drift {
    const NAME: &'static str = "drift";
    const SUMMARY: &'static str = "what differs is carried off over an edge: a skyrmion leaves the film";
    const EXAMPLE: &'static str = r#"{"drift": {"direction": [1, 0, 0]}}"#;
}

impl FirstGuess for Drift {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let lattice = context.states.lattice;
        if let Some(onto) = &self.onto {
            return self.onto(onto, [a, b], images, context);
        }
        let (comes_in, [rough, rest]) = by_roughness(a, b, lattice);
        let carried = Carried::new(rough, rest, lattice);
        let edges = Outline::of(lattice).edges;
        let edges = self.direction.map_or(edges, |direction| vec![direction.vector()]);
        let nearest = edges.into_iter().map(|n| (carried.distance(n), n));
        let Some((far, n)) = nearest.reduce(|p, q| if q.0 < p.0 - 1e-9 { q } else { p }) else {
            return Err(Error::invalid(
                "",
                "all directions of the lattice are periodic: there is no edge to drift over",
            ));
        };
        if !carried.has_left(vector::scale(far, n)) {
            let message = "the lattice is periodic that way: there is no edge to drift over";
            return Err(Error::invalid("direction", message));
        }
        let by = |gone: f64| vector::scale(far * if comes_in { 1.0 - gone } else { gone }, n);
        Ok(carried.path([a, b], images, by))
    }
}

impl Drift {
    fn onto(&self, place: &Place, [a, b]: [&Spins; 2], images: usize, context: &GuessContext) -> Result<Path> {
        if self.direction.is_some() {
            return Err(Error::invalid("onto", "a direction is given too: it goes over an edge, or onto a place"));
        }
        let lattice = context.states.lattice;
        let place = lattice.point(place).map_err(|e| e.within("onto"))?;
        let way = way_to(&Difference::between(a, b, lattice), place, lattice);
        let (comes_in, [rough, rest]) = by_roughness(a, b, lattice);
        let mut stops = Carried::new(rough, rest, lattice).stops(rough, way, STOPS);
        stops.push(rest.clone());
        if comes_in {
            stops.reverse();
        }
        Ok(through(&stops, images, context.default_axis))
    }
}

/// Whether what is carried comes in; the state that holds it, and the other one.
fn by_roughness<'s>(a: &'s Spins, b: &'s Spins, lattice: &Lattice) -> (bool, [&'s Spins; 2]) {
    let comes_in = is_rougher(b, a, lattice);
    (comes_in, if comes_in { [b, a] } else { [a, b] })
}

/// The edges over which what differs can leave: their normals.
pub(super) fn exits(a: &Spins, b: &Spins, lattice: &Lattice) -> Vec<Vector> {
    let (_, [rough, rest]) = by_roughness(a, b, lattice);
    let carried = Carried::new(rough, rest, lattice);
    let leaves = |n: &Vector| carried.has_left(vector::scale(carried.distance(*n), *n));
    Outline::of(lattice).edges.into_iter().filter(leaves).collect()
}

/// From the middle of what differs to a place, the shortest way without the directions along which it goes through.
fn way_to(difference: &Difference, place: Vector, lattice: &Lattice) -> Vector {
    let way = lattice.periods().shortest(vector::sub(place, difference.middle));
    difference.through.iter().fold(way, |v, e| vector::normal_part(v, *e))
}

/// The nearest holes onto which what differs can go, of those that it is not over already.
pub(super) fn nearest_holes(difference: &Difference, lattice: &Lattice) -> Vec<Vector> {
    let far = |hole: &Vector| vector::norm(way_to(difference, *hole, lattice));
    let mut found: Vec<Vector> = holes(lattice).into_iter().filter(|hole| far(hole) > 1.0).collect();
    found.sort_by(|p, q| far(p).total_cmp(&far(q)));
    found.truncate(NEAREST);
    found
}
