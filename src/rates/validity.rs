//! Where the numbers are rough: low barriers, large fluctuations, flat tops, weak damping; with the range that each leaves.
//!
//! Each is a factor above 1 at any temperature ([`Validity`]), near 1 where it does not matter; together, their logarithms added as
//! squares, they are the range within which a rate is known, and say how many of its digits are worth showing. Words are made of a factor only where it matters.

use super::determinant::PinnedHessian;
use super::{Prefactor, RateSettings, Regime, Unstable};
use crate::energy::Hamiltonian;
use crate::lattice::Lattice;
use crate::stationary::State;
use crate::units::K_B;
use std::f64::consts::PI;

/// Barriers below so many k_BT are low.
pub const LOW_BARRIER: f64 = 5.0;
/// A mean square deviation of a spin (rad²) from which the harmonic approximation is rough.
pub(super) const LARGE: f64 = 0.3;
/// A relative error of the descending curvature that is worth a word.
const VAGUE: f64 = 1e-6;
/// A part of a rate that is worth a word.
const UNEVEN: f64 = 0.05;
/// Damping times ΔE/k_BT below which the bath feeds energy slowly.
const WEAK: f64 = 3.0;

/// A mode that reaches round the sphere leaves the order of magnitude, if that.
pub const ORDER: f64 = 10.0;
/// Most digits of a rate that are shown.
const MOST_DIGITS: usize = 4;

/// What the errors of a rate hang on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// ΔE (meV).
    pub barrier_mev: f64,
    /// Gilbert damping, where the rate is Langer's.
    pub damping: Option<f64>,
    /// ln of the rate by HTST over Langer's, where there are both.
    pub ln_htst_over_langer: Option<f64>,
    /// About the minimum.
    pub minimum: Fluctuations,
    /// About the saddle.
    pub saddle: Fluctuations,
    /// Rounding error of the descending curvature, relative to it.
    pub vague: f64,
    /// By how much ½ ln|det'H| differs round the turns along which the states slide.
    pub uneven: f64,
}

impl Validity {
    /// ln of the factor within which the rate is known at a temperature (K); infinite where nothing is known.
    pub fn ln_factor(&self, temperature_k: f64) -> f64 {
        let thermal = K_B * temperature_k;
        let low = thermal / self.barrier_mev.max(0.0);
        // what the bath must feed is ΔE or k_BT, whichever is more
        let weak = self.damping.map_or(0.0, |a| thermal / (a * self.barrier_mev.max(thermal)));
        let spread = [self.minimum, self.saddle].map(|f| f.factor(thermal));
        let factors = [1.0 + low, 1.0 + weak, spread[0], spread[1], self.top(thermal), 1.0 + 0.5 * self.vague];
        let squares = factors.into_iter().map(|f| libm::log(f) * libm::log(f)).sum::<f64>();
        (squares + self.uneven * self.uneven).sqrt()
    }

    /// What a top that is flat over k_BT leaves: no more than lies between the two theories.
    fn top(&self, thermal_mev: f64) -> f64 {
        let square = self.saddle.top_per_mev * thermal_mev;
        let open = if square < LARGE { 1.0 + square } else { (square / LARGE).sqrt().max(1.0 + LARGE) };
        let between = self.ln_htst_over_langer.filter(|ln| *ln > 0.0).map_or(f64::INFINITY, libm::exp);
        open.min(between)
    }
}

/// How many digits of a number are known within this factor; one where there is none.
pub fn digits(known_within: Option<f64>) -> usize {
    let error = known_within.map_or(1.0, |factor| (factor - 1.0).max(1e-12));
    (-libm::log10(error)).ceil().clamp(1.0, MOST_DIGITS as f64) as usize
}

/// Thermal fluctuations of the spins about a stationary state, per k_BT.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fluctuations {
    /// Largest mean square angle of the probed spins over k_BT (rad²/meV), zero modes and the descending mode apart.
    pub mean_square_per_mev: f64,
    /// Largest square of a spin's part in the descending mode over its |curvature| (rad²/meV); 0 at a minimum.
    pub top_per_mev: f64,
}

impl Fluctuations {
    /// What modes that are not harmonic leave: wrong by terms of the order of σ², one that is free by σ over its true extent.
    fn factor(&self, thermal_mev: f64) -> f64 {
        let angle = (thermal_mev * self.mean_square_per_mev).sqrt();
        // what goes round the sphere has less room than the harmonic integral counts, by as many times
        if angle < PI { 1.0 + angle.min(angle * angle) } else { ORDER * angle / PI }
    }

    /// About a minimum.
    pub fn of_minimum(h: &Hamiltonian, state: &State, pinned: &PinnedHessian, unstable: &Unstable) -> Fluctuations {
        let around = probes(h, unstable).into_iter().map(|i| mean_square(state, pinned, i));
        Fluctuations { mean_square_per_mev: around.fold(0.0, f64::max), top_per_mev: 0.0 }
    }

