//! From the highest point of an unrelaxed way between the two nearest minima that no pass below T joins.

use super::{Cut, Rival};
use crate::geometry::Direction;
use crate::landscape::{turned, turns};
use crate::path::guess::{Edge, Geodesic, GuessSpec, NoiseSpec, Sweep, add_noise};
use crate::path::{Path, distance};
use crate::units::Angle;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// Images of a way.
const IMAGES: usize = 13;
/// A pair that was tried k times counts as (1 + k)⁴ times as far.
const TIRED: i32 = 4;

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
        let way = way(cut, [a, b], *tries - 1, random)?;
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
        for &a in below.iter().filter(|a| cut.is_near_an_end(**a)) {
            for &b in below.iter().filter(|b| cut.part[a] != cut.part[**b]) {
                let pair = [a.min(b), a.max(b)];
                let (squared, tries) = *self.pairs.entry(pair).or_insert_with(|| (apart(cut, pair), 0));
                let cost = squared * ((1 + tries) as f64).powi(TIRED);
                if best.is_none_or(|(least, _)| cost < least) {
                    best = Some((cost, pair));
                }
            }
        }
        best.map(|(_, pair)| pair)
    }
}

/// The square of the distance of two minima (rad²).
fn apart(cut: &Cut, [a, b]: [usize; 2]) -> f64 {
    let minima = cut.land.minima();
    let (a, b) = (&minima[a].spins, &minima[b].spins);
    let turns = turns(cut.land.evaluator(), b, a);
    distance(a.as_slice(), turned(b, &turns).as_slice()).powi(2)
}

/// The way of the k-th try: geodesic, sweeps, all in both senses, and then blends of these with noise.
fn way(cut: &Cut, [a, b]: [usize; 2], tries: usize, random: &mut ChaCha8Rng) -> Option<Path> {
    let minima = cut.land.minima();
    let (a, b) = (&minima[a].spins, &minima[b].spins);
    let b = &turned(b, &turns(cut.land.evaluator(), b, a));
    let axis = cut.context.default_axis;
    let sweep = |from, axis: Direction| GuessSpec::Sweep(Sweep { from, width: None, axis: Some(axis) });
    let edges =
        if cut.context.states.lattice.is_ring() { [Edge::Center, Edge::Left] } else { [Edge::Left, Edge::Right] };
    let about = |axis: Direction| {
        let geodesic = GuessSpec::Geodesic(Geodesic { axis: Some(axis) });
        [geodesic, sweep(edges[0], axis), sweep(edges[1], axis)]
    };
    let ways: Vec<GuessSpec> = about(axis).into_iter().chain(about(axis.reversed())).collect();
    let along = |k: usize| ways[k].member().path(a, b, IMAGES, &cut.context).ok();
    if tries < ways.len() {
        return along(tries);
    }
    let path = along(random.random_range(0..ways.len()))?;
    let noise = NoiseSpec { amplitude: Angle(random.random_range(0.0..0.5)), seed: random.random() };
    Some(add_noise(&path, &noise, cut.context.states.lattice))
}
