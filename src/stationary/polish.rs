//! The last digits of a stationary point: a few plain Newton steps, and of the points on the way the one with the least torque.
//!
//! A valley bends, so that a step along a soft mode first costs torque across it.

use super::border::pin;
use super::state::State;
use crate::energy::Evaluator;
use crate::linalg::remove;
use crate::sphere::rotation_of;

/// Most steps.
const STEPS: usize = 6;
/// A longer step (rad, any spin) is no last digit.
const FARTHEST: f64 = 0.05;

/// The stationary point that `state` all but is, the zero modes left as they are. A state from which Newton's method leads far
/// away, or nowhere, is given back as it came.
pub fn polish(h: Evaluator, state: State) -> State {
    let mut best = state.clone();
    let mut state = state;
    for _ in 0..STEPS {
        if best.max_torque_mev() <= 4e-15 * h.stiffness_mev() {
            break;
        }
        let Some(next) = newton(h, &state) else { break };
        if next.max_torque_mev() < best.max_torque_mev() {
            best = next.clone();
        }
        state = next;
    }
    best
}

fn newton(h: Evaluator, state: &State) -> Option<State> {
    let mut matrix = state.hessian.clone();
    let mut used = Vec::new();
    for z in &state.zeros {
        pin(&mut matrix, z, &mut used, h.stiffness_mev());
    }
    let mut x = state.downhill();
    remove(&mut x, &state.zeros);
    matrix.factor().solve(&mut x, 1);
    remove(&mut x, &state.zeros);
    let v = state.field(&x);
    // a NaN is no small rotation either
    (rotation_of(&v) < FARTHEST).then(|| State::at(h, state.moved(&v)))
}
