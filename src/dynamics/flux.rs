//! Rates of rare events: forward flux, and plain waiting.
//!
//! ```text
//! k = Φ(λ₁) Π P(λ_{i+1}|λ_i)
//! ```
//! λ is any number that grows from a state A (λ < λ₀) to the other side (λ ≥ λ_n). Φ is how often trajectories out of A pass λ₁, in the
//! time that belongs to A; P is how many of those that are started anew where others came to λ_i reach λ_{i+1} before they fall back
//! to A. Nothing of the dynamics is changed, and no equilibrium is asked for: R. J. Allen, P. B. Warren, P. R. ten Wolde, Phys. Rev.
//! Lett. 94, 018104 (2005), doi:10.1103/PhysRevLett.94.018104. Errors are those of the mean of independent blocks.

use super::{Bath, LANES, Walkers};
use crate::field::Components;
use crate::geometry::Vector;
use rayon::prelude::*;

/// A spin's share of λ = Σ over all spins, a number that grows along the way.
pub type Order<'a> = dyn Fn(Vector) -> f64 + Sync + 'a;

/// λ of spins (component-major, 3N numbers).
pub fn total(order: &Order, m: &[f64]) -> f64 {
    let m = Components::new(m);
    (0..m.sites()).map(|i| order(m.get(i))).sum()
}

/// What is asked of forward flux.
#[derive(Clone, Debug, PartialEq)]
pub struct Flux {
    /// λ₀ < λ₁ < … < λ_n.
    pub interfaces: Vec<f64>,
    /// Time steps that trajectories in A are left to themselves before they count.
    pub settle: usize,
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
        let mut run = Block { bath, order, flux, walkers: Walkers::new(start, flux.seed + number as u64), steps: 0 };
        (run.rate(start, number), run.steps)
    };
    let blocks: Vec<(f64, usize)> = (0..flux.blocks).into_par_iter().map(block).collect();
    let rates: Vec<f64> = blocks.iter().map(|b| b.0).collect();
    FluxRate::of(&rates, blocks.iter().map(|b| b.1).sum())
}

/// The rate by waiting: escapes over the time that trajectories out of A (λ < `bottom`) spend until λ ≥ `goal`, from so many escapes
/// or a few more. A trajectory that has escaped begins anew where another one is in A. `settle` steps do not count.
pub fn escape_rate(
    bath: &Bath,
    start: &[f64],
    order: &Order,
    [bottom, goal]: [f64; 2],
    settle: usize,
    escapes: usize,
    seed: u64,
) -> FluxRate {
    const APART: usize = 16;
    let wait = |number: usize| {
        let mut walkers = Walkers::new(start, seed + number as u64);
        let (mut seen, mut steps) = (0, 0);
        while seen * APART < escapes + APART || steps <= settle {
            bath.step(&mut walkers);
            let orders = walkers.orders(order);
            let out = walkers.begin_anew(orders, [bottom, goal], start);
            steps += 1;
            seen += if steps > settle { out } else { 0 };
        }
        (seen, LANES * (steps - settle), LANES * steps)
    };
    let all: Vec<(usize, usize, usize)> = (0..APART).into_par_iter().map(wait).collect();
    // each ends at an escape, so one of its own says nothing
    let seen = all.iter().map(|w| w.0 - 1).sum::<usize>() as f64;
    let per_s = seen / (all.iter().map(|w| w.1).sum::<usize>() as f64 * bath.step_s());
    FluxRate { per_s, error_per_s: per_s / seen.sqrt(), steps: all.iter().map(|w| w.2).sum() }
}

impl Walkers {
    /// Those with λ ≥ `goal` begin anew, each where the next one is that is in A, else from the start; how many they are.
    fn begin_anew(&mut self, orders: [f64; LANES], [bottom, goal]: [f64; 2], start: &[f64]) -> usize {
        let out = (0..LANES).filter(|lane| orders[*lane] >= goal);
        out.inspect(|lane| {
            let other = (1..LANES).map(|k| (lane + k) % LANES).find(|other| orders[*other] < bottom);
            let from = other.map_or(start.to_vec(), |other| self.spins(other));
            self.put(*lane, &from);
        })
        .count()
    }
}

struct Block<'a> {
    bath: &'a Bath<'a>,
    order: &'a Order<'a>,
    flux: &'a Flux,
    walkers: Walkers,
    steps: usize,
}

