//! Saddles that are all but alike: what a symmetry makes of one that a weak field, a little disorder or an edge breaks.
//!
//! ```text
//! E_g = E(g s) − E(s) − ½ f·H⁻¹f,   f = g⁻¹ ∂E/∂m (g s)      the height of the saddle beside g s above s, H: the Hessian at s
//! Σ_g e^(−E_g/k_BT)                                         so many saddles like s there are
//! ```
//! E_g is exact to second order in what breaks the symmetry (perturbation theory, with the Hessian of zeroth order); the number of saddles
//! goes to that of an exact symmetry as it vanishes. What the last part of E_g comes to is taken for its error.

use super::determinant::PinnedHessian;
use super::sliding::Turn;
use super::symmetry::{APART, KEPT_OR_EXCHANGED, free_shifts, largest_steps, places, shifted, slid};
use super::unstable::Unstable;
use crate::energy::{Evaluator, Hamiltonian};
use crate::linalg::slab;
use crate::sphere::rotation_of;
use crate::stationary::{Point, State};
use crate::symmetry::{Group, Operation};
use std::borrow::Cow;

/// Most operations that are tried.
const MOST: usize = 4096;

/// The exact symmetry of an energy, and that which it would have without what is weak in it.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// Of the energy and the moments.
    pub exact: Group,
    /// The same, nearly; nothing where that is no more.
    pub near: Option<Group>,
}

impl Symmetry {
    /// Of an energy, see [`Group::of`].
    pub fn of(h: &Hamiltonian, state: &[f64], alike: &[f64]) -> Symmetry {
        let (exact, near) = (Group::of(h, state, alike), Group::nearly(h, state, alike));
        let is_more = near.order() > exact.order() && (near.orders() == exact.orders() || near.order() <= MOST);
        Symmetry { exact, near: Some(near).filter(|_| is_more) }
    }

    /// The exact one alone: of what all saddles are known of.
    pub fn exactly(group: &Group) -> Symmetry {
        Symmetry { exact: group.clone(), near: None }
    }

    /// Whether shifts alone take state a to b.
    pub fn shifts(&self, a: &[f64], b: &[f64]) -> bool {
        is_shifted(&self.exact, &self.exact.classes()[0], a, b)
    }

    /// The same where states slide along a turn.
    pub fn along(&self, turn: Option<Turn>) -> Cow<'_, Symmetry> {
        let Some(Turn { axis, .. }) = turn else { return Cow::Borrowed(self) };
        let near = self.near.as_ref().map(|near| near.with_axis(axis));
        Cow::Owned(Symmetry { exact: self.exact.with_axis(axis), near })
    }
}

/// The operations, exact or nearly so, that keep the first and the last state of a path: rates are over what they make of its saddles.
#[derive(Debug)]
pub struct Kin<'a> {
    group: &'a Group,
    keep: [Vec<Operation>; 2],
    loose: [bool; 2],
}

impl<'a> Kin<'a> {
    /// Of the path between two minima, each of which may be `loose`: all places to which shifts move it are one state, and what keeps that
    /// need not keep one of them.
    pub fn of(symmetry: &'a Symmetry, ends: [&[f64]; 2], loose: [bool; 2]) -> Kin<'a> {
        let group = symmetry.near.as_ref().unwrap_or(&symmetry.exact);
        let all = if group.order() > MOST { Vec::new() } else { group.classes_within(&group.orders()).collect() };
        let keep = [0, 1].map(|k| {
            let end = ends[k];
            match loose[k] {
                true => group.classes().iter().filter(|by| is_shifted(group, by, end, end)).cloned().collect(),
                false => all.iter().filter(|by| group.takes(by, end, end, APART)).cloned().collect(),
            }
        });
        Kin { group, keep, loose }
    }

    /// Whether those that keep the first end (0) or the last (1) make this saddle of one of the path's.
    pub fn holds(&self, end: usize, saddles: &[&[f64]], m: &[f64]) -> bool {
        let makes = |by: &Operation, saddle: &[f64]| match self.loose[end] {
            true => is_shifted(self.group, by, saddle, m),
            false => self.group.takes(by, saddle, m, APART),
        };
        self.keep[end].iter().any(|by| saddles.iter().any(|saddle| makes(by, saddle)))
    }
}

/// Whether an operation, and then shifts, take state a to b.
fn is_shifted(group: &Group, by: &Operation, a: &[f64], b: &[f64]) -> bool {
    shifted(group, &by.apply(a), b, APART)
}

/// A saddle, or another state, that is all but alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sibling {
    /// Above the state itself (meV).
    pub above_mev: f64,
    /// By how much that may be off (meV).
    pub off_mev: f64,
    /// Its places: so many there are, at the same height.
    pub places: usize,
}

/// All of a state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Siblings(pub Vec<Sibling>);

