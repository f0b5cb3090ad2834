//! Turns and mirror images of what no period keeps from being turned: clusters, and wires about their axis, in whichever cells their
//! sites are counted.
//!
//! ```text
//! r' = c + Q (r − c) + τ ê          c the middle of all sites; ê along the one periodic direction, if there is one
//! Q u = u', Q v = v'                u, v sites of rare shells, as far from c and of one species; u', v' others of theirs
//! ```
//! Two sites of a cluster, and one of a wire, say what Q is but for a reflection. The rarer the shells the fewer images there are to
//! try, at most N² and mostly a few dozen; an image that fails does so at one of the first sites.

use super::motion::{Motion, STAY, in_order};
use super::{Lattice, Shift};
use crate::geometry::matrix::{product, times, transposed};
use crate::geometry::{Matrix, Vector, vector};

/// Places are the same that differ by less than this part of the furthest distance from the middle.
const SAME: f64 = 1e-5;
/// The middle of all is one place where none is further from it than this part of a length.
const ONE: f64 = 1e-9;
/// Sites have different places along this direction, but by chance.
const ACROSS: Vector = [0.801_783_725, 0.495_529_6, 0.332_111_9];

/// The places of sites beside what is periodic.
struct Points {
    list: Vec<Point>,
    /// By their places along `ACROSS`.
    order: Vec<usize>,
    /// Sites of one species as far from the middle as each other.
    shells: Vec<Vec<usize>>,
    /// The direction that is periodic, where it points, and how far to the next cell.
    axis: Option<(usize, Vector, f64)>,
    same: f64,
}

#[derive(Clone, Copy)]
struct Point {
    place: usize,
    species: usize,
    /// From the middle, across the axis.
    at: Vector,
    /// Along the axis, from the origin.
    along: f64,
}

/// A turn, which keeps or reverses the axis, and then a slide along it.
struct Turn {
    matrix: Matrix,
    sense: isize,
    slide: f64,
}

impl Lattice {
    /// The motions of a cluster or a wire, and of no other lattice; none twice.
    pub(super) fn point_motions(&self) -> Vec<Motion> {
        let Some(points) = Points::of(self) else { return Vec::new() };
        let mut found: Vec<Motion> = Vec::new();
        for turn in points.turns() {
            if let Some(motion) = points.motion(self, &turn).filter(|motion| !found.contains(motion)) {
                found.push(motion);
            }
        }
        found
    }
}

impl Points {
    /// None where more than one direction is periodic, and in a row, which has no turns but its mirror image.
    fn of(lattice: &Lattice) -> Option<Points> {
        let mut periodic = (0..3).filter(|d| lattice.grid.periodic[*d]);
        let axis = periodic.next().map(|d| (d, lattice.steps[d].1.vector(), lattice.steps[d].0));
        if periodic.next().is_some() || lattice.is_row() {
            return None;
        }
        let taken = lattice.places_taken();
        let point = |place: usize| {
            let (atom, cell) = lattice.numbered_place(place);
            let r = lattice.to([0, 1, 2].map(|d| cell[d] as f64 + lattice.atoms[atom].at[d]));
            let (at, along) = axis.map_or((r, 0.0), |(_, e, _)| (vector::normal_part(r, e), vector::dot(r, e)));
            Point { place, species: lattice.atoms[atom].species, at, along }
        };
        let mut list: Vec<Point> = (0..taken.len()).filter(|p| taken[*p]).map(point).collect();
        let middle = vector::scale(1.0 / list.len() as f64, list.iter().map(|p| p.at).fold([0.0; 3], vector::add));
        list.iter_mut().for_each(|p| p.at = vector::sub(p.at, middle));
        let furthest = list.iter().map(|p| vector::norm(p.at)).fold(0.0, f64::max);
        // all in one place, but for rounding
        if furthest < ONE * axis.map_or(vector::norm(middle), |(_, _, length)| length) {
            return None;
        }
        let same = SAME * furthest;
        let mut order: Vec<usize> = (0..list.len()).collect();
        order.sort_by(|a, b| across(list[*a].at).total_cmp(&across(list[*b].at)));
        let shells = shells(&list, same);
        Some(Points { list, order, shells, axis, same })
    }

    /// u, the first of the furthest of the rarest shells, and of a cluster v, the one most beside it of the rarest shell that has any.
    fn references(&self) -> Option<(Point, Option<Point>)> {
        let u = self.list[self.rarest(|p| vector::norm(p.at))?[0]];
        if self.axis.is_some() {
            return Some((u, None));
        }
        let beside = |p: &Point| vector::norm(vector::cross(p.at, u.at)) / vector::norm(u.at);
        let shell = self.rarest(beside)?.iter().map(|k| self.list[*k]);
        Some((u, shell.max_by(|a, b| beside(a).total_cmp(&beside(b)))))
    }

    /// Where the second reference is: a site, or along the axis.
    fn second(&self, v: Option<Point>) -> Vector {
        v.map(|p| p.at).or(self.axis.map(|(_, e, _)| e)).unwrap_or_default()
    }