    /// About a saddle.
    pub fn of_saddle(h: &Hamiltonian, state: &State, pinned: &PinnedHessian, unstable: &Unstable) -> Fluctuations {
        let own = |i: usize| part(&unstable.mode, i) / -unstable.eigenvalue_mev;
        let around = probes(h, unstable).into_iter().map(|i| mean_square(state, pinned, i));
        let top = (0..h.sites()).map(own).fold(0.0, f64::max);
        Fluctuations { mean_square_per_mev: around.fold(0.0, f64::max), top_per_mev: top }
    }
}

/// |v_i|² of a tangent vector on a site.
fn part(v: &[f64], i: usize) -> f64 {
    v[2 * i] * v[2 * i] + v[2 * i + 1] * v[2 * i + 1]
}

/// A few sites: the ends, the middle, and where the descending mode is largest.
fn probes(h: &Hamiltonian, unstable: &Unstable) -> Vec<usize> {
    let n = h.sites();
    let largest = (0..n).fold(0, |b, i| if part(&unstable.mode, i) > part(&unstable.mode, b) { i } else { b });
    let mut sites = vec![0, n / 2, n - 1, largest];
    sites.sort_unstable();
    sites.dedup();
    sites.retain(|i| !h.is_frozen(*i));
    sites
}

/// tr (H⁻¹)_ii: the mean square angle of spin i over k_BT (rad²/meV), zero modes apart.
fn mean_square(state: &State, pinned: &PinnedHessian, i: usize) -> f64 {
    let entry = |a: usize| {
        let mut x = vec![0.0; state.slope.len()];
        x[2 * i + a] = 1.0;
        pinned.solve(&mut x);
        x[2 * i + a]
    };
    entry(0) + entry(1)
}

/// What a user should know about the rates out of one minimum, as they are at the highest temperature.
pub fn warnings(settings: &RateSettings, barrier_mev: f64, at: &Regime) -> Vec<String> {
    let (htst, langer) = (at.htst, at.langer);
    let Some(Validity { minimum, saddle, vague, uneven, .. }) = &at.validity else { return Vec::new() };
    let hottest = settings.hottest_k();
    let said = [
        low_barrier(barrier_mev, hottest),
        large_fluctuations("minimum", minimum, hottest),
        large_fluctuations("saddle", saddle, hottest),
        flat_top(saddle, hottest, htst, langer),
        weak_damping(settings, barrier_mev, langer),
        vague_curvature(*vague, langer),
        uneven_turn(*uneven),
    ];
    said.into_iter().flatten().collect()
}

fn low_barrier(barrier_mev: f64, hottest: f64) -> Option<String> {
    let from = barrier_mev / (LOW_BARRIER * K_B);
    let delta = barrier_mev / (K_B * hottest);
    let range = match delta >= 1.0 {
        true => format!("the rate is known within a factor of about {:.2}", 1.0 + 1.0 / delta),
        false => "nothing holds the state back, and there is no rate".into(),
    };
    (hottest > from).then(|| {
        format!(
            "above {} the barrier is below {LOW_BARRIER} k_BT: the theories leave out terms of the order of k_BT/ΔE, so at \
             {hottest} K (ΔE = {delta:.2} k_BT) {range}",
            kelvin(from)
        )
    })
}

fn large_fluctuations(which: &str, spread: &Fluctuations, hottest: f64) -> Option<String> {
    let from = LARGE / (K_B * spread.mean_square_per_mev.max(1e-300));
    let angle = (K_B * hottest * spread.mean_square_per_mev).sqrt();
    let range = match angle < PI {
        true => format!("within a factor of about {:.2}", spread.factor(K_B * hottest)),
        false => format!(
            "no better than within a factor of about {:.0}, if at all: a mode reaches round the sphere",
            spread.factor(K_B * hottest)
        ),
    };
    (hottest > from).then(|| {
        format!(
            "above {} a spin of the {which} fluctuates by more than {:.2} rad: its softest modes are not harmonic; at \
             {hottest} K ({angle:.2} rad as if they were) the rate is known {range}",
            kelvin(from),
            LARGE.sqrt()
        )
    })
}

fn flat_top(saddle: &Fluctuations, hottest: f64, htst: Option<Prefactor>, langer: Option<Prefactor>) -> Option<String> {
    let from = LARGE / (K_B * saddle.top_per_mev.max(1e-300));
    let range = match (htst.map(|p| p.ln_hz), langer.map(|p| p.ln_hz)) {
        (Some(h), Some(l)) if h > l => {
            format!(": the rate lies between Langer's and that of HTST, {:.3} times it", libm::exp(h - l))
        }
        (_, Some(_)) => {
            let factor = (saddle.top_per_mev * K_B * hottest / LARGE).sqrt();
            format!(": Langer's rate may be too small by a factor of up to about {factor:.2} at {hottest} K")
        }
        _ => ": HTST counts every return over it, and may be far above the rate".into(),
    };
    (hottest > from)
        .then(|| format!("above {} the top of the path is flat over what k_BT can climb{range}", kelvin(from)))
}

