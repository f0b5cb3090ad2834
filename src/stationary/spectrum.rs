//! Counting negative, flat and positive directions of a Hessian, zero modes apart.
//!
//! A sign is told only above the noise floor 8·eps·‖H‖₁. The counts come from the inertia of H ± floor with the zero modes
//! pinned (see [`super::Pinned`]), so they hold for all eigenvalues, not just the few that are computed.

use super::border::pin_all;
use super::point::Point;
use super::state::State;
use super::tolerances::{FEW, INDEPENDENT, STATIONARY};
use crate::energy::Evaluator;
use crate::hessian::{Bound, Place, StandIn, bound};
use crate::linalg::{Factors, Matrix, Wanted, orthonormal};
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
    /// Where there are no factors: how negative a direction may be beside the negative ones, and none is flat to the floor. Nothing
    /// where they were counted, or where there are more negative ones than were looked for.
    #[serde(default)]
    pub bound: Option<Bound>,
}

impl Spectrum {
    /// Of a state, with `count` of its eigenvalues. The counts of signs cost two factorisations, one where none is
    /// negative; eigenvalues cost far more. Where there are no factors, see `bound`.
    pub fn of(h: Evaluator, state: &State, count: usize) -> Spectrum {
        let (spectrum, _) = Spectrum::counted(h, state, |_| None);
        Spectrum { lowest_mev: lowest_eigenvalues_mev(h, state, count, &[]), ..spectrum }
    }

    /// Of a state, without eigenvalues, and the vector of its negative mode (in tangent coordinates) where it has one alone, or of its
    /// flat one where none is negative and one is flat. Where no other eigenvalue is below the floor that mode's own value tells the
    /// counts, by one factorisation. A field (3N) may be `like` that mode.
    pub fn of_saddle(h: Evaluator, state: &State, like: Option<&Vec<f64>>) -> (Spectrum, Option<Vec<f64>>) {
        Spectrum::counted(h, state, |factors| {
            if factors.negatives() != 1 {
                return None;
            }
            let at_hand = state.mode_at_hand(factors, Wanted::Vectors, like);
            at_hand.or_else(|| state.lowest_mode(h).map(|mode| mode.vector))
        })
    }

    /// Of what may be a minimum, without eigenvalues but for the lowest (meV), roughly, where the factors that count the signs tell it.
    pub fn of_minimum(h: Evaluator, state: &State) -> (Spectrum, Option<f64>) {
        let (spectrum, softest) = Spectrum::counted(h, state, |factors| {
            if factors.negatives() == 0 { state.mode_at_hand(factors, Wanted::Size, None) } else { None }
        });
        (spectrum, softest.map(|v| state.curvature_mev(&v)))
    }

    /// The counts, and the mode that `tell` finds by the factors that give them.
    fn counted(
        h: Evaluator,
        state: &State,
        tell: impl Fn(&Factors) -> Option<Vec<f64>>,
    ) -> (Spectrum, Option<Vec<f64>>) {
        let norm_mev = state.hessian.norm1();
        let floor_mev = floor_mev(h, norm_mev);
        if h.forgoes_factors() {
            return Spectrum::bounded(h, state, norm_mev, floor_mev);
        }
        let falls = |v: &Vec<f64>| state.curvature_mev(v) < -floor_mev;
        let mut factors = pinned(h, state.hessian.clone(), &state.zeros, -floor_mev);
        let below_floor = factors.negatives();
        let mut mode = tell(&factors);
        // most states that are looked at are minima, and need no more
        let negative = if below_floor == 0 || mode.as_ref().is_some_and(falls) {
            below_floor
        } else {
            let mut matrix = factors.into_memory();
            matrix.copy_from(&state.hessian);
            factors = pinned(h, matrix, &state.zeros, floor_mev);
            mode = tell(&factors).filter(falls).or(mode.filter(|_| factors.negatives() == 0));
            factors.negatives()
        };
        let flat = below_floor.saturating_sub(negative);
        let zero = state.zeros.len();
        (Spectrum { negative, flat, zero, floor_mev, norm_mev, lowest_mev: Vec::new(), bound: None }, mode)
    }

