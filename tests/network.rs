//! Mean first-passage times of random networks, against the fundamental matrix in a thousand digits and against random walks.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::Deserialize;
use spinneb::network::Network;

/// `tests/reference/networks.json`: see its comment.
#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Fixture {
    boltzmann_meV_K: String,
    kelvin: Vec<f64>,
    networks: Vec<Case>,
}

#[derive(Deserialize)]
struct Case {
    minima: Vec<f64>,
    /// Two minima, energy, ln of the prefactor out of each.
    saddles: Vec<(usize, usize, f64, f64, f64)>,
    start: Vec<usize>,
    goal: Vec<usize>,
    /// By temperature: from the first start, and from all of them in equilibrium.
    ln_times_s: Vec<[String; 2]>,
}

fn fixture() -> Fixture {
    serde_json::from_str(include_str!("reference/networks.json")).unwrap()
}

impl Case {
    /// The network where energies are so many times larger than k_BT, all logarithms times a factor.
    fn network(&self, beta: f64, factor: f64) -> Network {
        let mut network = Network::new(self.minima.len());
        for &(a, b, top, ln_a, ln_b) in &self.saddles {
            network.add(a, b, factor * (ln_a - beta * (top - self.minima[a])));
            network.add(b, a, factor * (ln_b - beta * (top - self.minima[b])));
        }
        network
    }
}

#[test]
fn fifty_random_networks_agree_with_the_fundamental_matrix_in_a_thousand_digits_from_4_to_300_kelvin() {
    let fixture = fixture();
    let boltzmann: f64 = fixture.boltzmann_meV_K.parse().unwrap();
    assert_eq!(fixture.networks.len(), 50);
    let (mut longest, mut worst) = (0.0f64, 0.0f64);
    for (number, case) in fixture.networks.iter().enumerate() {
        assert_eq!(case.ln_times_s.len(), fixture.kelvin.len());
        for (kelvin, expected) in fixture.kelvin.iter().zip(&case.ln_times_s) {
            let network = case.network(1.0 / (boltzmann * kelvin), 1.0);
            let found = [&case.start[..1], &case.start[..]].map(|from| network.ln_passage_s(from, &case.goal).unwrap());
            for (found, expected) in found.iter().zip(expected) {
                let expected: f64 = expected.parse().unwrap();
                let off = (found - expected).exp_m1().abs();
                assert!(off < 1e-8, "network {number} at {kelvin} K: {found} {expected}");
                (longest, worst) = (longest.max(expected), worst.max(off));
            }
        }
    }
    // beyond what a double holds, and no worse than the rounding of ln k
    assert!(longest > 709.8 && worst < 1e-10, "{longest} {worst}");
}

/// The time of one walk from a state to the first of some others.
fn walk(ways: &[Vec<(usize, f64)>], from: usize, to: &[usize], random: &mut ChaCha8Rng) -> f64 {
    let (mut here, mut time) = (from, 0.0);
    while !to.contains(&here) {
        let total: f64 = ways[here].iter().map(|way| way.1).sum();
        time -= (-random.random_range(0.0..1.0f64)).ln_1p() / total;
        let mut left = total * random.random_range(0.0..1.0);
        let next = ways[here].iter().find(|way| {
            left -= way.1;
            left < 0.0
        });
        here = next.or(ways[here].last()).unwrap().0;
    }
    time
}

#[test]
fn kinetic_monte_carlo_takes_as_long_in_ten_of_them() {
    let mut random = ChaCha8Rng::seed_from_u64(10);
    for (number, case) in fixture().networks.iter().take(10).enumerate() {
        let spread = case.minima.iter().copied().fold(0.0, f64::max);
        let network = case.network(6.0 / spread, 0.3);
        let states = network.states();
        let rate = |i: usize, j: usize| Some((j, network.ln_rate(i, j)?.exp()));
        let ways: Vec<Vec<(usize, f64)>> =
            (0..states).map(|i| (0..states).filter_map(|j| rate(i, j)).collect()).collect();
        let walks = 20_000;
        let times: Vec<f64> = (0..walks).map(|_| walk(&ways, case.start[0], &case.goal, &mut random)).collect();
        let mean = times.iter().sum::<f64>() / walks as f64;
        let variance = times.iter().map(|t| (t - mean).powi(2)).sum::<f64>() / walks as f64;
        let expected = network.ln_passage_s(&case.start[..1], &case.goal).unwrap().exp();
        let off = (mean - expected) / (variance / walks as f64).sqrt();
        assert!(off.abs() < 3.0, "network {number}: {mean} {expected}, {off} σ");
    }
}