/// Langer's rate goes with the root of the descending curvature, which may be little more than rounding.
fn vague_curvature(vague: f64, langer: Option<Prefactor>) -> Option<String> {
    langer.filter(|_| vague > VAGUE)?;
    Some(format!(
        "the curvature of the descending mode is known to {:.1e} of itself only, and Langer's rate to half of that",
        vague
    ))
}

/// The product of the modes across a turn is taken where the state stands.
fn uneven_turn(uneven: f64) -> Option<String> {
    (uneven > UNEVEN).then(|| {
        format!(
            "a state turns without cost, but the modes across its turn are not alike all round, and the rate is made of those where it \
             stands: it is known within a factor of {:.2}",
            libm::exp(uneven)
        )
    })
}

/// The spin waves of a film or a body have ever more room for entropy the smaller its cells are (those of a wire have not).
pub(super) fn of_cells(lattice: &Lattice) -> Option<String> {
    let directions = lattice.grid.size.iter().filter(|cells| **cells > 1).count();
    (lattice.sections_nm.is_some() && directions > 1).then(|| {
        format!(
            "the prefactor counts the spin waves of {} cells, and changes with their size; A, K and Ms as measured at a temperature \
             hold the part of these waves already",
            lattice.sites
        )
    })
}

/// A temperature in a few digits.
pub(super) fn kelvin(t: f64) -> String {
    if t < 0.01 { format!("{t:.1e} K") } else { format!("{t:.4} K") }
}

/// Langer's rate needs a bath that makes good, between two attempts, the energy that a crossing takes. Where α ΔE/k_BT is small it
/// does not, and the rate falls with α; α Δ/(1 + α Δ) is what is left of it, roughly, between the two limits (for one spin with
/// K_hard = 2 K the true factor is 0.48 at α Δ = 0.4 and 0.79 at 1: example 04).
fn weak_damping(settings: &RateSettings, barrier_mev: f64, langer: Option<Prefactor>) -> Option<String> {
    langer?;
    let (coldest, hottest) = (settings.coldest_k(), settings.hottest_k());
    let at = |t: f64| settings.damping * barrier_mev / (K_B * t);
    (at(hottest) < WEAK).then(|| {
        let from = (settings.damping * barrier_mev / (WEAK * K_B)).max(coldest);
        let left = at(hottest) / (1.0 + at(hottest));
        format!(
            "from {} on, damping times ΔE/k_BT is below {WEAK}: the bath feeds energy slowly, and the rate lies between \
             Langer's and, at {hottest} K, about {left:.3} times that",
            kelvin(from)
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_many_digits_are_shown_as_the_known_error_leaves() {
        let shown = [1.0, 1.0004, 1.004, 1.03, 1.3, 2.0, 50.0].map(|factor| digits(Some(factor)));
        assert_eq!(shown, [4, 4, 3, 2, 1, 1, 1]);
        assert_eq!(digits(None), 1);
    }

    #[test]
    fn a_rate_is_known_the_better_the_colder_and_not_at_all_without_a_bath() {
        let calm = Fluctuations { mean_square_per_mev: 0.01, top_per_mev: 0.02 };
        let at = |damping, kelvin: f64| {
            let both = Some(0.2);
            let validity = Validity {
                barrier_mev: 50.0,
                damping,
                ln_htst_over_langer: both,
                minimum: calm,
                saddle: calm,
                vague: 0.0,
                uneven: 0.0,
            };
            libm::exp(validity.ln_factor(kelvin))
        };
        let kelvin = 1.0 / K_B;
        // 1/Δ, 1/(αΔ), two times σ² and the top's own square, by hand
        let parts = [1.02, 1.2, 1.01, 1.01, 1.02f64].map(|f| f.ln().powi(2));
        let expected = parts.iter().sum::<f64>().sqrt().exp();
        assert!((at(Some(0.1), kelvin) / expected - 1.0).abs() < 1e-12);
        assert!(at(Some(0.1), 0.5 * kelvin) < expected && at(None, kelvin) < expected);
        assert_eq!(at(Some(0.0), kelvin), f64::INFINITY);
        // a flat top costs no more than lies between the two theories: at 200 meV its own square is 4
        let hot = [5.0, 1.0 + 2f64.sqrt(), 1.0 + 2f64.sqrt(), libm::exp(0.2)].map(|f| f.ln().powi(2));
        assert!((at(None, 200.0 * kelvin) / hot.iter().sum::<f64>().sqrt().exp() - 1.0).abs() < 1e-12);
    }
}
