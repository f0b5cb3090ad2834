//! From a minimum with one site, or a block of sites, turned about an axis across it.

use super::{Cut, Rival};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::sphere::rotate_sites;
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// How often one site is turned, and how often a minimum that is joined with an end.
const ONE_SITE: f64 = 0.4;
const NEAR_AN_END: f64 = 0.7;
/// By how much (rad).
const LEAST: f64 = 0.5;
const MOST: f64 = 2.5;
/// How often a block is drawn anew where all its sites are frozen.
const DRAWS: usize = 100;

/// How often each minimum was pushed.
#[derive(Debug, Default)]
pub struct Push {
    pushed: BTreeMap<usize, usize>,
}

impl Rival for Push {
    fn start(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let minimum = self.least_pushed(cut, random)?;
        let h = cut.land.evaluator();
        let mut m = cut.land.minima()[minimum].spins.as_slice().to_vec();
        let free = |sites: Vec<usize>| -> Vec<usize> { sites.into_iter().filter(|i| !h.is_frozen(*i)).collect() };
        let mut draws = (0..DRAWS).map(|_| free(block(h.lattice(), random)));
        let sites = draws.find(|sites| !sites.is_empty())?;
        let spins = Components::new(&m);
        let mean = sites.iter().fold([0.0; 3], |sum, i| vector::add(sum, spins.get(*i)));
        let axis = across(mean, random)?;
        let angle = random.random_range(LEAST..MOST);
        rotate_sites(&mut m, sites.into_iter(), axis, angle);
        Some(m)
    }
}

impl Push {
    /// One of the minima that were pushed least, those joined with an end first.
    fn least_pushed(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<usize> {
        let (near, far): (Vec<usize>, Vec<usize>) = cut.starts().partition(|k| cut.is_near_an_end(*k));
        let pool = if far.is_empty() || random.random_bool(NEAR_AN_END) { near } else { far };
        let mut best: Option<(f64, usize)> = None;
        for k in pool {
            let count = self.pushed.get(&k).copied().unwrap_or(0) as f64 + random.random_range(0.0..1.0);
            if best.is_none_or(|(least, _)| count < least) {
                best = Some((count, k));
            }
        }
        let (_, k) = best?;
        *self.pushed.entry(k).or_insert(0) += 1;
        Some(k)
    }
}

/// A site, or a block of sites that is up to half as long as the lattice in each direction, short ones as often as long ones on a
/// scale of logarithms.
fn block(lattice: &Lattice, random: &mut ChaCha8Rng) -> Vec<usize> {
    let one = random.random_bool(ONE_SITE);
    let (grid, centre) = (&lattice.grid, random.random_range(0..lattice.sites));
    let mut length = |d: usize| {
        let most = (grid.size[d] / 2).max(1) as f64;
        if one { 1 } else { libm::exp(random.random_range(0.0..1.0) * libm::log(most + 1.0)) as isize }
    };
    let [x, y, z] = [length(0), length(1), length(2)];
    let around = |n: isize| -n / 2..n - n / 2;
    let shifts = around(z).flat_map(|c| around(y).flat_map(move |b| around(x).map(move |a| [a, b, c])));
    let (own, cell) = lattice.cell(centre);
    let cells = shifts.filter_map(|shift| grid.shifted(cell, shift));
    let atoms = if one { own..own + 1 } else { 0..lattice.atoms.len() };
    cells.flat_map(|cell| atoms.clone().filter_map(move |atom| lattice.site(atom, cell))).collect()
}

/// A direction across another one.
fn across(along: Vector, random: &mut ChaCha8Rng) -> Option<Direction> {
    let z: f64 = random.random_range(-1.0..1.0);
    let (sin, cos) = libm::sincos(random.random_range(0.0..TAU));
    let any = [(1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z];
    let across = vector::cross(along, any);
    Direction::new(if vector::norm(across) > 1e-6 { across } else { any }).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::LatticeSpec;
    use rand::SeedableRng;

    #[test]
    fn blocks_are_sites_of_the_lattice_once_each_and_up_to_half_as_long() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for text in [
            r#"{"chain": {"sites": 1}}"#,
            r#"{"chain": {"sites": 12}}"#,
            r#"{"chain": {"sites": 12, "periodic": true}}"#,
            r#"{"square": {"cells": [4, 6], "periodic": [true, false]}}"#,
            r#"{"kagome": {"cells": [4, 2]}}"#,
        ] {
            let lattice = serde_json::from_str::<LatticeSpec>(text).unwrap().resolve().unwrap();
            let mut sizes = std::collections::BTreeSet::new();
            for _ in 0..400 {
                let mut sites = block(&lattice, &mut random);
                sites.sort_unstable();
                let count = sites.len();
                sites.dedup();
                assert!(sites.len() == count && count > 0 && sites.iter().all(|i| *i < lattice.sites), "{sites:?}");
                sizes.insert(count);
            }
            let most: usize = lattice.grid.size.iter().map(|n| (n / 2).max(1)).product();
            let most = most * lattice.atoms.len();
            assert!(sizes.contains(&1) && sizes.last() == Some(&most), "{text}: {sizes:?}");
        }
    }
}
