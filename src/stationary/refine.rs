//! The saddle that a path's maximum stands for.
//!
//! Where two walls may each stand on any site, the energy is a lattice of shallow minima, saddles and maxima, and the path's own way
//! may lead to a maximum: so the lowest mode is followed, whichever way that is.

use super::point::Point;
use super::polish::polish;
use super::search::{GaveUp, STEPS, Saddle, Search};
use super::spectrum::Spectrum;
use super::state::State;
use super::step::Step;
use super::tolerances::{ALIKE, FAR, STEP};
use crate::energy::Evaluator;
use crate::field::project;
use crate::linalg::slab;
use crate::path::largest_angle;
use serde::{Deserialize, Serialize};
use std::mem::take;

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
    refined(h, m, tau, floor_mev, |_| false)
}

/// The same, but `m` as it is where the search strays: its first step would turn a spin half-way to another state, with more than one
/// direction falling. Of 43 tops of unrelaxed bands of films of 200 to 1900 sites that did so 3 led to a saddle, the others took 14
/// factorisations each in vain; of 13 whose step was shorter, but still cut, 4. After a band was relaxed a saddle takes 3.
pub fn refine_unless_it_strays(h: Evaluator, m: &[f64], tau: &[f64], floor_mev: f64) -> Refined {
    let strays = |step: &Step| step.negative > 1 && step.asked > 0.5 * FAR;
    refined(h, m, tau, floor_mev, strays)
}

fn refined(h: Evaluator, m: &[f64], tau: &[f64], floor_mev: f64, strays: impl Fn(&Step) -> bool) -> Refined {
    let mut search = Search::from(h, m, STEP);
    search.along = Some(tau.to_vec());
    let left = |here: &Point| largest_angle(m, &here.m) > FAR || here.energy_mev < floor_mev;
    let mut begins = true;
    let found = search.saddle(STEPS, true, |here, step| match take(&mut begins) && strays(step) {
        true => Some(GaveUp::Strayed),
        false => left(here).then_some(GaveUp::Stuck),
    });
    match found {
        Ok(Saddle { state, mode: valley, spectrum, .. }) => Refined { state, valley, spectrum: Some(spectrum) },
        Err(GaveUp::Strayed) => with_valley(State::at(h, m.to_vec()), tau, None),
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
    with_valley(state, tau, spectrum)
}

fn with_valley(state: State, tau: &[f64], spectrum: Option<Spectrum>) -> Refined {
    let mut valley = tau.to_vec();
    project(&state.m, &mut valley);
    slab::normalise(&mut valley);
    Refined { state, valley, spectrum }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::spins::Spins;

    #[test]
    fn a_search_that_strays_is_given_up_and_one_that_does_not_is_the_same() {
        let lattice = Chain::open(2).resolve().unwrap();
        let terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Anisotropy::uniform(2, 1.0, Direction::Z)),
            Box::new(Anisotropy::uniform(2, -0.5, Direction::X)),
        ];
        let h = Hamiltonian::new(&lattice, terms).unwrap();
        let h = Evaluator::from(&h);
        // so far from the hard plane (rad), both or one alone
        let at = |off: [f64; 2]| {
            let spins = off.map(|x| [0.0, libm::cos(x), libm::sin(x)]);
            Spins::from_vectors(&spins).unwrap().as_slice().to_vec()
        };
        let tau = [0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let both = [refine, refine_unless_it_strays];
        // either falls, and the step is far longer than a step may be
        let [whole, given_up] = both.map(|refine| refine(h, &at([0.5, 0.55]), &tau, f64::NEG_INFINITY));
        assert_eq!(whole.index(), 1);
        assert!(given_up.spectrum.is_none() && given_up.state.m == at([0.5, 0.55]));
        let [whole, same] = both.map(|refine| refine(h, &at([0.2, 1.5]), &tau, f64::NEG_INFINITY));
        assert!(whole.index() == 1 && whole.state.m == same.state.m && whole.spectrum == same.spectrum);
    }
}
