//! Rates: how long a state lives, from a saddle and the minima beside it.
//!
//! Each spin obeys the Landau–Lifshitz–Gilbert equation; in tangent coordinates v near a stationary state
//!
//! ```text
//! dv/dt = −Γ (α + R) H v /(1 + α²)      Γ_i = γ/μ_i = g/(ħ n_i) for a moment of n_i μ_B, α the damping, R v = m × v
//! ```
//! with the Riemannian Hessian H (meV). Both theories are a frequency, an entropy factor and Arrhenius' exponential:
//!
//! ```text
//! k = ω/2π · √(det'H_m/|det'H_s|) · V_s/V_m · (2πk_BT)^((P_m − P_s)/2) · e^(−ΔE/k_BT)
//! HTST     ω = √(|λ₁| wᵀH_s w),  w_i = Γ_i m_i × e₁,i     e₁, λ₁: the saddle's descending mode
//! Langer   ω = λ₊, the one growth rate of the linearised equation at the saddle
//! ```
//! A prime leaves out P zero modes, which enter with the volume V (rad^P) of the set of states that they sweep: det' is the limit
//! of a bordered determinant, not a determinant divided by a small number. Frozen spins drop out.
//!
//! Harmonic transition-state theory (HTST) of spins: P. F. Bessarab, V. M. Uzdin, H. Jónsson, Phys. Rev. B 85, 184409 (2012),
//! doi:10.1103/PhysRevB.85.184409; determinants of chains in O(N): I. S. Lobanov, V. M. Uzdin, Comput. Phys. Commun. 269, 108136
//! (2021), arXiv:2008.06754; Langer's theory of intermediate to high damping: J. S. Langer, Ann. Phys. 54, 258 (1969),
//! doi:10.1016/0003-4916(69)90153-5; for spins H. B. Braun, J. Appl. Phys. 76, 6310 (1994), doi:10.1063/1.358269. HTST counts
//! every crossing of the plane normal to e₁, also those that turn back: without damping it is an upper bound, far above the rate on
//! plateaus. Langer's needs a bath that keeps up with the crossings: with α ΔE/k_BT below about three it is too large. Below
//! ΔE = k_BT nothing holds a state back, and there is no rate ([`LEAST_BARRIER`]).
//!
//! The moments are classical. With the saddle comes the temperature at which tunnelling through the barrier takes over, see
//! [`SaddleRate::crossover_k`].

mod bordered;
mod crossover;
mod determinant;
mod growth;
mod passage;
mod rate;
mod refusal;
mod settings;
mod siblings;
mod sliding;
mod switches;
mod symmetry;
#[cfg(test)]
pub mod test_rates;
mod transition;
mod unstable;
mod validity;
mod wells;
mod zero_modes;

pub use crossover::crossover_temperature;
pub use determinant::log_determinant;
pub use growth::growth_rate;
pub use passage::{TEN_YEARS_S, blocking_temperature, first_passage, passages};
pub use rate::{Crossing, LEAST_BARRIER, Prefactor, Regime, Row, SaddleRate, Way, refused, saddle_rates};
pub use refusal::{Refusal, UnknownModes};
pub use settings::{RateSettings, Theory, checked_damping, checked_g_factor, checked_temperature};
pub use siblings::{Family, Kin, Sibling, Siblings, Symmetry};
pub use sliding::{Pinning, Turn};
pub use symmetry::{
    APART, Equivalents, KEPT, KEPT_OR_EXCHANGED, OneState, equivalent_saddles, leads_back_by, may_slide_to,
};
pub use transition::{Kindred, NetworkTime, Orbits, TransitionRate, TransitionRow, transitions};
pub use unstable::{Unstable, unstable_mode};
pub use validity::{LOW_BARRIER, ORDER, Validity, digits};
pub use zero_modes::{ZeroKind, ZeroModes};
use zero_modes::{ln_cut, zero_modes};

/// Everything about the rates of a path.
#[derive(Clone, Debug, PartialEq)]
pub struct Rates {
    /// What was asked for.
    pub settings: RateSettings,
    /// Each saddle, forward and backward, in path order.
    pub saddles: Vec<SaddleRate>,
    /// The whole path, forward and backward.
    pub transitions: Vec<TransitionRate>,
}

impl Rates {
    /// What the rates over a saddle are made of at the first temperature, where results tell it.
    pub fn told<'a>(&self, rate: &'a SaddleRate) -> &'a Regime {
        rate.at(self.settings.first_k())
    }
}
