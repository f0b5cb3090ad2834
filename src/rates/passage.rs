//! Times: the mean first passage through a row of minima, and the temperature that gives a lifetime.
//!
//! A row of minima 0 … n, of which n absorbs. f_i is the rate from i to i + 1, b_i that from i to i − 1. The mean time t_i from
//! the first visit of i to that of i + 1 obeys
//!
//! ```text
//! t_0 = 1/f_0,    t_i = (1 + b_i t_{i−1})/f_i,    mean first passage from 0 to n: Σ t_i
//! ```
//! (an absorbing Markov chain with the minima as states). All terms are positive, and all is done in logarithms. A change of the two
//! rates over saddle i by one factor changes t_i by it, and no other: t_i over the whole is how far the time hangs on that saddle.

use crate::linalg::log_sum;

/// Ten years of 365.25 days (s).
pub const TEN_YEARS_S: f64 = 3.155_76e8;

/// ln t_i (s) from the logarithms of the rates (1/s) over the n saddles: `onward[i]` from minimum i to i + 1, `back[i]` from minimum
/// i + 1 to i, of which the last takes no part and may be left out.
pub fn passages(onward: &[f64], back: &[f64]) -> Vec<f64> {
    let mut times: Vec<f64> = Vec::with_capacity(onward.len());
    for (i, forward) in onward.iter().enumerate() {
        let returns = times.last().map_or(f64::NEG_INFINITY, |before| back[i - 1] + before);
        times.push(log_sum(0.0, returns) - forward);
    }
    times
}

/// ln of the mean first-passage time (s) from minimum 0 to minimum n, likewise.
pub fn first_passage(onward: &[f64], back: &[f64]) -> f64 {
    passages(onward, back).into_iter().fold(f64::NEG_INFINITY, log_sum)
}

/// The temperature (K) at which the mean lifetime is `seconds`: the solution between Δ = 5000 and a hair above Δ = 1,
/// from the logarithm of the
/// lifetime (s) at a temperature (K). Nothing where the lifetime does not fall through `seconds` in between.
pub fn blocking_temperature(ln_lifetime_s: impl Fn(f64) -> Option<f64>, barrier_mev: f64, seconds: f64) -> Option<f64> {
    let wanted = libm::log(seconds);
    let over_k = barrier_mev / crate::units::K_B;
    let (mut low, mut high) = (over_k / 5000.0, 0.999_999 * over_k);
    let crosses = high > low && ln_lifetime_s(low)? > wanted && ln_lifetime_s(high)? < wanted;
    if !crosses {
        return None;
    }
    while high - low > 1e-14 * high {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if ln_lifetime_s(middle)? > wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::solve_dense;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_first_passage_solves_the_equations_of_the_absorbing_chain() {
        let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        for n in 1..7 {
            let rates = |random: &mut rand_chacha::ChaCha8Rng| -> Vec<f64> {
                (0..n).map(|_| random.random_range(-3.0..3.0)).collect()
            };
            let (onward, back) = (rates(&mut random), rates(&mut random));
            // Q τ = −1 for the mean times τ_i from minimum i to the last one
            let mut q = vec![0.0; n * n];
            for i in 0..n {
                let (f, b) = (libm::exp(onward[i]), if i > 0 { libm::exp(back[i - 1]) } else { 0.0 });
                q[i * n + i] = -(f + b);
                if i + 1 < n {
                    q[i * n + i + 1] = f;
                }
                if i > 0 {
                    q[i * n + i - 1] = b;
                }
            }
            let times = solve_dense(&q, &vec![-1.0; n], n).unwrap();
            let found = libm::exp(first_passage(&onward, &back));
            assert!((found - times[0]).abs() < 1e-12 * times[0], "{n}: {found} {}", times[0]);
        }
    }

    #[test]
    fn rates_too_small_for_a_double_still_have_a_first_passage() {
        let found = first_passage(&[-5000.0, -5000.0], &[-4000.0, 0.0]);
        assert!((found - 6000.0).abs() < 1e-9, "{found}");
    }

    #[test]
    fn the_lifetime_at_the_blocking_temperature_is_the_one_asked_for() {
        let lifetime = |t: f64| Some(-libm::log(1e12) + 100.0 / (crate::units::K_B * t));
        for seconds in [1.0, TEN_YEARS_S] {
            let t = blocking_temperature(lifetime, 100.0, seconds).unwrap();
            assert!((lifetime(t).unwrap() - libm::log(seconds)).abs() < 1e-11);
        }
        assert_eq!(blocking_temperature(|_| None, 100.0, 1.0), None);
        assert_eq!(blocking_temperature(lifetime, 0.0, 1.0), None);
        assert_eq!(blocking_temperature(lifetime, 100.0, 1e-13), None);
    }
}
