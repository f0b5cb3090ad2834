//! The ways in which a state may slide: shifts of its lattice, and a turn about an axis.

use super::pinning::Pinning;
use super::valleys::{Held, LEAST, towards, unit};
use crate::energy::{Evaluator, Hamiltonian};
use crate::field::{Components, ComponentsMut};
use crate::geometry::matrix::UNIT;
use crate::geometry::{Direction, Vector, log, vector};
use crate::lattice::Lattice;
use crate::linalg::{remove, slab};
use crate::sphere::rotate_sites;
use crate::stationary::{Point, State};
use crate::symmetry::{Group, Operation};
use std::f64::consts::PI;

/// Places at which the energy along a turn is looked at, from a place to the next.
const LOOKS: usize = 32;

/// What takes a state from a place to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Generator {
    /// The shift of this number of the group.
    Shift(usize),
    /// A turn of all free spins.
    Turn(Turn),
}

/// A turn of all free spins about a unit axis by the part 1/fold of a circle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// About this axis.
    pub axis: Vector,
    /// After so many turns every spin is where it was.
    pub fold: usize,
}

/// One way, from a place to the next.
#[derive(Debug)]
pub(super) struct Way {
    pub generator: Generator,
    /// ∂m/∂x, tangent coordinates (2N).
    pub derivative: Vec<f64>,
    /// Log_m of the state in the next place; of a turn the derivative.
    pub hop: Vec<f64>,
    /// What a place costs, the other ways following.
    pub pinning: Pinning,
    /// k_BT (meV) above which it is no valley: the state is held across it no better than to its radius of curvature.
    pub closes_mev: f64,
}

/// The cosine of the angle between ways that begin alike falls short of 1 by this.
const ALIKE: f64 = 1e-3;

/// The ways along these directions of the lattice, and the softest turn that costs less than `most_mev` by its curvature.
pub(super) fn all(h: Evaluator, held: &Held, group: &Group, directions: &[usize], most_mev: f64) -> Vec<Way> {
    let mut ways: Vec<Way> = directions.iter().filter_map(|d| shift(h, held, group, *d, directions)).collect();
    ways.extend(turn(h, held, group, most_mev));
    ways
}

fn shift(h: Evaluator, held: &Held, group: &Group, direction: usize, all: &[usize]) -> Option<Way> {
    let (number, shift) = shift_along(group, direction)?;
    let m = &held.state.m;
    let mut derivative = held.tangent(&derivative(h.lattice(), m, direction))?;
    let hop = towards(m, &shift.apply(m));
    if !goes_on(shift, m, &hop) {
        return None;
    }
    let half: Vec<f64> = hop.iter().map(|x| 0.5 * x).collect();
    // half-way nothing tells how far the others lead, which are as soft
    let others = |at: &Point| -> Vec<Vec<f64>> {
        all.iter().filter(|d| **d != direction).map(|d| self::derivative(h.lattice(), &at.m, *d)).collect()
    };
    // a direction half-way is the mean of those in the two places
    let between = |mut field: Vec<f64>| {
        let next = shift.apply(&field);
        slab::add_scaled(&mut field, 1.0, &next);
        field
    };
    let along = |at: &Point| [vec![towards(&at.m, m)], others(at)].concat();
    let top_mev = held.top_mev(h, held.state.moved(&h, &half), along, between)?;
    let cells = shift.motion.shifts_by().map_or(1, |by| by[direction]);
    slab::scale(&mut derivative, cells as f64);
    let pinning = held.pinning(&derivative, top_mev);
    let hop = held.tangent(&hop)?;
    Some(Way { generator: Generator::Shift(number), derivative, hop, pinning, closes_mev: f64::INFINITY })
}

/// A turn with ∂m/∂x (2N) and what a place costs.
type Candidate = (Turn, Vec<f64>, Pinning);

