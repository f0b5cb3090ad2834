//! From the highest point of an unrelaxed way between the two nearest minima that no pass below T joins.

use super::{Cut, Rival};
use crate::landscape::pairs::{Alike, Pairs, tired};
use crate::landscape::ways::{WAYS, way};
use crate::path::Path;
use crate::path::guess::{NoiseSpec, add_noise};
use crate::units::Angle;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;

/// Images of a way.
const IMAGES: usize = 13;

/// What is known of pairs of minima.
#[derive(Debug, Default)]
pub struct Near {
    pairs: Pairs,
}

impl Rival for Near {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let pair = self.nearest(cut)?;
        let squared = self.pairs.squared(cut.land, pair);
        let tries = self.pairs.try_once_more(alike(cut, pair, squared));
        let way = any_way(cut, pair, tries, random)?;
        let h = cut.land.evaluator();
        let inner = 1..way.images() - 1;
        let height = |k: &usize| h.difference_mev(way.image(*k), way.image(0));
        let heights: Vec<(usize, f64)> = inner.map(|k| (k, height(&k))).collect();
        let (top, _) = heights.into_iter().max_by(|p, q| p.1.total_cmp(&q.1))?;
        Some(way.image(top).to_vec())
    }
}

impl Near {
    /// The first number is the smaller one; of pairs as near as each other the one from the first start. All distances from one minimum stand
    /// side by side: where there are thousands this loop is what a search takes.
    fn nearest(&mut self, cut: &Cut) -> Option<[usize; 2]> {
        let below: Vec<usize> = cut.below().collect();
        let mut is_start = vec![false; cut.part.len()];
        cut.starts().filter(|k| cut.is_near_an_end(*k)).for_each(|k| is_start[k] = true);
        let mut best: Option<(f64, [usize; 2])> = None;
        for (before, &b) in below.iter().enumerate() {
            let apart = |a: &&usize| (is_start[**a] || is_start[b]) && cut.part[**a] != cut.part[b];
            let mut row = self.pairs.row(cut.land, b);
            for &a in below[..before].iter().filter(apart) {
                let squared = row.squared(a);
                // most are too far however seldom they were tried
                if best.is_some_and(|(least, _)| squared > least) {
                    continue;
                }
                let from = if is_start[a] { [a, b] } else { [b, a] };
                let cost = tired(squared, row.tries(&alike(cut, [a, b], squared)));
                if best.is_none_or(|(least, first)| cost < least || cost == least && from < first) {
                    best = Some((cost, from));
                }
            }
        }
        best.map(|(_, [a, b])| [a.min(b), a.max(b)])
    }
}

/// What pairs share that are tried as one: where all are looked for, none are, as those to start from are one of each kind already.
fn alike(cut: &Cut, pair: [usize; 2], squared: f64) -> Alike {
    if cut.ends.is_some() { cut.land.alike(pair, squared) } else { (pair, 0) }
}

/// The way of the k-th try: all there are by turns, and then any of them with noise.
fn any_way(cut: &Cut, pair: [usize; 2], tries: usize, random: &mut ChaCha8Rng) -> Option<Path> {
    let along = |k: usize| way(cut.land, pair, k, IMAGES, &cut.context);
    if tries < WAYS {
        return along(tries);
    }
    let path = along(random.random_range(0..WAYS))?;
    let noise = NoiseSpec { amplitude: Angle(random.random_range(0.0..0.5)), seed: random.random() };
    Some(add_noise(&path, &noise, cut.context.states.lattice))
}
