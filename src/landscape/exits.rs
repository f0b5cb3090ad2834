//! Saddles beside a path, by which the state that it begins in is left for states that are not on it.

use super::{Landscape, Seen};

impl Landscape<'_> {
    /// How high one has to go at least by those that are known (meV above the state), from the first of a path's minima or along the path
    /// from one that comes before its highest saddle; its saddles' heights above the reference (meV). States that symmetry makes of minima
    /// on the path are none, but for those that it makes of the last one: the path has an image that leads there, and is not counted with
    /// it.
    pub fn lowest_exit_mev(&self, minima: &[usize], saddles_mev: &[f64]) -> Option<f64> {
        let nodes: Vec<usize> = minima.iter().map(|k| self.standing_for(*k)).collect();
        let (last, earlier) = nodes.split_last()?;
        let highest = (0..saddles_mev.len()).max_by(|i, j| saddles_mev[*i].total_cmp(&saddles_mev[*j]))?;
        let before = &earlier[..=highest];
        let is_own = |height: f64| saddles_mev.iter().any(|own| (own - height).abs() < self.tolerance_mev(*own));
        let is_image = |k: usize| !self.is_image(k, *last) && earlier.iter().any(|own| self.is_image(k, *own));
        // the height of a way that leaves the path at `from`, over the saddles of the path until there, and where it leads
        let way = |from: usize, to: usize, height: f64| {
            let place = before.iter().position(|node| *node == from)?;
            let leads_off = !nodes.contains(&to) || !before.contains(&to) && !is_own(height);
            leads_off.then(|| (saddles_mev[..place].iter().copied().fold(height, f64::max), to))
        };
        let ways = self.edges().iter().flat_map(|edge| {
            let [a, b] = edge.ends.map(|k| self.standing_for(k));
            [way(a, b, edge.height_mev), way(b, a, edge.height_mev)]
        });
        let mut ways: Vec<(f64, usize)> = ways.flatten().collect();
        ways.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        // images are dear to tell: from the lowest way up, as few as may be
        let lowest = ways.into_iter().find(|(_, to)| nodes.contains(to) || !is_image(*to));
        lowest.map(|(height, _)| height - self.heights_mev()[nodes[0]])
    }

    /// Whether symmetry makes one minimum of another.
    fn is_image(&self, k: usize, of: usize) -> bool {
        let [m, of_m] = [k, of].map(|k| self.minima()[k].spins.as_slice());
        let seen = Seen::of(self.evaluator(), m);
        self.orbit(k) == self.orbit(of) || self.operations_known().iter().any(|by| seen.is_made(by, of_m))
    }
}