impl Block<'_> {
    fn rate(&mut self, start: &[f64], number: usize) -> f64 {
        let (mut rate, mut there) = self.first(start);
        for k in 2..self.flux.interfaces.len() {
            let next = self.on(&there, self.flux.interfaces[k], self.flux.seed + number as u64, (k as u64) << 32);
            rate *= next.len() as f64 / self.flux.trials as f64;
            if next.is_empty() {
                return 0.0;
            }
            there = next;
        }
        rate
    }

    /// A step of all walkers, and where they are then.
    fn step(&mut self) -> [f64; LANES] {
        self.bath.step(&mut self.walkers);
        self.steps += LANES;
        self.walkers.orders(self.order)
    }

    /// The flux out of A over λ₁ (1/s), and the spins there. What reaches the other side begins anew in A.
    fn first(&mut self, start: &[f64]) -> (f64, Vec<Vec<f64>>) {
        let (bottom, first) = (self.flux.interfaces[0], self.flux.interfaces[1]);
        let last = self.flux.interfaces[self.flux.interfaces.len() - 1];
        // what is out counts when it has been back in A
        let (mut there, mut steps, mut out) = (Vec::new(), 0usize, [true; LANES]);
        while there.len() < self.flux.crossings {
            let orders = self.step();
            steps += 1;
            for lane in 0..LANES {
                if !out[lane] && orders[lane] >= first {
                    out[lane] = true;
                    if steps > self.flux.settle {
                        there.push(self.walkers.spins(lane));
                    }
                } else if orders[lane] < bottom {
                    out[lane] = false;
                }
            }
            (0..LANES).filter(|lane| orders[*lane] >= last).for_each(|lane| out[lane] = false);
            self.walkers.begin_anew(orders, [bottom, last], start);
        }
        let time_s = (LANES * (steps - self.flux.settle)) as f64 * self.bath.step_s();
        (there.len() as f64 / time_s, there)
    }

    /// The spins of those of all trials that come to λ before they fall back to A, each from the next of the spins that are there.
    fn on(&mut self, there: &[Vec<f64>], lambda: f64, seed: u64, first: u64) -> Vec<Vec<f64>> {
        let (mut begun, mut ended) = (0, 0);
        let mut found: Vec<Option<Vec<f64>>> = vec![None; self.flux.trials];
        let mut trial: [Option<usize>; LANES] = [None; LANES];
        while ended < self.flux.trials {
            for lane in 0..LANES {
                while trial[lane].is_none() && begun < self.flux.trials {
                    let from = &there[begun % there.len()];
                    if total(self.order, from) >= lambda {
                        // a step took it over both
                        found[begun] = Some(from.clone());
                        ended += 1;
                    } else {
                        self.walkers.begin(lane, from, seed, first + begun as u64);
                        trial[lane] = Some(begun);
                    }
                    begun += 1;
                }
            }
            let orders = self.step();
            for lane in 0..LANES {
                let Some(number) = trial[lane] else { continue };
                let reached = orders[lane] >= lambda;
                if reached {
                    found[number] = Some(self.walkers.spins(lane));
                }
                if reached || orders[lane] < self.flux.interfaces[0] {
                    trial[lane] = None;
                    ended += 1;
                }
            }
        }
        found.into_iter().flatten().collect()
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
        let order = |m: Vector| -m[2];
        let start = [0.0, 0.0, 1.0];
        let waited = escape_rate(&bath, &start, &order, [-0.75, 0.6], 500, 2000, 1000);
        // the second ones lie closer than a step takes the spin
        for apart in [0.25, 0.02] {
            let further = (0..).map(|k| -0.55 + apart * f64::from(k)).take_while(|lambda| *lambda < 0.6);
            let interfaces = std::iter::once(-0.75).chain(further).chain([0.6]).collect();
            let flux = Flux { interfaces, settle: 500, crossings: 1000, trials: 1000, blocks: 12, seed: 3 };
            let found = forward_flux(&bath, &start, &order, &flux);
            let error = libm::hypot(found.error_per_s, waited.error_per_s);
            assert!(
                (found.per_s - waited.per_s).abs() < 3.0 * error && error < 0.05 * waited.per_s,
                "{found:?} {waited:?}"
            );
            assert_eq!(forward_flux(&bath, &start, &order, &flux), found);
        }
    }
}
