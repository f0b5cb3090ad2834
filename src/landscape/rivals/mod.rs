//! Where a saddle below the top of the best route may be looked for. One file a rival.

mod alike;
mod firsts;
mod melt;
mod modes;
mod near;
mod one_by_one;
mod push;

use super::Landscape;
use crate::lattice::Lattice;
use crate::path::guess::GuessContext;
use rand_chacha::ChaCha8Rng;
use std::fmt::Debug;

/// Those that look for a route, in the order of their turns. In a film a texture moves in ways that no block of its sites does: there
/// modes are followed too. In a row blocks reach what modes do.
pub(super) fn rivals(lattice: &Lattice) -> Vec<Box<dyn Rival>> {
    let mut rivals: Vec<Box<dyn Rival>> = vec![Box::<near::Near>::default(), Box::<push::Push>::default()];
    if !lattice.is_row() {
        rivals.push(Box::<modes::Modes>::default());
    }
    rivals
}

/// Those that look for all there is.
pub(super) fn scouts() -> Vec<Box<dyn Rival>> {
    vec![Box::<near::Near>::default(), Box::<push::Push>::default(), Box::<melt::Melt>::default()]
}

/// Those that go before them, through all that they have; that one of their starts brings no news says little.
pub(super) fn vanguard(all: bool) -> Vec<Box<dyn Rival>> {
    let alike: Box<dyn Rival> = Box::<alike::Alike>::default();
    match all {
        true => vec![Box::<modes::Modes>::default(), alike],
        false => vec![Box::<one_by_one::OneByOne>::default(), Box::<firsts::Firsts>::default(), alike],
    }
}

/// Names states from which climbs may lead to passes below the top.
pub trait Rival: Debug {
    /// The next one (3N); nothing if there is none to try.
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>>;
}

/// The landscape as the height T cuts it.
#[derive(Debug)]
pub struct Cut<'l> {
    /// All that is known.
    pub land: &'l Landscape<'l>,
    /// The two minima that are to be joined; none where all are.
    pub ends: Option<[usize; 2]>,
    /// Where T is, less what passes must be lower by (meV above the landscape's reference).
    pub top_mev: f64,
    /// For each minimum the number that those joined with it below T share.
    pub part: Vec<usize>,
    /// What first paths need to know.
    pub context: GuessContext<'l>,
}

impl<'l> Cut<'l> {
    /// At a height.
    pub fn of(land: &'l Landscape<'l>, ends: Option<[usize; 2]>, top_mev: f64, context: GuessContext<'l>) -> Cut<'l> {
        let ends = ends.map(|ends| ends.map(|k| land.standing_for(k)));
        Cut { land, ends, top_mev, part: land.parts_below(top_mev), context }
    }

    /// Whether a minimum is joined with one of the two ends below T; where all are looked for, every one is as good as an end.
    pub fn is_near_an_end(&self, minimum: usize) -> bool {
        self.ends.is_none_or(|ends| ends.iter().any(|end| self.part[*end] == self.part[minimum]))
    }

    /// The minima below T.
    pub fn below(&self) -> impl Iterator<Item = usize> {
        let is_end = |k: usize| self.ends.is_some_and(|ends| ends.contains(&k));
        (0..self.part.len()).filter(move |k| {
            self.land.standing_for(*k) == *k && (self.land.heights_mev()[*k] < self.top_mev || is_end(*k))
        })
    }

    /// Those to start from: where all are looked for, one of each kind that symmetry makes the same.
    pub fn starts(&self) -> impl Iterator<Item = usize> {
        self.below().filter(|k| self.ends.is_some() || self.land.orbit(*k) == *k)
    }
}
