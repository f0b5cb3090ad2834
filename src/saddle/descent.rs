//! Down from a saddle to the minimum on one side.
//!
//! First along the valley, with everything across it relaxed, until the energy has plainly fallen: near a flat top the gradient
//! is rounding error and no guide. Then down the gradient by implicit Euler steps, (H + 1/Δt) v = −g, whose Δt grows as long as
//! H + 1/Δt stays positive definite: the steepest descent with its stiff directions relaxed.

use super::pinned::Pinned;
use super::state::State;
use crate::energy::Hamiltonian;
use crate::linalg::slab;
use crate::path::largest_angle;
use crate::sphere::rotation_of;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.3;
/// A valley that has risen by more than this part of c leads nowhere.
const RISEN: f64 = 1e-3;
/// Most steps of either part.
const STEPS: usize = 20_000;

/// Where a descent ended.
#[derive(Debug)]
pub struct Descent {
    /// The lowest point reached.
    pub m: Vec<f64>,
    /// Energy fallen (meV), positive.
    pub fallen_mev: f64,
    /// It ended at a stationary point.
    pub arrived: bool,
    /// Points on the way, each with a spin turned by a quarter radian or more since the last.
    pub way: Vec<Vec<f64>>,
}

/// Points on the way are so far apart (rad, any spin).
const APART: f64 = 0.25;

/// Keeps a point that is far from the last one kept.
fn keep(way: &mut Vec<Vec<f64>>, start: &[f64], m: &[f64]) {
    if largest_angle(way.last().map_or(start, |p| p), m) >= APART {
        way.push(m.to_vec());
    }
}

/// Descends from a saddle along ± its valley (a unit field of 3N numbers); c is the stiffness scale (meV).
pub fn descend(h: &Hamiltonian, saddle: &State, valley: &[f64], c: f64) -> Descent {
    let top = saddle.energy_mev;
    let noise = 64.0 * f64::EPSILON * (top.abs() + h.stiffness_mev());
    let mut way = Vec::new();
    let state = march(h, saddle, valley, c, noise.max(1e-9 * c), &mut way);
    let (state, arrived) = fall(h, state, c, &saddle.m, &mut way);
    Descent { fallen_mev: h.difference_mev(&saddle.m, &state.m), arrived, m: state.m, way }
}

/// Along the valley until the energy is `enough` below the start; or plainly above it, which then is no saddle along this valley.
fn march(h: &Hamiltonian, saddle: &State, valley: &[f64], c: f64, enough: f64, way: &mut Vec<Vec<f64>>) -> State {
    let kappa = (h.stiffness_mev() / 3.0).max(c);
    let mut state = saddle.clone();
    let mut tau = valley.to_vec();
    let mut step = 0.02;
    for _ in 0..STEPS {
        let fallen = h.difference_mev(&saddle.m, &state.m);
        if fallen > enough || fallen < -RISEN * c {
            break;
        }
        let t = state.basis.coordinates(&tau);
        let p = Pinned::new(&state, &t, 1e-6 * c, &[], kappa);
        let minus: Vec<f64> = state.slope.iter().map(|g| -g).collect();
        let (d, _) = p.solve(&minus, 0.0);
        let (w, _) = p.solve(&vec![0.0; d.len()], 1.0);
        let (mut across, mut along) = (state.field(&d), state.field(&w));
        if p.complement_negatives > 0 || slab::dot(&w, &p.soft).abs() < 0.05 * slab::norm(&w) {
            // the valley is lost: straight on, the descent will find the way
            along = state.field(&p.soft);
            across.fill(0.0);
        }
        let size = rotation_of(&along);
        slab::scale(&mut along, step / size);
        let correction = rotation_of(&across);
        slab::add_scaled(&mut along, if correction > CAP { CAP / correction } else { 1.0 }, &across);
        let m = state.moved(&along);
        tau = along;
        crate::field::project(&m, &mut tau);
        keep(way, &saddle.m, &m);
        state = State::at(h, m);
        step = (1.3f64 * step).min(CAP);
    }
    state
}

/// Implicit Euler down the gradient, to a stationary point.
fn fall(h: &Hamiltonian, mut state: State, c: f64, top: &[f64], way: &mut Vec<Vec<f64>>) -> (State, bool) {
    let scale = h.stiffness_mev();
    let tolerance = 1e-13 * scale;
    let mut rate = c;
    for _ in 0..STEPS {
        if state.max_torque_mev() <= tolerance {
            return (state, true);
        }
        let Some(next) = euler(h, &state, &mut rate, scale) else { return (state, false) };
        let stuck = state.energy_mev - next.energy_mev <= 4.0 * f64::EPSILON * (state.energy_mev.abs() + scale);
        let settled = stuck && next.max_torque_mev() < 1e-9 * c && next.max_torque_mev() > 0.5 * state.max_torque_mev();
        state = next;
        keep(way, top, &state.m);
        if settled {
            return (state, true);
        }
    }
    (state, false)
}

/// One step; the rate 1/Δt falls after a success and rises until H + rate is positive definite and the energy does not rise.
fn euler(h: &Hamiltonian, state: &State, rate: &mut f64, scale: f64) -> Option<State> {
    let slack = 1e-13 * (state.energy_mev.abs() + scale);
    while *rate < 1e6 * scale {
        let mut matrix = state.hessian.clone();
        matrix.shift(*rate + 1e-12 * scale);
        let factors = matrix.factor();
        if factors.negatives() == 0 {
            let mut x: Vec<f64> = state.slope.iter().map(|g| -g).collect();
            factors.solve(&mut x, 1);
            let mut v = state.field(&x);
            let rotation = rotation_of(&v);
            if rotation > CAP {
                slab::scale(&mut v, CAP / rotation);
            }
            let next = State::at(h, state.moved(&v));
            if next.energy_mev <= state.energy_mev + slack {
                *rate = if *rate < 1e-8 * scale { 0.0 } else { *rate / 4.0 };
                return Some(next);
            }
        }
        *rate = (4.0 * *rate).max(1e-9 * scale);
    }
    None
}
