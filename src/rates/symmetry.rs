//! Saddles that symmetry makes of one: each is a way out of its own.
//!
//! An operation of the group counts where it keeps both minima and moves the saddle, rotations about a symmetry axis (and shifts,
//! where they are zero modes) apart: those are in the volume of zero modes.

use crate::field::Components;
use crate::geometry::vector;
use crate::lattice::Lattice;
use crate::sphere::SAME;
use crate::symmetry::{Group, Operation};

/// How many saddles are alike, and by what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Equivalents {
    /// Their number, at least 1.
    pub count: usize,
    /// The symmetry that was found.
    pub by: String,
}

/// The saddles (or other states) that the group makes of this one, beside the same two minima. `shifts_are_free`: shifts of the
/// ring are a zero mode.
///
/// S: the shifts that keep both minima. Every operation that keeps them is one of S after one that is no further shifted than the
/// shortest of S; so the states alike are those that S makes of the latter's images.
pub fn equivalent_saddles(
    lattice: &Lattice,
    group: &Group,
    saddle: &[f64],
    minima: [&[f64]; 2],
    shifts_are_free: bool,
) -> Equivalents {
    if group.axes().len() > 1 {
        return Equivalents { count: 1, by: "not sought: the energy has no axis".into() };
    }
    let once = vec![1; group.shifts().len()];
    let shortest = group.periods(&minima, &once, SAME);
    let off = if shifts_are_free { SAME + 0.6 * largest_step(lattice, saddle) } else { SAME };
    let mut by = Vec::new();
    let mut kept: Vec<Vec<f64>> = vec![saddle.to_vec()];
    for operation in group.classes_within(&shortest).skip(1) {
        if minima.iter().any(|m| !group.takes(&operation, m, m, SAME)) {
            continue;
        }
        let image = operation.apply(saddle);
        let onto = |state: &Vec<f64>, shift: &Operation| group.takes(shift, &image, state, off);
        let known = |state: &Vec<f64>| group.multiples(&shortest).any(|shift| onto(state, &shift));
        if !kept.iter().any(known) {
            by.push(operation.to_string());
            kept.push(image);
        }
    }
    let places = |m: &[f64]| if shifts_are_free { 1 } else { places(group, m, &shortest) };
    if places(saddle) > 1 {
        by.push(format!("{} shifts of the ring", places(saddle)));
    }
    let count = kept.iter().map(|m| places(m)).sum();
    let by = if by.is_empty() { "none found".into() } else { by.join(", ") };
    Equivalents { count, by }
}

/// How many states multiples of these shifts make of one.
fn places(group: &Group, m: &[f64], shortest: &[usize]) -> usize {
    let periods = group.periods(&[m], shortest, SAME);
    let whole: usize = periods.iter().zip(shortest).map(|(p, s)| p / s).product();
    let keeping = group.products(shortest, &periods).filter(|shift| group.takes(shift, m, m, SAME));
    whole / keeping.count()
}

/// After how many sites a ring's state repeats; nothing where a shift by one does not leave the energy as it is.
pub(super) fn period(group: &Group, m: &[f64]) -> Option<usize> {
    let steps = |o: &Operation| o.motion.shifts_by() == Some([1, 0, 0]) && o.moves_sites_alone();
    let first = group.shifts().first().filter(|s| steps(&s.operation));
    first.map(|_| group.periods(&[m], &vec![1; group.shifts().len()], SAME)[0])
}

/// How much neighbours of a ring differ at most (rad): a state that slides freely may stand half a site beside its image.
fn largest_step(ring: &Lattice, m: &[f64]) -> f64 {
    let c = Components::new(m);
    let n = c.sites();
    (0..n).map(|i| vector::norm(vector::sub(c.get(ring.along_ring(i, 1)), c.get(i)))).fold(0.0, f64::max)
}
