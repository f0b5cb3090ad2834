//! Relaxing a state to its minimum: Newton's method with a shift that keeps the Hessian positive, and descent checked.

use crate::energy::{Hamiltonian, TangentBasis, assemble};
use crate::error::{Error, Result};
use crate::linalg::{Banded, slab};
use crate::path::largest_angle;
use crate::saddle::{Spectrum, State, descend, polish};
use crate::sphere::{move_points, rotation_of};
use crate::spins::Spins;

/// Largest rotation of a spin in one step (rad).
const CAP: f64 = 0.5;
/// Most Newton steps.
const STEPS: usize = 500;
/// How often a stationary state that is no minimum is left.
const KICKS: usize = 8;

/// An end that turned by more than this left the place where it was put (rad).
const FAR: f64 = 1.0;

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

/// A configuration with its derivatives.
struct Point {
    m: Vec<f64>,
    gradient: Vec<f64>,
    force: Vec<f64>,
    energy: f64,
}

impl Point {
    fn at(h: &Hamiltonian, m: Vec<f64>) -> Point {
        let mut p = Point { gradient: vec![0.0; m.len()], force: vec![0.0; m.len()], energy: 0.0, m };
        p.energy = h.energy_gradient(&p.m, &mut p.gradient);
        h.force(&p.m, &p.gradient, &mut p.force);
        p
    }

    fn moved(&self, h: &Hamiltonian, v: &[f64]) -> Point {
        let mut m = self.m.clone();
        move_points(&mut m, v, v.len(), 1.0);
        Point::at(h, m)
    }

    fn torque(&self) -> f64 {
        slab::max_abs(&self.force)
    }
}

/// The minimum that `start` relaxes to, with every force component below `tolerance_mev`.
pub fn relax_to_minimum(h: &Hamiltonian, start: &Spins, tolerance_mev: f64) -> Result<Relaxed> {
    let mut p = Point::at(h, start.as_slice().to_vec());
    let mut shift = 0.0;
    let mut left_saddle = false;
    let mut kicks = 0;
    let mut steps = 0;
    let mut stalled = 0;
    while steps < STEPS {
        if h.is_stopped() {
            return Err(Error::Stopped);
        }
        if !p.torque().is_finite() {
            return Err(Error::Numerical(
                "the forces on the state are not finite numbers: are the energies absurdly large?".into(),
            ));
        }
        if p.torque() <= tolerance_mev || stalled >= 2 {
            if kicks == KICKS {
                break;
            }
            let Some(below) = way_down(h, &p) else { break };
            left_saddle = true;
            kicks += 1;
            p = below;
            (shift, stalled, steps) = (0.0, 0, steps + 1);
            continue;
        }
        let before = p.torque();
        let basis = TangentBasis::at(&p.m);
        let hessian = assemble(h, &p.m, &p.gradient, &basis);
        let next = newton_step(h, &p, &hessian, &basis, &mut shift);
        let Some(next) = next else { break };
        stalled = if next.torque() > 0.5 * before && next.torque() < 20.0 * tolerance_mev { stalled + 1 } else { 0 };
        p = next;
        steps += 1;
    }
    if p.torque() > tolerance_mev && p.torque() < 1e6 * tolerance_mev {
        // the shift makes steps along a valley that is all but flat short
        p = Point::at(h, polish(h, State::at(h, p.m)).m);
    }
    Ok(Relaxed {
        max_torque_mev: p.torque(),
        steps,
        largest_rotation_rad: largest_angle(start.as_slice(), &p.m),
        left_saddle,
        converged: p.torque() <= 1e3 * tolerance_mev,
        spins: Spins::from_unit_components(&p.m),
    })
}

/// One accepted step: (H + shift) v = F, capped, with a larger shift as long as the energy would rise.
fn newton_step(h: &Hamiltonian, p: &Point, hessian: &Banded, basis: &TangentBasis, shift: &mut f64) -> Option<Point> {
    let scale = h.stiffness_mev();
    let slack = 1e-13 * (p.energy.abs() + scale);
    let force = basis.coordinates(&p.force);
    while *shift < 1e6 * scale {
        let mut matrix = hessian.clone();
        matrix.shift(*shift + 1e-12 * scale);
        let factors = matrix.factor();
        if factors.negatives() == 0 {
            let mut x = force.clone();
            factors.solve(&mut x, 1);
            let mut v = vec![0.0; p.m.len()];
            basis.field(&x, &mut v);
            let rotation = rotation_of(&v);
            if rotation > CAP {
                slab::scale(&mut v, CAP / rotation);
            }
            let next = p.moved(h, &v);
            if next.energy <= p.energy + slack {
                *shift = if *shift > 1e-4 * scale { *shift / 4.0 } else { 0.0 };
                return Some(next);
            }
        }
        *shift = (4.0 * *shift).max(1e-3 * scale);
    }
    None
}

/// From a stationary state with a negative direction: the minimum below it; nothing if it is a minimum itself.
fn way_down(h: &Hamiltonian, p: &Point) -> Option<Point> {
    let state = State::at(h, p.m.clone());
    if Spectrum::negatives(h, &state) == 0 {
        return None;
    }
    let mode = state.lowest_mode()?;
    let descent = descend(h, &state, &state.field(&mode.vector), h.stiffness_mev());
    Some(Point::at(h, descent.m))
}

/// An end that stays as given.
pub fn kept(h: &Hamiltonian, spins: &Spins) -> Relaxed {
    Relaxed {
        spins: spins.clone(),
        max_torque_mev: Point::at(h, spins.as_slice().to_vec()).torque(),
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
    if r.largest_rotation_rad > FAR {
        warnings.push(format!("the {which} state relaxed far from where it was put: a spin turned by {degrees:.0} degrees, so it may be another state than meant"));
    }
    if !r.converged {
        warnings
            .push(format!("the {which} state did not relax fully: a torque of {:.1e} meV remains", r.max_torque_mev));
    }
    warnings
}
