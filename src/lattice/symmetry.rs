//! What the places of the sites alone are symmetric under: turns and mirror images of the lattice, and shifts along periodic
//! directions. Whether an energy is too is for the energy to tell.
//!
//! ```text
//! r' = Q r + t          cell c of atom s ↦ cell M c + t_s of atom σ(s)          Q A = A M, the columns of A the steps of the lattice
//! ```
//! M is a matrix of whole numbers, here of at most 2: the vectors of a cell are not to be much longer than they need be.

use super::motion::{STAY, Whole, in_order};
use super::{Lattice, Motion, Shift};
use crate::geometry::matrix::{UNIT, determinant, product, times, transposed};
use crate::geometry::{Matrix, Vector, vector};

/// Lengths and places that are the same differ by less than this part of a step.
const SAME: f64 = 1e-6;
/// The largest whole number in M.
const MOST: isize = 2;

/// What takes atom s of cell c to atom σ(s) of cell M c + t_s.
#[derive(Clone)]
struct OfCells {
    /// M.
    turn: Whole,
    /// σ(s) and t_s of every atom of a cell.
    to: Vec<(usize, Shift)>,
}

/// A⁻¹.
fn inverse(a: &Matrix) -> Matrix {
    let [x, y, z] = transposed(a);
    let volume = determinant(&[x, y, z]);
    [vector::cross(y, z), vector::cross(z, x), vector::cross(x, y)].map(|v| vector::scale(1.0 / volume, v))
}

/// The normal of the plane of the longest of all and of what is most beside it; none where all are along one line.
fn normal(ways: &[Vector]) -> Option<Vector> {
    let longest = |vectors: &mut dyn Iterator<Item = Vector>| {
        vectors.max_by(|a, b| vector::norm(*a).total_cmp(&vector::norm(*b))).filter(|v| vector::norm(*v) > SAME)
    };
    let along = longest(&mut ways.iter().copied()).and_then(vector::unit)?;
    longest(&mut ways.iter().map(|w| vector::cross(along, *w))).and_then(vector::unit)
}

impl Lattice {
    /// The motions that are more than shifts of whole cells, but for such shifts: those that the places of the atoms allow, put so
    /// that along open directions the box of all sites is the same, and those that clusters and wires allow, in whichever cells.
    pub fn motions(&self) -> Vec<Motion> {
        let mut found = vec![Motion::none(self)];
        found.extend(self.motions_of_cells());
        let more: Vec<Motion> = self.point_motions().into_iter().filter(|motion| !found.contains(motion)).collect();
        if !more.is_empty() {
            found.extend(more);
            found[1..].sort_by_key(|motion| in_order(motion.turn()));
        }
        found.split_off(1)
    }

    fn motions_of_cells(&self) -> Vec<Motion> {
        if self.is_row() {
            // a ring of two is its own mirror image, shifted
            let mirror =
                OfCells { turn: [[-1, 0, 0], [0, 1, 0], [0, 0, 1]], to: vec![(0, [self.sites as isize - 1, 0, 0])] };
            let is_one = self.sites >= 2 + usize::from(self.grid.periodic[0]);
            return is_one.then(|| self.motion(&mirror)).flatten().into_iter().collect();
        }
        let mut found = vec![Motion::none(self)];
        for turn in self.turns() {
            for first in 0..self.atoms.len() {
                let boxed = self.with_turn(turn, first).map(|motion| self.boxed(motion));
                let Some(motion) = boxed.and_then(|motion| self.motion(&motion)) else { continue };
                if !found.contains(&motion) {
                    found.push(motion);
                }
            }
        }
        found.split_off(1)
    }

    /// If every site goes to a place of one.
    fn motion(&self, of_cells: &OfCells) -> Option<Motion> {
        let to = |p: usize| {
            let (atom, cell) = self.numbered_place(p);
            let (to, by) = of_cells.to[atom];
            let image =
                [0, 1, 2].map(|d| by[d] + (0..3).map(|k| of_cells.turn[d][k] * cell[k] as isize).sum::<isize>());
            let open = [0, 1, 2].map(|d| if self.grid.periodic[d] { 0 } else { image[d] });
            Some((self.place_number(to, self.grid.shifted([0; 3], open)?), image))
        };
        Motion::of_places(self, self.matrix(&of_cells.turn), of_cells.turn, to)
    }

