//! An order of elimination by nested dissection: a cut in two, both halves one after the other, and last the sites that keep
//! them apart (George, SIAM J. Numer. Anal. 10, 345 (1973), doi:10.1137/0710032).
//!
//! Tried are the cuts across x, y and z at the median, between layers, and one by the graph alone: half of the sites in the
//! order in which they are reached from a far one. So a graph in no space, or one whose sites all stand at one point, is
//! dissected too. What separates is read from the graph: the sites of one side that have partners on the other.

use super::Graph;

/// Sets of so few sites are not dissected.
const LEAF: usize = 4;
/// Coordinates as near as this part of the extent are equal.
const SAME: f64 = 1e-9;
/// Coordinate of the cut that only the graph knows.
const REACHED: usize = 3;

/// The sites in the order of their elimination, from their positions and partners.
pub fn nested_dissection(graph: &Graph, positions: &[[f64; 3]]) -> Vec<u32> {
    let sites = graph.sites();
    let mut order: Vec<u32> = (0..sites as u32).collect();
    let mut work = Dissection { graph, positions, side: vec![Side::Outside; sites], reached: vec![0; sites] };
    work.dissect(&mut order);
    order
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Side {
    Outside,
    Low,
    High,
    Between,
}

/// Sites of which a coordinate is less than a threshold on one side; those of `separator`'s side that have partners on the
/// other keep them apart.
struct Cut {
    coordinate: usize,
    threshold: f64,
    separator: Side,
    /// Sites between by the product of those on both sides.
    cost: f64,
}

struct Dissection<'a> {
    graph: &'a Graph,
    positions: &'a [[f64; 3]],
    /// Of all sites; outside those that are dissected.
    side: Vec<Side>,
    /// When a site was reached on a walk through the graph.
    reached: Vec<u32>,
}

