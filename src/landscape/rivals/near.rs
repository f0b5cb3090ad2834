//! From the highest point of an unrelaxed way between the two nearest minima that no pass below T joins.

use super::{Cut, Rival};
use crate::landscape::pairs::{Alike, tired};
use crate::landscape::ways::{WAYS, way};
use crate::path::Path;
use crate::path::guess::{NoiseSpec, add_noise};
use crate::units::Angle;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// Images of a way.
const IMAGES: usize = 13;

/// What is known of pairs of minima.
#[derive(Debug, Default)]
pub struct Near {
    /// Of minimum b with each before it: the square of their distance, NaN until it is asked for.
    apart: Vec<Vec<f64>>,
    /// How often each pair was tried, it or what a symmetry makes of it.
    tried: BTreeMap<Alike, usize>,
}

impl Rival for Near {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let [a, b] = self.nearest(cut)?;
        let tries = self.tried.entry(alike(cut, [a, b], self.apart[b][a])).or_default();
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
    fn squared_distance(&mut self, cut: &Cut, [a, b]: [usize; 2]) -> f64 {
        let apart = &mut self.apart;
        apart.resize_with(apart.len().max(b + 1), Vec::new);
        let row = &mut apart[b];
        if row.is_empty() {
            row.resize(b, f64::NAN);
        }
        if row[a].is_nan() {
            row[a] = cut.land.squared_distance([a, b]);
        }
        row[a]
    }

    /// The first number is the smaller one.
    fn nearest(&mut self, cut: &Cut) -> Option<[usize; 2]> {
        let below: Vec<usize> = cut.below().collect();
        let mut best: Option<(f64, [usize; 2])> = None;
        for a in cut.starts().filter(|a| cut.is_near_an_end(*a)) {
            for &b in below.iter().filter(|b| cut.part[a] != cut.part[**b]) {
                let pair = [a.min(b), a.max(b)];
                let squared = self.squared_distance(cut, pair);
                // most are too far however seldom they were tried
                if best.is_some_and(|(least, _)| squared >= least) {
                    continue;
                }
                let tries = self.tried.get(&alike(cut, pair, squared)).copied().unwrap_or(0);
                let cost = tired(squared, tries);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, pair));
                }
            }
        }
        best.map(|(_, pair)| pair)
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
