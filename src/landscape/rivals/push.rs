//! From a minimum with one site, or a block of sites, turned about an axis across it.

use super::{Cut, Rival};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::lattice::Lattice;
use crate::sphere::{SAME, rotate_sites};
use crate::stationary::{MANY, STRIDE};
use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// How often one site is turned, and no block.
const ONE_SITE: f64 = 0.4;
/// By how much at most (rad); at least by a stride.
const MOST: f64 = 2.5;

/// How often each minimum was pushed, it or what a symmetry makes of it.
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
        let mut draws = (0..MANY).map(|_| free(block(h.lattice(), 2, random)));
        let sites = draws.find(|sites| !sites.is_empty())?;
        let spins = Components::new(&m);
        let mean = sites.iter().fold([0.0; 3], |sum, i| vector::add(sum, spins.get(*i)));
        let axis = across(mean, random)?;
        let angle = random.random_range(STRIDE..MOST);
        rotate_sites(&mut m, sites.into_iter(), axis, angle);
        Some(m)
    }
}

impl Push {
    /// One of the minima that were pushed least, as often of those joined with an end as of the others.
    fn least_pushed(&mut self, cut: &Cut, random: &mut ChaCha8Rng) -> Option<usize> {
        let (near, far): (Vec<usize>, Vec<usize>) = cut.starts().partition(|k| cut.is_near_an_end(*k));
        let pool = if far.is_empty() || random.random_bool(0.5) { near } else { far };
        let mut best: Option<(f64, usize)> = None;
        for k in pool {
            let count =
                self.pushed.get(&cut.land.orbit(k)).copied().unwrap_or(0) as f64 + random.random_range(0.0..1.0);
            if best.is_none_or(|(least, _)| count < least) {
                best = Some((count, k));
            }
        }
        let (_, k) = best?;
        *self.pushed.entry(cut.land.orbit(k)).or_insert(0) += 1;
        Some(k)
    }
}

/// A site, or a block of sites that is up to the whole lattice over `part` long in each direction, short ones as often as long ones on a
/// scale of logarithms.
pub(super) fn block(lattice: &Lattice, part: usize, random: &mut ChaCha8Rng) -> Vec<usize> {
    let one = random.random_bool(ONE_SITE);
    let (grid, centre) = (&lattice.grid, random.random_range(0..lattice.sites));
    let places = lattice.places_in_cell();
    let mut length = |d: usize| {
        let most = (grid.size[d] * places[d] / part).max(1) as f64;
        if one { 1 } else { libm::exp(random.random_range(0.0..1.0) * libm::log(most + 1.0)) as usize }
    };
    let lengths = [length(0), length(1), length(2)];
    if one {
        return vec![centre];
    }
    let middle = lattice.steps_to(centre);
    let is_in = |i: &usize| {
        let here = lattice.steps_to(*i);
        (0..3).all(|d| {
            let (size, n) = (grid.size[d] as f64, lengths[d]);
            let away = here[d] - middle[d];
            let away = if grid.periodic[d] { away - size * (away / size + 0.5).floor() } else { away };
            let first = -((n / 2) as f64) - 0.5;
            (first..first + n as f64).contains(&(places[d] as f64 * away))
        })
    };
    (0..lattice.sites).filter(is_in).collect()
}

/// A unit vector, all directions alike.
pub(super) fn anywhere(random: &mut ChaCha8Rng) -> Vector {
    let z: f64 = random.random_range(-1.0..1.0);
    let (sin, cos) = libm::sincos(random.random_range(0.0..TAU));
    [(1.0 - z * z).sqrt() * cos, (1.0 - z * z).sqrt() * sin, z]
}

/// A direction across another one.
fn across(along: Vector, random: &mut ChaCha8Rng) -> Option<Direction> {
    let any = anywhere(random);
    let across = vector::cross(along, any);
    Direction::new(if vector::norm(across) > SAME { across } else { any }).ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::lattice;
    use rand::SeedableRng;

    #[test]
    fn blocks_are_sites_of_the_lattice_once_each_and_up_to_a_part_as_long() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for (text, most) in [
            (r#"{"chain": {"sites": 1}}"#, 1),
            (r#"{"chain": {"sites": 12}}"#, 6),
            (r#"{"chain": {"sites": 12, "periodic": true}}"#, 6),
            (r#"{"square": {"cells": [4, 6], "periodic": [true, false]}}"#, 6),
            // half as long along both vectors, in places half a vector apart, a quarter of which are empty
            (r#"{"kagome": {"cells": [4, 2], "periodic": true}}"#, 6),
        ] {
            let lattice = lattice(text);
            for part in [1, 2] {
                let mut sizes = std::collections::BTreeSet::new();
                for _ in 0..400 {
                    let mut sites = block(&lattice, part, &mut random);
                    sites.sort_unstable();
                    let count = sites.len();
                    sites.dedup();
                    assert!(sites.len() == count && count > 0 && sites.iter().all(|i| *i < lattice.sites), "{sites:?}");
                    sizes.insert(count);
                }
                // of blocks as long as the lattice, most have an end outside
                let largest = sizes.last() == Some(&most) || part == 1 && sizes.last() > Some(&most);
                assert!(sizes.contains(&1) && largest, "{text}: {sizes:?}");
            }
        }
    }

    /// Atoms of one large cell, at such places of a grid.
    fn crystal(size: [usize; 2], at: impl Fn(usize) -> [f64; 2]) -> Lattice {
        let basis: Vec<String> = (0..size[0] * size[1])
            .map(|i| {
                let [x, y] = at(i);
                format!(r#"{{"at": [{}, {}, 0]}}"#, x / size[0] as f64, y / size[1] as f64)
            })
            .collect();
        let [x, y] = size;
        let vectors = format!("[[{x}, 0, 0], [0, {y}, 0], [0, 0, 1]]");
        let basis = basis.join(", ");
        lattice(&format!(r#"{{"crystal": {{"vectors": {vectors}, "basis": [{basis}], "cells": [1, 1, 1]}}}}"#))
    }

    #[test]
    fn blocks_are_places_whichever_cells_the_lattice_is_made_of() {
        let square = lattice(r#"{"square": {"cells": [4, 6]}}"#);
        let whole = crystal([4, 6], |i| [(i % 4) as f64, (i / 4) as f64]);
        let [mut one, mut other] = [1, 1].map(ChaCha8Rng::seed_from_u64);
        for _ in 0..100 {
            assert_eq!(block(&square, 2, &mut one), block(&whole, 2, &mut other));
        }
        // where no two atoms are in one row: about as many places as in a grid
        let slanted =
            crystal([6, 6], |i| [(i % 6) as f64 + 0.1 * (i / 6) as f64, (i / 6) as f64 + 0.1 * (i % 6) as f64]);
        assert_eq!((whole.places_in_cell(), slanted.places_in_cell()), ([4, 6, 1], [6, 6, 1]));
        let largest = (0..400).map(|_| block(&slanted, 2, &mut one).len()).max();
        assert!(largest.is_some_and(|n| (6..=12).contains(&n)), "{largest:?}");
    }
}
