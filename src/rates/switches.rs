//! What a change from one description of a state to another leaves open: held in one place, or sliding over all of them.
//!
//! ```text
//! J = ln Z_s/Z_m above T_s − ln Z_s/Z_m below it       at the temperature T_s of the change, over all saddles that the rate is over
//! Σ |J| min(T/T_s, T_s/T)                              so much more is open at T
//! ```
//! Below T_s the well is wrong by terms of the order of k_BT/U, above it the valley by U/k_BT, U what a place costs. Where both are good J is
//! small (14 % for a valley that is a cosine). Not so where the place next to a saddle's is another of its kind, nearer than a shift makes,
//! or where more of the way between two places is low than its curvature and its top tell. Frequencies are judged by the bath.

use super::Regime;
use std::f64::consts::PI;

/// ln of the factor that changes among regimes, by ascending temperature, leave open at one (K).
pub fn ln_open(regimes: &[Regime], temperature_k: f64) -> f64 {
    let change = |pair: &[Regime]| {
        let from_k = pair[1].above_k;
        let [below, above] = [&pair[0], &pair[1]].map(|regime| ln_states(regime, from_k));
        let near = (temperature_k / from_k).min(from_k / temperature_k);
        above.zip(below).map_or(0.0, |(above, below)| (above - below).abs() * near)
    };
    regimes.windows(2).map(change).sum()
}

/// ln of the states of all saddles over those of the minimum at a temperature (K), a place of the other minimum each; nothing without rates.
fn ln_states(regime: &Regime, temperature_k: f64) -> Option<f64> {
    let prefactor = regime.htst.or(regime.langer)?;
    let ln_frequency = libm::log(prefactor.frequency_per_s / (2.0 * PI));
    Some(prefactor.ln_hz_at(temperature_k) - ln_frequency + regime.ln_saddles(temperature_k)[0] - regime.ln_targets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rates::test_rates::both;

    #[test]
    fn what_two_descriptions_differ_by_is_open_on_both_sides_of_the_change_and_less_far_from_it() {
        let [held, sliding] = [25.0, 25.7].map(|ln_hz| both(0, ln_hz, [20.0; 2], [false; 2])[0].regimes[0].clone());
        let mut regimes = [held, Regime { above_k: 4.0, ..sliding }];
        for (kelvin, part) in [(4.0, 1.0), (2.0, 0.5), (8.0, 0.5), (0.04, 0.01)] {
            assert!((ln_open(&regimes, kelvin) - 0.7 * part).abs() < 1e-12, "{kelvin}");
        }
        // more places of the other minimum are no error
        regimes[1].ln_targets = 0.7;
        assert!(ln_open(&regimes, 4.0) < 1e-12);
        assert_eq!(ln_open(&regimes[..1], 4.0), 0.0);
    }
}
