//! The way from one minimum to another over the known passes.

use super::Pass;
use super::graph::{Edge, Landscape};
use crate::network::Parts;

/// A way over passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    /// Edges in order, and whether each is gone from its second end to its first.
    pub steps: Vec<(usize, bool)>,
    /// The highest of its saddles above the landscape's reference (meV).
    pub top_mev: f64,
}

impl Landscape<'_> {
    /// The route whose highest saddle is lowest; of several the one over the fewest passes.
    pub fn route(&self, from: usize, to: usize) -> Option<Route> {
        let [from, to] = [from, to].map(|k| self.standing_for(k));
        let top_mev = self.top_mev(from, to)?;
        // the energies of images of one pass differ by rounding
        let most = top_mev + self.tolerance_mev(top_mev);
        let allowed: Vec<usize> = (0..self.edges().len()).filter(|k| self.edges()[*k].height_mev <= most).collect();
        Some(Route { steps: self.shortest(&allowed, from, to)?, top_mev })
    }

    /// Where the highest saddle of that route is (meV above the reference).
    pub fn top_mev(&self, from: usize, to: usize) -> Option<f64> {
        let [from, to] = [from, to].map(|k| self.standing_for(k));
        let mut ascending: Vec<&Edge> = self.edges().iter().collect();
        ascending.sort_by(|p, q| p.height_mev.total_cmp(&q.height_mev));
        let mut parts = Parts::of(self.minima().len());
        let last = ascending.into_iter().find(|edge| {
            parts.join(edge.ends[0], edge.ends[1]);
            parts.root(from) == parts.root(to)
        })?;
        Some(last.height_mev)
    }

    /// The way over the fewest of some edges; of several the one over the fewest images, of these with the lowest sum of heights.
    fn shortest(&self, allowed: &[usize], from: usize, to: usize) -> Option<Vec<(usize, bool)>> {
        let mut ways: Vec<Vec<(usize, bool)>> = vec![Vec::new(); self.minima().len()];
        for &k in allowed {
            let [a, b] = self.edges()[k].ends;
            ways[a].push((k, false));
            ways[b].push((k, true));
        }
        // so many images on the way to a minimum, the sum of all heights, and the last edge
        type Cost = (usize, f64);
        let mut reached: Vec<Option<(Cost, (usize, bool))>> = vec![None; self.minima().len()];
        let mut front = vec![(from, (0, 0.0))];
        let mut seen = vec![false; self.minima().len()];
        seen[from] = true;
        while !seen[to] {
            let mut next: Vec<usize> = Vec::new();
            for (here, sum) in front {
                for &(edge, backward) in &ways[here] {
                    let there = self.edges()[edge].ends[usize::from(!backward)];
                    let Edge { height_mev, by, .. } = &self.edges()[edge];
                    let sum = (sum.0 + usize::from(by.is_some()), sum.1 + height_mev);
                    if !seen[there] && reached[there].is_none_or(|(least, _)| sum < least) {
                        next.push(there);
                        reached[there] = Some((sum, (edge, backward)));
                    }
                }
            }
            next.sort_unstable();
            next.dedup();
            next.iter().for_each(|k| seen[*k] = true);
            front = next.into_iter().filter_map(|k| Some((k, reached[k]?.0))).collect();
            if front.is_empty() {
                return None;
            }
        }
        let mut steps = Vec::new();
        let mut here = to;
        while here != from {
            let (_, (edge, backward)) = reached[here]?;
            steps.push((edge, backward));
            here = self.edges()[edge].ends[usize::from(backward)];
        }
        steps.reverse();
        Some(steps)
    }

    /// Which minima are joined by passes below a height (meV): a number for each that those joined with it share.
    pub fn parts_below(&self, height_mev: f64) -> Vec<usize> {
        let mut parts = Parts::of(self.minima().len());
        for edge in self.edges().iter().filter(|e| e.height_mev < height_mev) {
            parts.join(edge.ends[0], edge.ends[1]);
        }
        (0..self.minima().len()).map(|k| parts.root(self.standing_for(k))).collect()
    }

    /// The passes of a route, each in the direction in which the route goes over it.
    pub fn passes_of(&self, route: &Route) -> Vec<Pass> {
        let pass = |&(k, backward): &(usize, bool)| {
            let Edge { pass, by, .. } = &self.edges()[k];
            let mut pass = match by {
                Some(by) => self.passes()[*pass].image(self.evaluator(), &self.operations_known()[*by]),
                None => self.passes()[*pass].clone(),
            };
            if backward {
                pass.reverse();
            }
            pass
        };
        route.steps.iter().map(pass).collect()
    }
}
