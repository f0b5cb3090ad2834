//! From states between two of a wall's places in which one spin has turned half-way, the spins turning over one after another, row by row
//! from a side. Where spins stand against their neighbours, as grains do and atoms with a large anisotropy, all these places are minima
//! among 2ᴺ others, and no search comes by them in their order. Where walls are wide there are none.

use super::{Cut, Rival};
use crate::energy::Evaluator;
use crate::field::Components;
use crate::geometry::angle;
use crate::lattice::Lattice;
use crate::linalg::Matrix;
use crate::path::guess::{Geodesic, Ways};
use crate::stationary::{Point, STRIDE, Spectrum};
use rand_chacha::ChaCha8Rng;

/// After this part of the spins a row is not whole, as a rule: a wall has a kink, which is where it moves.
const PART: f64 = 0.382;

/// Which of the starts is next.
#[derive(Debug, Default)]
pub struct OneByOne {
    /// None until one is asked for; then the order, if there is one.
    order: Option<Option<Order>>,
    next: usize,
}

/// Spins before, half-way and after (3N each), and in which order the sites go over.
#[derive(Debug)]
struct Order {
    way: [Vec<f64>; 3],
    sites: Vec<usize>,
}

impl Rival for OneByOne {
    fn start(&mut self, cut: &Cut, _: &mut ChaCha8Rng) -> Option<Vec<f64>> {
        let order = self.order.get_or_insert_with(|| lowest_order(cut)).as_ref()?;
        let start = (self.next < order.sites.len()).then(|| between(&order.way, &order.sites, self.next));
        self.next += 1;
        start
    }
}

/// The order that leads over the lowest states, if it leads below T.
fn lowest_order(cut: &Cut) -> Option<Order> {
    let h = cut.land.evaluator();
    let [a, b] = cut.ends?.map(|k| &cut.land.minima()[k].spins);
    let half = Geodesic::default().along(&Ways::between(a, b), 3, &cut.context);
    let way = [a.as_slice(), half.image(1), b.as_slice()].map(<[f64]>::to_vec);
    let [from, to] = [a, b].map(|spins| Components::new(spins.as_slice()));
    let turns = |i: &usize| !h.is_frozen(*i) && angle(from.get(*i), to.get(*i)) > STRIDE;
    let moving: Vec<usize> = (0..h.sites()).filter(turns).collect();
    let kink = (PART * moving.len() as f64) as usize;
    let mut best: Option<(f64, Vec<usize>)> = None;
    for sites in orders(h.lattice(), &moving) {
        // where the lattice does not hold a wall that comes from one side it holds none
        if best.is_none() && !is_held(h, &turned(&way, &sites[..kink])) {
            return None;
        }
        let limit = best.as_ref().map_or(cut.top_mev, |(least, _)| *least);
        let height = |k: usize| if h.is_stopped() { limit } else { cut.land.height_mev(&between(&way, &sites, k)) };
        if let Some(top) = highest_below(limit, (0..sites.len()).map(height)) {
            best = Some((top, sites));
        }
    }
    best.map(|(_, sites)| Order { way, sites })
}

/// The highest of them, if all are below a limit; none after the first that is not is asked for.
fn highest_below(limit: f64, mut heights: impl Iterator<Item = f64>) -> Option<f64> {
    heights.try_fold(f64::NEG_INFINITY, |top, height| (height < limit).then_some(top.max(height)))
}

/// Sites row by row from each side of the lattice.
fn orders(lattice: &Lattice, sites: &[usize]) -> Vec<Vec<usize>> {
    let extents = lattice.extents();
    let directions = (0..3).filter(|d| extents[*d]).flat_map(|d| [(d, 1.0), (d, -1.0)]);
    let order = |(d, sign): (usize, f64)| {
        let place = |i: &usize| {
            let at = lattice.steps_to(*i);
            [sign * at[d], at[(d + 1) % 3], at[(d + 2) % 3]]
        };
        let mut sites = sites.to_vec();
        let compare = |p: [f64; 3], q: [f64; 3]| (0..3).map(|k| p[k].total_cmp(&q[k])).find(|o| o.is_ne());
        sites.sort_by(|i, j| compare(place(i), place(j)).unwrap_or(i.cmp(j)));
        sites
    };
    directions.map(order).collect()
}

/// The first k sites of an order as they are after all, the next one as it is half-way, the others as they are before.
fn between(way: &[Vec<f64>; 3], order: &[usize], k: usize) -> Vec<f64> {
    let mut m = turned(way, &order[..k]);
    put(&mut m, order[k], &way[1]);
    m
}

/// These sites as they are after all, the others as they are before.
fn turned([before, _, after]: &[Vec<f64>; 3], sites: &[usize]) -> Vec<f64> {
    let mut m = before.clone();
    sites.iter().for_each(|i| put(&mut m, *i, after));
    m
}

fn put(m: &mut [f64], site: usize, from: &[f64]) {
    let sites = m.len() / 3;
    (0..3).for_each(|c| m[c * sites + site] = from[c * sites + site]);
}

/// Whether spins that stand against their neighbours are held there.
fn is_held(h: Evaluator, m: &[f64]) -> bool {
    Spectrum::softer(h, &Point::at(h, m.to_vec()), 0.0, &mut Matrix::default()) == 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::landscape::{Landscape, Minimum};
    use crate::path::guess::GuessContext;
    use crate::spins::Spins;
    use crate::state::StateContext;
    use rand::SeedableRng;

    /// The starts in a square of 4 × 4 spins with J = 1 meV, between ±z, where passes have to lie below so many meV.
    fn starts(k_mev: f64, below_mev: f64) -> Vec<Vec<f64>> {
        let lattice = lattice(r#"{"square": {"cells": [4, 4]}}"#);
        let easy = format!(r#"{{"anisotropy": {{"K": "{k_mev} meV", "axis": [0, 0, 1]}}}}"#);
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, &easy]);
        let [up, down] = [1.0, -1.0].map(|z| Spins::uniform(16, Direction::new([0.0, 0.0, z]).unwrap()));
        let mut land = Landscape::new((&h).into(), up.as_slice());
        let ends = [&up, &down].map(|end| land.add_minimum(&Minimum::examine((&h).into(), end)));
        let context = GuessContext { states: StateContext::new(&lattice, 1.0), default_axis: Direction::X };
        let cut = Cut::of(&land, Some(ends), below_mev, context);
        let (mut rival, mut random) = (OneByOne::default(), ChaCha8Rng::seed_from_u64(1));
        std::iter::from_fn(|| rival.start(&cut, &mut random)).collect()
    }

    #[test]
    fn spins_turn_over_one_after_another_where_they_stand_against_their_neighbours() {
        // K + (2n + 2) J, of the spin that begins the third row
        let found = starts(10.0, 21.0);
        assert_eq!(found.len(), 16);
        for (k, m) in found.iter().enumerate() {
            let down = m[32..].iter().filter(|z| **z < -0.9).count();
            let half = m[32..].iter().filter(|z| z.abs() < 0.1).count();
            assert_eq!((down, half), (k, 1));
        }
        assert!(starts(10.0, 19.0).is_empty(), "it leads higher");
        assert!(starts(0.1, 21.0).is_empty(), "a wide wall has no such places");
    }
}
