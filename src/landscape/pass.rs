//! Saddles with the minima on their two sides.

use super::{Doubt, Minimum, Saddle};
use crate::energy::{Evaluator, recorded};
use crate::error::Result;
use crate::linalg::slab;
use crate::rates::{Crossing, RateSettings, SaddleRate, Symmetry, saddle_rates};
use crate::spins::Spins;
use crate::stationary::{
    Downhill, RELAXED, ROUGHLY, Refined, Spectrum, descend, lowest_eigenvalues_mev, relax_to_minimum,
};
use crate::symmetry::Operation;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// How many of the softest modes are told of and tried.
pub(super) const SOFTEST: usize = 4;

/// The direction (3N) in which a saddle falls: the valley that its search followed, or, where that is a mixture of soft modes,
/// the lowest mode, if that is plainly negative.
fn falling(h: Evaluator, saddle: &Saddle) -> Vec<f64> {
    let (state, valley) = (&saddle.refined.state, &saddle.refined.valley);
    let v = state.basis.coordinates(valley);
    let mut residual = vec![0.0; v.len()];
    state.hessian.multiply(&v, &mut residual);
    let curvature = slab::dot(&v, &residual) / slab::dot(&v, &v);
    slab::add_scaled(&mut residual, -curvature, &v);
    // a mode, roughly
    if slab::norm(&residual) < ROUGHLY * curvature.abs() * slab::norm(&v) {
        return valley.clone();
    }
    let floor = 1e3 * f64::EPSILON * state.hessian.norm1();
    match state.lowest_mode(h) {
        Some(lowest) if lowest.value < -floor => state.field(&lowest.vector),
        _ => valley.clone(),
    }
}

/// What the descents from a saddle need to know.
#[derive(Clone, Copy)]
pub struct Sides<'a> {
    /// Stiffness scale c (meV).
    pub c: f64,
    /// What rises by less is level (meV).
    pub level_mev: f64,
    /// Minima beside it.
    pub beside: &'a [&'a Minimum],
    /// Most steps by factors of each.
    pub most: usize,
}

/// A saddle with the minima on its two sides.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Pass {
    /// The saddle.
    pub saddle: Saddle,
    /// The signs of its modes.
    pub spectrum: Spectrum,
    /// The minimum that the descent against the path's direction reaches.
    pub before: Minimum,
    /// The minimum that the descent along the path's direction reaches.
    pub after: Minimum,
    /// How far the energy fell on either side (meV).
    pub fallen_mev: [f64; 2],
    /// The descents: states on the way down to `before` and to `after`, without the two ends.
    pub ways: [Arc<Vec<Spins>>; 2],
    /// What lies on its two sides was given, not found by descents.
    pub given: bool,
}

impl Pass {
    /// Descends from a saddle on both sides; where a slope forks or ends there, to one of the minima `beside` it, if one of them is.
    pub fn of(h: Evaluator, saddle: Saddle, sides: Sides) -> Result<Pass> {
        let beside: Vec<&Minimum> = sides.beside.iter().copied().filter(|minimum| minimum.is_proven()).collect();
        let ends: Vec<&Spins> = beside.iter().map(|minimum| &minimum.spins).collect();
        let state = &saddle.refined.state;
        let falls = falling(h, &saddle);
        let sign = if slab::dot(&falls, &saddle.top.tau) < 0.0 { -1.0 } else { 1.0 };
        let side = |direction: f64| -> Result<(Minimum, f64, Vec<Spins>)> {
            let valley: Vec<f64> = falls.iter().map(|v| direction * sign * v).collect();
            let d = descend(
                h,
                state,
                &valley,
                Downhill { c: sides.c, level_mev: sides.level_mev, beside: &ends, most: sides.most },
            );
            let way = d.way.into_iter().map(|m| Spins::from_unit_components(&m)).collect();
            if let Some(known) = beside.iter().find(|minimum| minimum.spins.as_slice() == d.m) {
                return Ok((Minimum::clone(known), d.fallen_mev, way));
            }
            let end = Spins::from_unit_components(&d.m);
            if d.given_up {
                return Ok((Minimum::examine(h, &end), d.fallen_mev, way));
            }
            let relaxed = relax_to_minimum(h, &end, RELAXED * h.stiffness_mev())?;
            Ok((Minimum::of(h, &relaxed), d.fallen_mev, way))
        };
        let spectrum = saddle.refined.spectrum.clone().unwrap_or_else(|| Spectrum::of(h, state, 0));
        let sides = rayon::join(|| side(-1.0), || side(1.0));
        let ((before, f, back), (after, g, on)) = (sides.0?, sides.1?);
        Ok(Pass { spectrum, before, after, fallen_mev: [f, g], ways: [back, on].map(Arc::new), saddle, given: false })
    }

