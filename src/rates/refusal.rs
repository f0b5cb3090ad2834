//! Where a saddle has no rate, and what would give it one.

use super::{Crossing, RateSettings};
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::{Vector, vector};
use crate::linalg::slab;
use crate::spins::Spins;
use crate::stationary::Spectrum;
use thiserror::Error;

/// A total moment that changes by less than this part of the sum of all is the same.
const SAME_MOMENT: f64 = 1e-6;

/// Why there is no rate, from a closed list. Energies in meV.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Refusal {
    /// The path is no barrier, for this reason.
    #[error("there is no barrier: {0}")]
    NoBarrier(String),
    /// This stands against the certificate of the whole path.
    #[error("{0}")]
    Path(String),
    /// This stands against the certificate of every saddle of the path.
    #[error(
        "the saddle is not certified{}: {doubt}; a rate belongs to a proven saddle between two proven minima \
         (\"saddle\": {{\"refine\": true, \"certify\": true}})", index(*.negative_modes)
    )]
    Unproven {
        /// Its descending modes, where counted.
        negative_modes: Option<usize>,
        /// What stands against it.
        doubt: String,
    },
    /// This stands against the certificate of the saddle.
    #[error("the saddle is not certified: {0}; a rate belongs to a proven saddle between two proven minima")]
    Doubted(String),
    /// The saddle has so many descending modes.
    #[error(
        "the saddle has {0} negative modes: a rate belongs to a saddle with one; another first path (\"path.guess\") may pass a \
         lower one"
    )]
    NegativeModes(usize),
    /// The saddle's descending mode lies below this rounding error of its Hessian.
    #[error(
        "the saddle's descending mode is flat to {0:.1e} meV, the rounding error of its Hessian, so the curvature that a rate is \
         made of is not known; a shorter chain, a field or a defect gives the top of the path a shape"
    )]
    FlatMode(f64),
    /// Memory does not hold the factors of a Hessian that a prefactor is made of.
    #[error(
        "the memory that may be used does not hold the factors of its Hessian, of whose determinant a prefactor is made"
    )]
    NoFactors,
    /// The descending mode of the saddle was not computed.
    #[error("the saddle has a descending mode that could not be computed")]
    LostMode,
    /// A state beside the saddle has so many descending modes, such as an end that was kept as given.
    #[error("the state {0} the saddle is no minimum: it has {1} descending modes")]
    Descends(&'static str, usize),
    /// A state beside the saddle has this torque.
    #[error("the state {0} the saddle is no minimum: a torque of {1:.1e} meV is left on it")]
    Torque(&'static str, f64),
    /// A state has modes whose volume is not known.
    #[error("{0} has {1}")]
    Volume(&'static str, UnknownModes),
    /// Precession conserves the moment along this axis, which differs between the saddle and a minimum.
    #[error(
        "the energy is the same for all turns about ({:.3}, {:.3}, {:.3}), so without damping the moment along that axis is \
         conserved and no spin crosses the saddle: what transition-state theory counts is not there; use \"langer\" with a damping \
         above 0, or a second anisotropy that breaks the symmetry", .0[0], .0[1], .0[2]
    )]
    Conserved(Vector),
    /// The run was stopped before.
    #[error("the run was stopped before its rates were computed")]
    Stopped,
    /// The frequency of the crossing cannot be told from zero.
    #[error("the crossing has no frequency that can be told from zero: the spins do not precess across the saddle")]
    NoFrequency,
}

/// Modes of which nobody knows how far they reach.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum UnknownModes {
    /// So many below this rounding error (meV) that are neither a rotation nor a translation.
    #[error(
        "{modes} mode(s) flat to {floor_mev:.1e} meV that are no rotation and no translation of a periodic lattice: how far they reach is not \
         known; a term that gives them a stiffness, such as an anisotropy or a pinning site, would tell"
    )]
    Flat {
        /// How many.
        modes: usize,
        /// The rounding error (meV).
        floor_mev: f64,
    },
    /// A translation over a lattice that does not repeat along it, all but free.
    #[error(
        "a translation that nothing holds: k_BT at {} moves it by {cells:.1} cells along a direction in which the lattice does not \
         repeat, so how far it reaches is not known; a periodic lattice, or something that pins the state, would tell",
        super::validity::kelvin(*kelvin)
    )]
    Wanders {
        /// How far (cells of the lattice, root mean square).
        cells: f64,
        /// The highest temperature asked for (K).
        kelvin: f64,
    },
}

fn index(negative_modes: Option<usize>) -> String {
    negative_modes.filter(|n| *n != 1).map_or(String::new(), |n| format!(" and has {n} negative modes"))
}

/// Why a saddle has no rate by any theory: no certificate, or not one descending mode. Nothing if it may have one.
pub fn unfit(crossing: &Crossing) -> Option<Refusal> {
    let s = crossing.spectrum;
    match s.negative {
        0 => Some(Refusal::FlatMode(s.floor_mev)),
        1 if s.bound.is_some() && crossing.doubt.is_none() => Some(Refusal::NoFactors),
        1 => crossing.doubt.map(|doubt| Refusal::Doubted(doubt.into())),
        n => Some(Refusal::NegativeModes(n)),
    }
}

/// Why a state beside a saddle is not one to be left at a rate, such as an end that was kept as given; nothing if it is a minimum.
pub fn no_minimum(spectrum: &Spectrum, torque_mev: f64, side: &'static str) -> Option<Refusal> {
    if spectrum.negative > 0 {
        return Some(Refusal::Descends(side, spectrum.negative));
    }
    (!spectrum.is_stationary(torque_mev)).then_some(Refusal::Torque(side, torque_mev))
}

/// Why precession alone cannot cross: a symmetry axis along which the total moment is conserved, and it differs between the saddle
/// and a minimum. Nothing if no such axis stands in the way.
pub fn conserved_moment(
    h: &Hamiltonian,
    saddle: &[f64],
    minima: [&Spins; 2],
    settings: &RateSettings,
) -> Option<Refusal> {
    let total: f64 = settings.moments_mub.iter().sum();
    let changes = |axis: &Vector| {
        let at = |m: &[f64]| moment_along(h, m, *axis, &settings.moments_mub);
        let here = at(saddle);
        minima.iter().any(|m| (at(m.as_slice()) - here).abs() > SAME_MOMENT * total)
    };
    h.symmetry_axes_at(saddle).into_iter().find(changes).map(Refusal::Conserved)
}

/// Total moment (μ_B) along an axis, frozen sites apart.
fn moment_along(h: &Hamiltonian, m: &[f64], axis: Vector, moments: &[f64]) -> f64 {
    let m = Components::new(m);
    let part = |i: usize| moments[i] * vector::dot(axis, m.get(i));
    slab::sum(&(0..m.sites()).filter(|&i| !h.is_frozen(i)).map(part).collect::<Vec<f64>>())
}