    /// The smallest shell, of such the one of the largest measure, if it has any.
    fn rarest(&self, measure: impl Fn(&Point) -> f64) -> Option<&[usize]> {
        let most = |shell: &[usize]| shell.iter().map(|k| measure(&self.list[*k])).fold(0.0, f64::max);
        let all = self.shells.iter().map(|shell| (most(shell), shell.as_slice())).filter(|(most, _)| *most > self.same);
        let first = all.min_by(|(p, a), (q, b)| a.len().cmp(&b.len()).then(q.total_cmp(p)));
        first.map(|(_, shell)| shell)
    }

    /// All turns worth trying.
    fn turns(&self) -> Vec<Turn> {
        let Some((u, v)) = self.references() else { return Vec::new() };
        let second = self.second(v);
        let like = |p: &Point| {
            let holds = |shell: &&Vec<usize>| shell.iter().any(|k| self.list[*k].place == p.place);
            self.shells.iter().find(holds).into_iter().flatten().map(|k| &self.list[*k])
        };
        // the axis goes to itself or is reversed
        let seconds: Vec<(isize, Vector)> = match v {
            Some(v) => like(&v).map(|p| (1, p.at)).collect(),
            None => vec![(1, second), (-1, vector::scale(-1.0, second))],
        };
        let angle = vector::dot(u.at, second);
        let most = self.same * (vector::norm(u.at) + vector::norm(second));
        let from = frame(u.at, second);
        let mut turns = Vec::new();
        for image in like(&u) {
            for (sense, w) in seconds.iter().filter(|(_, w)| (vector::dot(image.at, *w) - angle).abs() < most) {
                let slide = image.along - *sense as f64 * u.along;
                let [x, y, z] = frame(image.at, *w);
                let onto = [1.0, -1.0].map(|side| [x, vector::scale(side, y), z]);
                let matrix = |to: &Matrix| product(&transposed(to), &from);
                turns.extend(onto.iter().map(|to| Turn { matrix: matrix(to), sense: *sense, slide }));
            }
        }
        turns.sort_by_key(|turn| in_order(&turn.matrix));
        turns
    }

    /// If every site goes to one.
    fn motion(&self, lattice: &Lattice, turn: &Turn) -> Option<Motion> {
        let mut to: Vec<(usize, Shift)> = vec![(usize::MAX, [0; 3]); self.list.last()?.place + 1];
        let mut is_met = vec![false; self.list.len()];
        for p in &self.list {
            let (k, cells) = self.meets(p, turn)?;
            if std::mem::replace(&mut is_met[k], true) {
                return None;
            }
            let mut by = [0; 3];
            self.axis.iter().for_each(|(d, ..)| by[*d] = cells);
            to[p.place] = (self.list[k].place, by);
        }
        let mut cells = STAY;
        self.axis.iter().for_each(|(d, ..)| cells[*d][*d] = turn.sense);
        Motion::of_places(lattice, turn.matrix, cells, |p| Some(to[p]))
    }

    /// The site that one is turned to, and how many cells on along the axis.
    fn meets(&self, p: &Point, turn: &Turn) -> Option<(usize, isize)> {
        let at = times(&turn.matrix, p.at);
        let along = turn.sense as f64 * p.along + turn.slide;
        let first = self.order.partition_point(|k| across(self.list[*k].at) < across(at) - self.same);
        let near = self.order[first..].iter().take_while(|k| across(self.list[**k].at) <= across(at) + self.same);
        let off = |k: usize| {
            let q = &self.list[k];
            let (cells, length) = self.axis.map_or((0.0, 0.0), |(_, _, l)| (((along - q.along) / l).round(), l));
            let apart = vector::norm(vector::sub(q.at, at)).max((along - q.along - cells * length).abs());
            (apart, k, cells as isize)
        };
        let like = near.filter(|k| self.list[**k].species == p.species).map(|k| off(*k));
        let (apart, k, cells) = like.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (apart < self.same).then_some((k, cells))
    }
}

fn shells(list: &[Point], same: f64) -> Vec<Vec<usize>> {
    let mut sorted: Vec<(usize, f64, usize)> =
        list.iter().enumerate().map(|(k, p)| (p.species, vector::norm(p.at), k)).collect();
    sorted.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let alike = |a: &(usize, f64, usize), b: &(usize, f64, usize)| a.0 == b.0 && b.1 - a.1 < same;
    sorted.chunk_by(alike).map(|shell| shell.iter().map(|(.., k)| *k).collect()).collect()
}

fn across(at: Vector) -> f64 {
    vector::dot(at, ACROSS)
}

/// Three unit vectors at right angles: along u, normal to u and v, and beside u in their plane.
fn frame(u: Vector, v: Vector) -> Matrix {
    let x = vector::unit_or(u, u);
    let y = vector::unit_or(vector::cross(x, v), v);
    [x, y, vector::cross(x, y)]
}