/// The softest turn about an axis that a term singles out, where the energy has no axis of its own.
fn turn(h: Evaluator, held: &Held, group: &Group, most_mev: f64) -> Option<Way> {
    let axes = h.own_axes();
    if !group.axes().is_empty() || axes.is_empty() {
        return None;
    }
    let rotation = |axis: Vector| held.tangent(&turned(&h, &held.state.m, axis));
    let softness = held.softness(UNIT.into_iter().filter_map(rotation).collect());
    let mut found: Vec<Candidate> = Vec::new();
    for axis in axes {
        let Some(mut derivative) = rotation(axis) else { continue };
        let turn = Turn { axis, fold: fold(group, axis) };
        slab::scale(&mut derivative, 2.0 * PI / turn.fold as f64);
        let pinning = Pinning::new(1.0 / softness(&unit(&derivative)), slab::norm(&derivative), 0.0);
        if pinning.curved_mev < most_mev {
            found.push((turn, derivative, pinning));
        }
    }
    found.sort_by(|a, b| a.2.curved_mev.total_cmp(&b.2.curved_mev));
    let leaves = |one: &Candidate| found.iter().any(|other| goes_straighter(&h, held.state, other, one));
    found.iter().filter(|one| !leaves(one)).find_map(|(turn, derivative, pinning)| {
        let half = |v: Vec<f64>| turn.half(&h, v);
        let along = |at: &Point| vec![turned(&h, &at.m, turn.axis)];
        let top_mev = held.top_mev(h, half(held.state.m.clone()), along, half)?;
        let pinning = Pinning { top_mev: pinning.top_mev.max(top_mev), ..*pinning };
        let [hop, derivative] = [(); 2].map(|()| derivative.clone());
        let closes_mev = fills_mev(&h, held, turn.axis);
        Some(Way { generator: Generator::Turn(*turn), hop, derivative, pinning, closes_mev })
    })
}

/// κR²: k_BT (meV) at which a state moves as far across the circle that a turn makes of it as the circle's radius of curvature R, held
/// there with κ, which down its descent is the size of that curvature. A small circle about an axis that spins all but point along is filled,
/// and the state a harmonic well: what it costs to go round tells nothing.
fn fills_mev(h: &Hamiltonian, held: &Held, axis: Vector) -> f64 {
    let velocity = turned(h, &held.state.m, axis);
    let mut inwards = held.state.basis.coordinates(&turned(h, &velocity, axis));
    remove(&mut inwards, &[unit(&held.state.basis.coordinates(&velocity))]);
    remove(&mut inwards, &held.state.zeros);
    let size = slab::norm(&inwards);
    let radius = slab::dot(&velocity, &velocity) / size;
    if size > LEAST { radius * radius / held.across(&unit(&inwards)) } else { f64::INFINITY }
}

/// Whether of two turns that begin alike the first goes on as it begins, by its energy (meV), as far as the smaller of their circles
/// leads in a radian, and the other less so: of collinear spins any axis that is not normal to them makes a circle that leaves the valley,
/// and the nearer it is to them the smaller.
fn goes_straighter(h: &Hamiltonian, state: &State, one: &Candidate, other: &Candidate) -> bool {
    let alike = slab::dot(&unit(&one.1), &unit(&other.1)).abs() > 1.0 - ALIKE;
    let radius = |(turn, derivative, _): &Candidate| slab::norm(derivative) * turn.fold as f64 / (2.0 * PI);
    let far = radius(one).min(radius(other));
    let bends_mev = |candidate: &Candidate| {
        let turned = |angle: f64| h.difference_mev(&candidate.0.by(h, state.m.clone(), angle), &state.m);
        let both: f64 = [1.0, -1.0].map(|sense| turned(sense * far / radius(candidate))).iter().sum();
        (both - far * far * state.curvature_mev(&candidate.1)).abs()
    };
    alike && bends_mev(one) < bends_mev(other)
}

impl Way {
    /// k_BT (meV) below which it is left out, whatever the others: all of them together may hold the state less. A turn is one only where
    /// the state goes round: about many an axis its first part is a translation, and soft.
    pub fn opens_mev(&self) -> f64 {
        match self.generator {
            Generator::Shift(_) => self.pinning.loosens_mev().min(self.pinning.top_mev),
            Generator::Turn(_) => self.pinning.top_mev,
        }
    }

    /// Whether it may be one at a k_BT (meV).
    pub fn is_open(&self, thermal_mev: f64) -> bool {
        self.opens_mev() < thermal_mev && thermal_mev <= self.closes_mev
    }
}

impl Turn {
    /// Half-way to the next place, spins or a field (3N).
    pub fn half(&self, h: &Hamiltonian, v: Vec<f64>) -> Vec<f64> {
        self.by(h, v, PI / self.fold as f64)
    }

