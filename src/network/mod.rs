//! Networks of states: the rates between them, how long it takes to get from some to others, and the tree of their barriers.
//!
//! States are numbered from 0; a rate k_ij (1/s) leads from i to j. All is done in logarithms, since rates may be too small or too
//! large for a double, and all that is subtracted is known as a sum of what remains.

mod elimination;
mod layout;
mod parts;
mod tree;

pub use layout::layout;
pub use parts::Parts;
pub use tree::{Branch, Tree};

use crate::linalg::log_sum;
use std::collections::{BTreeMap, BTreeSet};

/// States and the rates between them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Network {
    /// Of each state: ln k (1/s) to each of its neighbours.
    ln_rates: Vec<BTreeMap<usize, f64>>,
}

impl Network {
    /// So many states, and no rates yet.
    pub fn new(states: usize) -> Network {
        Network { ln_rates: vec![BTreeMap::new(); states] }
    }

    /// A further way from one state to another. One that leads back to where it began is none.
    pub fn add(&mut self, from: usize, to: usize, ln_per_s: f64) {
        if from != to {
            let rate = self.ln_rates[from].entry(to).or_insert(f64::NEG_INFINITY);
            *rate = log_sum(*rate, ln_per_s);
        }
    }

    /// How many states there are.
    pub fn states(&self) -> usize {
        self.ln_rates.len()
    }

    /// ln of the rate (1/s) from one state to another, over all ways.
    pub fn ln_rate(&self, from: usize, to: usize) -> Option<f64> {
        self.ln_rates[from].get(&to).copied()
    }

    /// The states that ways lead to from one, itself counted.
    pub fn joined_with(&self, state: usize) -> BTreeSet<usize> {
        let mut joined = BTreeSet::from([state]);
        let mut front = vec![state];
        while let Some(i) = front.pop() {
            front.extend(self.ln_rates[i].keys().copied().filter(|j| joined.insert(*j)));
        }
        joined
    }

    /// ln of the weights of some states in equilibrium, their sum 1, from p_i k_ij = p_j k_ji along the ways that join them. Nothing
    /// where they are not joined.
    pub fn ln_equilibrium(&self, states: &[usize]) -> Option<Vec<f64>> {
        let mut ln = vec![f64::NAN; self.states()];
        let mut front = vec![*states.first()?];
        ln[front[0]] = 0.0;
        while let Some(i) = front.pop() {
            for (&j, &on) in &self.ln_rates[i] {
                if let (true, Some(back)) = (ln[j].is_nan(), self.ln_rate(j, i)) {
                    ln[j] = ln[i] + on - back;
                    front.push(j);
                }
            }
        }
        let own: Vec<f64> = states.iter().map(|k| ln[*k]).collect();
        let sum = own.iter().copied().fold(f64::NEG_INFINITY, log_sum);
        own.iter().all(|x| !x.is_nan()).then(|| own.into_iter().map(|x| x - sum).collect())
    }

    /// ln of the mean time (s) until one of some states is reached for the first time, from states with ln weights whose sum is 1.
    /// Nothing where it may never be.
    pub fn ln_first_passage_s(&self, from: &[(usize, f64)], to: &[usize]) -> Option<f64> {
        let times: Option<Vec<f64>> = from
            .iter()
            .map(|(k, weight)| Some(weight + elimination::ln_first_passage_s(&self.ln_rates, *k, to)?))
            .collect();
        Some(times?.into_iter().fold(f64::NEG_INFINITY, log_sum))
    }

    /// ln of the mean time (s) until a group of states is left, from its own equilibrium.
    pub fn ln_escape_s(&self, group: &[usize]) -> Option<f64> {
        let others: Vec<usize> = (0..self.states()).filter(|k| !group.contains(k)).collect();
        self.ln_passage_s(group, &others)
    }

    /// ln of the mean time (s) from one group of states, in its own equilibrium, to another one.
    pub fn ln_passage_s(&self, from: &[usize], to: &[usize]) -> Option<f64> {
        let weights = if from.len() == 1 { vec![0.0] } else { self.ln_equilibrium(from)? };
        let start: Vec<(usize, f64)> = from.iter().copied().zip(weights).collect();
        self.ln_first_passage_s(&start, to)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;
    use crate::rates::first_passage;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// A network of states at energies `e` with barriers between them, of both directions consistent: ln k_ij = ln A − b_ij + e_i.
    fn network(random: &mut ChaCha8Rng, states: usize, spread: f64) -> Network {
        let e: Vec<f64> = (0..states).map(|_| spread * random.random_range(0.0..1.0)).collect();
        let mut network = Network::new(states);
        for i in 0..states {
            for j in 0..i {
                if j + 1 == i || random.random_bool(0.3) {
                    let top = e[i].max(e[j]) + spread * random.random_range(0.0..1.0);
                    network.add(i, j, e[i] - top);
                    network.add(j, i, e[j] - top);
                }
            }
        }
        network
    }

    /// Mean first-passage times to the last state by the dense equations Q τ = −1.
    fn dense(network: &Network) -> Vec<f64> {
        let n = network.states() - 1;
        let mut q = vec![0.0; n * n];
        for i in 0..n {
            for (&j, ln) in &network.ln_rates[i] {
                q[i * n + i] -= libm::exp(*ln);
                if j < n {
                    q[i * n + j] += libm::exp(*ln);
                }
            }
        }
        solve_dense(&q, &vec![-1.0; n], n).unwrap()
    }

    #[test]
    fn first_passage_times_are_those_of_the_dense_equations() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        for states in [2, 3, 5, 9, 14] {
            let network = network(&mut random, states, 2.0);
            for (start, expected) in dense(&network).into_iter().enumerate() {
                let found = libm::exp(network.ln_passage_s(&[start], &[states - 1]).unwrap());
                assert!((found - expected).abs() < 1e-11 * expected, "{states} {start}: {found} {expected}");
            }
        }
    }

