//! Relaxing a state to its minimum: Newton's method with a shift that keeps the Hessian positive, and descent checked.

use super::outcome::MOVED_FAR_RAD;
use crate::energy::Hamiltonian;
use crate::error::{Error, Result};
use crate::linalg::{Banded, Ldl, slab};
use crate::path::largest_angle;
use crate::saddle::{Point, Spectrum, State, descend, polish};
use crate::sphere::rotation_of;
use crate::spins::Spins;
use std::mem::take;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.5;
/// Most Newton steps.
const STEPS: usize = 500;
/// How often a stationary state that is no minimum is left.
const KICKS: usize = 8;

/// A relaxed state.
#[derive(Clone, Debug)]
pub struct Relaxed {
    /// The spins.
    pub spins: Spins,
    /// Largest component of the remaining force (meV).
    pub max_torque_mev: f64,
    /// Newton steps taken.
    pub steps: usize,
    /// Largest rotation of any spin from where it was put (rad).
    pub largest_rotation_rad: f64,
    /// The state as given was stationary but no minimum, and was left along its lowest mode.
    pub left_saddle: bool,
    /// The force fell below the tolerance.
    pub converged: bool,
}

/// The minimum that `start` relaxes to, with every force component below `tolerance_mev`.
pub fn relax_to_minimum(h: &Hamiltonian, start: &Spins, tolerance_mev: f64) -> Result<Relaxed> {
    let mut p = Point::at(h, start.as_slice().to_vec());
    let mut shift = 0.0;
    let mut left_saddle = false;
    let mut kicks = 0;
    let mut steps = 0;
    let mut stalled = 0;
    let mut memory = Banded::default();
    while steps < STEPS {
        if h.is_stopped() {
            return Err(Error::Stopped);
        }
        if !p.max_torque_mev().is_finite() {
            return Err(Error::Numerical(
                "the forces on the state are not finite numbers: are the energies absurdly large?".into(),
            ));
        }
        if p.max_torque_mev() <= tolerance_mev || stalled >= 2 {
            if kicks == KICKS {
                break;
            }
            let Some(below) = way_down(h, &p, &mut memory) else { break };
            left_saddle = true;
            kicks += 1;
            p = below;
            (shift, stalled, steps) = (0.0, 0, steps + 1);
            continue;
        }
        let before = p.max_torque_mev();
        let next = newton_step(h, &p, &mut shift, &mut memory);
        let Some(next) = next else { break };
        let torque = next.max_torque_mev();
        stalled = if torque > 0.5 * before && torque < 20.0 * tolerance_mev { stalled + 1 } else { 0 };
        p = next;
        steps += 1;
    }
    if p.max_torque_mev() > tolerance_mev && p.max_torque_mev() < 1e6 * tolerance_mev {
        // the shift makes steps along a valley that is all but flat short
        p = polish(h, State::of(h, p)).point;
    }
    Ok(Relaxed {
        max_torque_mev: p.max_torque_mev(),
        steps,
        largest_rotation_rad: largest_angle(start.as_slice(), &p.m),
        left_saddle,
        converged: p.max_torque_mev() <= 1e3 * tolerance_mev,
        spins: Spins::from_unit_components(&p.m),
    })
}

/// One accepted step: (H + shift) v = F, capped, with a larger shift as long as the energy would rise.
fn newton_step(h: &Hamiltonian, p: &Point, shift: &mut f64, memory: &mut Banded) -> Option<Point> {
    let scale = h.stiffness_mev();
    let slack = 1e-13 * (p.energy_mev.abs() + scale);
    while *shift < 1e6 * scale {
        let mut matrix = take(memory);
        p.write_hessian(h, *shift + 1e-12 * scale, &mut matrix);
        let mut x = p.downhill();
        let factors = Ldl::solving(matrix, &mut x, 1);
        let positive = factors.negatives() == 0;
        *memory = factors.into_memory();
        if positive {
            let mut v = p.field(&x);
            let rotation = rotation_of(&v);
            if rotation > CAP {
                slab::scale(&mut v, CAP / rotation);
            }
            let mut next = Point::default();
            next.go(h, p, &v);
            if next.energy_mev <= p.energy_mev + slack {
                *shift = if *shift > 1e-4 * scale { *shift / 4.0 } else { 0.0 };
                return Some(next);
            }
        }
        *shift = (4.0 * *shift).max(1e-3 * scale);
    }
    None
}

/// From a stationary state with a negative direction: the minimum below it; nothing if it is a minimum itself.
fn way_down(h: &Hamiltonian, p: &Point, memory: &mut Banded) -> Option<Point> {
    if Spectrum::negatives(h, p, memory) == 0 {
        return None;
    }
    let state = State::of(h, p.clone());
    let mode = state.lowest_mode()?;
    let descent = descend(h, &state, &state.field(&mode.vector), h.stiffness_mev());
    Some(Point::at(h, descent.m))
}

/// An end that stays as given.
pub fn kept(h: &Hamiltonian, spins: &Spins) -> Relaxed {
    Relaxed {
        spins: spins.clone(),
        max_torque_mev: Point::at(h, spins.as_slice().to_vec()).max_torque_mev(),
        steps: 0,
        largest_rotation_rad: 0.0,
        left_saddle: false,
        converged: true,
    }
}

/// What a user should know of how an end relaxed.
pub fn judge_end(r: &Relaxed, which: &str) -> Vec<String> {
    let mut warnings = Vec::new();
    let degrees = r.largest_rotation_rad.to_degrees();
    if r.left_saddle {
        warnings.push(format!("the {which} state was stationary but no minimum; it was left along its lowest mode"));
    }
    if r.largest_rotation_rad > MOVED_FAR_RAD {
        warnings.push(format!("the {which} state relaxed far from where it was put: a spin turned by {degrees:.0} degrees, so it may be another state than meant"));
    }
    if !r.converged {
        warnings
            .push(format!("the {which} state did not relax fully: a torque of {:.1e} meV remains", r.max_torque_mev));
    }
    warnings
}
