//! From the highest point of an unrelaxed way between the two nearest minima that no pass below T joins.

use super::{Cut, Rival};
use crate::landscape::pairs::tired;
use crate::landscape::ways::{WAYS, way};
use crate::path::Path;
use crate::path::guess::{NoiseSpec, add_noise};
use crate::units::Angle;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// Images of a way.
const IMAGES: usize = 13;

/// Pairs of minima with the square of their distance and how often they were tried.
#[derive(Debug, Default)]
pub struct Near {
    pairs: BTreeMap<[usize; 2], (f64, usize)>,
}

impl Rival for Near {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let [a, b] = self.nearest(cut)?;
        let (_, tries) = self.pairs.get_mut(&[a, b])?;
        *tries += 1;
        let way = any_way(cut, [a, b], *tries - 1, random)?;
        let h = cut.land.evaluator();
        let inner = 1..way.images() - 1;
        let height = |k: &usize| h.difference_mev(way.image(*k), way.image(0));
        let heights: Vec<(usize, f64)> = inner.map(|k| (k, height(&k))).collect();
        let (top, _) = heights.into_iter().max_by(|p, q| p.1.total_cmp(&q.1))?;
        Some(way.image(top).to_vec())
    }
}

impl Near {
    fn nearest(&mut self, cut: &Cut) -> Option<[usize; 2]> {
        let below: Vec<usize> = cut.below().collect();
        let mut best: Option<(f64, [usize; 2])> = None;
        for a in cut.starts().filter(|a| cut.is_near_an_end(*a)) {
            for &b in below.iter().filter(|b| cut.part[a] != cut.part[**b]) {
                let pair = [a.min(b), a.max(b)];
                let (squared, tries) = *self.pairs.entry(pair).or_insert_with(|| (cut.land.squared_distance(pair), 0));
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
