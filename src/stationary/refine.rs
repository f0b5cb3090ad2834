//! The saddle that a path's maximum stands for.
//!
//! Where two walls may each stand on any site, the energy is a lattice of shallow minima, saddles and maxima, and the path's own way
//! may lead to a maximum: so the lowest mode is followed, whichever way that is.

use super::point::Point;
use super::polish::polish;
use super::search::{GaveUp, STEPS, Saddle, Search};
use super::spectrum::Spectrum;
use super::state::State;
use super::tolerances::{ALIKE, FAR, STEP};
use crate::energy::Evaluator;
use crate::field::project;
use crate::linalg::slab;
use crate::path::largest_angle;
use serde::{Deserialize, Serialize};

/// A refined saddle.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Refined {
    /// Where it ended.
    pub state: State,
    /// Unit tangent field (3N) of the valley there.
    pub valley: Vec<f64>,
    /// The signs of its modes, if they were counted.
    pub spectrum: Option<Spectrum>,
}

impl Refined {
    /// Negative directions, zero modes apart, as far as they were counted.
    pub fn index(&self) -> usize {
        self.spectrum.as_ref().map_or(0, |s| s.negative)
    }
}

/// The saddle of index one, or of one mode flat to rounding and none that falls, that following the lowest mode from `m` reaches, if it
/// reaches one nearby without falling below `floor_mev` (meV above the Hamiltonian's reference). Else the stationary state that `m`
/// all but is, of whatever index, or `m` as it is. `tau` (3N): the path's direction.
pub fn refine(h: Evaluator, m: &[f64], tau: &[f64], floor_mev: f64) -> Refined {
    let mut search = Search::from(h, m, STEP);
    let left = |here: &Point| largest_angle(m, &here.m) > FAR || here.energy_mev < floor_mev;
    let found = search.saddle(STEPS, true, |here, _| left(here).then_some(GaveUp::Stuck));
    match found {
        Ok(Saddle { state, mode: valley, spectrum, .. }) => Refined { state, valley, spectrum: Some(spectrum) },
        Err(_) => beside(h, m, tau),
    }
}

/// The stationary state beside `m`, if there is one.
fn beside(h: Evaluator, m: &[f64], tau: &[f64]) -> Refined {
    let here = Point::at(h, m.to_vec());
    let here = if h.forgoes_factors() { here } else { polish(h, here) };
    let state = State::of(h, here);
    let rests = state.max_torque_mev() < ALIKE * h.stiffness_mev() && !h.forgoes_factors();
    let spectrum = rests.then(|| Spectrum::of(h, &state, 0));
    let mut valley = tau.to_vec();
    project(&state.m, &mut valley);
    slab::normalise(&mut valley);
    Refined { state, valley, spectrum }
}