impl Siblings {
    /// ln of the number of states at a k_BT (meV) of which so many are alike, and by how much that may be off.
    pub fn ln_number(&self, alike: usize, thermal_mev: f64) -> [f64; 2] {
        let (mut number, mut vague) = (alike as f64, 0.0);
        for Sibling { above_mev, off_mev, places } in &self.0 {
            let weight = *places as f64 * libm::exp(-above_mev / thermal_mev);
            number += weight;
            vague += weight * (off_mev / thermal_mev).min(1.0);
        }
        [libm::log(number), libm::log1p(vague / number)]
    }
}

/// What the operations of an exact and of a near group make of stationary states that lie between two minima.
pub struct Family<'a> {
    h: Evaluator<'a>,
    exact: &'a Group,
    near: &'a Group,
    minima: [&'a [f64]; 2],
    /// Whether they slide, each.
    slide: [bool; 2],
    /// Of those that differ by shifts alone one is enough, where all shifts are exact.
    by_class: bool,
    /// Of each shift the first multiple that is free.
    steps: Vec<usize>,
    /// By which the minima become, exactly and nearly, what they may.
    exactly: Vec<Operation>,
    nearly: Vec<Operation>,
}

impl<'a> Family<'a> {
    /// Of minima that may become these of them. Nothing where the symmetry is nearly no more than it is.
    pub fn of(
        h: Evaluator<'a>,
        symmetry: &'a Symmetry,
        minima: [&'a [f64]; 2],
        slide: [bool; 2],
        minima_become: &[[usize; 2]],
    ) -> Option<Family<'a>> {
        let exact = &symmetry.exact;
        let near = symmetry.near.as_ref().filter(|_| exact.axes().len() < 2)?;
        let (by_class, steps) = (near.orders() == exact.orders(), free_shifts(exact, minima, slide));
        let [exactly, nearly] = [(); 2].map(|()| Vec::new());
        let mut family = Family { h, exact, near, minima, slide, by_class, steps, exactly, nearly };
        family.exactly = family.operations(exact, minima_become);
        family.nearly = family.operations(near, minima_become);
        let exactly = &family.exactly;
        family.nearly.retain(|by| !exactly.iter().any(|own| own.is_same(by)));
        Some(family)
    }

    /// The operations of one of the groups by which the minima become these of them, nearly.
    fn operations(&self, group: &Group, minima_become: &[[usize; 2]]) -> Vec<Operation> {
        let off = |k: usize| APART + 0.6 * largest_steps(self.h.lattice(), self.minima[k]);
        let takes = |by: &Operation, from: usize, to: usize| match self.slide[to] {
            true => slid(self.exact, &self.steps, &by.apply(self.minima[from]), self.minima[to], off(to)),
            false => self.near.takes(by, self.minima[from], self.minima[to], APART),
        };
        let keeps = |by: &Operation| minima_become.iter().any(|[a, b]| takes(by, 0, *a) && takes(by, 1, *b));
        let until = if self.by_class { self.steps.clone() } else { group.orders() };
        group.classes_within(&until).filter(keeps).collect()
    }

    /// The states that the near group makes of one, with its descending mode and how many of its modes are soft, which may slide itself: but
    /// for those that the exact one makes of it, and of others that are `counted`, by operations that keep or exchange the minima.
    pub fn siblings(
        &self,
        (state, unstable, soft): (&State, Option<&Unstable>, usize),
        slides: bool,
        counted: &[&[f64]],
    ) -> Siblings {
        let off = if slides { APART + 0.6 * largest_steps(self.h.lattice(), &state.m) } else { APART };
        let slides = slides || self.slide.contains(&true);
        if slides && !self.by_class {
            return Siblings::default();
        }
        let is_one = |a: &[f64], b: &[f64]| match self.by_class {
            true => slid(self.exact, &self.steps, a, b, off),
            false => self.near.takes(&self.exact.classes()[0], a, b, APART),
        };
        let exact = self.exactly.iter().map(|by| by.apply(&state.m)).collect();
        let mut known = distinct(exact, Vec::new(), &is_one);
        let is_new = |image: &[f64], known: &[Vec<f64>]| !known.iter().any(|other| is_one(image, other));
        let is_more = |known: &[Vec<f64>]| self.nearly.iter().any(|by| is_new(&by.apply(&state.m), known));
        if !is_more(&known) || self.h.is_stopped() {
            return Siblings::default();
        }
        if !counted.is_empty() {
            let all = self.operations(self.exact, KEPT_OR_EXCHANGED);
            let others = all.iter().flat_map(|by| counted.iter().map(|m| by.apply(m))).collect();
            known = distinct(others, known, &is_one);
            if !is_more(&known) {
                return Siblings::default();
            }
        }
        let near = Near::of(self.h, state, unstable, soft);
        let mut tried = known.clone();
        let mut siblings = Vec::new();
        for operation in &self.nearly {
            let image = operation.apply(&state.m);
            if !is_new(&image, &tried) {
                continue;
            }
            tried.push(image.clone());
            let Some((there, mut sibling)) = near.rests(operation, image) else { continue };
            // what the symmetry makes may lie in the basin of what is known
            if is_new(&there, &known) {
                // free shifts of what slides are in the volumes
                sibling.places = if self.by_class && !slides { places(self.exact, &there, &self.steps) } else { 1 };
                siblings.push(sibling);
                known.push(there);
            }
        }
        Siblings(siblings)
    }
}

