//! From the highest point of an unrelaxed way between the two nearest minima that no pass below T joins.

use super::{Cut, Rival};
use crate::landscape::pairs::tired;
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
    /// Of minimum b with each before it: the square of their distance, NaN until it is asked for, and how often they were tried.
    pairs: Vec<Vec<(f64, usize)>>,
}

impl Rival for Near {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let [a, b] = self.nearest(cut)?;
        let (_, tries) = self.of(cut, [a, b]);
        *tries += 1;
        let tried = *tries - 1;
        let way = any_way(cut, [a, b], tried, random)?;
        let h = cut.land.evaluator();
        let inner = 1..way.images() - 1;
        let height = |k: &usize| h.difference_mev(way.image(*k), way.image(0));
        let heights: Vec<(usize, f64)> = inner.map(|k| (k, height(&k))).collect();
        let (top, _) = heights.into_iter().max_by(|p, q| p.1.total_cmp(&q.1))?;
        Some(way.image(top).to_vec())
    }
}

impl Near {
    fn of(&mut self, cut: &Cut, [a, b]: [usize; 2]) -> &mut (f64, usize) {
        let pairs = &mut self.pairs;
        pairs.resize_with(pairs.len().max(b + 1), Vec::new);
        let row = &mut pairs[b];
        if row.is_empty() {
            row.resize(b, (f64::NAN, 0));
        }
        let known = &mut row[a];
        if known.0.is_nan() {
            known.0 = cut.land.squared_distance([a, b]);
        }
        known
    }

    fn nearest(&mut self, cut: &Cut) -> Option<[usize; 2]> {
        let below: Vec<usize> = cut.below().collect();
        let mut best: Option<(f64, [usize; 2])> = None;
        for a in cut.starts().filter(|a| cut.is_near_an_end(*a)) {
            for &b in below.iter().filter(|b| cut.part[a] != cut.part[**b]) {
                let pair = [a.min(b), a.max(b)];
                let (squared, tries) = *self.of(cut, pair);
                let cost = tired(squared, tries);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, pair));
                }
            }
        }
        best.map(|(_, pair)| pair)
    }
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
