//! The gradient's flow dm/dt = −g, step by step: stiff directions relaxed however long a step is, those that are soft followed.
//!
//! ```text
//! A = H + 1/(d Δt),  f(v) = −g at the end of v,  d = 1/(2 + √2)
//! A u₁ = f(0)/d,  A (u₂ − u₁) = f(u₁/2)/d − u₁/(d Δt)                                             the step is u₂
//! A w = (f(u₂) + (e − 2) f(u₁/2) + f(0))/d − e u₂/(d Δt),  e = 6 + √2                             its error w/6
//! ```
//! A Rosenbrock method of second order, L-stable, with three solutions by one factor (ode23s: L. F. Shampine, M. W. Reichelt, SIAM J. Sci.
//! Comput. 18, 1 (1997), doi:10.1137/S1064827594276424; w is u₁ − 2 u₂ + u₃ of their third stage, solved for at once, as where no
//! factors are it need be right only roughly), in the tangent space of the step's start. As Δt grows it becomes Newton's.

use super::point::Point;
use super::tolerances::{ROUGHLY, STEP};
use super::unfactored::{LEFT, Unfactored};
use crate::energy::Evaluator;
use crate::linalg::{Factors, Matrix, remove, slab};
use crate::sphere::rotation_of;
use std::f64::consts::SQRT_2;
use std::mem::take;

/// d and e of the method.
pub const D: f64 = 1.0 / (2.0 + SQRT_2);
const E: f64 = 6.0 + SQRT_2;

/// A step.
#[derive(Debug)]
pub struct Flown {
    /// The step (3N).
    pub v: Vec<f64>,
    /// Largest rotation of a spin (rad), and the largest by which it may be wrong.
    pub rotation: f64,
    /// The error of that (rad).
    pub error: f64,
    /// How steeply the energy falls where it begins, along it (meV/rad), and where it ends.
    pub slopes_mev: [f64; 2],
}

/// One step from `here` to `next`, of 1/(d Δt) = `rate` (meV); `matrix` is memory. None where H + rate is not positive definite, or along the
/// step not by half the rate, so near to where the method has a pole; and where the step turns a spin by more than about [`STEP`] (rad).
pub fn flow(
    h: Evaluator,
    here: &Point,
    next: &mut Point,
    rate: f64,
    matrix: &mut Matrix,
    without: Option<&mut Unfactored>,
) -> Option<Flown> {
    let mut equations = Equations::at(h, here, rate, matrix, without)?;
    let flown = step(h, here, next, rate, &mut equations);
    if let Equations::Factors(factors) = equations {
        *matrix = factors.into_memory();
    }
    flown
}

fn step(h: Evaluator, here: &Point, next: &mut Point, rate: f64, equations: &mut Equations) -> Option<Flown> {
    let mut v = Vec::new();
    let f0 = force(here, here);
    let u1 = equations.solve(here, sum(&[(1.0 / D, &f0)]), LEFT)?;
    here.write_field(&u1, &mut v);
    // it is half of this that the next force is taken at, and what comes of it is the shorter by d
    let is_near_pole = slab::dot(&u1, &f0) < 0.5 * D * rate * slab::dot(&u1, &u1);
    if is_near_pole || D * rotation_of(&v) > STEP {
        return None;
    }
    slab::scale(&mut v, 0.5);
    next.go(h, here, &v);
    let f1 = force(here, next);
    let mut u2 = equations.solve(here, sum(&[(1.0 / D, &f1), (-rate, &u1)]), LEFT)?;
    slab::add_scaled(&mut u2, 1.0, &u1);
    here.write_field(&u2, &mut v);
    next.go(h, here, &v);
    let f2 = force(here, next);
    let w = sum(&[(1.0 / D, &f2), ((E - 2.0) / D, &f1), (1.0 / D, &f0), (-E * rate, &u2)]);
    let w = equations.solve(here, w, ROUGHLY)?;
    let length = slab::norm(&u2);
    let slopes_mev = [&f0, &f2].map(|f| slab::dot(&u2, f) / length);
    Some(Flown { rotation: rotation_of(&v), error: rotation_of(&here.field(&w)) / 6.0, slopes_mev, v })
}

/// The force at a point, in the tangent coordinates of another one.
fn force(here: &Point, there: &Point) -> Vec<f64> {
    let mut force = here.basis.coordinates(&there.field(&there.downhill()));
    remove(&mut force, &here.zeros);
    force
}

fn sum(parts: &[(f64, &Vec<f64>)]) -> Vec<f64> {
    let mut sum = vec![0.0; parts[0].1.len()];
    parts.iter().for_each(|(a, x)| slab::add_scaled(&mut sum, *a, x));
    sum
}

/// (H + rate) x = b at one point.
enum Equations<'a, 'b> {
    Factors(Box<Factors>),
    Without(Evaluator<'a>, f64, &'b mut Unfactored),
}