    /// Q.
    fn matrix(&self, turn: &Whole) -> Matrix {
        let columns = transposed(&self.frame());
        let turn = turn.map(|row| row.map(|n| n as f64));
        product(&product(&columns, &turn), &inverse(&columns))
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

    /// The mirror image that leaves all sites of a film or a flat cluster where they are; of any other lattice that along the first
    /// direction that does not extend, if there is one.
    pub fn flat_mirror(&self) -> Option<Matrix> {
        let frame = self.frame();
        let first = (0..3).find(|d| !self.grid.extends(*d)).map(|d| frame[d]);
        let ways = self.ways();
        let crosses = |n: Vector| ways.iter().all(|w| vector::dot(*w, n).abs() < SAME);
        let n = match first.filter(|n| crosses(*n)) {
            Some(n) => n,
            None => normal(&ways).filter(|n| crosses(*n)).or(first)?,
        };
        Some([0, 1, 2].map(|r| vector::sub(UNIT[r], vector::scale(2.0 * n[r], n))))
    }

    /// From the first site to all others, and round along each periodic direction.
    fn ways(&self) -> Vec<Vector> {
        let round = (0..3).filter(|d| self.grid.periodic[*d]).map(|d| self.steps[d]);
        let round = round.map(|(length, along)| vector::scale(length, along.vector()));
        let first = self.position(0);
        round.chain((1..self.sites).map(|i| vector::sub(self.position(i), first))).collect()
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
    fn with_turn(&self, turn: Whole, first: usize) -> Option<OfCells> {
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
        Some(OfCells { turn, to: places.iter().map(goes).collect::<Option<_>>()? })
    }

    /// The motion after a shift that puts the box of all sites where it was along open directions.
    fn boxed(&self, mut motion: OfCells) -> OfCells {
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
        motion
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

    /// A crystal of such cells with these atoms.
    fn crystal(vectors: &str, atoms: &[[f64; 3]], more: &str) -> String {
        let basis: Vec<String> = atoms.iter().map(|at| format!(r#"{{"at": {at:?}}}"#)).collect();
        format!(r#"{{"crystal": {{"vectors": {vectors}, "basis": [{}], {more}}}}}"#, basis.join(", "))
    }

    #[test]
    fn a_cluster_has_the_motions_of_its_sites_whichever_cells_they_are_counted_in() {
        let part = |k: usize, n: usize| (k % n) as f64 / n as f64 + 0.1;
        let cube = |n: usize, high: usize| -> Vec<[f64; 3]> {
            (0..n * n * high).map(|k| [part(k, n), part(k / n, n), part(k / n / n, high)]).collect()
        };
        let row: Vec<[f64; 3]> = (0..4).map(|k| [part(k, 4), 0.0, 0.0]).collect();
        let round = |n: usize, rise: f64| -> Vec<[f64; 3]> {
            let angle = |k: usize| (360.0 * k as f64 / n as f64).to_radians();
            (0..n).map(|k| [0.2 * angle(k).cos(), 0.2 * angle(k).sin(), rise * k as f64]).collect()
        };
        let (cell, long) = ("[[4, 0, 0], [0, 4, 0], [0, 0, 1]]", "[[4, 0, 0], [0, 1, 0], [0, 0, 1]]");
        let wide = "[[9, 0, 0], [2, 9, 0], [0, 0, 9]]";
        let wire = r#""cells": [1, 1, 5], "periodic": [false, false, true]"#;
        let one = r#""cells": [1, 1, 1]"#;
        for (text, expected) in [
            (crystal(cell, &cube(4, 1), one), 8),
            (crystal(long, &row, r#""cells": [1, 4, 1]"#), 8),
            (crystal("[[4, 0, 0], [0, 4, 0], [0, 0, 4]]", &cube(4, 4), one), 48),
            (crystal("[[4, 0, 0], [0, 4, 0], [0, 0, 1]]", &cube(4, 1), r#""cells": [1, 1, 4]"#), 48),
            // off the axes of the cell
            (crystal(wide, &[[0.1, 0.1, 0.1], [0.2, 0.1, 0.1], [0.1, 0.1, 0.2], [0.5, 0.1, 0.5]], one), 2),
            (crystal("[[9, 0, 0], [0, 9, 0], [0, 0, 9]]", &round(7, 0.0), one), 14),
            // along a wire the period stays
            (crystal("[[9, 0, 0], [0, 9, 0], [0, 0, 9]]", &round(3, 0.0), wire), 12),
            (crystal("[[9, 0, 0], [0, 9, 0], [0, 0, 9]]", &round(5, 0.2), wire), 10),
            (crystal("[[4, 0, 0], [0, 4, 0], [0, 0, 1]]", &cube(4, 1), wire), 16),
        ] {
            assert_eq!(count(&text), expected, "{text}");
        }
    }
}
