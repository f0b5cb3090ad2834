//! Saddles beside a path, by which the state that it begins in is left for states that are not on it.

use super::{Edge, Landscape, Minimum, Seen};
use crate::network::Parts;
use crate::symmetry::Operation;

/// The way from a path's first minimum to its last, and which minima are one state.
struct Way {
    /// Of each minimum the state.
    state: Vec<usize>,
    /// The path's minima, the last one apart.
    earlier: Vec<usize>,
    last: usize,
}

impl Landscape<'_> {
    /// How high one has to go at least by those that are known (meV above the state), from the first of a path's minima or along the path
    /// from one that comes before its highest saddle; its saddles' heights above the reference (meV). Minima between which no saddle is as
    /// high as `within_mev` above both are one state. What a symmetry that keeps the last one makes of the path leads there just as the path
    /// does: it is none where it begins in the same state, and the first state's images are none, nor is what is told of already.
    pub fn lowest_exit_mev(
        &self,
        minima: &[usize],
        saddles_mev: &[f64],
        within_mev: f64,
        is_told: &dyn Fn(&Edge) -> bool,
    ) -> Option<f64> {
        let nodes: Vec<usize> = minima.iter().map(|k| self.standing_for(*k)).collect();
        let (last, earlier) = nodes.split_last()?;
        let highest = (0..saddles_mev.len()).max_by(|i, j| saddles_mev[*i].total_cmp(&saddles_mev[*j]))?;
        let path = Way { state: self.states(within_mev), earlier: earlier.to_vec(), last: *last };
        let state = |k: usize| path.state[k];
        let before: Vec<usize> = earlier[..=highest].iter().map(|k| state(*k)).collect();
        let is_own = |height: f64| saddles_mev.iter().any(|own| (own - height).abs() < self.tolerance_mev(*own));
        // the height of a way that leaves the path at `from`, over the saddles of the path until there, and where it leads
        let way = |from: usize, to: usize, height: f64| {
            let place = before.iter().position(|known| *known == state(from))?;
            let on_path = nodes.iter().any(|k| state(*k) == state(to));
            let leads_off = !on_path || !before.contains(&state(to)) && !is_own(height);
            leads_off.then(|| (saddles_mev[..place].iter().copied().fold(height, f64::max), (!on_path).then_some(to)))
        };
        let ways = self.edges().iter().flat_map(|edge| {
            let [a, b] = edge.ends;
            [way(a, b, edge.height_mev), way(b, a, edge.height_mev)].into_iter().flatten().map(move |way| (way, edge))
        });
        let mut ways: Vec<((f64, Option<usize>), &Edge)> = ways.collect();
        ways.sort_by(|((a, _), _), ((b, _), _)| a.total_cmp(b));
        // images are dear to tell: from the lowest way up, as few as may be
        let is_other = |((_, off), edge): &((f64, Option<usize>), &Edge)| {
            !is_told(edge) && off.is_none_or(|to| !self.is_alike(&path, to))
        };
        ways.into_iter().find(is_other).map(|((height, _), _)| height - self.heights_mev()[nodes[0]])
    }

    /// The other minima that are one state with one, see [`lowest_exit_mev`](Self::lowest_exit_mev).
    pub fn one_with(&self, minimum: usize, within_mev: f64) -> impl Iterator<Item = &Minimum> {
        let (state, own) = (self.states(within_mev), self.standing_for(minimum));
        self.minima()
            .iter()
            .enumerate()
            .filter(move |(k, _)| *k != own && state[*k] == state[own])
            .map(|(_, other)| other)
    }

    /// The state that each minimum belongs to.
    fn states(&self, within_mev: f64) -> Vec<usize> {
        let mut parts = Parts::of(self.minima().len());
        for edge in self.edges() {
            let [a, b] = edge.ends;
            if [a, b].iter().all(|k| edge.height_mev - self.heights_mev()[*k] < within_mev) {
                parts.join(a, b);
            }
        }
        (0..self.minima().len()).map(|k| parts.root(k)).collect()
    }

    /// Whether symmetry makes the path lead over a minimum: it keeps the last state, and the first, or makes the minimum of that. A state
    /// of several minima is kept where its sites alone move.
    fn is_alike(&self, path: &Way, k: usize) -> bool {
        let spins = |k: usize| self.minima()[k].spins.as_slice();
        let seen = |k: usize| Seen::of(self.evaluator(), spins(k));
        let [here, first, last] = [k, path.earlier[0], path.last].map(seen);
        let is_loose = |end: usize| path.state.iter().filter(|state| **state == path.state[end]).count() > 1;
        let keeps = |by: &Operation, end: usize, seen: &Seen| {
            by.moves_sites_alone() && is_loose(end) || seen.is_made(by, spins(end))
        };
        let makes = |by: &Operation| {
            let of = |own: usize| here.is_made(by, spins(own));
            of(path.earlier[0])
                || path.earlier[1..].iter().chain([&path.last]).any(|own| of(*own))
                    && keeps(by, path.earlier[0], &first)
        };
        // images that operations make of one another, of which the graph does not have all
        let keep_last = || self.operations_known().iter().all(|by| last.is_made(by, spins(path.last)));
        let is_of_first = self.orbit(k) == self.orbit(path.earlier[0]) && keep_last();
        is_of_first || self.operations_known().iter().any(|by| makes(by) && keeps(by, path.last, &last))
    }
}
