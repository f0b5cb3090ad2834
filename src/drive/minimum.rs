//! Minima: what a descent ends in, and whether two of them are the same.

use super::Doubt;
use super::climb::Found;
use super::ends::relax_to_minimum;
use super::recorded::recorded;
use super::turns::{turned, turns};
use crate::energy::Evaluator;
use crate::error::Result;
use crate::linalg::slab;
use crate::path::largest_angle;
use crate::spins::Spins;
use crate::stationary::{Spectrum, State, descend};
use crate::threads::both;
use serde::{Deserialize, Serialize};

/// How many eigenvalues of a saddle are reported.
const REPORTED: usize = 6;
/// Of more sites the modes and the descents are not followed at the same time.
const MANY: usize = 200_000;
/// A valley with less than this (of its curvature) left over when the Hessian acts on it is a mode.
const PURE: f64 = 0.1;
/// Spins of two states of one minimum differ by less (rad).
const SAME: f64 = 1e-3;

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

    /// Two of them.
    pub fn examine_both(h: Evaluator, spins: [&Spins; 2]) -> [Minimum; 2] {
        let [a, b] = spins;
        both(3 * h.sites(), || Minimum::examine(h, a), || Minimum::examine(h, b)).into()
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
        let noise = 1e-12 * h.stiffness_mev();
        let both_flat = self.spectrum.flat > 0 && other.spectrum.flat > 0;
        both_flat && h.difference_mev(self.spins.as_slice(), other.spins.as_slice()).abs() < noise
    }

    /// Whether `other` has the same spins, perhaps after a rotation about the symmetry axes.
    pub fn is_identical(&self, h: Evaluator, other: &Minimum) -> bool {
        largest_angle(self.spins.as_slice(), other.spins.as_slice()) < SAME || self.is_turned(h, other)
    }

    /// Whether a rotation about the symmetry axes makes `other` of this minimum.
    pub fn is_turned(&self, h: Evaluator, other: &Minimum) -> bool {
        let a = self.spins.as_slice();
        let turn = turns(h, &other.spins, &self.spins);
        !turn.is_empty() && largest_angle(a, turned(&other.spins, &turn).as_slice()) < SAME
    }
}

/// The direction (3N) in which a saddle falls: the valley that its search followed, or, where that is a mixture of soft modes,
/// the lowest mode, if that is plainly negative.
fn falling(found: &Found) -> Vec<f64> {
    let (state, valley) = (&found.refined.state, &found.refined.valley);
    let v = state.basis.coordinates(valley);
    let mut residual = vec![0.0; v.len()];
    state.hessian.multiply(&v, &mut residual);
    let curvature = slab::dot(&v, &residual) / slab::dot(&v, &v);
    slab::add_scaled(&mut residual, -curvature, &v);
    if slab::norm(&residual) < PURE * curvature.abs() * slab::norm(&v) {
        return valley.clone();
    }
    let floor = 1e3 * f64::EPSILON * state.hessian.norm1();
    match state.lowest_mode() {
        Some(lowest) if lowest.value < -floor => state.field(&lowest.vector),
        _ => valley.clone(),
    }
}

/// A saddle with the minima on its two sides.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Link {
    /// The saddle.
    pub found: Found,
    /// Its modes.
    pub spectrum: Spectrum,
    /// The minimum that the descent against the path's direction reaches.
    pub before: Minimum,
    /// The minimum that the descent along the path's direction reaches.
    pub after: Minimum,
    /// How far the energy fell on either side (meV).
    pub fallen_mev: [f64; 2],
    /// The descents: states on the way down to `before` and to `after`, without the two ends.
    pub ways: [Vec<Spins>; 2],
    /// What lies on its two sides was given, not found by descents.
    pub given: bool,
}

impl Link {
    /// Descends from a saddle on both sides.
    pub fn of(h: Evaluator, found: Found, c: f64) -> Result<Link> {
        let state = &found.refined.state;
        let falls = falling(&found);
        let sign = if slab::dot(&falls, &found.top.tau) < 0.0 { -1.0 } else { 1.0 };
        let side = |direction: f64| -> Result<(Minimum, f64, Vec<Spins>)> {
            let valley: Vec<f64> = falls.iter().map(|v| direction * sign * v).collect();
            let d = descend(h, state, &valley, c);
            let relaxed = relax_to_minimum(h, &Spins::from_unit_components(&d.m), 1e-14 * h.stiffness_mev())?;
            let way = d.way.into_iter().map(|m| Spins::from_unit_components(&m)).collect();
            Ok((Minimum::examine(h, &relaxed.spins), d.fallen_mev, way))
        };
        let descents = || rayon::join(|| side(-1.0), || side(1.0));
        let modes = || Spectrum::of(h, state, REPORTED);
        // on long chains the modes take much memory, which is given back before the descents
        let (spectrum, sides) = if h.sites() > MANY { (modes(), descents()) } else { rayon::join(modes, descents) };
        let ((before, f, back), (after, g, on)) = (sides.0?, sides.1?);
        Ok(Link { spectrum, before, after, fallen_mev: [f, g], ways: [back, on], found, given: false })
    }

    /// A saddle whose spectrum alone tells that it is one, between ends that are kept as they are, minima or not. Nothing if its
    /// descending direction is too flat for that.
    pub fn between(h: Evaluator, found: Found, [before, after]: [Minimum; 2]) -> Option<Link> {
        let state = &found.refined.state;
        let spectrum = Spectrum::of(h, state, REPORTED);
        if spectrum.negative == 0 {
            return None;
        }
        let fallen_mev = [&before, &after].map(|end| h.difference_mev(&state.m, end.spins.as_slice()));
        Some(Link { spectrum, before, after, fallen_mev, ways: Default::default(), found, given: true })
    }

    /// The same, as far as it is not on record.
    pub fn recorded(h: Evaluator, found: Found, c: f64) -> Result<Link> {
        let Found { top, refined } = &found;
        let [m, valley, tau] = [&refined.state.m, &refined.valley, &top.tau].map(Vec::clone);
        recorded(h, "descents", &[&m, &valley, &tau], || Link::of(h, found, c))
    }

    /// Exchanges its two sides: which of them the path comes from is not always plain at the saddle itself.
    pub fn reverse(&mut self) {
        std::mem::swap(&mut self.before, &mut self.after);
        self.fallen_mev.reverse();
        self.ways.reverse();
    }

    /// Why this is not a proven saddle of index one between two proven minima; nothing if it is.
    pub fn doubt(&self, h: Evaluator) -> Option<Doubt> {
        let state = &self.found.refined.state;
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
