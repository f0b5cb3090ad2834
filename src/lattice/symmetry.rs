//! What the places of the sites alone are symmetric under: turns and mirror images of the lattice, and shifts along periodic
//! directions. Whether an energy is too is for the energy to tell.
//!
//! ```text
//! r' = Q r + t          cell c of atom s ↦ cell M c + t_s of atom σ(s)          Q A = A M, the columns of A the steps of the lattice
//! ```
//! M is a matrix of whole numbers, here of at most 2: the vectors of a cell are not to be much longer than they need be.

use super::{Lattice, Shift};
use crate::geometry::matrix::{UNIT, determinant, product, times, transposed};
use crate::geometry::{Matrix, Vector, vector};

/// Lengths and places that are the same differ by less than this part of a step.
const SAME: f64 = 1e-6;
/// The largest whole number in M.
const MOST: isize = 2;

/// Whole numbers, row by row.
type Whole = [[isize; 3]; 3];
const STAY: Whole = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];

/// The sites of a lattice in other places of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Motion {
    /// M.
    turn: Whole,
    /// σ(s) and t_s of every atom of a cell.
    to: Vec<(usize, Shift)>,
}

impl Motion {
    /// So many cells on.
    pub fn shift(lattice: &Lattice, by: Shift) -> Motion {
        Motion { turn: STAY, to: (0..lattice.atoms.len()).map(|atom| (atom, by)).collect() }.normal(lattice)
    }

    /// Every site where it is.
    pub fn none(lattice: &Lattice) -> Motion {
        Motion::shift(lattice, [0; 3])
    }

    /// Whether every site stays.
    pub fn is_none(&self) -> bool {
        self.shifts_by() == Some([0; 3])
    }

    /// How many cells on all sites go, where they are shifted only.
    pub fn shifts_by(&self) -> Option<Shift> {
        let (_, by) = self.to[0];
        let alike = self.to.iter().enumerate().all(|(atom, to)| *to == (atom, by));
        (self.turn == STAY && alike).then_some(by)
    }

    /// The atom and the cell that site i goes to; no cell where it leaves the box.
    #[inline]
    pub fn place(&self, lattice: &Lattice, i: usize) -> (usize, Option<[usize; 3]>) {
        let (atom, cell) = lattice.cell(i);
        let (to, by) = self.to[atom];
        let cell = cell.map(|n| n as isize);
        let along = |d: usize| {
            let row = self.turn[d];
            lattice.grid.step(0, by[d] + row[0] * cell[0] + row[1] * cell[1] + row[2] * cell[2], d)
        };
        let [x, y, z] = [along(0), along(1), along(2)];
        (to, x.and_then(|x| Some([x, y?, z?])))
    }

    /// Where it takes site i, if there is a site.
    #[inline]
    pub fn of(&self, lattice: &Lattice, i: usize) -> Option<usize> {
        let (atom, cell) = self.place(lattice, i);
        lattice.site(atom, cell?)
    }

    /// What takes i to self(first(i)).
    pub fn after(&self, first: &Motion, lattice: &Lattice) -> Motion {
        let turn = [0, 1, 2].map(|r| [0, 1, 2].map(|c| (0..3).map(|k| self.turn[r][k] * first.turn[k][c]).sum()));
        let both = |&(between, by): &(usize, Shift)| {
            let (to, further) = self.to[between];
            let image = |r: usize| further[r] + (0..3).map(|k| self.turn[r][k] * by[k]).sum::<isize>();
            (to, [image(0), image(1), image(2)])
        };
        Motion { turn, to: first.to.iter().map(both).collect() }.normal(lattice)
    }

    /// A shift, so many times.
    pub fn times(&self, count: usize, lattice: &Lattice) -> Motion {
        let to = self.to.iter().map(|(atom, by)| (*atom, by.map(|n| n * count as isize))).collect();
        Motion { turn: self.turn, to }.normal(lattice)
    }

    /// The same, with no more cells on along a periodic direction than there are.
    fn normal(mut self, lattice: &Lattice) -> Motion {
        for d in (0..3).filter(|d| lattice.grid.periodic[*d]) {
            self.to.iter_mut().for_each(|(_, by)| by[d] = by[d].rem_euclid(lattice.grid.size[d] as isize));
        }
        self
    }

    /// By how many sites a row is shifted, or shifted after it was mirrored end for end.
    pub fn beside_mirror(&self, lattice: &Lattice) -> usize {
        let by = self.to[0].1[0] + isize::from(self.turn[0][0] < 0);
        by.rem_euclid(lattice.grid.size[0] as isize) as usize
    }

    /// Q.
    pub fn turn(&self, lattice: &Lattice) -> Matrix {
        let columns = transposed(&lattice.frame());
        let turn = self.turn.map(|row| row.map(|n| n as f64));
        product(&product(&columns, &turn), &inverse(&columns))
    }
}

