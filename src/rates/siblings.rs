//! Saddles that are all but alike: what a symmetry makes of one that a weak field, a little disorder or an edge breaks.
//!
//! ```text
//! E_g = E(g s) − E(s) − ½ f·H⁻¹f,   f = g⁻¹ ∂E/∂m (g s)      the height of the saddle beside g s above s, H: the Hessian at s
//! Σ_g e^(−E_g/k_BT)                                         so many saddles like s there are
//! ```
//! E_g is exact to second order in what breaks the symmetry (perturbation theory, with the Hessian of zeroth order); the number of saddles
//! goes to that of an exact symmetry as it vanishes. What the last part of E_g comes to is taken for its error.

use super::determinant::PinnedHessian;
use super::symmetry::{KEPT_OR_EXCHANGED, free_shifts, largest_steps, places, slid};
use super::unstable::Unstable;
use crate::energy::{Evaluator, Hamiltonian};
use crate::linalg::slab;
use crate::sphere::rotation_of;
use crate::stationary::State;
use crate::symmetry::{Group, Operation};

/// Spins of a state differ from those of another by more somewhere (rad); what differs by less is the same, changed by what is weak.
pub const APART: f64 = 0.3;
/// Most operations that are tried.
const MOST: usize = 4096;

/// The exact symmetry of an energy, and that which it would have without what is weak in it.
#[derive(Debug)]
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
}

/// The operations, exact or nearly so, that keep the first and the last state of a path: rates are over what they make of its saddles.
#[derive(Debug)]
pub struct Kin {
    near: Group,
    keep: [Vec<Operation>; 2],
}

impl Kin {
    /// Of the path between two minima.
    pub fn of(h: &Hamiltonian, ends: [&[f64]; 2], alike: &[f64]) -> Kin {
        let near = Group::nearly(h, ends[0], alike);
        let all = if near.order() > MOST { Vec::new() } else { near.classes_within(&near.orders()).collect() };
        let keep = ends.map(|end| all.iter().filter(|by| near.takes(by, end, end, APART)).cloned().collect());
        Kin { near, keep }
    }

    /// Whether those that keep the first end (0) or the last (1) make this saddle of one of the path's.
    pub fn holds(&self, end: usize, saddles: &[&[f64]], m: &[f64]) -> bool {
        self.keep[end].iter().any(|by| saddles.iter().any(|saddle| self.near.takes(by, saddle, m, APART)))
    }
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

/// The states that operations which nearly are of the group make of a stationary one, with its descending mode: those by which two minima
/// nearly become these of them, but for those that the group itself makes of it, and of others that are `counted`, by operations that keep
/// or exchange the minima. So many of its modes are `soft`. `sliding` as in
/// [`equivalent_saddles`](super::equivalent_saddles).
pub fn siblings(
    h: Evaluator,
    [exact, near]: [&Group; 2],
    (state, unstable, soft): (&State, Option<&Unstable>, usize),
    minima: [&[f64]; 2],
    sliding: [bool; 3],
    minima_become: &[[usize; 2]],
    counted: &[&[f64]],
) -> Siblings {
    // of those that differ by shifts alone one is enough, where all shifts are exact
    let (slides, by_class) = (sliding.contains(&true), near.orders() == exact.orders());
    if exact.axes().len() > 1 || slides && !by_class {
        return Siblings::default();
    }
    let steps = free_shifts(exact, minima, [sliding[1], sliding[2]]);
    let off = |m: &[f64], own: bool| if own { APART + 0.6 * largest_steps(h.lattice(), m) } else { APART };
    let within = [off(&state.m, sliding[0]), off(minima[0], sliding[1]), off(minima[1], sliding[2])];
    let keeps = |operation: &Operation, become_these: &[[usize; 2]]| {
        become_these.iter().any(|images| {
            (0..2).all(|from| {
                let to = images[from];
                match sliding[to + 1] {
                    true => slid(exact, &steps, &operation.apply(minima[from]), minima[to], within[to + 1]),
                    false => near.takes(operation, minima[from], minima[to], APART),
                }
            })
        })
    };
    let operations = |group: &Group, become_these: &[[usize; 2]]| -> Vec<Operation> {
        let until = if by_class { steps.clone() } else { group.orders() };
        group.classes_within(&until).filter(|operation| keeps(operation, become_these)).collect()
    };
    let is_one = |a: &[f64], b: &[f64]| match by_class {
        true => slid(exact, &steps, a, b, within[0]),
        false => near.takes(&exact.classes()[0], a, b, APART),
    };
    let mut kept: Vec<Vec<f64>> = Vec::new();
    let own = operations(exact, minima_become).into_iter().map(|by| by.apply(&state.m));
    let others = if counted.is_empty() { Vec::new() } else { operations(exact, KEPT_OR_EXCHANGED) };
    let others = others.iter().flat_map(|by| counted.iter().map(|m| by.apply(m)));
    for image in own.chain(others) {
        if !kept.iter().any(|known| is_one(&image, known)) {
            kept.push(image);
        }
    }
    let mut new: Vec<(Operation, Vec<f64>)> = Vec::new();
    for operation in operations(near, minima_become) {
        let image = operation.apply(&state.m);
        if !kept.iter().any(|known| is_one(&image, known)) {
            kept.push(image.clone());
            new.push((operation, image));
        }
    }
    if new.is_empty() || h.is_stopped() {
        return Siblings::default();
    }
    let kappa = h.stiffness_mev() / 3.0;
    let pinned = PinnedHessian::new(&state.hessian, &state.zeros, unstable, kappa);
    let sibling = |(operation, image): (Operation, Vec<f64>)| {
        let there = State::at(h, image);
        let force = state.basis.coordinates(&operation.undone_field(&there.field(&there.slope)));
        // down across the descent, up along it
        let mut way = force.clone();
        pinned.solve(&mut way);
        if let Some(Unstable { eigenvalue_mev, mode }) = unstable {
            slab::add_scaled(&mut way, slab::dot(mode, &force) / eigenvalue_mev, mode);
        }
        let falls_mev = 0.5 * slab::dot(&way, &force);
        let falling = PinnedHessian::new(&there.hessian, &there.zeros, None, kappa).negatives();
        let is_one = rotation_of(&state.field(&way)) < APART && falling <= usize::from(unstable.is_some()) + soft;
        let above_mev = there.above_mev(&state.point) - falls_mev;
        // free shifts of what slides are in the volumes
        let places = if by_class && !slides { places(exact, &there.m, &steps) } else { 1 };
        is_one.then_some(Sibling { above_mev, off_mev: falls_mev.abs(), places })
    };
    Siblings(new.into_iter().filter_map(sibling).collect())
}
