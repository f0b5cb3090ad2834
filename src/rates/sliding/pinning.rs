//! The energy along a soft valley from a place to the next, and the integral over it.
//!
//! ```text
//! E(x) = ½ A (1 − cos 2πx) + ½ B (1 − cos 4πx),   A: the top between two places,   A + 4B = U: the curvature of a cosine of height U
//! ```
//! A state that is wide against its lattice has A = U. A narrow one is held flatly and has a higher top.

use std::f64::consts::PI;

/// What a place costs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinning {
    /// U (meV), from the curvature.
    pub curved_mev: f64,
    /// A (meV), the top between two places.
    pub top_mev: f64,
}

impl Pinning {
    /// From the stiffness (meV) along a valley, the spins turning by `hop` from a place to the next, and the energy half-way (meV): less
    /// than half of U would be a place of its own there.
    pub fn new(stiffness_mev: f64, hop: f64, top_mev: f64) -> Pinning {
        let curved_mev = stiffness_mev * hop * hop / (2.0 * PI * PI);
        Pinning { curved_mev, top_mev: top_mev.max(0.5 * curved_mev) }
    }

    /// k_BT (meV) below which the state is held in a place as by a harmonic well, U (U/A)³: of a cosine that is U, where the harmonic
    /// integral is wrong by 14 %; under a higher top it fails sooner, by (3A − 4U) k_BT/4U², and is left sooner.
    pub fn loosens_mev(&self) -> f64 {
        let Pinning { curved_mev, top_mev } = *self;
        if curved_mev > 0.0 { curved_mev * (curved_mev / curved_mev.max(top_mev)).powi(3) } else { 0.0 }
    }

    /// ln of ∫₀¹ e^(−E/k_BT) dx at a k_BT (meV), by points so dense that the rule is exact to rounding.
    pub fn ln_mean(&self, thermal_mev: f64) -> f64 {
        let [one, two] = [self.top_mev, 0.25 * (self.curved_mev - self.top_mev)].map(|mev| mev / thermal_mev);
        let points = 32 + (12.0 * (one.abs() + 4.0 * two.abs()).sqrt()) as usize;
        let part = |k: usize| {
            let x = PI * (k as f64 + 0.5) / points as f64;
            let [slow, fast] = [libm::sin(x), libm::sin(2.0 * x)];
            libm::exp(-one * slow * slow - two * fast * fast)
        };
        libm::log((0..points).map(part).sum::<f64>() / points as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pinned_mode_is_free_when_hot_and_a_well_when_cold() {
        // e^(−u) I₀(u): tables of M. Abramowitz, I. A. Stegun (1964), 9.8
        for (u, expected) in [(1.0, 0.465_759_607_593_640_4), (5.0, 0.183_540_812_609_328_37), (0.0, 1.0)] {
            let pinning = Pinning { curved_mev: 2.0 * u, top_mev: 2.0 * u };
            assert!((libm::exp(pinning.ln_mean(1.0)) - expected).abs() < 1e-15, "{u}");
        }
        // a well of curvature ε = U (2π)²/2 in each period, whatever the top
        for top_mev in [2.6e4, 5e4, 1.5e5] {
            let (pinning, thermal) = (Pinning { curved_mev: 5e4, top_mev }, 1.0);
            let well = 0.5 * libm::log(2.0 * PI * thermal / (2.0 * PI * PI * pinning.curved_mev));
            assert!((pinning.ln_mean(thermal) - well).abs() < 2e-4, "{top_mev}");
        }
    }

    #[test]
    fn where_a_state_is_held_the_integral_is_near_that_of_a_harmonic_well() {
        for (curved_mev, top_mev) in [(1.0, 1.0), (1.0, 1.5), (1.0, 3.0), (0.2, 1.2)] {
            let pinning = Pinning { curved_mev, top_mev };
            let thermal = pinning.loosens_mev();
            let well = 0.5 * libm::log(2.0 * PI * thermal / (2.0 * PI * PI * curved_mev));
            assert!((pinning.ln_mean(thermal) - well).abs() < 0.14, "{curved_mev} {top_mev}");
        }
    }
}
