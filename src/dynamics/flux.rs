//! Rates of rare events: forward flux, and plain waiting.
//!
//! ```text
//! k = Φ(λ₁) Π P(λ_{i+1}|λ_i)
//! ```
//! λ is any number that grows from a state A (λ < λ₀) to the other side (λ ≥ λ_n). Φ is how often trajectories out of A pass λ₁, in the
//! time that belongs to A; P is how many of those that are started anew where others came to λ_i reach λ_{i+1} before they fall back
//! to A. Nothing of the dynamics is changed, and no equilibrium is asked for: R. J. Allen, P. B. Warren, P. R. ten Wolde, Phys. Rev.
//! Lett. 94, 018104 (2005), doi:10.1103/PhysRevLett.94.018104. Errors are those of the mean of independent blocks.

use super::{Bath, Walker};
use rayon::prelude::*;

/// A number that grows along the way, from component-major spins.
pub type Order<'a> = dyn Fn(&[f64]) -> f64 + Sync + 'a;

/// What is asked of forward flux.
#[derive(Clone, Debug, PartialEq)]
pub struct Flux {
    /// λ₀ < λ₁ < … < λ_n.
    pub interfaces: Vec<f64>,
    /// Trajectories out of A that are kept where they pass λ₁, in each block.
    pub crossings: usize,
    /// Trajectories from each further interface, in each block.
    pub trials: usize,
    /// Independent repetitions (at least 2).
    pub blocks: usize,
    /// Seed of all random numbers.
    pub seed: u64,
}

/// A rate with its standard error (1/s), and the steps that it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FluxRate {
    /// The rate (1/s).
    pub per_s: f64,
    /// Its standard error (1/s).
    pub error_per_s: f64,
    /// Time steps of all trajectories.
    pub steps: usize,
}

impl FluxRate {
    /// Of independent values of one rate.
    fn of(rates: &[f64], steps: usize) -> FluxRate {
        let n = rates.len() as f64;
        let mean = rates.iter().sum::<f64>() / n;
        let variance = rates.iter().map(|k| (k - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
        FluxRate { per_s: mean, error_per_s: (variance / n).sqrt(), steps }
    }
}

/// The rate by forward flux, from spins in A. A block none of whose trajectories reaches an interface counts as a rate of 0.
pub fn forward_flux(bath: &Bath, start: &[f64], order: &Order, flux: &Flux) -> FluxRate {
    let block = |number: usize| {
        let mut run = Block { bath, order, flux, walker: Walker::new(start, flux.seed + number as u64), steps: 0 };
        (run.rate(start), run.steps)
    };
    let blocks: Vec<(f64, usize)> = (0..flux.blocks).into_par_iter().map(block).collect();
    let rates: Vec<f64> = blocks.iter().map(|b| b.0).collect();
    FluxRate::of(&rates, blocks.iter().map(|b| b.1).sum())
}

/// The rate by waiting so many times, from spins in A until λ ≥ `goal`: one over the mean time.
pub fn escape_rate(bath: &Bath, start: &[f64], order: &Order, goal: f64, escapes: usize, seed: u64) -> FluxRate {
    let wait = |number: usize| {
        let mut walker = Walker::new(start, seed + number as u64);
        let mut steps = 0;
        while order(&walker.m) < goal {
            bath.step(&mut walker);
            steps += 1;
        }
        steps
    };
    let steps: Vec<usize> = (0..escapes).into_par_iter().map(wait).collect();
    let times: Vec<f64> = steps.iter().map(|n| *n as f64 * bath.step_s()).collect();
    let time = FluxRate::of(&times, steps.iter().sum());
    let per_s = 1.0 / time.per_s;
    FluxRate { per_s, error_per_s: per_s * time.error_per_s / time.per_s, steps: time.steps }
}

struct Block<'a> {
    bath: &'a Bath<'a>,
    order: &'a Order<'a>,
    flux: &'a Flux,
    walker: Walker,
    steps: usize,
}

impl Block<'_> {
    fn rate(&mut self, start: &[f64]) -> f64 {
        let (mut rate, mut there) = self.first(start);
        for k in 2..self.flux.interfaces.len() {
            let mut next = Vec::new();
            for _ in 0..self.flux.trials {
                let from = self.walker.below(there.len());
                self.walker.put(&there[from]);
                if self.reaches(self.flux.interfaces[k]) {
                    next.push(self.walker.m.clone());
                }
            }
            rate *= next.len() as f64 / self.flux.trials as f64;
            if next.is_empty() {
                return 0.0;
            }
            there = next;
        }
        rate
    }

    fn step(&mut self) -> f64 {
        self.bath.step(&mut self.walker);
        self.steps += 1;
        (self.order)(&self.walker.m)
    }

    /// The flux out of A over λ₁ (1/s), and the spins there. What goes on to the other side begins anew in A.
    fn first(&mut self, start: &[f64]) -> (f64, Vec<Vec<f64>>) {
        let (bottom, first) = (self.flux.interfaces[0], self.flux.interfaces[1]);
        let last = self.flux.interfaces[self.flux.interfaces.len() - 1];
        let (mut there, mut steps, mut out) = (Vec::new(), 0usize, false);
        while there.len() < self.flux.crossings {
            let order = self.step();
            steps += 1;
            if !out && order >= first {
                out = true;
                there.push(self.walker.m.clone());
            } else if order < bottom {
                out = false;
            }
            if order >= last {
                self.walker.put(start);
                out = false;
            }
        }
        (there.len() as f64 / (steps as f64 * self.bath.step_s()), there)
    }

    /// Whether the walker comes to λ before it falls back to A.
    fn reaches(&mut self, lambda: f64) -> bool {
        loop {
            let order = self.step();
            if order >= lambda {
                return true;
            }
            if order < self.flux.interfaces[0] {
                return false;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::lattice::Chain;

    #[test]
    fn forward_flux_and_waiting_agree_for_one_spin() {
        let lattice = Chain::open(1).resolve().unwrap();
        let terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Anisotropy::uniform(1, 1.0, Direction::Z)),
            Box::new(Anisotropy::uniform(1, -1.0, Direction::X)),
        ];
        let h = Hamiltonian::new(&lattice, terms).unwrap();
        let bath = Bath::new(&h, &[1.0], 0.7, 0.3, 0.02);
        let order = |m: &[f64]| -m[2];
        let start = [0.0, 0.0, 1.0];
        let interfaces = vec![-0.75, -0.55, -0.35, -0.15, 0.05, 0.3, 0.6];
        let flux = Flux { interfaces, crossings: 150, trials: 150, blocks: 12, seed: 3 };
        let found = forward_flux(&bath, &start, &order, &flux);
        let waited = escape_rate(&bath, &start, &order, 0.6, 300, 1000);
        let error = libm::hypot(found.error_per_s, waited.error_per_s);
        assert!(
            (found.per_s - waited.per_s).abs() < 3.0 * error && error < 0.15 * waited.per_s,
            "{found:?} {waited:?}"
        );
        assert_eq!(forward_flux(&bath, &start, &order, &flux), found);
    }
}