    /// A saddle whose spectrum alone tells that it is one, between ends that are kept as they are, minima or not.
    pub fn between(h: Evaluator, saddle: Saddle, [before, after]: [Minimum; 2]) -> Pass {
        let state = &saddle.refined.state;
        let spectrum = saddle.refined.spectrum.clone().unwrap_or_else(|| Spectrum::of(h, state, 0));
        let fallen_mev = [&before, &after].map(|end| h.difference_mev(&state.m, end.spins.as_slice()));
        Pass { spectrum, before, after, fallen_mev, ways: Default::default(), saddle, given: true }
    }

    /// The same, as far as it is not on record.
    pub fn recorded(h: Evaluator, saddle: Saddle, sides: Sides) -> Result<Pass> {
        let Saddle { top, refined } = &saddle;
        let [m, valley, tau] = [&refined.state.m, &refined.valley, &top.tau].map(Vec::clone);
        let states = sides.beside.iter().map(|minimum| minimum.spins.as_slice());
        let level = [sides.level_mev];
        let inputs: Vec<&[f64]> = [&m[..], &valley, &tau, &level].into_iter().chain(states).collect();
        recorded(h, "descents", &inputs, || Pass::of(h, saddle, sides))
    }

    /// The saddle's lowest eigenvalues (meV), ascending, as many as are reported: what takes longest to find of all that is told of
    /// it, and no search asks for it.
    pub fn lowest_eigenvalues_mev(&self, h: Evaluator) -> Vec<f64> {
        let Refined { state, valley, spectrum, .. } = &*self.saddle.refined;
        // the direction in which it falls is a mode where a search found it as one
        let lowest = spectrum.as_ref().map(|_| state.basis.coordinates(valley));
        lowest_eigenvalues_mev(h, state, SOFTEST, lowest.as_slice())
    }

    /// The rates over it, from the minimum before it and back; as a saddle of this number.
    pub fn rates(&self, h: Evaluator, number: usize, symmetry: &Symmetry, settings: &RateSettings) -> [SaddleRate; 2] {
        let doubt = self.doubt(h).map(|doubt| doubt.to_string());
        let crossing = Crossing {
            saddle: &self.saddle.refined.state,
            valley: &self.saddle.refined.valley,
            spectrum: &self.spectrum,
            minima: [&self.before.spins, &self.after.spins],
            minima_spectra: [&self.before.spectrum, &self.after.spectrum],
            symmetry,
            doubt: doubt.as_deref(),
        };
        saddle_rates(h, number, &crossing, settings)
    }

    /// What a symmetry of the energy makes of it.
    pub fn image(&self, h: Evaluator, operation: &Operation) -> Pass {
        let spins = |s: &Spins| Spins::from_unit_components(&operation.apply(s.as_slice()));
        Pass {
            saddle: self.saddle.image(h, operation),
            spectrum: self.spectrum.clone(),
            before: self.before.image(operation),
            after: self.after.image(operation),
            ways: self.ways.each_ref().map(|way| Arc::new(way.iter().map(spins).collect())),
            ..*self
        }
    }

    /// Exchanges its two sides: which of them the path comes from is not always plain at the saddle itself.
    pub fn reverse(&mut self) {
        std::mem::swap(&mut self.before, &mut self.after);
        self.fallen_mev.reverse();
        self.ways.reverse();
    }

    /// Why this is not a proven saddle of index one between two proven minima; nothing if it is.
    pub fn doubt(&self, h: Evaluator) -> Option<Doubt> {
        let state = &self.saddle.refined.state;
        let s = &self.spectrum;
        if !s.is_stationary(state.max_torque_mev()) {
            return Some(Doubt::Torque(state.max_torque_mev()));
        }
        if s.negative > 1 {
            return Some(Doubt::NegativeModes(s.negative));
        }
        if self.given {
            return None;
        }
        let rounding = 16.0 * f64::EPSILON * (state.energy_mev.abs() + h.stiffness_mev());
        if self.fallen_mev.iter().any(|f| *f <= rounding) {
            return Some(Doubt::NoFall(rounding));
        }
        if s.negative == 0 && s.flat == 0 {
            return Some(Doubt::NoNegativeMode);
        }
        let unproven = [&self.before, &self.after].into_iter().find(|m| !m.is_proven())?;
        Some(Doubt::Descent { negative: unproven.spectrum.negative, torque_mev: unproven.max_torque_mev })
    }
}
