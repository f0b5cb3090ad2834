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

/// ln of the mean first-passage time (s) where two rows of minima, joined at their ends alone, lead from one end to the other; each with
/// its rates onward and back as above.
///
/// ```text
/// T = (1 + Σ u/r) / Σ 1/r
/// ```
/// over both rows, r + u a row's own first-passage time (see [`passages`]) of which r = Σ r_i, r_0 = 1/f_0, r_i = r_{i−1} b_i/f_i is
/// one over the rate at which what leaves the first minimum comes through.
pub fn first_passage_by_either(rows: [[&[f64]; 2]; 2]) -> f64 {
    let (mut through, mut within) = (f64::NEG_INFINITY, 0.0);
    for [onward, back] in rows {
        let (mut r, mut u) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
        let (mut last_r, mut last_u) = (0.0, f64::NEG_INFINITY);
        for (i, forward) in onward.iter().enumerate() {
            let returns = if i == 0 { 0.0 } else { back[i - 1] };
            last_u = if i == 0 { last_u } else { log_sum(0.0, returns + last_u) - forward };
            last_r += returns - forward;
            (r, u) = (log_sum(r, last_r), log_sum(u, last_u));
        }
        through = log_sum(through, -r);
        within = log_sum(within, u - r);
    }
    within - through
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
    fn either_of_two_rows_is_crossed_as_the_equations_of_both_say() {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(31);
        for (one, other) in [(1, 1), (2, 2), (3, 3), (1, 4), (4, 2)] {
            let mut rates = |n: usize| -> Vec<f64> { (0..n).map(|_| r.random_range(-6.0..6.0)).collect() };
            let rows = [one, other].map(|n| [rates(n), rates(n - 1)]);
            // the first minimum, then the inner ones of each row: −Σ k t_j + Σ k t_i = 1
            let n = 1 + one - 1 + other - 1;
            let (mut matrix, mut first) = (vec![0.0; n * n], 1);
            for [onward, back] in &rows {
                let place = |i: usize| if i == 0 { 0 } else { first + i - 1 };
                for i in 0..onward.len() {
                    let (here, forward) = (place(i), libm::exp(onward[i]));
                    matrix[here * n + here] += forward;
                    if i + 1 < onward.len() {
                        matrix[here * n + place(i + 1)] -= forward;
                        let returns = libm::exp(back[i]);
                        matrix[place(i + 1) * n + place(i + 1)] += returns;
                        matrix[place(i + 1) * n + here] -= returns;
                    }
                }
                first += onward.len() - 1;
            }
            let times = solve_dense(&matrix, &vec![1.0; n], n).unwrap();
            let found = first_passage_by_either(rows.each_ref().map(|row| row.each_ref().map(|k| &k[..])));
            assert!((found - libm::log(times[0])).abs() < 1e-10, "{one} {other}: {found} {}", libm::log(times[0]));
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
