//! Counting negative, flat and positive directions of a Hessian, zero modes apart.
//!
//! A sign is told only above the noise floor 8·eps·‖H‖₁. The counts come from the inertia of H ± floor with the zero modes
//! pinned (see [`super::Pinned`]), so they hold for all eigenvalues, not just the few that are computed.

use super::border::pin;
use super::point::Point;
use super::state::State;
use super::tolerances::STATIONARY;
use crate::energy::Evaluator;
use crate::linalg::{Factors, Matrix};
use serde::{Deserialize, Serialize};
use std::mem::take;

/// What kind of stationary point a state is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spectrum {
    /// Eigenvalues below −floor.
    pub negative: usize,
    /// Eigenvalues within the floor.
    pub flat: usize,
    /// Exact zero modes: rotations about symmetry axes.
    pub zero: usize,
    /// The floor 8·eps·‖H‖₁ (meV).
    pub floor_mev: f64,
    /// ‖H‖₁ (meV).
    pub norm_mev: f64,
    /// The lowest eigenvalues (meV), as many as were asked for, ascending, zero modes and frozen spins apart.
    pub lowest_mev: Vec<f64>,
}

impl Spectrum {
    /// Of a state, with `count` of its eigenvalues. The counts of signs cost two factorisations, one where none is
    /// negative; eigenvalues cost far more.
    pub fn of(h: Evaluator, state: &State, count: usize) -> Spectrum {
        let norm_mev = state.hessian.norm1();
        let floor_mev = floor_mev(h, norm_mev);
        let below = |shift: f64| pinned(h, state.hessian.clone(), &state.zeros, shift).negatives();
        let below_floor = below(-floor_mev);
        // most states that are looked at are minima, and need no more
        let negative = if below_floor == 0 { 0 } else { below(floor_mev) };
        let flat = below_floor.saturating_sub(negative);
        let lowest_mev = lowest_eigenvalues_mev(h, state, count);
        Spectrum { negative, flat, zero: state.zeros.len(), floor_mev, norm_mev, lowest_mev }
    }

    /// Negative directions at a point, zero modes apart: one factorisation, in the memory of `matrix`.
    pub fn negatives(h: Evaluator, point: &Point, matrix: &mut Matrix) -> usize {
        point.write_hessian(h, 0.0, matrix);
        let floor = floor_mev(h, matrix.norm1());
        let factors = pinned(h, take(matrix), &point.zeros, floor);
        let negatives = factors.negatives();
        *matrix = factors.into_memory();
        negatives
    }

    /// Zero modes and flat ones together, as results report them.
    pub fn zero_and_flat(&self) -> usize {
        self.zero + self.flat
    }

    /// Whether a torque is zero as far as double precision tells: |grad|∞ ≤ 1e-12·‖H‖₁.
    pub fn is_stationary(&self, torque_mev: f64) -> bool {
        torque_mev <= STATIONARY * self.norm_mev
    }
}

/// The lowest eigenvalues of a state's Hessian (meV), so many if there are, ascending, zero modes and frozen spins apart.
pub fn lowest_eigenvalues_mev(h: Evaluator, state: &State, count: usize) -> Vec<f64> {
    let frozen = (0..h.sites()).filter(|&i| h.is_frozen(i)).count();
    let free = (state.hessian.order() - 2 * frozen).saturating_sub(state.zeros.len());
    state.lowest_eigenvalues_mev(h, count.min(free))
}

/// The factors of a Hessian + shift·1 whose zero modes are pinned.
fn pinned(h: Evaluator, mut matrix: Matrix, zeros: &[Vec<f64>], shift: f64) -> Factors {
    let mut used = Vec::new();
    for z in zeros {
        pin(&mut matrix, z, &mut used, h.stiffness_mev());
    }
    matrix.shift(shift);
    matrix.factor()
}

/// What an eigenvalue must exceed in size to have a sign (meV): the rounding error, or what the Hessian leaves out.
fn floor_mev(h: Evaluator, norm_mev: f64) -> f64 {
    (8.0 * f64::EPSILON * norm_mev).max(h.hessian_error_mev())
}