/// Known states, and those of others that are none of them, each once.
fn distinct(others: Vec<Vec<f64>>, mut known: Vec<Vec<f64>>, is_one: &dyn Fn(&[f64], &[f64]) -> bool) -> Vec<Vec<f64>> {
    for m in others {
        if !known.iter().any(|other| is_one(&m, other)) {
            known.push(m);
        }
    }
    known
}

/// A stationary state, by whose Hessian the states of rest are found beside what operations make of it.
struct Near<'a> {
    h: Evaluator<'a>,
    state: &'a State,
    unstable: Option<&'a Unstable>,
    soft: usize,
    kappa: f64,
    pinned: PinnedHessian,
}

impl<'a> Near<'a> {
    fn of(h: Evaluator<'a>, state: &'a State, unstable: Option<&'a Unstable>, soft: usize) -> Near<'a> {
        let kappa = h.stiffness_mev() / 3.0;
        let pinned = PinnedHessian::new(&state.hessian, &state.zeros, unstable, kappa);
        Near { h, state, unstable, soft, kappa, pinned }
    }

    /// The way to rest (tangent coordinates of the state) against the slope at what an operation makes of it: down across the descent, up
    /// along it; and by how much the energy falls on it (meV).
    fn way(&self, operation: &Operation, there: &Point) -> (Vec<f64>, f64) {
        let force = self.state.basis.coordinates(&operation.undone_field(&there.field(&there.slope)));
        let mut way = force.clone();
        self.pinned.solve(&mut way);
        if let Some(Unstable { eigenvalue_mev, mode }) = self.unstable {
            slab::add_scaled(&mut way, slab::dot(mode, &force) / eigenvalue_mev, mode);
        }
        let falls_mev = 0.5 * slab::dot(&way, &force);
        way.iter_mut().for_each(|x| *x = -*x);
        (way, falls_mev)
    }

    /// The state of rest beside what an operation makes of it, by one step, with its height; nothing where there is none of this kind.
    fn rests(&self, operation: &Operation, image: Vec<f64>) -> Option<(Vec<f64>, Sibling)> {
        let there = State::at(self.h, image);
        let (way, falls_mev) = self.way(operation, &there);
        let step = self.state.field(&way);
        let falling = PinnedHessian::new(&there.hessian, &there.zeros, None, self.kappa).negatives();
        let is_one = rotation_of(&step) < APART && falling <= usize::from(self.unstable.is_some()) + self.soft;
        let above_mev = there.above_mev(&self.state.point) - falls_mev;
        let sibling = Sibling { above_mev, off_mev: falls_mev.abs(), places: 1 };
        is_one.then(|| (there.moved(&self.h, &operation.apply_field(&step)), sibling))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, Exchange};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::spins::Spins;

    #[test]
    fn where_a_state_slides_what_shifts_make_of_its_saddle_leads_to_it_too() {
        const SITES: usize = 12;
        let ring = Chain::ring(SITES).resolve().unwrap();
        let easy = Anisotropy::uniform(SITES, 1.0, Direction::Z);
        let h = Hamiltonian::new(&ring, vec![Box::new(Exchange::uniform(&ring, &[1.0])), Box::new(easy)]).unwrap();
        // a spin on its side, or half-way to that, among spins up
        let at = |site: usize, x: f64| {
            let spins: Vec<[f64; 3]> =
                (0..SITES).map(|i| if i == site { [x, 0.0, 1.0 - x] } else { [0.0, 0.0, 1.0] }).collect();
            Spins::from_vectors(&spins).unwrap().as_slice().to_vec()
        };
        let (up, side, saddle) = (at(0, 0.0), at(3, 1.0), at(3, 0.5));
        let symmetry = Symmetry::of(&h, &up, &[1.0; SITES]);
        let told = |loose: bool, end: usize, site: usize| {
            Kin::of(&symmetry, [&side, &up], [loose, false]).holds(end, &[&saddle], &at(site, 0.5))
        };
        // those that keep the state up are all shifts
        assert!([3, 7].into_iter().all(|site| told(false, 1, site)));
        assert!(told(false, 0, 3) && !told(false, 0, 7));
        assert!(told(true, 0, 3) && told(true, 0, 7));
        // the state on its side is no saddle
        assert!(!Kin::of(&symmetry, [&side, &up], [true, false]).holds(0, &[&saddle], &side));
    }
}
