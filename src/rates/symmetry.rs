//! Saddles that symmetry makes of one: each is a way out of its own.
//!
//! An operation of the group counts where it keeps both minima, or makes each the other, and moves the saddle, rotations about a symmetry
//! axis (and shifts of states that slide) apart: those are in the volume of zero modes.

use crate::field::Components;
use crate::geometry::vector;
use crate::lattice::Lattice;
use crate::linalg::slab;
use crate::path::largest_angle;
use crate::sphere::{SAME, write_logs};
use crate::symmetry::{Group, Operation};

/// Spins of a state differ from those of another by more somewhere (rad); what differs by less is the same, changed by what is weak.
pub const APART: f64 = 0.3;

/// What of a square lies along a way that leads there.
const ALONG: f64 = 0.75;

/// How many saddles are alike, and by what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Equivalents {
    /// Their number, at least 1.
    pub count: usize,
    /// The symmetry that was found.
    pub by: String,
}

/// What two minima become by the operations that count: themselves.
pub const KEPT: &[[usize; 2]] = &[[0, 1]];

/// Themselves, or each the other.
pub const KEPT_OR_EXCHANGED: &[[usize; 2]] = &[[0, 1], [1, 0]];

/// What is one state with all its places.
#[derive(Clone, Copy, Debug)]
pub struct OneState<'a> {
    /// Whether the saddle and each of the minima slide over the lattice, so that what free shifts make of them is one.
    pub slide: [bool; 3],
    /// Whether all places of each minimum are one, as are those of one that slides.
    pub minima: [bool; 2],
    /// Orthonormal fields (3N) along which alone the saddle slides; none where it does along all that move it.
    pub along: &'a [Vec<f64>],
}

impl OneState<'_> {
    /// Of a saddle that slides, or not, between minima that do.
    pub fn of(saddle: bool, minima: [bool; 2]) -> OneState<'static> {
        OneState { slide: [saddle, minima[0], minima[1]], minima, along: &[] }
    }
}

/// The saddles (or other states) that operations of the group make of this one by which the minima become these of them.
///
/// S: the shifts that keep both minima. Every operation that keeps or exchanges them is one of S after one that is no further shifted than
/// the shortest of S; so the states alike are those that S makes of the latter's images.
pub fn equivalent_saddles(
    lattice: &Lattice,
    group: &Group,
    saddle: &[f64],
    minima: [&[f64]; 2],
    one: OneState,
    minima_become: &[[usize; 2]],
) -> Equivalents {
    if group.axes().len() > 1 {
        return Equivalents { count: 1, by: "not sought: the energy has no axis".into() };
    }
    let OneState { slide: sliding, minima: one, along } = one;
    let steps = free_shifts(group, minima, one);
    let off = |m: &[f64], slides: bool| if slides { SAME + 0.6 * largest_steps(lattice, m) } else { SAME };
    let within = [off(saddle, sliding[0]), off(minima[0], sliding[1]), off(minima[1], sliding[2])];
    let (mut by, mut kept) = (Vec::new(), vec![(saddle.to_vec(), along.to_vec())]);
    let operations = || group.classes_within(&steps).skip(1);
    // those that keep both first: they are told of
    for ([a, b], operation) in
        minima_become.iter().flat_map(|ends| operations().map(move |operation| (ends, operation)))
    {
        let takes = |from: usize, to: usize| match one[to] {
            true => slid(group, &steps, &operation.apply(minima[from]), minima[to], within[to + 1]),
            false => group.takes(&operation, minima[from], minima[to], SAME),
        };
        if !(takes(0, *a) && takes(1, *b)) {
            continue;
        }
        let image = operation.apply(saddle);
        if !kept.iter().any(|(state, along)| slid_along(group, &steps, &image, state, along, within[0])) {
            by.push(operation.to_string());
            kept.push((image, along.iter().map(|v| operation.apply_field(v)).collect()));
        }
    }
    // free shifts are in the volumes
    let each = |m: &[f64]| if sliding.contains(&true) { 1 } else { places(group, m, &steps) };
    if each(saddle) > 1 {
        by.push(format!("{} shifts of the {}", each(saddle), if lattice.is_row() { "ring" } else { "lattice" }));
    }
    let count = kept.iter().map(|(m, _)| each(m)).sum();
    let by = if by.is_empty() { "none found".into() } else { by.join(", ") };
    Equivalents { count, by }
}

/// Whether operations that make each of two minima the other make of this state one that none of those that keep both makes of `last`:
/// of the first state on a path between the minima, and of the last, each spin to less than `off` (rad). Of states that do not slide.
pub fn leads_back_by(group: &Group, [first, last]: [&[f64]; 2], minima: [&[f64]; 2], off: f64) -> bool {
    if group.axes().len() > 1 {
        return false;
    }
    let steps = free_shifts(group, minima, [false; 2]);
    let takes = |operation: &Operation, from: usize, to: usize| group.takes(operation, minima[from], minima[to], off);
    // all others are this one after one that keeps both
    let Some(back) = group.classes_within(&steps).find(|by| takes(by, 0, 1) && takes(by, 1, 0)) else {
        return false;
    };
    let image = back.apply(first);
    !group.classes_within(&steps).any(|by| {
        let keeps = takes(&by, 0, 0) && takes(&by, 1, 1);
        keeps && slid(group, &steps, &by.apply(last), &image, off)
    })
}

