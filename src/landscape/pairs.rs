//! Which pair of minima to join next: the graph of squared distances, in which joined pairs are no distance apart.
//!
//! The shortest way through it from one end to the other leads in short steps over what is known; its first step that no pass
//! joins yet is the pair. (As J. M. Carr, S. A. Trygubenko, D. J. Wales, J. Chem. Phys. 122, 234903 (2005),
//! doi:10.1063/1.1931587.)

use super::nearing::Nearing;
use super::{Landscape, turned, turns};
use crate::field::Components;
use crate::linalg::slab;
use crate::sphere::{SAME, best_overlap};
use std::collections::BTreeMap;

/// A pair that was tried k times counts as (1 + k)⁴ times as far.
const TIRED: i32 = 4;

/// What pairs share that are images of each other by symmetry: the orbits of the two, and the square of their distance.
pub(super) type Alike = ([usize; 2], i64);

/// What is known of pairs of minima.
#[derive(Debug, Default)]
pub(super) struct Pairs {
    /// Squares of distances of minimum k from those before it, as far as they were asked for; NaN where they were not.
    apart: Vec<Vec<f64>>,
    /// How often each was tried, it or an image of it by symmetry.
    tried: BTreeMap<Alike, usize>,
    /// How the joins of one path get on.
    pub nearing: Option<Nearing>,
}

/// What is known of the pairs of one minimum with those before it.
pub(super) struct Row<'p, 'l> {
    land: &'p Landscape<'l>,
    k: usize,
    apart: &'p mut [f64],
    tried: &'p BTreeMap<Alike, usize>,
}

impl Row<'_, '_> {
    /// The square of the distance from the one before.
    pub fn squared(&mut self, before: usize) -> f64 {
        let squared = &mut self.apart[before];
        if squared.is_nan() {
            *squared = self.land.squared_distance([before, self.k]);
        }
        *squared
    }

    /// How often a pair was tried.
    pub fn tries(&self, pair: &Alike) -> usize {
        times(self.tried, pair)
    }
}

impl Pairs {
    /// The pairs of a minimum with those before it.
    pub fn row<'p, 'l>(&'p mut self, land: &'p Landscape<'l>, k: usize) -> Row<'p, 'l> {
        if self.apart.len() <= k {
            self.apart.resize(k + 1, Vec::new());
        }
        let apart = &mut self.apart[k];
        apart.resize(k, f64::NAN);
        Row { land, k, apart, tried: &self.tried }
    }

    /// The square of the distance of two minima.
    pub fn squared(&mut self, land: &Landscape, pair: [usize; 2]) -> f64 {
        self.row(land, pair[0].max(pair[1])).squared(pair[0].min(pair[1]))
    }

    /// How often a pair was tried.
    pub fn tries(&self, pair: &Alike) -> usize {
        times(&self.tried, pair)
    }

    /// The same; one time more from now on.
    pub fn try_once_more(&mut self, pair: Alike) -> usize {
        let tried = self.tried.entry(pair).or_default();
        *tried += 1;
        *tried - 1
    }
}

fn times(tried: &BTreeMap<Alike, usize>, pair: &Alike) -> usize {
    tried.get(pair).copied().unwrap_or(0)
}

/// The square of a distance that counts a pair as further apart with every try.
pub(super) fn tired(squared: f64, tries: usize) -> f64 {
    squared * ((1 + tries) as f64).powi(TIRED)
}

impl Landscape<'_> {
    /// The square of the distance of two minima, Σ |m − m'|², turned about the symmetry axes to be near each other.
    pub fn squared_distance(&self, [a, b]: [usize; 2]) -> f64 {
        let [a, b] = [a.min(b), a.max(b)].map(|k| &self.minima()[k].spins);
        let together = match self.evaluator().symmetry_axes() {
            [] => slab::dot(a.as_slice(), b.as_slice()),
            [axis] => best_overlap(Components::new(a.as_slice()), Components::new(b.as_slice()), *axis),
            _ => slab::dot(a.as_slice(), turned(b, &turns(self.evaluator(), b, a)).as_slice()),
        };
        2.0 * (a.sites() as f64 - together).max(0.0)
    }

    /// The joins of another path begin: what those of the last one came to does not count.
    pub fn begin_joins(&mut self) {
        self.pairs.nearing = None;
    }

    /// How often a pair was tried; one time more from now on.
    pub(super) fn try_once_more(&mut self, pair: [usize; 2]) -> usize {
        let key = self.alike(pair, self.squared_distance(pair));
        self.pairs.try_once_more(key)
    }

    /// What pairs share that are images of each other by symmetry.
    pub(super) fn alike(&self, pair: [usize; 2], squared: f64) -> Alike {
        let [a, b] = pair.map(|k| self.orbit(k));
        ([a.min(b), a.max(b)], (squared / SAME).round() as i64)
    }

    /// The pair to try next on the way from one minimum to another over passes below a height (meV), and how far that way is, the sum
    /// of squared distances; none if all that lead on were tried so many times.
    pub fn next_pair(&mut self, [from, to]: [usize; 2], below_mev: f64, tries: usize) -> Option<([usize; 2], f64)> {
        let [from, to] = [from, to].map(|k| self.standing_for(k));
        let part = self.parts_below(below_mev);
        let is_node = |k: usize| self.standing_for(k) == k && (self.heights_mev()[k] < below_mev || k == to);
        let mut open: Vec<usize> = (0..part.len()).filter(|k| is_node(*k)).collect();
        let mut pairs = std::mem::take(&mut self.pairs);
        // the shortest way to each minimum so far, and where its last step comes from
        let mut far = vec![f64::INFINITY; part.len()];
        let mut before = vec![from; part.len()];
        far[from] = 0.0;
        while let Some(place) = (0..open.len()).min_by(|i, j| far[open[*i]].total_cmp(&far[open[*j]])) {
            let here = open.swap_remove(place);
            if here == to || far[here] == f64::INFINITY {
                break;
            }
            for &there in &open {
                let is_apart = part[here] != part[there];
                let mut step = if is_apart { pairs.squared(self, [here, there]) } else { 0.0 };
                // most are far from here however often they were tried
                if is_apart && far[here] + step < far[there] {
                    let tried = pairs.tries(&self.alike([here, there], step));
                    step = if tried < tries { tired(step, tried) } else { f64::INFINITY };
                }
                if far[here] + step < far[there] {
                    (far[there], before[there]) = (far[here] + step, here);
                }
            }
        }
        self.pairs = pairs;
        let mut pair = None;
        let mut here = to;
        while here != from && far[to] < f64::INFINITY {
            if part[before[here]] != part[here] {
                pair = Some([before[here], here]);
            }
            here = before[here];
        }
        pair.map(|pair| (pair, far[to]))
    }
}
