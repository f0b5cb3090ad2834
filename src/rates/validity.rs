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
/// How many times Langer's rate may be too large for want of damping before it is worth a word.
const WEAK: f64 = 4.0 / 3.0;

/// A mode that reaches round the sphere leaves the order of magnitude, if that.
pub const ORDER: f64 = 10.0;
/// Most digits of a rate that are shown.
const MOST_DIGITS: usize = 4;

/// What the errors of a rate hang on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// ΔE (meV).
    pub barrier_mev: f64,
    /// How the bath feeds the crossings, where the rate is Langer's.
    pub bath: Option<Bath>,
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
    /// ln of the ratio of volumes, saddle over minimum, by the hop to the next place over that by the derivative.
    pub cut: f64,
}

impl Validity {
    /// ln of the factor within which the rate is known at a temperature (K); infinite where nothing is known.
    pub fn ln_factor(&self, temperature_k: f64) -> f64 {
        let thermal = K_B * temperature_k;
        let low = thermal / self.barrier_mev.max(0.0);
        let weak = self.bath.map_or(1.0, |bath| bath.weak(self.barrier_mev, thermal));
        let spread = [self.minimum, self.saddle].map(|f| f.factor(thermal));
        let factors = [1.0 + low, weak, spread[0], spread[1], self.top(thermal), 1.0 + 0.5 * self.vague];
        let squares = factors.into_iter().map(|f| libm::log(f) * libm::log(f)).sum::<f64>();
        (squares + self.uneven * self.uneven + self.cut * self.cut).sqrt()
    }

    /// What a top that is flat over k_BT leaves: no more than lies between the two theories.
    fn top(&self, thermal_mev: f64) -> f64 {
        let open = self.saddle.opens(thermal_mev);
        let between = self.ln_htst_over_langer.filter(|ln| *ln > 0.0).map_or(f64::INFINITY, libm::exp);
        open.min(between)
    }
}

/// How a bath feeds the crossings of a saddle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bath {
    /// α, Gilbert damping.
    pub damping: f64,
    /// √(ω/Γ|λ₁|), at most 1: ω is the frequency at the saddle without damping, Γ|λ₁| that of a spin as stiff across the descent as it
    /// falls along it. The less, the farther a spin precesses along a soft saddle, and the less it loses on its way.
    pub share: f64,
    /// Langer's λ₊ over αΓ|λ₁|/(1 + α²), that of spins that do not precess over the saddle at all.
    pub precesses: f64,
    /// Whether the saddle slides along a turn: λ₊ is that of what precesses past all of its places.
    pub slides: bool,
}

/// By so much may what precesses past all places of a saddle be faster than λ₊ between them, where none costs more than k_BT (one spin,
/// Fokker–Planck: 1.2 at U = 0.2 k_BT, 2 at 0.75 k_BT with little damping).
const PAST_PLACES: f64 = 2.5;

impl Bath {
    /// The same where λ₊ is taken between the places of a saddle, so many times smaller than at one.
    pub fn sliding(self, slower: f64) -> Bath {
        Bath { precesses: slower.min(PAST_PLACES), slides: true, ..self }
    }

    /// How many times Langer's rate may be too large at a k_BT (meV): a bath makes good what a crossing takes between two attempts only
    /// where α ΔE/k_BT is large. 1 + k_BT/(α ΔE √(ω/Γ|λ₁|)) covers one spin with hard axes of 0.02 to 1 times the easy one (Fokker–Planck,
    /// α from 0.005 to 1, ΔE from 12 to 25 k_BT); no less than what does not precess is left.
    fn weak(&self, barrier_mev: f64, thermal_mev: f64) -> f64 {
        let fed = self.damping * barrier_mev.max(thermal_mev) * self.share;
        let most = self.precesses * (1.0 + thermal_mev / barrier_mev.max(thermal_mev));
        (1.0 + thermal_mev / fed).min(most).max(1.0)
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

    /// How many times faster than by its curvature a top may be crossed that is flat over what k_BT climbs; σ² is its spin's square. (One
    /// spin with a quartic term, Fokker–Planck: 1.2 at σ² = 1/8, 1.95 at 1/2, 4.1 at 5/2 and 12.8 at 25.)
    fn opens(&self, thermal_mev: f64) -> f64 {
        let square = self.top_per_mev * thermal_mev;
        (1.0 + 2.0 * square).min((1.0 + 6.6 * square).sqrt())
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
    let Some(Validity { minimum, saddle, vague, uneven, bath, .. }) = &at.validity else { return Vec::new() };
    let hottest = settings.hottest_k();
    let said = [
        low_barrier(barrier_mev, hottest),
        large_fluctuations("minimum", minimum, hottest),
        large_fluctuations("saddle", saddle, hottest),
        flat_top(saddle, hottest, htst, langer),
        weak_damping(settings, barrier_mev, *bath),
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
            let factor = saddle.opens(K_B * hottest);
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

/// Where Langer's rate is too large, because the bath feeds it slowly.
fn weak_damping(settings: &RateSettings, barrier_mev: f64, bath: Option<Bath>) -> Option<String> {
    let bath = bath?;
    let factor = |t: f64| bath.weak(barrier_mev, K_B * t);
    let hottest = settings.hottest_k();
    (factor(hottest) > WEAK).then(|| {
        if bath.slides {
            let most = factor(hottest);
            return format!("the saddle turns freely, past all of its places: the rate lies between Langer's and {most:.2} times that");
        }
        format!(
            "the bath feeds energy slowly where damping times ΔE/k_BT is small: the rate lies between Langer's and, at {hottest} K, about \
             {:.3} times that",
            1.0 / factor(hottest)
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
        let at = |damping: Option<f64>, kelvin: f64| {
            let both = Some(0.2);
            let validity = Validity {
                barrier_mev: 50.0,
                bath: damping.map(|damping| Bath { damping, share: 1.0, precesses: f64::INFINITY, slides: false }),
                ln_htst_over_langer: both,
                minimum: calm,
                saddle: calm,
                vague: 0.0,
                uneven: 0.0,
                cut: 0.0,
            };
            libm::exp(validity.ln_factor(kelvin))
        };
        let kelvin = 1.0 / K_B;
        // 1/Δ, 1/(αΔ), two times σ² and twice the top's own square, by hand
        let parts = [1.02, 1.2, 1.01, 1.01, 1.04f64].map(|f| f.ln().powi(2));
        let expected = parts.iter().sum::<f64>().sqrt().exp();
        assert!((at(Some(0.1), kelvin) / expected - 1.0).abs() < 1e-12);
        assert!(at(Some(0.1), 0.5 * kelvin) < expected && at(None, kelvin) < expected);
        assert_eq!(at(Some(0.0), kelvin), f64::INFINITY);
        // a flat top costs no more than lies between the two theories: at 200 meV its own square is 4
        let hot = [5.0, 1.0 + 2f64.sqrt(), 1.0 + 2f64.sqrt(), libm::exp(0.2)].map(|f| f.ln().powi(2));
        assert!((at(None, 200.0 * kelvin) / hot.iter().sum::<f64>().sqrt().exp() - 1.0).abs() < 1e-12);
    }
}
