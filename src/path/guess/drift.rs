//! What differs between two states is carried off over an edge, as it is; in the other sense it comes in there.
//!
//! ```text
//! m_i(u) = unit(b_i + d(r_i − u n)),      d = a − b at the sites, linear between like sites of neighbouring cells, 0 outside
//! ```
//! a being the state in which neighbours differ more, n the direction. Frozen spins stay.

use super::difference::is_rougher;
use super::outline::Outline;
use super::{FirstGuess, GuessContext};
use crate::error::{Error, Result};
use crate::field::ComponentsMut;
use crate::geometry::matrix::transposed;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::{Lattice, Shift};
use crate::linalg::solve_dense;
use crate::path::Path;
use crate::registry::Described;
use crate::spins::Spins;
use schemars::JsonSchema;
use serde::Deserialize;

/// Steps for each image, of which those at equal distances are kept.
const FINE: usize = 4;
/// What differs by less than this is left behind.
const SEEN: f64 = 0.05;

/// `{"drift": {"direction": [1, 0, 0]}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drift {
    /// Where it goes; to the nearest edge if absent.
    #[serde(default)]
    pub direction: Option<Direction>,
}

impl Described for Drift {
    const NAME: &'static str = "drift";
    const SUMMARY: &'static str = "what differs is carried off over an edge: a skyrmion leaves the film";
    const EXAMPLE: &'static str = r#"{"drift": {"direction": [1, 0, 0]}}"#;
}

/// The difference of two states that is carried off.
struct Carried<'a> {
    lattice: &'a Lattice,
    rest: &'a Spins,
    difference: Vec<Vector>,
    frozen: Vec<bool>,
    /// From a place to numbers of cells.
    cells: [Vector; 3],
}

impl<'a> Carried<'a> {
    fn new(rough: &Spins, rest: &'a Spins, lattice: &'a Lattice) -> Carried<'a> {
        let difference = (0..rest.sites()).map(|i| vector::sub(rough.get(i), rest.get(i))).collect();
        Carried { lattice, rest, difference, frozen: lattice.is_frozen(), cells: lattice.cell_vectors() }
    }

    /// How far it goes until the last spin that is seen to differ is over the edge.
    fn distance(&self, n: Vector) -> f64 {
        let x = |i: usize| vector::dot(self.lattice.place(i), n);
        let seen = (0..self.difference.len()).filter(|i| vector::norm(self.difference[*i]) > SEEN);
        let first = seen.map(x).fold(f64::INFINITY, f64::min);
        let edge = (0..self.difference.len()).map(x).fold(f64::NEG_INFINITY, f64::max);
        (edge - first).max(0.0) + 1.0
    }

    /// The cells on the corners of the cell that a site's place was in before it was moved, with their weights.
    fn corners(&self, by: Vector) -> Vec<(Shift, f64)> {
        let columns = transposed(&self.cells);
        let back = solve_dense(&columns.concat(), &vector::scale(-1.0, by), 3).unwrap_or_else(|| vec![0.0; 3]);
        let corner = |k: usize| {
            let up = [0, 1, 2].map(|d| k >> d & 1);
            let share = |d: usize| {
                let part = back[d] - back[d].floor();
                if up[d] == 1 { part } else { 1.0 - part }
            };
            ([0, 1, 2].map(|d| back[d].floor() as isize + up[d] as isize), share(0) * share(1) * share(2))
        };
        (0..8).map(corner).filter(|(_, weight)| *weight > 0.0).collect()
    }

    /// What has come to site i from the corners.
    fn arrived(&self, i: usize, corners: &[(Shift, f64)]) -> Vector {
        let from = corners.iter().filter_map(|(shift, weight)| Some((self.lattice.shifted(i, *shift)?, weight)));
        from.fold([0.0; 3], |sum, (j, weight)| vector::add(sum, vector::scale(*weight, self.difference[j])))
    }

    /// The state as it has moved by so much.
    fn write(&self, by: Vector, out: &mut [f64]) {
        let corners = self.corners(by);
        let mut out = ComponentsMut::new(out);
        for i in (0..self.difference.len()).filter(|i| !self.frozen[*i]) {
            let rest = self.rest.get(i);
            out.set(i, vector::unit_or(vector::add(rest, self.arrived(i, &corners)), rest));
        }
    }

    /// Whether nothing of it is left after it has moved by so much.
    fn has_left(&self, by: Vector) -> bool {
        let corners = self.corners(by);
        let seen = |i: usize| vector::norm(self.arrived(i, &corners)) > SEEN;
        !(0..self.difference.len()).any(|i| !self.frozen[i] && seen(i))
    }
}

impl FirstGuess for Drift {
    fn path(&self, a: &Spins, b: &Spins, images: usize, context: &GuessContext) -> Result<Path> {
        let lattice = context.states.lattice;
        let comes_in = is_rougher(b, a, lattice);
        let carried = if comes_in { Carried::new(b, a, lattice) } else { Carried::new(a, b, lattice) };
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
        let fine = FINE * (images.max(2) - 1) + 1;
        let path = Path::build(fine, a.sites(), |k, out| {
            out.copy_from_slice(if k + 1 == fine { b.as_slice() } else { a.as_slice() });
            let gone = k as f64 / (fine - 1) as f64;
            if k > 0 && k + 1 < fine {
                carried.write(vector::scale(far * if comes_in { 1.0 - gone } else { gone }, n), out);
            }
        });
        let mut path = path.resampled(images);
        for image in path.as_mut_slice().chunks_mut(3 * a.sites()) {
            let mut held = ComponentsMut::new(image);
            (0..a.sites()).filter(|i| carried.frozen[*i]).for_each(|i| held.set(i, a.get(i)));
        }
        Ok(path)
    }
}

/// The edges over which what differs can leave: their normals.
pub(super) fn exits(a: &Spins, b: &Spins, lattice: &Lattice) -> Vec<Vector> {
    let carried = if is_rougher(b, a, lattice) { Carried::new(b, a, lattice) } else { Carried::new(a, b, lattice) };
    let leaves = |n: &Vector| carried.has_left(vector::scale(carried.distance(*n), *n));
    Outline::of(lattice).edges.into_iter().filter(leaves).collect()
}
