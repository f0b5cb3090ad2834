//! Paths on which every spin goes its own way from a to b, each by its own clock.
//!
//! The way is the great circle. Where the ends are (nearly) opposite its plane is undefined, or decided by a canting of the
//! ends that means nothing; all such spins turn about one axis instead, right-handed, so that neighbours stay together:
//! parallel ones parallel, antiparallel ones antiparallel.

use crate::field::ComponentsMut;
use crate::geometry::{Arc, Direction, Quaternion, Vector, angle, vector};
use crate::path::Path;
use crate::spins::Spins;
use crate::threads::{MADE, apiece};
use rayon::prelude::*;
use std::borrow::Cow;

/// Ends farther apart than this (rad) are nearly opposite: they turn about the common axis, not in their own plane.
pub const NEARLY_OPPOSITE: f64 = 3.0;

/// An axis serves spins whose line has at least this sine with it; the sense of those along it would be left to chance.
const ACROSS: f64 = 0.1;

/// The way of one spin.
#[derive(Clone, Copy, Debug)]
pub enum Way {
    /// It stays.
    Rest(Vector),
    /// Along its great circle.
    Direct(Arc),
    /// In two halves, by the middle of a turn about the common axis.
    Around([Arc; 2]),
    /// With all others about an axis, by so much in the end (rad), and what that leaves over along a great circle.
    Turned(Direction, f64, Arc),
}

impl Way {
    /// From p to q; nearly opposite ones turn right-handed about `axis`.
    pub fn new(p: Vector, q: Vector, axis: Direction) -> Way {
        if p == q {
            return Way::Rest(p);
        }
        if !are_nearly_opposite(p, q) {
            return Way::Direct(Arc::new(p, q, axis));
        }
        let line = line(p, q);
        let middle = Arc::new(line, line.map(|c| -c), axis).middle();
        Way::Around([Arc::new(p, middle, axis), Arc::new(middle, q, axis)])
    }

    /// The spin at fraction u of its way, 0 to 1, at constant angular velocity; the ends are exact.
    pub fn at(&self, u: f64) -> Vector {
        match self {
            Way::Rest(p) => *p,
            Way::Direct(arc) => arc.at(u),
            Way::Around([first, _]) if u <= 0.5 => first.at(2.0 * u),
            Way::Around([_, second]) => second.at(2.0 * u - 1.0),
            Way::Turned(axis, angle, rest) => {
                let p = rest.at(u);
                vector::unit_or(Quaternion::from_axis_angle(*axis, u * angle).rotate(p), p)
            }
        }
    }

    /// Its length (rad), up to 2π − 3 where it goes around; of a turn and what it leaves over the sum.
    pub fn length(&self) -> f64 {
        match self {
            Way::Rest(_) => 0.0,
            Way::Direct(arc) => arc.angle(),
            Way::Around([first, second]) => first.angle() + second.angle(),
            Way::Turned(axis, angle, rest) => {
                angle.abs() * vector::norm(vector::cross(axis.vector(), rest.at(0.0))) + rest.angle()
            }
        }
    }
}

/// The direction halfway between p and −q: that of p where the two are opposite.
fn line(p: Vector, q: Vector) -> Vector {
    vector::unit_or(vector::sub(p, q), p)
}

/// The ways of all spins, the nearly opposite ones about one axis: [`common_axis`].
pub fn ways(a: &Spins, b: &Spins, axis: Direction) -> Vec<Way> {
    let ways = Ways::between(a, b);
    let about = ways.about(axis);
    (0..a.sites()).map(|i| *about.of(i)).collect()
}

/// The axis about which all nearly opposite spins turn: the given one, unless one of these spins lies along it. Then it is the
/// next Cartesian axis (x → y → z → x) across all of them, or else the one that stays farthest from them.
pub fn common_axis(a: &Spins, b: &Spins, axis: Direction) -> Direction {
    Ways::between(a, b).common_axis(axis)
}

/// The ways between two states about any axis: what does not depend on the axis is worked out once, and once for neighbours
/// that are alike in both states.
#[derive(Clone, Debug)]
pub struct Ways<'a> {
    /// From here
    pub a: &'a Spins,
    /// to here.
    pub b: &'a Spins,
    /// The first spin of each row of spins that are alike.
    firsts: Vec<usize>,
    /// Which row a spin belongs to.
    rows: Vec<u32>,
    /// The ways of the rows, those of nearly opposite spins still to be filled in.
    direct: Vec<Way>,
    /// Rows of nearly opposite spins.
    opposite: Vec<usize>,
}

/// The ways about one axis.
#[derive(Clone, Debug)]
pub struct About<'w> {
    rows: Cow<'w, [u32]>,
    ways: Vec<Way>,
}

impl About<'_> {
    /// The way of spin i.
    pub fn of(&self, i: usize) -> &Way {
        &self.ways[self.rows[i] as usize]
    }

    /// The lengths of all spins' ways (rad).
    pub fn lengths(&self) -> Vec<f64> {
        let lengths: Vec<f64> = self.ways.iter().map(Way::length).collect();
        self.rows.iter().map(|row| lengths[*row as usize]).collect()
    }
}