    /// The counts without factors: negative directions are looked for until the rest is bounded.
    fn bounded(h: Evaluator, state: &State, norm_mev: f64, floor_mev: f64) -> (Spectrum, Option<Vec<f64>>) {
        let stand_in = StandIn::about(&h, &state.m, &state.gradient, h.longest_wave_mev());
        let at = Place { h: &h, m: &state.m, g: &state.gradient, shift: 0.0, pull: 0.0 };
        let zeros: Vec<Vec<f64>> = state.zeros.iter().map(|z| state.field(z)).collect();
        let mut falling: Vec<Vec<f64>> = Vec::new();
        let bound = loop {
            let known = falling.iter().map(|v| state.field(v));
            let border = orthonormal(zeros.iter().cloned().chain(known).collect(), INDEPENDENT);
            let rest = bound(at, &border, &stand_in, &|| h.is_stopped());
            if rest.is_some() || falling.len() == FEW || h.is_stopped() {
                break rest;
            }
            let modes = state.lowest_modes_beside(h, falling.len() + 1, &falling);
            let negative = modes.into_iter().filter(|mode| mode.value < -floor_mev).map(|mode| mode.vector);
            let before = std::mem::replace(&mut falling, negative.collect()).len();
            if falling.len() <= before {
                break None;
            }
        };
        // what is negative and was not found is at least one direction more
        let negative = falling.len() + usize::from(bound.is_none());
        let zero = state.zeros.len();
        let counts = Spectrum { negative, flat: 0, zero, floor_mev, norm_mev, lowest_mev: Vec::new(), bound };
        (counts, if negative == 1 { falling.pop() } else { None })
    }

    /// Directions at a point in which the energy's curvature is less than this (meV), zero modes apart: one factorisation, in the memory
    /// of `matrix`. Without factors those that are negative.
    pub fn softer(h: Evaluator, point: &Point, curvature_mev: f64, matrix: &mut Matrix) -> usize {
        if h.forgoes_factors() {
            return Spectrum::of(h, &State::of(h, point.clone()), 0).negative;
        }
        point.write_hessian(h, -curvature_mev, matrix);
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

/// The lowest eigenvalues of a state's Hessian (meV), so many if there are, ascending, zero modes and frozen spins apart; `known` are
/// the vectors of the lowest of them, as far as these are known.
pub fn lowest_eigenvalues_mev(h: Evaluator, state: &State, count: usize, known: &[Vec<f64>]) -> Vec<f64> {
    let frozen = (0..h.sites()).filter(|&i| h.is_frozen(i)).count();
    let free = (state.hessian.order() - 2 * frozen).saturating_sub(state.zeros.len());
    state.lowest_eigenvalues_mev(h, count.min(free), known)
}

/// The factors of a Hessian + shift·1 whose zero modes are pinned.
fn pinned(h: Evaluator, mut matrix: Matrix, zeros: &[Vec<f64>], shift: f64) -> Factors {
    pin_all(&mut matrix, zeros, h.stiffness_mev());
    matrix.shift(shift);
    matrix.factor()
}

/// What an eigenvalue must exceed in size to have a sign (meV): the rounding error, or what the Hessian leaves out.
pub fn floor_mev(h: Evaluator, norm_mev: f64) -> f64 {
    (8.0 * f64::EPSILON * norm_mev).max(h.hessian_error_mev())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::spins::Spins;
    use crate::stationary::relax_end;

    #[test]
    fn an_end_of_a_film_comes_with_its_stiffness() {
        let lattice = lattice(r#"{"square": {"cells": [14, 9]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let canted = r#"{"dmi": {"D": "0.1 meV", "kind": "interfacial"}}"#;
        let oblique = r#"{"anisotropy": {"K": "0.02 meV", "axis": [1, 2, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy, canted, oblique]);
        let start = Spins::uniform(h.sites(), Direction::Z);
        let end = relax_end((&h).into(), &start, 1e-13 * h.stiffness_mev()).expect("it relaxes");
        let state = State::at((&h).into(), end.spins.as_slice().to_vec());
        let exact = state.lowest_mode((&h).into()).expect("a mode").value;
        let told = end.stiffness_mev.expect("the factors at hand tell it");
        assert!((told / exact - 1.0).abs() < 1e-3, "{told} {exact}");
    }
}
