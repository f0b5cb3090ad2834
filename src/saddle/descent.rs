//! Down from a saddle to the minimum on one side.
//!
//! First along the valley, with everything across it relaxed, as long as it becomes steeper: near a flat top and on a plateau the
//! gradient is rounding error and no guide, and its flow is slow. Then down the gradient by implicit Euler steps,
//! (H + 1/Δt) v = −g, whose Δt grows as long as H + 1/Δt stays positive definite and the energy falls as foretold: the steepest
//! descent with its stiff directions relaxed. Where the forces vanish in double precision but a direction is still negative, the
//! descent goes on along that direction, and ends only where the inertia counts none.

use super::pinned::Pinned;
use super::spectrum::Spectrum;
use super::state::State;
use super::trail::Trail;
use crate::energy::Hamiltonian;
use crate::linalg::{Ldl, slab};
use crate::sphere::rotation_of;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.3;
/// The first step along a valley, the longest one, and how fast they grow (rad, any spin).
const FIRST: f64 = 0.05;
const LONGEST: f64 = 0.4;
const GROWTH: f64 = 1.4;
/// Most steps along a valley at a time.
const MARCH: usize = 600;
/// Most Newton steps across a valley after each step along it, which end when one is less than this part of that step.
const CORRECTIONS: usize = 3;
const ON_THE_WAY: f64 = 0.1;
/// A valley whose slope is less than this part of the steepest has left its top behind.
const LESS_STEEP: f64 = 0.8;
/// Most steps down the gradient.
const STEPS: usize = 20_000;
/// So many steps down the gradient shorter than this (rad, any spin) are a crawl.
const CRAWL: usize = 4;
const SHORT: f64 = 0.05;
/// How often a descent goes on along a valley.
const ROUNDS: usize = 24;

/// Where a descent ended.
#[derive(Debug)]
pub struct Descent {
    /// The lowest point reached.
    pub m: Vec<f64>,
    /// Energy fallen (meV), positive.
    pub fallen_mev: f64,
    /// It ended at a stationary point without a negative direction.
    pub arrived: bool,
    /// Points on the way, each with a spin turned by a quarter radian or more since the last (more on long chains, so that they
    /// fit into memory).
    pub way: Vec<Vec<f64>>,
}

/// Descends from a saddle along ± its valley (a unit field of 3N numbers); c is the stiffness scale (meV).
pub fn descend(h: &Hamiltonian, saddle: &State, valley: &[f64], c: f64) -> Descent {
    let mut trail = Trail::from(&saddle.m);
    let mut state = saddle.clone();
    let mut tau = valley.to_vec();
    let mut arrived = false;
    let mut less_steep = LESS_STEEP;
    for _ in 0..ROUNDS {
        state = march(h, state, &mut tau, c, less_steep, &mut trail);
        let end;
        (state, end) = fall(h, state, c, &mut trail);
        if let Fall::Crawling(v) = end {
            tau = v;
            crate::field::project(&state.m, &mut tau);
            less_steep = 0.0;
            continue;
        }
        less_steep = LESS_STEEP;
        arrived = matches!(end, Fall::Arrived);
        if Spectrum::negatives(h, &state) == 0 || h.is_stopped() {
            break;
        }
        arrived = false;
        crate::field::project(&state.m, &mut tau);
        let Some(mode) = state.lowest_mode() else { break };
        let mut on = state.field(&mode.vector);
        if slab::dot(&on, &tau) < 0.0 {
            slab::scale(&mut on, -1.0);
        }
        tau = on;
    }
    Descent { fallen_mev: h.difference_mev(&saddle.m, &state.m), arrived, m: state.m, way: trail.into_points() }
}

/// Along the valley as long as it falls, and its slope is more than a part of the steepest.
fn march(h: &Hamiltonian, start: State, tau: &mut Vec<f64>, c: f64, part: f64, trail: &mut Trail) -> State {
    let noise = 64.0 * f64::EPSILON * h.stiffness_mev();
    let mut state = start;
    let mut steepest = 0.0f64;
    let mut step = FIRST;
    for _ in 0..MARCH {
        let mut along = tau.clone();
        slab::scale(&mut along, step / rotation_of(tau));
        let mut next = State::at(h, state.moved(&along));
        crate::field::project(&next.m, tau);
        for _ in 0..CORRECTIONS {
            let Some(rotation) = correct(h, &mut next, tau, c) else { break };
            if rotation < ON_THE_WAY * step {
                break;
            }
        }
        if h.difference_mev(&state.m, &next.m) < -noise || h.is_stopped() {
            break;
        }
        state = next;
        trail.pass(&state.m);
        let t = state.basis.coordinates(tau);
        let slope = -slab::dot(&state.slope, &t) / slab::norm(&t);
        if slope < part * steepest {
            break;
        }
        steepest = steepest.max(slope);
        step = (GROWTH * step).min(LONGEST);
    }
    state
}