    /// By which angle (rad) a state is turned until its energy along the turn has no curvature any more. The energy of a ring need not be a
    /// cosine: beside a symmetry that holds there may be one that holds nearly, and more places than it makes.
    pub fn straightens(&self, h: &Hamiltonian, m: &[f64]) -> Option<f64> {
        let step = 2.0 * PI / (LOOKS * self.fold) as f64;
        let height = |k: usize| h.difference_mev(&self.by(h, m.to_vec(), k as f64 * step), m);
        let heights: Vec<f64> = (0..LOOKS).map(height).collect();
        let at = |k: usize| heights[k % LOOKS];
        let bends = |k: usize| at(k + 1) - 2.0 * at(k) + at(k + LOOKS - 1);
        let first = (1..=LOOKS / 2).find(|k| bends(*k) <= 0.0)?;
        let [before, after] = [bends(first - 1), bends(first)];
        (before > 0.0).then(|| step * ((first - 1) as f64 + before / (before - after)))
    }

    /// The direction of the turn at these spins, a field (3N).
    pub fn along(&self, h: &Hamiltonian, m: &[f64]) -> Vec<f64> {
        turned(h, m, self.axis)
    }

    /// After a turn by an angle (rad), spins or a field (3N).
    pub fn by(&self, h: &Hamiltonian, mut v: Vec<f64>, angle: f64) -> Vec<f64> {
        if let Ok(axis) = Direction::new(self.axis) {
            rotate_sites(&mut v, moving(h), axis, angle);
        }
        v
    }
}

fn moving(h: &Hamiltonian) -> impl Iterator<Item = usize> {
    (0..h.sites()).filter(|i| !h.is_frozen(*i) && !h.lattice().vacant[*i])
}

/// axis × m of the spins that can move (3N).
fn turned(h: &Hamiltonian, m: &[f64], axis: Vector) -> Vec<f64> {
    let (m, mut field) = (Components::new(m), vec![0.0; m.len()]);
    moving(h).for_each(|i| ComponentsMut::new(&mut field).set(i, vector::cross(axis, m.get(i))));
    field
}

/// How many turns of the group about an axis there are that move no site, the identity among them.
fn fold(group: &Group, axis: Vector) -> usize {
    group.classes().iter().filter(|o| o.motion.is_none() && o.turns_about(axis)).count().max(1)
}

/// The group's shift along a direction that moves sites and nothing else, with its number.
pub(super) fn shift_along(group: &Group, direction: usize) -> Option<(usize, &Operation)> {
    let goes = |o: &Operation| o.motion.shifts_by().filter(|_| o.moves_sites_alone())?.iter().position(|by| *by != 0);
    group.shifts().iter().map(|s| &s.operation).enumerate().find(|(_, o)| goes(o) == Some(direction))
}

/// Whether a state goes on by this hop to the next place in the direction in which it came from the one before.
fn goes_on(shift: &Operation, m: &[f64], hop: &[f64]) -> bool {
    let (a, ahead) = (Components::new(m), Components::new(hop));
    let back = |i: usize| vector::dot(ahead.get(shift.source(i)), log(a.get(shift.source(i)), a.get(i)));
    (0..a.sites()).map(back).sum::<f64>() < 0.0
}

/// dm/dx (3N numbers a site) along a direction, to sixth order in the distance of two sites, to second order near an edge; 0 at it.
pub(super) fn derivative(lattice: &Lattice, m: &[f64], direction: usize) -> Vec<f64> {
    const SIXTH: [f64; 3] = [45.0, -9.0, 1.0];
    let m = Components::new(m);
    let mut d = vec![0.0; 3 * m.sites()];
    for i in 0..m.sites() {
        let beside = |k: isize| {
            let [ahead, behind] = [k, -k].map(|by| lattice.step_from(i, direction, by));
            Some(vector::sub(m.get(ahead?), m.get(behind?)))
        };
        let sum = match (beside(1), beside(2), beside(3)) {
            (Some(one), Some(two), Some(three)) => [one, two, three]
                .iter()
                .zip(SIXTH)
                .fold([0.0; 3], |sum, (v, w)| vector::add(sum, vector::scale(w / 60.0, *v))),
            (Some(one), ..) => vector::scale(0.5, one),
            _ => continue,
        };
        ComponentsMut::new(&mut d).set(i, sum);
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Chain;

    #[test]
    fn the_derivative_of_a_spiral_is_its_wave_number() {
        let n = 60;
        let k = 2.0 * PI / n as f64;
        let m: Vec<f64> = (0..3 * n)
            .map(|c| match c / n {
                0 => libm::cos(k * (c % n) as f64),
                1 => libm::sin(k * (c % n) as f64),
                _ => 0.0,
            })
            .collect();
        assert!(
            (slab::norm(&derivative(&Chain::ring(n).resolve().unwrap(), &m, 0)) - k * (n as f64).sqrt()).abs() < 1e-8
        );
    }
}
