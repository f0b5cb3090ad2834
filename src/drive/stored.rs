//! What the computations of a run result in, as taken over from a record: checked, so that the run goes on with numbers that it can
//! bear, and with all that follows from what is stored.

use super::climb::Found;
use super::ends::{Relaxed, WayDown};
use super::minimum::{Link, Minimum};
use super::outcome::HistoryRow;
use super::recorded::Stored;
use super::top::Top;
use super::{Scales, Stop};
use crate::energy::Evaluator;
use crate::path::Path;
use crate::record::MOST;
use crate::spins::{Spins, are_unit};
use crate::stationary::{Refined, Spectrum, State};

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
fn fit(h: Evaluator, spins: &Spins) -> bool {
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

impl<T: Stored> Stored for Vec<T> {
    fn restored(self, h: Evaluator) -> Option<Self> {
        self.into_iter().map(|one| one.restored(h)).collect()
    }
}

impl Stored for [Relaxed; 2] {
    fn restored(self, h: Evaluator) -> Option<Self> {
        let is_sound = |end: &Relaxed| {
            let left = end.left.as_ref().is_none_or(|WayDown { site, .. }| *site < h.sites());
            fit(h, &end.spins) && are_finite(&[end.max_torque_mev]) && are_counts(&[end.steps]) && left
        };
        self.iter().all(is_sound).then_some(self)
    }
}

impl Stored for Scales {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let Scales { stiffness_mev, exchange_mev, wall_width_sites } = self;
        (stiffness_mev > 0.0 && are_finite(&[stiffness_mev, exchange_mev, wall_width_sites])).then_some(self)
    }
}

impl Stored for Found {
    fn restored(mut self, h: Evaluator) -> Option<Self> {
        let Found { top: Top { m, tau, energy_mev, s, image }, refined } = &mut self;
        let Refined { state, valley, steps, factorisations, index, .. } = refined;
        let is_sound = are_spins(h, m)
            && are_spins(h, &state.m)
            && is_tangent(h, tau)
            && is_tangent(h, valley)
            && are_finite(&[*energy_mev, *s])
            && are_counts(&[*image, *steps, *factorisations, *index]);
        is_sound.then_some(())?;
        *state = State::at(h, std::mem::take(&mut state.point.m));
        Some(self)
    }
}

impl Stored for Spectrum {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let Spectrum { negative, flat, zero, floor_mev, norm_mev, lowest_mev } = &self;
        let is_sound =
            are_counts(&[*negative, *flat, *zero]) && are_finite(&[*floor_mev, *norm_mev]) && are_finite(lowest_mev);
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

impl Stored for Link {
    fn restored(self, h: Evaluator) -> Option<Self> {
        self.ways.iter().flatten().all(|spins| fit(h, spins)).then_some(())?;
        Some(Link {
            found: self.found.restored(h)?,
            spectrum: self.spectrum.restored(h)?,
            before: self.before.restored(h)?,
            after: self.after.restored(h)?,
            ..self
        })
    }
}

impl Stored for Path {
    fn restored(self, h: Evaluator) -> Option<Self> {
        (self.sites() == h.sites()).then_some(self)
    }
}

impl Stored for Stop {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let is_sound = match self {
            Stop::Converged { rotation, tolerance } => are_finite(&[rotation, tolerance]),
            Stop::MaxEvaluations { evaluations, rotation, tolerance }
            | Stop::Stalled { evaluations, rotation, tolerance } => {
                are_counts(&[evaluations]) && are_finite(&[rotation, tolerance])
            }
            Stop::NotFinite => true,
        };
        is_sound.then_some(self)
    }
}

impl Stored for HistoryRow {
    fn restored(self, _: Evaluator) -> Option<Self> {
        are_counts(&[self.iteration, self.images]).then_some(self)
    }
}