/// A⁻¹.
fn inverse(a: &Matrix) -> Matrix {
    let [x, y, z] = transposed(a);
    let volume = determinant(&[x, y, z]);
    [vector::cross(y, z), vector::cross(z, x), vector::cross(x, y)].map(|v| vector::scale(1.0 / volume, v))
}

impl Lattice {
    /// The motions that are more than shifts of whole cells, but for such shifts: those that the places of the atoms allow, put so
    /// that along open directions the box of all sites is the same.
    pub fn motions(&self) -> Vec<Motion> {
        if self.is_row() {
            // a ring of two is its own mirror image, shifted
            let mirror =
                Motion { turn: [[-1, 0, 0], [0, 1, 0], [0, 0, 1]], to: vec![(0, [self.sites as isize - 1, 0, 0])] };
            return if self.sites < 2 + usize::from(self.grid.periodic[0]) { Vec::new() } else { vec![mirror] };
        }
        let mut found = vec![Motion::none(self)];
        for turn in self.turns() {
            for first in 0..self.atoms.len() {
                let Some(motion) = self.with_turn(turn, first).and_then(|motion| self.boxed(motion)) else { continue };
                let extends = |d: &usize| self.grid.extends(*d);
                let moves_alike = |other: &&Motion| {
                    other.to == motion.to && (0..3).filter(extends).all(|d| other.turn[d] == motion.turn[d])
                };
                if found.iter().find(moves_alike).is_none() {
                    found.push(motion);
                }
            }
        }
        found.split_off(1)
    }

    /// The steps along directions that extend, and unit vectors at right angles to all others along those that do not.
    fn frame(&self) -> Matrix {
        let extends = [0, 1, 2].map(|d| self.grid.extends(d));
        let mut frame = [0, 1, 2].map(|d| if extends[d] { self.steps[d].1.vector() } else { [0.0; 3] });
        for d in (0..3).filter(|d| !extends[*d]) {
            let others: Vec<Vector> = frame.iter().copied().filter(|v| *v != [0.0; 3]).collect();
            let free = |e: &Vector| others.iter().fold(*e, |v, other| vector::normal_part(v, *other));
            let across = match others[..] {
                [a, b] => vector::cross(a, b),
                // of one, any; of its own two neighbours in the order x, y, z the first that is not along it
                _ => [UNIT[d], UNIT[(d + 1) % 3]].iter().map(free).find(|v| vector::norm(*v) > 0.5).unwrap_or(UNIT[d]),
            };
            frame[d] = vector::unit_or(across, UNIT[d]);
        }
        [0, 1, 2].map(|d| if extends[d] { vector::scale(self.steps[d].0, frame[d]) } else { frame[d] })
    }

    /// The mirror image along a direction that does not extend.
    pub fn mirrored(&self, direction: usize) -> Matrix {
        let n = self.frame()[direction];
        [0, 1, 2].map(|r| vector::sub(UNIT[r], vector::scale(2.0 * n[r], n)))
    }

    /// The M that keep all distances, and no torus or open border is torn by.
    fn turns(&self) -> Vec<Whole> {
        let (frame, extends) = (self.frame(), [0, 1, 2].map(|d| self.grid.extends(d)));
        let whole = |v: [isize; 3]| (0..3).fold([0.0; 3], |r, d| vector::add(r, vector::scale(v[d] as f64, frame[d])));
        let range = |d: usize, own: usize| match (extends[d], extends[own]) {
            (true, true) => -MOST..=MOST,
            (false, false) if d == own => -1..=1,
            _ => 0..=0,
        };
        let images = |own: usize| -> Vec<([isize; 3], Vector)> {
            let all =
                range(2, own).flat_map(|z| range(1, own).flat_map(move |y| range(0, own).map(move |x| [x, y, z])));
            let length = vector::norm(frame[own]);
            let alike = |(_, r): &([isize; 3], Vector)| (vector::norm(*r) - length).abs() < SAME * length;
            all.map(|v| (v, whole(v))).filter(alike).collect()
        };
        let angle = |p: Vector, q: Vector, a: usize, b: usize| {
            let scale = vector::norm(frame[a]) * vector::norm(frame[b]);
            (vector::dot(p, q) - vector::dot(frame[a], frame[b])).abs() < SAME * scale
        };
        let [first, second, third] = [images(0), images(1), images(2)];
        let mut found = Vec::new();
        for (a, p) in &first {
            for (b, q) in second.iter().filter(|(_, q)| angle(*p, *q, 0, 1)) {
                for (c, _) in third.iter().filter(|(_, r)| angle(*p, *r, 0, 2) && angle(*q, *r, 1, 2)) {
                    found.push([0, 1, 2].map(|d| [a[d], b[d], c[d]]));
                }
            }
        }
        found.retain(|turn| self.keeps_borders(turn));
        found.sort_by_key(|turn| (*turn != STAY, turn.map(|row| row.map(|n| -n))));
        found
    }