impl Dissection<'_> {
    fn dissect(&mut self, sites: &mut [u32]) {
        if sites.len() <= LEAF {
            return;
        }
        sites.iter().for_each(|i| self.side[*i as usize] = Side::Low);
        self.reach(sites);
        let cuts: Vec<Cut> = (0..=REACHED).filter_map(|c| self.cut(sites, c)).collect();
        let cut = cuts.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost));
        let [low, high] = cut.map_or([0, 0], |cut| self.part(sites, &cut));
        sites.iter().for_each(|i| self.side[*i as usize] = Side::Outside);
        self.dissect(&mut sites[..low]);
        self.dissect(&mut sites[low..low + high]);
    }

    fn key(&self, coordinate: usize, site: u32) -> f64 {
        match coordinate {
            REACHED => f64::from(self.reached[site as usize]),
            axis => self.positions[site as usize][axis],
        }
    }

    /// Numbers the sites as a walk in breadth reaches them, from one that another such walk reaches last.
    fn reach(&mut self, sites: &[u32]) {
        let mut first = sites[0];
        let mut queue: Vec<u32> = Vec::with_capacity(sites.len());
        for _ in 0..2 {
            sites.iter().for_each(|i| self.reached[*i as usize] = u32::MAX);
            queue.clear();
            for seed in [first].iter().chain(sites) {
                let mut next = queue.len();
                self.arrive(*seed, &mut queue);
                while next < queue.len() {
                    let partners = self.graph.partners(queue[next] as usize);
                    partners.iter().for_each(|j| self.arrive(*j, &mut queue));
                    next += 1;
                }
            }
            first = queue[queue.len() - 1];
        }
    }

    fn arrive(&mut self, site: u32, queue: &mut Vec<u32>) {
        let i = site as usize;
        if self.side[i] != Side::Outside && self.reached[i] == u32::MAX {
            self.reached[i] = queue.len() as u32;
            queue.push(site);
        }
    }

    /// The cut across a coordinate; none where it is the same for all sites.
    fn cut(&mut self, sites: &[u32], coordinate: usize) -> Option<Cut> {
        let threshold = self.threshold(sites, coordinate);
        self.divide(sites, coordinate, threshold);
        let (mut inside, mut rim) = ([0; 2], [0; 2]);
        for i in sites {
            let side = self.side[*i as usize];
            let (here, other) = if side == Side::Low { (0, Side::High) } else { (1, Side::Low) };
            inside[here] += 1;
            rim[here] += usize::from(self.touches(*i, other));
        }
        if inside.contains(&0) {
            return None;
        }
        let cost = |s: usize| {
            let product = (inside[s] - rim[s]).max(1) as f64 * inside[1 - s] as f64;
            (rim[s] as f64 + 0.5) / product
        };
        let (separator, cost) = if cost(0) <= cost(1) { (Side::Low, cost(0)) } else { (Side::High, cost(1)) };
        Some(Cut { coordinate, threshold, separator, cost })
    }

    /// The place between two layers nearest to the median.
    fn threshold(&self, sites: &[u32], coordinate: usize) -> f64 {
        let mut keys: Vec<f64> = sites.iter().map(|i| self.key(coordinate, *i)).collect();
        let middle = keys.len() / 2;
        let median = *keys.select_nth_unstable_by(middle, f64::total_cmp).1;
        let (least, most) = keys.iter().fold((median, median), |(a, b), k| (k.min(a), k.max(b)));
        let same = SAME * (most - least);
        let below = keys.iter().filter(|k| **k < median - same).count();
        let not_above = keys.iter().filter(|k| **k < median + same).count();
        if below >= keys.len() - not_above { median - same } else { median + same }
    }

    fn divide(&mut self, sites: &[u32], coordinate: usize, threshold: f64) {
        for i in sites {
            let low = self.key(coordinate, *i) < threshold;
            self.side[*i as usize] = if low { Side::Low } else { Side::High };
        }
    }

    fn touches(&self, site: u32, side: Side) -> bool {
        self.graph.partners(site as usize).iter().any(|j| self.side[*j as usize] == side)
    }

    /// Sorts the sites into those below, above and between; how many are below and above.
    fn part(&mut self, sites: &mut [u32], cut: &Cut) -> [usize; 2] {
        self.divide(sites, cut.coordinate, cut.threshold);
        let other = if cut.separator == Side::Low { Side::High } else { Side::Low };
        for i in sites.iter() {
            if self.side[*i as usize] == cut.separator && self.touches(*i, other) {
                self.side[*i as usize] = Side::Between;
            }
        }
        let side = |i: &u32| self.side[*i as usize];
        sites.sort_by_key(side);
        let end = |last| sites.partition_point(|i| side(i) <= last);
        [end(Side::Low), end(Side::High) - end(Side::Low)]
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::{self, Lattice};
    use super::*;
    use crate::linalg::Symbolic;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn every_site_is_eliminated_once() {
        let mut r = ChaCha8Rng::seed_from_u64(31);
        for lattice in samples::all(&mut r) {
            let mut order = nested_dissection(&lattice.graph(), &lattice.positions);
            order.sort_unstable();
            assert!(order.into_iter().eq(0..lattice.positions.len() as u32), "{}", lattice.name);
        }
    }

    #[test]
    fn no_bond_passes_by_what_separates() {
        let mut r = ChaCha8Rng::seed_from_u64(32);
        for lattice in samples::all(&mut r) {
            let (graph, sites) = (lattice.graph(), lattice.positions.len());
            let mut work = Dissection {
                graph: &graph,
                positions: &lattice.positions,
                side: vec![Side::Low; sites],
                reached: vec![0; sites],
            };
            let mut all: Vec<u32> = (0..sites as u32).collect();
            work.reach(&all);
            let cuts: Vec<Cut> = (0..=REACHED).filter_map(|c| work.cut(&all, c)).collect();
            assert_eq!(cuts.is_empty(), sites == 1, "{}", lattice.name);
            for cut in cuts {
                let counts = work.part(&mut all, &cut);
                assert!(counts.iter().all(|c| *c < sites));
                for (i, j) in &lattice.bonds {
                    let sides = [work.side[*i], work.side[*j]];
                    let joined = sides.contains(&Side::Low) && sides.contains(&Side::High);
                    assert!(!joined, "{}: {i} {j} across {}", lattice.name, cut.coordinate);
                }
            }
        }
    }

    #[test]
    fn squares_and_chains_cost_what_theory_says() {
        let mut r = ChaCha8Rng::seed_from_u64(33);
        let flops = |l: &Lattice| Symbolic::of(l.graph(), &l.positions).flops();
        let square = |n, r: &mut ChaCha8Rng| flops(&Lattice::grid([n, n, 1], [false; 3], 1.0, r));
        let growth = square(96, &mut r) / square(48, &mut r);
        assert!((5.0..9.0).contains(&growth), "{growth}");
        let growth = flops(&Lattice::chain(8000, 1, true)) / flops(&Lattice::chain(4000, 1, true));
        assert!((1.9..2.1).contains(&growth), "{growth}");
    }

    #[test]
    fn a_lattice_without_positions_costs_little_more() {
        let mut r = ChaCha8Rng::seed_from_u64(34);
        let mut lattice = Lattice::grid([40, 40, 1], [false; 3], 1.0, &mut r);
        let with = Symbolic::of(lattice.graph(), &lattice.positions).flops();
        lattice.positions.fill([0.0; 3]);
        let without = Symbolic::of(lattice.graph(), &lattice.positions).flops();
        assert!(without < 2.5 * with, "{without} {with}");
    }

    #[test]
    fn many_sites_at_one_point_or_almost_end_the_dissection() {
        let mut r = ChaCha8Rng::seed_from_u64(35);
        let mut lattice = Lattice::chain(300, 1, false);
        for scale in [0.0, 1e-300, 1e-20, 1.0] {
            for offset in [0.0, 1e10, -1e300] {
                lattice.positions.iter_mut().flatten().for_each(|x| *x = offset + scale * r.random_range(-1.0..1.0));
                assert_eq!(nested_dissection(&lattice.graph(), &lattice.positions).len(), 300);
            }
        }
    }
}
