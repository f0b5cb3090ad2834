//! From a minimum with one site, or a block of sites, in random directions.

use super::push::{anywhere, block};
use super::{Cut, Rival};
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;

/// How often each minimum was left.
#[derive(Debug, Default)]
pub struct Melt {
    left: BTreeMap<usize, usize>,
}

impl Rival for Melt {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let minimum = cut.starts().min_by_key(|k| self.left.get(k).copied().unwrap_or(0))?;
        *self.left.entry(minimum).or_default() += 1;
        let h = cut.land.evaluator();
        let (mut m, sites) = (cut.land.minima()[minimum].spins.as_slice().to_vec(), h.sites());
        for i in block(h.lattice(), 1, random).into_iter().filter(|i| !h.is_frozen(*i)) {
            let direction = anywhere(random);
            (0..3).for_each(|c| m[c * sites + i] = direction[c]);
        }
        Some(m)
    }
}
