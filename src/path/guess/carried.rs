//! What a state differs by from another one, carried over the lattice as it is.
//!
//! ```text
//! m_i = unit(b_i + d(r_i − x)),      d = a − b at the sites, linear between like sites of neighbouring cells, 0 outside
//! ```
//! a being the state, b the rest, x how far it has moved. Frozen spins stay.

use crate::field::ComponentsMut;
use crate::geometry::matrix::transposed;
use crate::geometry::{Vector, vector};
use crate::lattice::{Lattice, Shift};
use crate::linalg::solve_dense;
use crate::path::Path;
use crate::spins::Spins;

/// Steps for each image, of which those at equal distances are kept.
const FINE: usize = 4;
/// What differs by less than this is left behind.
pub(super) const SEEN: f64 = 0.05;

/// What a state differs by from another one, the rest.
pub(super) struct Carried<'a> {
    lattice: &'a Lattice,
    rest: &'a Spins,
    difference: Vec<Vector>,
    /// Where nothing moves.
    frozen: Vec<bool>,
    /// From a place to numbers of cells.
    cells: [Vector; 3],
}

impl<'a> Carried<'a> {
    pub(super) fn new(rough: &Spins, rest: &'a Spins, lattice: &'a Lattice) -> Carried<'a> {
        let difference = (0..rest.sites()).map(|i| vector::sub(rough.get(i), rest.get(i))).collect();
        Carried { lattice, rest, difference, frozen: lattice.is_frozen(), cells: lattice.cell_vectors() }
    }

    /// How far it goes until the last spin that is seen to differ is over the edge.
    pub(super) fn distance(&self, n: Vector) -> f64 {
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
    pub(super) fn has_left(&self, by: Vector) -> bool {
        let corners = self.corners(by);
        let seen = |i: usize| vector::norm(self.arrived(i, &corners)) > SEEN;
        !(0..self.difference.len()).any(|i| !self.frozen[i] && seen(i))
    }

    /// The state that it begins in and those in which it has moved by so many equal parts of a way.
    pub(super) fn stops(&self, begins: &Spins, way: Vector, parts: usize) -> Vec<Spins> {
        let moved = |k: usize| {
            let mut m = begins.as_slice().to_vec();
            self.write(vector::scale(k as f64 / parts as f64, way), &mut m);
            Spins::from_unit_components(&m)
        };
        std::iter::once(begins.clone()).chain((1..=parts).map(moved)).collect()
    }

    /// From the first to the second of two states by way of those in which it has moved by so much, told of the part of the path that
    /// is gone; the images at equal distances.
    pub(super) fn path(&self, [a, b]: [&Spins; 2], images: usize, by: impl Fn(f64) -> Vector + Sync) -> Path {
        let fine = FINE * (images.max(2) - 1) + 1;
        let path = Path::build(fine, a.sites(), |k, out| {
            out.copy_from_slice(if k + 1 == fine { b.as_slice() } else { a.as_slice() });
            if k > 0 && k + 1 < fine {
                self.write(by(k as f64 / (fine - 1) as f64), out);
            }
        });
        let mut path = path.resampled(images);
        for image in path.as_mut_slice().chunks_mut(3 * a.sites()) {
            let mut held = ComponentsMut::new(image);
            (0..a.sites()).filter(|i| self.frozen[*i]).for_each(|i| held.set(i, a.get(i)));
        }
        path
    }
}
