//! A state relaxed by itself, with what it was before and what kind of state it is now.

use super::ends::{judge_end, torque_mev};
use crate::energy::Evaluator;
use crate::error::Result;
use crate::landscape::Minimum;
use crate::spins::Spins;
use crate::stationary::{RELAXED, Relaxed, relax_to_minimum};
use crate::words::counted;

/// A state before and after it was relaxed.
#[derive(Clone, Debug)]
pub struct RelaxedState {
    /// Energy as given (meV).
    pub given_mev: f64,
    /// Largest component of the force as given (meV).
    pub given_torque_mev: f64,
    /// How it relaxed.
    pub relaxed: Relaxed,
    /// What it is now, with its lowest eigenvalues.
    pub minimum: Minimum,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl RelaxedState {
    /// Converged, and proven to be a minimum, perhaps a flat one.
    pub fn is_proven(&self) -> bool {
        self.relaxed.converged && self.minimum.is_proven()
    }
}

/// Relaxes a state as a run relaxes its ends; `modes` of its eigenvalues are computed, and `which` names it in warnings.
pub fn relaxed_state(h: Evaluator, spins: &Spins, modes: usize, which: &str) -> Result<RelaxedState> {
    let relaxed = relax_to_minimum(h, spins, RELAXED * h.stiffness_mev())?;
    let minimum = Minimum::with_modes(h, &relaxed.spins, modes);
    let mut warnings = judge_end(h, &relaxed, which);
    let s = &minimum.spectrum;
    if s.negative > 0 {
        let down = counted(s.negative, "direction leads", "directions lead");
        warnings.push(format!("the {which} state is no minimum: {down} down from it"));
    }
    if s.flat > 0 {
        let modes = if s.flat == 1 { "mode is".into() } else { format!("{} modes are", s.flat) };
        warnings
            .push(format!("the {which} state is flat to {:.1e} meV: {modes} below the rounding error", s.floor_mev));
    }
    Ok(RelaxedState {
        given_mev: h.energy_mev(spins.as_slice()),
        given_torque_mev: torque_mev(h, spins),
        minimum,
        relaxed,
        warnings,
    })
}