/// One Newton step across the valley, which bends away from any straight step along it, and the valley's direction there;
/// its size (rad, any spin). None where the valley is lost: straight on, the descent will find the way.
fn correct(h: &Hamiltonian, state: &mut State, tau: &mut Vec<f64>, c: f64) -> Option<f64> {
    let kappa = (h.stiffness_mev() / 3.0).max(c);
    let p = Pinned::rough(state, &state.basis.coordinates(tau), 1e-6 * c, kappa);
    let (d, _) = p.solve(&state.downhill(), 0.0);
    let (w, _) = p.valley();
    if p.complement_negatives > 0 || slab::dot(&w, &p.soft).abs() < 0.05 * slab::norm(&w) {
        return None;
    }
    let mut across = state.field(&d);
    let rotation = rotation_of(&across);
    if rotation > CAP {
        slab::scale(&mut across, CAP / rotation);
    }
    *tau = state.field(&w);
    *state = State::at(h, state.moved(&across));
    crate::field::project(&state.m, tau);
    Some(rotation)
}

/// How a fall ended.
enum Fall {
    /// Where the gradient vanishes.
    Arrived,
    /// On a slope where steps down the gradient are short and a valley is the quicker way; the direction of the last one.
    Crawling(Vec<f64>),
    /// Where no step lowers the energy.
    Stuck,
}

/// Implicit Euler down the gradient, to a point where it vanishes.
fn fall(h: &Hamiltonian, mut state: State, c: f64, trail: &mut Trail) -> (State, Fall) {
    let scale = h.stiffness_mev();
    let tolerance = 4e-15 * scale;
    let mut rate = c;
    let mut short = 0;
    let mut refusals: usize = 0;
    for _ in 0..STEPS {
        if state.max_torque_mev() <= tolerance || h.is_stopped() {
            return (state, Fall::Arrived);
        }
        let Some((next, v, refused)) = euler(h, &state, &mut rate, scale) else { return (state, Fall::Stuck) };
        refusals = if refused { CRAWL } else { refusals.saturating_sub(1) };
        // plain Newton steps that gain nothing: the rest is rounding
        let settled = rate == 0.0
            && next.max_torque_mev() < 1e-9 * c
            && next.max_torque_mev() > 0.5 * state.max_torque_mev()
            && h.difference_mev(&state.m, &next.m) <= 64.0 * f64::EPSILON * scale;
        state = next;
        trail.pass(&state.m);
        if settled {
            return (state, Fall::Arrived);
        }
        short = if refusals > 0 && rotation_of(&v) < SHORT { short + 1 } else { 0 };
        if short >= CRAWL {
            return (state, Fall::Crawling(v));
        }
    }
    (state, Fall::Stuck)
}

/// One step, its field, and whether a longer one was refused. The rate 1/Δt rises until H + rate is positive definite and the
/// energy falls as foretold, and falls again after a step that succeeds at once.
fn euler(h: &Hamiltonian, state: &State, rate: &mut f64, scale: f64) -> Option<(State, Vec<f64>, bool)> {
    let noise = 256.0 * f64::EPSILON * scale;
    let smallest = 1e-14 * scale;
    let mut refused = false;
    while *rate < 1e6 * scale {
        let mut matrix = state.hessian.clone();
        matrix.shift(*rate + smallest);
        let mut x = state.downhill();
        let factors = Ldl::solving(matrix, &mut x, 1);
        if factors.negatives() == 0 {
            let mut v = state.field(&x);
            let rotation = rotation_of(&v);
            if rotation > CAP {
                slab::scale(&mut v, CAP / rotation);
                slab::scale(&mut x, CAP / rotation);
            }
            let next = State::at(h, state.moved(&v));
            let (told, fallen) = (-state.predicted_mev(&x), h.difference_mev(&state.m, &next.m));
            // a fall that was not foretold leads over a maximum into another valley
            let foretold = told < 16.0 * noise || (0.25 * told..4.0 * told).contains(&fallen);
            if foretold && fallen >= -noise {
                if !refused {
                    *rate = if *rate < 4.0 * smallest { 0.0 } else { *rate / 4.0 };
                }
                return Some((next, v, refused));
            }
        }
        refused = true;
        *rate = (4.0 * *rate).max(smallest);
    }
    None
}
