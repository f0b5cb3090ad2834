//! One state for all its places: where symmetry makes too many states to list each, those that a shift of the sites makes of one
//! are that one.
//!
//! A shift that moves the spins and leaves them as they are, a translation, keeps energy, mean spin and charge; of a network of
//! states it makes itself. So the states that translations make of one form a network of their own, with the same times: a state at
//! n_a places with saddles at n_s leads over n_s/n_a of them.

use super::is_same_state;
use crate::energy::Evaluator;
use crate::field::Components;
use crate::geometry::vector;
use crate::sphere::SAME;
use crate::symmetry::{Group, Operation};

/// Translations of which no state is told.
#[derive(Clone, Debug, Default)]
pub struct Places(Vec<Operation>);

impl Places {
    /// Of a group: those that multiples of each of its shifts make.
    pub fn of(group: &Group, multiples: &[usize]) -> Places {
        Places(group.multiples(multiples).skip(1).collect())
    }

    /// Whether one of them makes `b` of `a`, perhaps with a rotation about the symmetry axes.
    pub fn join(&self, h: Evaluator, a: &[f64], b: &[f64]) -> bool {
        !self.0.is_empty() && {
            let seen = Seen::of(h, b);
            self.0.iter().any(|by| seen.is_made(by, a))
        }
    }

    /// The places of `a`, its own first, of which every spin may be less than `off` (rad) beside that of `b`.
    pub fn beside<'p>(
        &'p self,
        h: Evaluator<'p>,
        a: &'p [f64],
        b: &'p [f64],
        off: f64,
    ) -> impl Iterator<Item = Vec<f64>> + 'p {
        let seen = Seen::of(h, b);
        let all = std::iter::once(None).chain(self.0.iter().map(Some));
        let near = all.filter(move |by| seen.may_be_within(*by, a, off));
        near.map(|by| by.map_or_else(|| a.to_vec(), |by| by.apply(a)))
    }

    /// At how many places a state may be.
    pub fn count(&self, h: Evaluator, m: &[f64]) -> usize {
        let seen = Seen::of(h, m);
        let keeps = self.0.iter().filter(|by| seen.is_made(by, m)).count();
        (1 + self.0.len()) / (1 + keeps)
    }
}

/// A state, looked at first where it is least like the rest.
pub struct Seen<'a> {
    h: Evaluator<'a>,
    m: &'a [f64],
    first: usize,
}

impl<'a> Seen<'a> {
    /// This state (3N).
    pub fn of(h: Evaluator<'a>, m: &'a [f64]) -> Seen<'a> {
        let spins = Components::new(m);
        let sum = (0..spins.sites()).fold([0.0; 3], |sum, i| vector::add(sum, spins.get(i)));
        let odd = |i: &usize| vector::dot(spins.get(*i), sum);
        let first = (0..spins.sites()).min_by(|i, j| odd(i).total_cmp(&odd(j))).unwrap_or(0);
        Seen { h, m, first }
    }

    /// Whether an operation makes it of another state, perhaps with a rotation about the symmetry axes.
    pub fn is_made(&self, by: &Operation, of: &[f64]) -> bool {
        self.may_be(Some(by), of) && is_same_state(self.h, &by.apply(of), self.m)
    }

    /// Whether an operation, or none, may make it of another state: what no rotation about the symmetry axes changes is compared.
    pub fn may_be(&self, by: Option<&Operation>, of: &[f64]) -> bool {
        self.may_be_within(by, of, SAME)
    }

    /// The same, each spin to less than `far` (rad) beside it.
    fn may_be_within(&self, by: Option<&Operation>, of: &[f64], far: f64) -> bool {
        let [own, from] = [self.m, of].map(Components::new);
        let sites = own.sites();
        let off = |i: usize| vector::sub(by.map_or_else(|| from.get(i), |by| by.at(from, i)), own.get(i));
        let is_off = |i: usize| match self.h.symmetry_axes() {
            [] => vector::norm(off(i)) > far,
            [axis] => vector::dot(*axis, off(i)).abs() > far,
            _ => false,
        };
        !(0..sites).map(|k| (self.first + k) % sites).any(is_off)
    }
}