    #[test]
    fn in_a_row_of_deep_minima_the_time_is_the_one_of_the_row() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        for depth in [30.0, 300.0, 900.0] {
            let mut random_ln = || -> f64 { -depth * random.random_range(0.0..1.0) };
            let (onward, back): (Vec<f64>, Vec<f64>) = (0..12).map(|_| (random_ln(), random_ln())).unzip();
            let mut network = Network::new(13);
            for k in 0..12 {
                network.add(k, k + 1, onward[k]);
                network.add(k + 1, k, back[k]);
            }
            let (found, expected) = (network.ln_passage_s(&[0], &[12]).unwrap(), first_passage(&onward, &back));
            assert!((found - expected).abs() < 1e-12 * expected.abs(), "{found} {expected}");
        }
    }

    #[test]
    fn the_order_of_the_states_and_a_factor_of_all_rates_do_not_matter() {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let network = network(&mut random, 20, 400.0);
        let renumbered = |k: usize| (7 * k + 3) % 20;
        let mut other = Network::new(20);
        for i in 0..20 {
            network.ln_rates[i].iter().for_each(|(j, ln)| other.add(renumbered(i), renumbered(*j), ln + 5.0));
        }
        let expected = network.ln_passage_s(&[4], &[11, 12]).unwrap();
        let found = other.ln_passage_s(&[renumbered(4)], &[renumbered(11), renumbered(12)]).unwrap();
        assert!((found + 5.0 - expected).abs() < 1e-11 * expected.abs(), "{found} {expected}");
    }

    #[test]
    fn random_walks_take_as_long() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let network = network(&mut random, 6, 2.0);
        let walks = 20_000;
        let mut times = Vec::new();
        for _ in 0..walks {
            let (mut here, mut time) = (0, 0.0);
            while here != 5 {
                let ways: Vec<(usize, f64)> =
                    network.ln_rates[here].iter().map(|(j, ln)| (*j, libm::exp(*ln))).collect();
                let total: f64 = ways.iter().map(|w| w.1).sum();
                time -= libm::log(1.0 - random.random_range(0.0..1.0)) / total;
                let mut left = total * random.random_range(0.0..1.0);
                here = ways
                    .iter()
                    .find(|w| {
                        left -= w.1;
                        left < 0.0
                    })
                    .unwrap_or(&ways[ways.len() - 1])
                    .0;
            }
            times.push(time);
        }
        let mean = times.iter().sum::<f64>() / walks as f64;
        let variance = times.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / walks as f64;
        let expected = libm::exp(network.ln_passage_s(&[0], &[5]).unwrap());
        assert!((mean - expected).abs() < 3.0 * (variance / walks as f64).sqrt(), "{mean} {expected}");
    }

    #[test]
    fn a_group_is_left_from_its_equilibrium_and_what_is_never_reached_has_no_time() {
        // 0 ⇄ 1 → 2, and 3 by itself
        let mut network = Network::new(4);
        for (i, j, k) in [(0, 1, 2.0f64), (1, 0, 1.0), (1, 2, 0.5), (2, 1, 0.1)] {
            network.add(i, j, libm::log(k));
        }
        let weights = network.ln_equilibrium(&[0, 1]).unwrap();
        assert!((libm::exp(weights[0]) - 1.0 / 3.0).abs() < 1e-14);
        // from 1: (1 + 1·½)/0.5 = 3 s, from 0: half a second more
        let found = libm::exp(network.ln_escape_s(&[0, 1]).unwrap());
        assert!((found - (3.0 + 0.5 / 3.0)).abs() < 1e-13, "{found}");
        assert_eq!(network.ln_passage_s(&[0], &[3]), None);
        assert_eq!(network.ln_escape_s(&[3]), None);
        assert_eq!(network.ln_equilibrium(&[0, 3]), None);
    }
}