    /// Whether cells that are one over the periodic borders stay one.
    fn keeps_borders(&self, turn: &Whole) -> bool {
        let (size, periodic) = (self.grid.size.map(|n| n as isize), self.grid.periodic);
        let mut pairs = (0..3).flat_map(|to| (0..3).map(move |from| (to, from))).filter(|(_, from)| periodic[*from]);
        pairs.all(|(to, from)| match periodic[to] {
            true => turn[to][from] * size[from] % size[to] == 0,
            false => turn[to][from] == 0,
        })
    }

    /// The motion that turns so and takes the first atom of a cell to such an atom, if every atom goes to one.
    fn with_turn(&self, turn: Whole, first: usize) -> Option<Motion> {
        let columns = transposed(&self.frame());
        let into = inverse(&columns);
        let places: Vec<Vector> = self.atoms.iter().map(|atom| times(&into, self.to(atom.at))).collect();
        let turned = |at: Vector| turn.map(|row| (0..3).map(|d| row[d] as f64 * at[d]).sum::<f64>());
        let moved = vector::sub(places[first], turned(places[0]));
        let goes = |at: &Vector| {
            let image = vector::add(turned(*at), moved);
            places.iter().enumerate().find_map(|(to, place)| {
                let apart = vector::sub(image, *place);
                let cells = [0, 1, 2].map(|d| if self.grid.extends(d) { apart[d].round() } else { 0.0 });
                let meets = (0..3).all(|d| (apart[d] - cells[d]).abs() < SAME);
                meets.then(|| (to, cells.map(|n| n as isize)))
            })
        };
        Some(Motion { turn, to: places.iter().map(goes).collect::<Option<_>>()? })
    }

    /// The motion after a shift that puts the box of all sites where it was along open directions.
    fn boxed(&self, mut motion: Motion) -> Option<Motion> {
        let open = (0..3).filter(|d| !self.grid.periodic[*d]);
        for d in open {
            let (mut lowest, mut image) = (isize::MAX, isize::MAX);
            for i in 0..self.sites {
                let (atom, cell) = self.cell(i);
                let row = motion.turn[d];
                let at = (0..3).map(|k| row[k] * cell[k] as isize).sum::<isize>() + motion.to[atom].1[d];
                (lowest, image) = (lowest.min(cell[d] as isize), image.min(at));
            }
            motion.to.iter_mut().for_each(|(_, by)| by[d] += lowest - image);
        }
        let all_open = self.grid.periodic == [false; 3];
        let stays = !all_open || (0..self.sites).all(|i| motion.of(self, i).is_some());
        stays.then(|| motion.normal(self))
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::vector;
    use crate::lattice::{Lattice, LatticeSpec};

    fn lattice(text: &str) -> Lattice {
        serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap()
    }

    /// How many motions there are, with the one that leaves every site; each is a permutation of the sites that keeps all distances
    /// where no border is periodic.
    fn count(text: &str) -> usize {
        let lattice = lattice(text);
        let motions = lattice.motions();
        for motion in &motions {
            let to: Vec<usize> = (0..lattice.sites).map(|i| motion.of(&lattice, i).unwrap()).collect();
            let mut sorted = to.clone();
            sorted.sort_unstable();
            sorted.dedup();
            assert!(sorted.len() == lattice.sites && to.iter().enumerate().any(|(i, j)| i != *j), "{text}: {motion:?}");
            if lattice.grid.periodic == [false; 3] {
                let apart = |i, j| vector::norm(vector::sub(lattice.position(i), lattice.position(j)));
                let pairs = (0..lattice.sites).flat_map(|i| (0..i).map(move |j| [i, j]));
                assert!(pairs.into_iter().all(|[i, j]| (apart(i, j) - apart(to[i], to[j])).abs() < 1e-9), "{text}");
            }
        }
        motions.len() + 1
    }

    #[test]
    fn a_lattice_has_as_many_motions_as_its_shape_allows() {
        for (text, expected) in [
            (r#"{"square": {"cells": [4, 4]}}"#, 8),
            (r#"{"square": {"cells": [4, 3]}}"#, 4),
            (r#"{"square": {"cells": [4, 4], "periodic": true}}"#, 8),
            (r#"{"square": {"cells": [4, 3], "periodic": true}}"#, 4),
            // a rhombus of 60°
            (r#"{"triangular": {"cells": [4, 4]}}"#, 4),
            (r#"{"triangular": {"cells": [6, 6], "periodic": true}}"#, 12),
            (r#"{"honeycomb": {"cells": [6, 6], "periodic": true}}"#, 12),
            (r#"{"kagome": {"cells": [4, 4], "periodic": true}}"#, 12),
            (r#"{"cubic": {"cells": [3, 3, 3]}}"#, 48),
            (r#"{"cubic": {"cells": [4, 4, 3]}}"#, 16),
            (r#"{"bcc": {"cells": [3, 3, 3], "periodic": true}}"#, 96),
            (r#"{"fcc": {"cells": [3, 3, 3], "periodic": true}}"#, 192),
            (r#"{"hcp": {"cells": [3, 3, 2], "periodic": true}}"#, 24),
        ] {
            assert_eq!(count(text), expected, "{text}");
        }
    }
}
