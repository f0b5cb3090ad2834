//! What keeps images apart along the path: springs, targets of equal distance, or the mildest local shift.

use super::Band;
use crate::path::RESOLVED;

impl Band<'_> {
    /// Shift of image k along τ (rad) that mends a spacing uneven by more than a factor two, else 0.
    pub fn local_shift(&self, k: usize) -> f64 {
        let (before, after) = (self.spacing[k - 1], self.spacing[k]);
        if after > 2.0 * before || before > 2.0 * after { 0.5 * (after - before) } else { 0.0 }
    }

    /// The same, and where the longer side alone is not resolved: from there images slide down, until they have no neighbour to go by.
    /// (Walls of 32² and cubes of 16³ sites take half the evaluations or fewer so. In chains, where a band relaxes in a few, it does
    /// not pay: 1440 random ones take 5 % fewer, of the shipped ones some more, up to a quarter.)
    pub fn resolving_shift(&self, k: usize) -> f64 {
        let (before, after) = (self.spacing[k - 1], self.spacing[k]);
        let (longer, shorter) = if after > before { (k, k - 1) } else { (k - 1, k) };
        let is_torn = self.widest[longer] > RESOLVED && self.widest[shorter] <= RESOLVED;
        if is_torn { 0.5 * (after - before) } else { self.local_shift(k) }
    }

    /// L⁺ − L⁻ of image k (rad): a geodesic spring's pull along τ, times its stiffness.
    pub fn spring_pull(&self, k: usize) -> f64 {
        self.spacing[k] - self.spacing[k - 1]
    }

    /// Shifts along τ (rad) of all images to equal distances between the ends and the held images; 0 for those.
    pub fn equal_shifts(&self) -> Vec<f64> {
        let last = self.images() - 1;
        let mut s = vec![0.0];
        for l in &self.spacing {
            s.push(s[s.len() - 1] + l);
        }
        let stops: Vec<usize> = (0..=last).filter(|&k| k == 0 || k == last || self.held[k]).collect();
        let mut shift = vec![0.0; last + 1];
        for pair in stops.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            for k in a + 1..b {
                shift[k] = s[a] + (s[b] - s[a]) * (k - a) as f64 / (b - a) as f64 - s[k];
            }
        }
        shift
    }
}

#[cfg(test)]
mod tests {
    use crate::band::Band;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::path::Path;
    use crate::spins::Spins;

    #[test]
    fn an_image_beside_a_gap_that_is_not_resolved_moves_towards_it() {
        let h = hamiltonian(&lattice(r#"{"square": {"cells": [4, 4]}}"#), &[r#"{"exchange": {"J": ["1 meV"]}}"#]);
        let turned = |angle: f64| Spins::from_vectors(&[[angle.sin(), 0.0, angle.cos()]; 16]).unwrap();
        // steps of 0.8, 0.9, 1.2, 1.3 and 0.6 rad, of four times as much in all 16 spins together; the last but one is uneven
        let mut band = Band::new(&h, Path::new(&[0.0, 0.8, 1.7, 2.9, 4.2, 4.8].map(turned)));
        band.evaluate();
        let shifts = |shift: &dyn Fn(usize) -> f64| [1, 2, 3, 4].map(|k| (1e9 * shift(k)).round() / 1e9);
        assert_eq!(shifts(&|k| band.resolving_shift(k)), [0.0, 0.6, 0.0, -1.4]);
        assert_eq!(shifts(&|k| band.local_shift(k)), [0.0, 0.0, 0.0, -1.4]);
    }
}
