//! Which pair of minima to join next: the graph of squared distances, in which joined pairs are no distance apart.
//!
//! The shortest way through it from one end to the other leads in short steps over what is known; its first step that no pass
//! joins yet is the pair. (As J. M. Carr, S. A. Trygubenko, D. J. Wales, J. Chem. Phys. 122, 234903 (2005),
//! doi:10.1063/1.1931587.)

use super::{Landscape, turned, turns};
use crate::path::distance;
use std::collections::BTreeMap;

/// A pair that was tried k times counts as (1 + k)⁴ times as far.
const TIRED: i32 = 4;

/// What is known of pairs of minima.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    /// Squares of distances (rad²).
    apart: BTreeMap<[usize; 2], f64>,
    /// How often each was tried, it or an image of it by symmetry: the orbits of the two, and the square of their distance.
    tried: BTreeMap<([usize; 2], i64), usize>,
}

/// Squares of distances (rad²) that differ by less are equal.
const EQUAL: f64 = 1e-5;

/// The square of a distance that counts a pair as further apart with every try.
pub(super) fn tired(squared: f64, tries: usize) -> f64 {
    squared * ((1 + tries) as f64).powi(TIRED)
}

impl Landscape<'_> {
    /// The square of the distance of two minima, turned about the symmetry axes to be near each other (rad²).
    pub(super) fn squared_distance(&self, [a, b]: [usize; 2]) -> f64 {
        let [a, b] = [a.min(b), a.max(b)].map(|k| &self.minima()[k].spins);
        let b = turned(b, &turns(self.evaluator(), b, a));
        distance(a.as_slice(), b.as_slice()).powi(2)
    }

    /// How often a pair was tried; one time more from now on.
    pub(super) fn try_once_more(&mut self, pair: [usize; 2]) -> usize {
        let key = self.alike(pair, self.squared_distance(pair));
        let tried = self.pairs.tried.entry(key).or_default();
        *tried += 1;
        *tried - 1
    }

    /// What pairs share that are images of each other by symmetry.
    fn alike(&self, pair: [usize; 2], squared: f64) -> ([usize; 2], i64) {
        let [a, b] = pair.map(|k| self.orbit(k));
        ([a.min(b), a.max(b)], (squared / EQUAL).round() as i64)
    }

    /// The pair to try next on the way from one minimum to another over passes below a height (meV); none if all that lead on were
    /// tried so many times.
    pub fn next_pair(&mut self, [from, to]: [usize; 2], below_mev: f64, tries: usize) -> Option<[usize; 2]> {
        let [from, to] = [from, to].map(|k| self.standing_for(k));
        let part = self.parts_below(below_mev);
        let is_node = |k: usize| self.standing_for(k) == k && (self.heights_mev()[k] < below_mev || k == to);
        let nodes: Vec<usize> = (0..part.len()).filter(|k| is_node(*k)).collect();
        let mut pairs = std::mem::take(&mut self.pairs);
        // the shortest way to each minimum so far, and where its last step comes from
        let mut reached: BTreeMap<usize, (f64, usize)> = BTreeMap::from([(from, (0.0, from))]);
        let mut done: BTreeMap<usize, usize> = BTreeMap::new();
        while !done.contains_key(&to) {
            let open = reached.iter().filter(|(k, _)| !done.contains_key(*k));
            let Some((&here, &(far, before))) = open.min_by(|p, q| p.1.0.total_cmp(&q.1.0)) else { break };
            done.insert(here, before);
            for &there in nodes.iter().filter(|k| !done.contains_key(*k)) {
                let pair = [here.min(there), here.max(there)];
                let mut step = 0.0;
                if part[here] != part[there] {
                    let squared = *pairs.apart.entry(pair).or_insert_with(|| self.squared_distance(pair));
                    let tried = pairs.tried.get(&self.alike(pair, squared)).copied().unwrap_or(0);
                    if tried >= tries {
                        continue;
                    }
                    step = tired(squared, tried);
                }
                if reached.get(&there).is_none_or(|(least, _)| far + step < *least) {
                    reached.insert(there, (far + step, here));
                }
            }
        }
        self.pairs = pairs;
        let mut pair = None;
        let mut here = to;
        while here != from {
            let before = *done.get(&here)?;
            if part[before] != part[here] {
                pair = Some([before, here]);
            }
            here = before;
        }
        pair
    }
}
