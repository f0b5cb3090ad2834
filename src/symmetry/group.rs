//! The group of an energy, as generators: shifts, and one operation of each class of those that differ by shifts.

use super::operation::Operation;
use super::search::{Alike, Search};
use super::shift::Shift;
use crate::energy::Hamiltonian;
use crate::geometry::Vector;

/// The operations that leave an energy as it is.
#[derive(Clone, Debug)]
pub struct Group {
    axes: Vec<Vector>,
    shifts: Vec<Shift>,
    classes: Vec<Operation>,
}

impl Group {
    /// The group of an energy. Frozen spins are those of `state` (component-major, 3N numbers). `alike`: a number a site, if more
    /// than the energy must be kept: the moments, where rates are to be the same.
    pub fn of(h: &Hamiltonian, state: &[f64], alike: &[f64]) -> Group {
        Group::found(h, state, alike, Alike::EXACTLY)
    }

    /// The operations that would leave an energy as it is if what is weak in it were not: each takes it to within a hundredth of the
    /// stiffness a site, all of them together to any. The rotations about axes are those of the energy as it is.
    pub fn nearly(h: &Hamiltonian, state: &[f64], alike: &[f64]) -> Group {
        Group::found(h, state, alike, Alike::NEARLY)
    }

    fn found(h: &Hamiltonian, state: &[f64], alike: &[f64], within: Alike) -> Group {
        let mut search = Search::new(h, state, alike, within);
        let turns = search.turns_of_spins();
        let shifts = search.shifts();
        let motions = search.motions(&shifts);
        let classes = motions.iter().flat_map(|m| turns.iter().map(move |turn| m.after(turn))).collect();
        Group { axes: search.into_axes(), shifts, classes }
    }

    /// The same operations, those aside that differ by a rotation about an axis along which states slide.
    pub fn with_axis(&self, axis: Vector) -> Group {
        Group { axes: vec![axis], ..self.clone() }
    }

    /// Unit vectors about which any rotation of all spins together is an operation too: none, one, or x, y and z. Such a rotation
    /// before or after another operation makes none of its own here.
    pub fn axes(&self) -> &[Vector] {
        &self.axes
    }

    /// The shortest shifts, one a direction that has any. Every product of them is an operation.
    pub fn shifts(&self) -> &[Shift] {
        &self.shifts
    }

    /// One operation of each class of those that differ by no more than shifts; the identity is the first.
    pub fn classes(&self) -> &[Operation] {
        &self.classes
    }

    /// How many operations there are, with the identity.
    pub fn order(&self) -> usize {
        self.classes.len() * self.shifts.iter().map(|s| s.order).product::<usize>()
    }

    /// All operations but the identity, in a fixed order: the classes, then each before the first shift, and so on.
    pub fn operations(&self) -> impl Iterator<Item = Operation> + '_ {
        self.classes_within(&self.orders()).skip(1)
    }

    /// The operations of all classes, each before the products of less than so many of each shift; the identity is the first.
    pub fn classes_within<'a>(&'a self, until: &[usize]) -> impl Iterator<Item = Operation> + use<'a> {
        let shifts = self.products(&vec![1; self.shifts.len()], until);
        shifts.flat_map(|shift| self.classes.iter().map(move |class| shift.after(class)))
    }

    /// The group that multiples of each shift make.
    pub fn multiples<'a>(&'a self, of: &[usize]) -> impl Iterator<Item = Operation> + use<'a> {
        self.products(of, &self.orders())
    }

    /// Products of shifts, of each no times or a multiple of `steps` less than `until`; the identity is the first.
    pub fn products<'a>(&'a self, steps: &[usize], until: &[usize]) -> impl Iterator<Item = Operation> + use<'a> {
        let counts = until.iter().zip(steps).map(|(until, step)| until.div_ceil(*step));
        let multiples = |((shift, step), count): ((&'a Shift, &usize), usize)| -> Vec<Operation> {
            (0..count).map(|k| shift.times(k * step)).collect()
        };
        let all: Vec<Vec<Operation>> = self.shifts.iter().zip(steps).zip(counts).map(multiples).collect();
        (0..all.iter().map(Vec::len).product()).map(move |mut k: usize| {
            all.iter().fold(self.classes[0].clone(), |before, multiples| {
                let times = k % multiples.len();
                k /= multiples.len();
                multiples[times].after(&before)
            })
        })
    }

    /// After how many times each shift leaves all spins as they are and moves them at most to other sites: a translation. Its order
    /// where none is one.
    pub fn until_translations(&self) -> Vec<usize> {
        let is_plain = |s: &Shift, k: usize| s.order.is_multiple_of(k) && s.times(k).moves_sites_alone();
        self.shifts.iter().map(|s| (1..s.order).find(|k| is_plain(s, *k)).unwrap_or(s.order)).collect()
    }

    /// After how many times each shift takes every site to where it was.
    pub fn orders(&self) -> Vec<usize> {
        self.shifts.iter().map(|s| s.order).collect()
    }
}
