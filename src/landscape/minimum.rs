//! Minima: what a descent ends in, and whether two of them are the same.

use super::{turned, turns};
use crate::energy::Evaluator;
use crate::field::Components;
use crate::geometry::vector;
use crate::path::{is_within, largest_angle};
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::{FLAT, Relaxed, Spectrum, State, both_by_factors};
use crate::symmetry::Operation;
use serde::{Deserialize, Serialize};

/// A stationary state with its spectrum.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Minimum {
    /// The spins.
    pub spins: Spins,
    /// Total energy (meV).
    pub energy_mev: f64,
    /// Largest component of the Riemannian gradient (meV).
    pub max_torque_mev: f64,
    /// Its modes.
    pub spectrum: Spectrum,
}

impl Minimum {
    /// A relaxed state, examined.
    pub fn examine(h: Evaluator, spins: &Spins) -> Minimum {
        Minimum::with_modes(h, spins, 0)
    }

    /// What a relaxation ended in, its modes counted if they were not.
    pub fn of(h: Evaluator, relaxed: &Relaxed) -> Minimum {
        let Relaxed { spins, max_torque_mev, spectrum, .. } = relaxed;
        let Some(spectrum) = spectrum.clone() else { return Minimum::examine(h, spins) };
        let (energy_mev, max_torque_mev) = (h.energy_mev(spins.as_slice()), *max_torque_mev);
        Minimum { energy_mev, max_torque_mev, spectrum, spins: spins.clone() }
    }

    /// Two of them.
    pub fn of_both(h: Evaluator, [a, b]: &[Relaxed; 2]) -> [Minimum; 2] {
        both_by_factors(&h, || Minimum::of(h, a), || Minimum::of(h, b)).into()
    }

    /// The same with so many of its lowest eigenvalues.
    pub fn with_modes(h: Evaluator, spins: &Spins, count: usize) -> Minimum {
        let state = State::at(h, spins.as_slice().to_vec());
        Minimum {
            energy_mev: h.energy_mev(&state.m),
            max_torque_mev: state.max_torque_mev(),
            spectrum: Spectrum::of(h, &state, count),
            spins: spins.clone(),
        }
    }

    /// Stationary, and without a negative direction.
    pub fn is_proven(&self) -> bool {
        self.spectrum.negative == 0 && self.spectrum.is_stationary(self.max_torque_mev)
    }

    /// Whether `other` is this minimum, or one along a valley that is flat as far as double precision tells: the same energy.
    pub fn is_same(&self, h: Evaluator, other: &Minimum) -> bool {
        if self.is_identical(h, other) {
            return true;
        }
        let noise = FLAT * h.stiffness_mev();
        let both_flat = self.spectrum.flat > 0 && other.spectrum.flat > 0;
        both_flat && h.difference_mev(self.spins.as_slice(), other.spins.as_slice()).abs() < noise
    }

    /// Whether `other` has the same spins, perhaps after a rotation about the symmetry axes.
    pub fn is_identical(&self, h: Evaluator, other: &Minimum) -> bool {
        is_same_state(h, self.spins.as_slice(), other.spins.as_slice())
    }

    /// Whether a rotation about the symmetry axes makes `other` of this minimum.
    pub fn is_turned(&self, h: Evaluator, other: &Minimum) -> bool {
        is_turned(h, &self.spins, &other.spins)
    }

    /// What a symmetry of the energy makes of it.
    pub fn image(&self, operation: &Operation) -> Minimum {
        let spins = Spins::from_unit_components(&operation.apply(self.spins.as_slice()));
        Minimum { spins, spectrum: self.spectrum.clone(), ..*self }
    }
}

/// Whether two states have the same spins, perhaps after a rotation about the symmetry axes.
pub fn is_same_state(h: Evaluator, a: &[f64], b: &[f64]) -> bool {
    let (p, q) = (Components::new(a), Components::new(b));
    if is_within(a, b, SAME) {
        return true;
    }
    // what a rotation about the axis leaves as it is tells most states apart
    match h.symmetry_axes() {
        [] => false,
        [axis] if (0..h.sites()).any(|i| vector::dot(*axis, vector::sub(p.get(i), q.get(i))).abs() > SAME) => false,
        _ => is_turned(h, &Spins::from_unit_components(a), &Spins::from_unit_components(b)),
    }
}

fn is_turned(h: Evaluator, a: &Spins, b: &Spins) -> bool {
    let turn = turns(h, b, a);
    !turn.is_empty() && largest_angle(a.as_slice(), turned(b, &turn).as_slice()) < SAME
}
