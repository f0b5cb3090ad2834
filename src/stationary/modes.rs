//! Saddles by following the lowest mode, for starts from which the valley search does not arrive.
//!
//! Where two walls may each stand on any site, the energy is a lattice of shallow minima, saddles and maxima, and the valley
//! through a start may lead to a maximum. What this search ends in has index one.

use super::point::Point;
use super::search::{GaveUp, STEPS, Saddle, Search};
use super::tolerances::STEP;
use super::valley::Refined;
use crate::energy::Evaluator;
use crate::path::largest_angle;

/// Farthest from the start (rad, any spin).
const FARTHEST: f64 = 2.0;

/// The saddle of index one that following the lowest mode from `m` reaches, if it reaches one nearby without falling below
/// `floor_mev` (meV above the Hamiltonian's reference).
pub fn follow_modes(h: Evaluator, m: &[f64], floor_mev: f64) -> Option<Refined> {
    let mut search = Search::from(h, m, STEP);
    let left = |here: &Point| largest_angle(m, &here.m) > FARTHEST || here.energy_mev < floor_mev;
    let found = search.run(STEPS, |here, _| left(here).then_some(GaveUp::Stuck));
    let factorisations = search.steps;
    let saddle = found.and_then(|()| search.saddle()).ok()?;
    let Saddle { state, mode: valley, spectrum, .. } = saddle;
    Some(Refined { arrived: true, state, valley, factorisations, index: 1, spectrum: Some(spectrum) })
}