impl<'a> Ways<'a> {
    /// From state a to state b of as many spins.
    pub fn between(a: &'a Spins, b: &'a Spins) -> Ways<'a> {
        let (mut firsts, mut rows) = (Vec::new(), Vec::with_capacity(a.sites()));
        for i in 0..a.sites() {
            if i == 0 || (a.get(i), b.get(i)) != (a.get(i - 1), b.get(i - 1)) {
                firsts.push(i);
            }
            rows.push(firsts.len() as u32 - 1);
        }
        let way = |&i: &usize| {
            let (p, q) = (a.get(i), b.get(i));
            if are_nearly_opposite(p, q) { (Way::Rest(p), true) } else { (Way::new(p, q, Direction::X), false) }
        };
        let each: Vec<(Way, bool)> = firsts.par_iter().with_min_len(apiece(3, MADE)).map(way).collect();
        let opposite = (0..each.len()).filter(|&row| each[row].1).collect();
        Ways { a, b, firsts, rows, direct: each.into_iter().map(|(way, _)| way).collect(), opposite }
    }

    /// Whether some spin's way depends on the axis.
    pub fn have_a_choice(&self) -> bool {
        !self.opposite.is_empty()
    }

    /// The ways of all spins, the nearly opposite ones about one axis: [`common_axis`].
    pub fn about(&self, axis: Direction) -> About<'_> {
        let axis = self.common_axis(axis);
        let mut ways = self.direct.clone();
        for &row in &self.opposite {
            let i = self.firsts[row];
            ways[row] = Way::new(self.a.get(i), self.b.get(i), axis);
        }
        About { rows: Cow::Borrowed(&self.rows), ways }
    }

    /// The ways of all spins, each nearly opposite one about an axis of its own, from its site and the line on which it turns over;
    /// all these lines point to one side.
    pub(super) fn about_each(&self, axis: impl Fn(usize, Vector) -> Direction) -> About<'_> {
        let line = |i: usize| line(self.a.get(i), self.b.get(i));
        let first = self.opposite.first().map_or([0.0, 0.0, 1.0], |row| line(self.firsts[*row]));
        let below = first.iter().rev().find(|c| c.abs() > 1e-6).is_some_and(|c| *c < 0.0);
        let side = if below { vector::scale(-1.0, first) } else { first };
        let mut is_opposite = vec![false; self.direct.len()];
        self.opposite.iter().for_each(|row| is_opposite[*row] = true);
        let way = |i: usize| {
            let row = self.rows[i] as usize;
            if !is_opposite[row] {
                return self.direct[row];
            }
            let up = if vector::dot(line(i), side) < 0.0 { vector::scale(-1.0, line(i)) } else { line(i) };
            Way::new(self.a.get(i), self.b.get(i), axis(i, up))
        };
        let sites = 0..self.a.sites();
        About { rows: Cow::Owned(sites.clone().map(|i| i as u32).collect()), ways: sites.map(way).collect() }
    }

    /// The ways of all spins that turn as one about an axis, by this angle (rad); frozen ones stay.
    pub(super) fn turned(&self, axis: Direction, angle: f64, is_frozen: &[bool]) -> About<'_> {
        let back = Quaternion::from_axis_angle(axis, -angle);
        let way = |i: usize| {
            let (p, q) = (self.a.get(i), self.b.get(i));
            let unturned = back.rotate(q);
            let rest = || Arc::new(p, vector::unit_or(unturned, unturned), axis);
            if is_frozen[i] { Way::Rest(p) } else { Way::Turned(axis, angle, rest()) }
        };
        let sites = 0..self.a.sites();
        About { rows: Cow::Owned(sites.clone().map(|i| i as u32).collect()), ways: sites.map(way).collect() }
    }

    fn common_axis(&self, axis: Direction) -> Direction {
        let closest = |k: Direction| {
            let line = |i: usize| line(self.a.get(i), self.b.get(i));
            let sine = |&row: &usize| vector::norm(vector::cross(line(self.firsts[row]), k.vector()));
            self.opposite.iter().map(sine).fold(f64::INFINITY, f64::min)
        };
        let candidates = [axis, next_axis(axis), next_axis(next_axis(axis))];
        let mut best = (axis, 0.0);
        for (n, k) in candidates.into_iter().enumerate() {
            let sine = closest(k);
            if sine >= ACROSS {
                return k;
            }
            if n == 0 || sine > best.1 {
                best = (k, sine);
            }
        }
        best.0
    }
}

/// Whether two spins are farther apart than [`NEARLY_OPPOSITE`].
fn are_nearly_opposite(p: Vector, q: Vector) -> bool {
    vector::dot(p, q) < -0.9 && angle(p, q) >= NEARLY_OPPOSITE
}

/// The Cartesian axis after the one the given axis is nearest to, with its sign.
pub(super) fn next_axis(axis: Direction) -> Direction {
    let d = axis.vector();
    let nearest = (1..3).fold(0, |n, c| if d[c].abs() > d[n].abs() { c } else { n });
    let next = [Direction::X, Direction::Y, Direction::Z][(nearest + 1) % 3];
    if d[nearest] < 0.0 { next.reversed() } else { next }
}

/// The path with spin i at fraction `clock(k, i)` of its way in image k, 0 to 1; ends exact.
pub fn clocked(ways: &Ways, about: &About, images: usize, clock: impl Fn(usize, usize) -> f64 + Sync) -> Path {
    let (a, b) = (ways.a, ways.b);
    Path::build(images, a.sites(), |k, out| {
        if k == 0 || k + 1 == images {
            return out.copy_from_slice(if k == 0 { a.as_slice() } else { b.as_slice() });
        }
        let mut out = ComponentsMut::new(out);
        for i in 0..a.sites() {
            out.set(i, about.of(i).at(clock(k, i)));
        }
    })
}

/// Image k's fraction of a path of `images` images, from 0 to 1.
pub(super) fn fraction(k: usize, images: usize) -> f64 {
    k as f64 / images.saturating_sub(1).max(1) as f64
}
