//! Random numbers that stand for normal ones in a rule that is right in distribution.
//!
//! ```text
//! ξ = ±a with 1/8 each, ±b with 3/8 each,   a² + 3b² = 4,  a⁴ + 3b⁴ = 12       ⟨ξ²⟩ = 1, ⟨ξ⁴⟩ = 3, odd moments 0
//! ```
//! The first five moments are a normal number's, which a rule of second order in distribution asks for: P. E. Kloeden, E. Platen,
//! Numerical Solution of Stochastic Differential Equations, Springer 1992, section 14.2, doi:10.1007/978-3-662-12616-5. Three bits make
//! one.

use super::{LANES, Spin};
use rand::Rng;
use rand_chacha::ChaCha8Rng;

/// a = √(1 + √6), and b = √(1 − √(2/3)).
const A: f64 = 1.857_280_200_396_046_3;
const B: f64 = 0.428_372_990_596_132_2;
/// By three bits.
const VALUES: [f64; 8] = [A, -A, B, -B, B, -B, B, -B];
/// Numbers that a word of 64 bits makes.
const A_WORD: usize = 21;

/// New numbers for all sites of a walker.
pub(super) fn fill(random: &mut ChaCha8Rng, lane: usize, noise: &mut [Spin]) {
    for sites in noise.chunks_mut(A_WORD / 3) {
        let mut word = random.next_u64();
        for component in sites.iter_mut().flatten() {
            component[lane] = VALUES[(word & 7) as usize];
            word >>= 3;
        }
    }
}

/// New numbers for all walkers.
pub(super) fn fill_all(random: &mut [ChaCha8Rng; LANES], noise: &mut [Spin]) {
    random.iter_mut().enumerate().for_each(|(lane, random)| fill(random, lane, noise));
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn five_moments_are_those_of_a_normal_number() {
        for (power, expected) in [(1, 0.0), (2, 1.0), (3, 0.0), (4, 3.0), (5, 0.0)] {
            let mean = VALUES.iter().map(|x| x.powi(power)).sum::<f64>() / 8.0;
            assert!((mean - expected).abs() < 1e-14, "{power}: {mean}");
        }
    }

    #[test]
    fn all_components_of_all_walkers_are_independent() {
        let mut noise = vec![[[0.0; LANES]; 3]; 10];
        let mut random = [0, 1, 2, 3, 4, 5, 6, 7].map(ChaCha8Rng::seed_from_u64);
        let (many, n) = (20_000, 3 * LANES * noise.len());
        let mut products = vec![0.0; n * n];
        for _ in 0..many {
            fill_all(&mut random, &mut noise);
            let all = noise.as_flattened().as_flattened();
            (0..n).for_each(|a| (0..n).for_each(|b| products[a * n + b] += all[a] * all[b]));
        }
        for (k, sum) in products.iter().enumerate() {
            let expected = if k % (n + 1) == 0 { 1.0 } else { 0.0 };
            assert!((sum / f64::from(many) - expected).abs() < 6.0 * (2.0 / f64::from(many)).sqrt(), "{k}");
        }
    }
}
