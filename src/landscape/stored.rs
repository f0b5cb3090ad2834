//! What was computed here, as taken over from a record: checked, so that a run goes on with numbers that it can bear, and with all
//! that follows from what is stored.

use super::{Minimum, Pass, Peak, Saddle};
use crate::energy::{Evaluator, Stored};
use crate::record::MOST;
use crate::spins::{Spins, are_unit};
use crate::stationary::{Refined, Spectrum, State};
use std::sync::Arc;

/// Largest size of a number that is computed with.
const LARGEST: f64 = 1e100;

/// Numbers that are some, and whose squares are.
pub fn are_finite(numbers: &[f64]) -> bool {
    numbers.iter().all(|x| x.abs() <= LARGEST)
}

/// How often things were done.
pub fn are_counts(counts: &[usize]) -> bool {
    counts.iter().all(|n| *n <= MOST)
}

/// Whether spins are as many as the Hamiltonian's.
pub fn fit(h: Evaluator, spins: &Spins) -> bool {
    spins.sites() == h.sites()
}

/// Whether `m` are so many spins.
fn are_spins(h: Evaluator, m: &[f64]) -> bool {
    m.len() == 3 * h.sites() && are_unit(m)
}

/// Whether `v` may be a unit tangent vector (3N).
fn is_tangent(h: Evaluator, v: &[f64]) -> bool {
    v.len() == 3 * h.sites() && v.iter().all(|x| x.abs() < 2.0)
}

impl Stored for Saddle {
    fn restored(mut self, h: Evaluator) -> Option<Self> {
        let Peak { m, tau, energy_mev, s, image, floor_mev } = &*self.top;
        let Refined { state, valley, spectrum } = Arc::make_mut(&mut self.refined);
        let is_sound = are_spins(h, m)
            && are_spins(h, &state.m)
            && is_tangent(h, tau)
            && is_tangent(h, valley)
            && are_finite(&[*energy_mev, *s])
            && !floor_mev.is_nan()
            && are_counts(&[*image]);
        is_sound.then_some(())?;
        *state = State::at(h, std::mem::take(&mut state.point.m));
        *spectrum = spectrum.take().restored(h)?;
        Some(self)
    }
}

impl Stored for Spectrum {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let Spectrum { negative, flat, zero, floor_mev, norm_mev, lowest_mev, bound } = &self;
        let is_sound = are_counts(&[*negative, *flat, *zero])
            && are_finite(&[*floor_mev, *norm_mev])
            && are_finite(lowest_mev)
            && bound.is_none_or(|bound| bound.part.is_finite());
        is_sound.then_some(self)
    }
}

impl Stored for Minimum {
    fn restored(self, h: Evaluator) -> Option<Self> {
        let is_sound = fit(h, &self.spins) && are_finite(&[self.energy_mev, self.max_torque_mev]);
        is_sound.then_some(())?;
        Some(Minimum { spectrum: self.spectrum.restored(h)?, ..self })
    }
}

impl Stored for Pass {
    fn restored(self, h: Evaluator) -> Option<Self> {
        self.ways.iter().flat_map(|way| way.iter()).all(|spins| fit(h, spins)).then_some(())?;
        Some(Pass {
            saddle: self.saddle.restored(h)?,
            spectrum: self.spectrum.restored(h)?,
            before: self.before.restored(h)?,
            after: self.after.restored(h)?,
            ..self
        })
    }
}
