//! Saddles by mode following, for starts from which the valley search does not arrive.
//!
//! Where two walls may each stand on any site, the energy is a lattice of shallow minima, saddles and maxima, and the valley
//! through a start may lead to a maximum. Here every step is taken in the frame of the Hessian's soft modes u_k, ascending:
//!
//! ```text
//! up along the lowest, a₀ = g₀/|λ₀|;  down along the other soft ones, a_k = −g_k/|λ_k|;  Newton across all of them
//! ```
//! each a_k within a trust radius, which follows how well ½ vᵀHv + g·v told the energy. What it ends in has index one.
//! (Cerjan, Miller, J. Chem. Phys. 75, 2800 (1981), doi:10.1063/1.442352; Baker, J. Comput. Chem. 7, 385 (1986).)

use super::pinned::Pinned;
use super::polish::polish;
use super::state::State;
use super::valley::{Refined, Verdict};
use crate::energy::Evaluator;
use crate::linalg::{Mode, lowest_modes, slab, soft_modes};
use crate::path::largest_angle;
use crate::sphere::rotation_of;

/// Most steps, accepted or not.
const STEPS: usize = 120;
/// Most modes that are followed one by one.
const MODES: usize = 5;
/// A mode below this part of c is soft.
const SOFT: f64 = 0.1;
/// Largest rotation of a spin along one mode in one step (rad).
const RADIUS: f64 = 0.3;
/// Farthest from the start (rad, any spin).
const FARTHEST: f64 = 2.0;

/// A torque below this part of the stiffness is small enough.
const LOOSE: f64 = 1e-11;
/// One below this is sought for, in so many steps more: where a saddle hardly minds sliding over the lattice, the torque of that
/// is smaller still.
const TIGHT: f64 = 1e-13;
/// Most steps between the two.
const LAST_STEPS: usize = 12;

/// The saddle of index one that mode following reaches from `m`, if it reaches one nearby; c is the stiffness scale (meV).
pub fn follow_modes(h: Evaluator, m: &[f64], c: f64) -> Option<Refined> {
    let kappa = (h.stiffness_mev() / 3.0).max(c);
    let mut state = State::at(h, m.to_vec());
    let mut radius = RADIUS / 3.0;
    let mut steps = 0;
    let mut factorisations = 0;
    let scale = c.max(h.stiffness_mev());
    let mut settled: Option<State> = None;
    let mut left = LAST_STEPS;
    while state.max_torque_mev() > TIGHT * scale && left > 0 {
        if state.max_torque_mev() <= LOOSE * scale || settled.is_some() {
            left -= 1;
            if settled.as_ref().is_none_or(|s| state.max_torque_mev() < s.max_torque_mev()) {
                settled = Some(state.clone());
            }
        }
        match Frame::at(&state, c, kappa).and_then(|frame| frame.advance(h, &state, &mut radius, &mut steps)) {
            Some(next) => state = next,
            None => break,
        }
        factorisations += 1;
        if largest_angle(m, &state.m) > FARTHEST {
            break;
        }
    }
    let sharp = |s: &State| s.max_torque_mev() <= LOOSE * scale && largest_angle(m, &s.m) <= FARTHEST;
    let better = |s: &State| settled.as_ref().is_none_or(|known| s.max_torque_mev() < known.max_torque_mev());
    let state = if sharp(&state) && better(&state) { state } else { settled? };
    let state = polish(h, state);
    let lowest = lowest_modes(&state.hessian, 2, &state.zeros);
    let valley = lowest.first()?;
    let below = lowest.get(1).is_none_or(|second| second.value > -1e-13 * h.stiffness_mev());
    (valley.value < 0.0 && below).then(|| Refined {
        verdict: Verdict::Saddle,
        valley: state.field(&valley.vector),
        steps,
        factorisations,
        index: 1,
        curvature_mev: valley.value,
        rotation_rad: largest_angle(m, &state.m),
        state,
    })
}

/// The soft modes of a state, and the Newton step across them.
struct Frame {
    soft: Vec<Mode>,
    across: Vec<f64>,
}

impl Frame {
    /// None where more directions are negative than are followed.
    fn at(state: &State, c: f64, kappa: f64) -> Option<Frame> {
        let mut soft = soft_modes(&state.hessian, MODES, &state.zeros, SOFT * c);
        let count = soft.iter().take_while(|m| m.value < SOFT * c).count().max(1);
        soft.truncate(count);
        let others: Vec<Vec<f64>> = soft.iter().skip(1).map(|m| m.vector.clone()).collect();
        let p = Pinned::new(state, &soft.first()?.vector, 0.0, &others, kappa);
        let minus = state.downhill();
        let (across, _) = p.solve(&minus);
        let positive = slab::dot(&across, &minus) >= 0.0 && soft.last().is_none_or(|m| count < MODES || m.value > 0.0);
        positive.then_some(Frame { soft, across })
    }

    /// The next state, with a radius for the step after it; none where no step tells the energy well enough.
    fn advance(&self, h: Evaluator, state: &State, radius: &mut f64, steps: &mut usize) -> Option<State> {
        loop {
            *steps += 1;
            if *steps > STEPS || *radius < 1e-7 || h.is_stopped() {
                return None;
            }
            let (v, longest) = self.step(state, *radius);
            let next = State::at(h, state.moved(&v));
            let told = state.predicted_mev(&state.hessian, &state.basis.coordinates(&v));
            let noise = 256.0 * f64::EPSILON * (state.energy_mev.abs() + h.stiffness_mev());
            let ratio = h.difference_mev(&next.m, &state.m) / told;
            let known = told.abs() > noise;
            if known && !(0.25..4.0).contains(&ratio) {
                *radius = 0.3 * longest.min(*radius);
                continue;
            }
            if !known || (0.7..1.4).contains(&ratio) {
                *radius = (2.0 * *radius).min(RADIUS);
            }
            return Some(next);
        }
    }

    /// The step as a vector field, and its longest part along a soft mode (rad, any spin).
    fn step(&self, state: &State, radius: f64) -> (Vec<f64>, f64) {
        let mut v = state.field(&self.across);
        let far = rotation_of(&v);
        if far > RADIUS {
            slab::scale(&mut v, RADIUS / far);
        }
        let mut longest = 0.0f64;
        for (k, mode) in self.soft.iter().enumerate() {
            let u = state.field(&mode.vector);
            let reach = radius / rotation_of(&u).max(f64::MIN_POSITIVE);
            let down = -slab::dot(&state.slope, &mode.vector) / mode.value.abs().max(f64::MIN_POSITIVE);
            let a = if k == 0 { -down } else { down }.clamp(-reach, reach);
            longest = longest.max(a.abs() * rotation_of(&u));
            slab::add_scaled(&mut v, a, &u);
        }
        (v, longest)
    }
}