impl<'a, 'b> Equations<'a, 'b> {
    /// None where a direction is negative.
    fn at(
        h: Evaluator<'a>,
        here: &Point,
        rate: f64,
        matrix: &mut Matrix,
        without: Option<&'b mut Unfactored>,
    ) -> Option<Equations<'a, 'b>> {
        if let Some(unfactored) = without {
            return Some(Equations::Without(h, rate, unfactored));
        }
        here.write_hessian(h, rate, matrix);
        let factors = take(matrix).factor();
        if factors.negatives() > 0 {
            *matrix = factors.into_memory();
            return None;
        }
        Some(Equations::Factors(Box::new(factors)))
    }

    /// Solves; without factors, until a part `left` of the residual is left.
    fn solve(&mut self, here: &Point, mut b: Vec<f64>, left: f64) -> Option<Vec<f64>> {
        match self {
            Equations::Factors(factors) => factors.solve(&mut b, 1),
            Equations::Without(h, rate, unfactored) => {
                let x = unfactored.solve_until(left, h, here, *rate, &[], &here.field(&b))?;
                here.basis.write_coordinates(x, &mut b);
            }
        }
        remove(&mut b, &here.zeros);
        Some(b)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::spins::Spins;

    /// One spin with an easy axis flows as tan θ = tan θ₀ exp(−2Kt).
    #[test]
    fn a_spin_flows_as_known_and_its_error_falls_with_the_cube_of_the_step() {
        let one = lattice(r#"{"chain": {"sites": 1}}"#);
        let h = hamiltonian(&one, &[r#"{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1]}}"#]);
        let h = Evaluator::from(&h);
        let start = 0.4f64;
        let m = Spins::from_vectors(&[[start.sin(), 0.0, start.cos()]]).unwrap().as_slice().to_vec();
        let wrong = |dt: f64| {
            let (here, mut next, mut matrix) = (Point::at(h, m.clone()), Point::default(), Matrix::default());
            let flown = flow(h, &here, &mut next, 1.0 / (D * dt), &mut matrix, None).unwrap();
            let exact = (start.tan() * (-2.0 * dt).exp()).atan();
            let off = (next.m[0].atan2(next.m[2]) - exact).abs();
            assert!(off < flown.error && flown.slopes_mev[0] > flown.slopes_mev[1], "{off:e} {flown:?}");
            [off, flown.error]
        };
        let [long, short] = [wrong(0.04), wrong(0.02)];
        for (long, short) in long.iter().zip(short) {
            assert!((6.0..10.0).contains(&(long / short)), "{long:e} {short:e}");
        }
    }

    #[test]
    fn without_factors_a_step_is_the_same_and_its_error_is_roughly() {
        let film = lattice(r#"{"square": {"cells": [14, 9]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&film, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let h = Evaluator::from(&h);
        // a wall that leaves the film
        let spin = |i: usize| {
            let angle = 2.0 * libm::atan(libm::exp(0.4 * ((i % 14) as f64 - 3.0)));
            [libm::sin(angle), 0.0, libm::cos(angle)]
        };
        let m = Spins::from_vectors(&(0..film.sites).map(spin).collect::<Vec<_>>()).unwrap().as_slice().to_vec();
        let (here, mut next, mut matrix) = (Point::at(h, m), Point::default(), Matrix::default());
        for rate in [0.5, 3.0] {
            let exact = flow(h, &here, &mut next, rate, &mut matrix, None).unwrap();
            let mut without = Unfactored::about(&h, &here, 0.2);
            let found = flow(h, &here, &mut next, rate, &mut matrix, Some(&mut without)).unwrap();
            let off = exact.v.iter().zip(&found.v).fold(0.0f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(off < 1e-5 * exact.rotation && exact.rotation > 0.01, "{rate}: {off:e} {}", exact.rotation);
            let ratio = found.error / exact.error;
            assert!((0.5..1.5).contains(&ratio), "{rate}: {ratio}");
        }
    }

    #[test]
    fn where_a_direction_falls_faster_than_the_rate_there_is_no_step() {
        let one = lattice(r#"{"chain": {"sites": 1}}"#);
        let h = hamiltonian(&one, &[r#"{"anisotropy": {"K": "1 meV", "axis": [0, 0, 1]}}"#]);
        let h = Evaluator::from(&h);
        let m = Spins::from_vectors(&[[1.0, 0.0, 0.01]]).unwrap().as_slice().to_vec();
        let (here, mut next, mut matrix) = (Point::at(h, m), Point::default(), Matrix::default());
        assert!(flow(h, &here, &mut next, 1.9, &mut matrix, None).is_none());
        assert!(flow(h, &here, &mut next, 20.0, &mut matrix, None).is_some());
    }
}
