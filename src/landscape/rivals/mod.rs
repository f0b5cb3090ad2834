//! Where a saddle below the top of the best route may be looked for. One file a rival.

mod near;
mod push;
mod walls;

use super::Landscape;
use crate::path::guess::GuessContext;
use rand_chacha::ChaCha8Rng;
use std::fmt::Debug;

/// All rivals, in the order of their turns.
pub(super) fn rivals() -> Vec<Box<dyn Rival>> {
    vec![Box::<walls::Walls>::default(), Box::<near::Near>::default(), Box::<push::Push>::default()]
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
    /// The two minima that are to be joined.
    pub ends: [usize; 2],
    /// Where T is, less what passes must be lower by (meV above the landscape's reference).
    pub top_mev: f64,
    /// For each minimum the number that those joined with it below T share.
    pub part: Vec<usize>,
    /// What first paths need to know.
    pub context: GuessContext<'l>,
}

impl<'l> Cut<'l> {
    /// At a height.
    pub fn of(land: &'l Landscape<'l>, ends: [usize; 2], top_mev: f64, context: GuessContext<'l>) -> Cut<'l> {
        let ends = ends.map(|k| land.standing_for(k));
        Cut { land, ends, top_mev, part: land.parts_below(top_mev), context }
    }

    /// The highest saddle of the route (3N), if there is one.
    pub fn highest_saddle(&self) -> Option<&'l [f64]> {
        let route = self.land.route(self.ends[0], self.ends[1])?;
        let edges = route.steps.iter().map(|(k, _)| &self.land.edges()[*k]);
        edges.max_by(|p, q| p.height_mev.total_cmp(&q.height_mev)).map(|edge| &edge.saddle[..])
    }

    /// Whether a minimum is joined with one of the two ends below T.
    pub fn is_near_an_end(&self, minimum: usize) -> bool {
        self.ends.iter().any(|end| self.part[*end] == self.part[minimum])
    }

    /// The minima below T.
    pub fn below(&self) -> impl Iterator<Item = usize> {
        (0..self.part.len()).filter(|k| {
            self.land.standing_for(*k) == *k && (self.land.heights_mev()[*k] < self.top_mev || self.ends.contains(k))
        })
    }
}