/// Of each shift the first multiple that keeps those of the minima that do not slide.
pub(super) fn free_shifts(group: &Group, minima: [&[f64]; 2], slide: [bool; 2]) -> Vec<usize> {
    let held: Vec<&[f64]> = minima.into_iter().zip(slide).filter(|(_, slides)| !slides).map(|(m, _)| m).collect();
    group.periods(&held, &vec![1; group.shifts().len()], SAME)
}

/// How many of the states that the group makes of one are places of one that slides: those that multiples of free shifts make, and
/// those between them, along these fields if there are any.
pub(super) fn states_on_the_way(
    lattice: &Lattice,
    group: &Group,
    m: &[f64],
    along: &[Vec<f64>],
    steps: &[usize],
) -> usize {
    let off = SAME + 0.6 * largest_steps(lattice, m);
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for image in group.classes_within(steps).map(|operation| operation.apply(m)) {
        let known = kept.iter().any(|state| slid(group, steps, &image, state, SAME));
        if !known && slid_along(group, steps, &image, m, along, off) {
            kept.push(image);
        }
    }
    kept.len() * places(group, m, steps)
}

/// How many of the states that the group makes of one are one with it where it turns about the axis of `along`: 1 where that is no
/// other than the group's own.
pub(super) fn states_along_turn(group: &Group, along: &Group, m: &[f64]) -> usize {
    if group.axes() == along.axes() {
        return 1;
    }
    let turned = group.classes().iter().filter(|operation| along.takes(operation, m, m, SAME));
    let mut kept: Vec<Vec<f64>> = Vec::new();
    for operation in turned {
        if !kept.iter().any(|state| group.takes(operation, m, state, SAME)) {
            kept.push(operation.apply(m));
        }
    }
    kept.len()
}

/// Whether a multiple of shifts takes state a to b: each spin to less than `off` beside it.
pub(super) fn slid(group: &Group, steps: &[usize], a: &[f64], b: &[f64], off: f64) -> bool {
    group.multiples(steps).any(|shift| group.takes(&shift, a, b, off))
}

/// Whether shifts bring state a so near to b that a may slide there: no farther than half-way to the places next to b, each spin to less
/// than [`APART`] beside that.
pub fn may_slide_to(group: &Group, a: &[f64], b: &[f64]) -> bool {
    let hops: f64 = group.shifts().iter().map(|shift| largest_angle(&shift.operation.apply(b), b)).sum();
    shifted(group, a, b, APART + 0.5 * hops)
}

/// Whether shifts, any of them, bring state a to b, each spin to less than `off` (rad).
pub(super) fn shifted(group: &Group, a: &[f64], b: &[f64], off: f64) -> bool {
    slid(group, &vec![1; group.shifts().len()], a, b, off)
}

/// Likewise, and what is left between b and the shifted a lies along orthonormal fields (3N) at b, if there are any: a state that slides along
/// one way is not what lies beside that.
fn slid_along(group: &Group, steps: &[usize], a: &[f64], b: &[f64], along: &[Vec<f64>], off: f64) -> bool {
    if along.is_empty() || !group.axes().is_empty() {
        return slid(group, steps, a, b, off);
    }
    group.multiples(steps).any(|shift| {
        group.takes(&shift, a, b, off) && {
            let mut rest = vec![0.0; b.len()];
            write_logs(Components::new(b), Components::new(&shift.apply(a)), &mut rest);
            let part: f64 = along.iter().map(|v| slab::dot(v, &rest).powi(2)).sum();
            let whole = slab::dot(&rest, &rest);
            whole < SAME * SAME || part > ALONG * whole
        }
    })
}

/// How many states multiples of these shifts make of one.
pub(super) fn places(group: &Group, m: &[f64], shortest: &[usize]) -> usize {
    let periods = group.periods(&[m], shortest, SAME);
    let whole: usize = periods.iter().zip(shortest).map(|(p, s)| p / s).product();
    let keeping = group.products(shortest, &periods).filter(|shift| group.takes(shift, m, m, SAME));
    whole / keeping.count()
}

/// How much like sites of neighbouring cells differ at most (rad), over all directions: a state that slides freely may stand half a
/// cell beside its image.
pub(super) fn largest_steps(lattice: &Lattice, m: &[f64]) -> f64 {
    let c = Components::new(m);
    let step =
        |d: usize, i: usize| lattice.step_from(i, d, 1).map_or(0.0, |j| vector::norm(vector::sub(c.get(j), c.get(i))));
    (0..3).map(|d| (0..c.sites()).map(|i| step(d, i)).fold(0.0, f64::max)).sum()
}
