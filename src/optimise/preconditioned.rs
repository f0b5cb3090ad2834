//! ODE12r: an adaptive Euler step along a preconditioned direction.
//!
//! ```text
//! y = F − F_new,  err = ½h |F_new − F|∞,  h_ls = h F·y/(y·y),  h_err = ½h √(rtol/err)
//! accept if |F_new|∞ ≤ |F|∞ (1 − C₁h)  or  (|F_new|∞ ≤ C₂|F|∞ and err ≤ rtol)
//! accepted: h ← max(h/4, min(4h, h_err, h_ls));   rejected: h ← max(h/10, min(h/4, h_err, h_ls))
//! ```
//! Makri, Ortner, Kermode, J. Chem. Phys. 150, 094109 (2019), doi:10.1063/1.5064465.

use super::{Follows, Method, Optimiser};
use crate::linalg::slab;
use crate::registry::Described;
use crate::sphere::move_points;
use schemars::JsonSchema;
use serde::Deserialize;

const RTOL: f64 = 0.1;
const C1: f64 = 0.01;
const C2: f64 = 2.0;

/// `{"preconditioned": {}}`.
#[derive(Clone, Debug, Default, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Preconditioned {}

impl Described for Preconditioned {
    const NAME: &'static str = "preconditioned";
    const SUMMARY: &'static str =
        "ODE12r on forces preconditioned by the exchange operator: for terms without a banded Hessian";
    const EXAMPLE: &'static str = r#"{"preconditioned": {}}"#;
}

impl Method for Preconditioned {
    fn follows(&self) -> Follows {
        Follows::Preconditioned
    }

    fn start(&self, _: f64) -> Box<dyn Optimiser> {
        Box::new(Ode12r::default())
    }
}

/// The last accepted points with their direction, and the step.
#[derive(Debug, Default)]
struct Ode12r {
    points: Vec<f64>,
    direction: Vec<f64>,
    h: f64,
}

impl Ode12r {
    /// Judges the direction at a trial; returns whether it is accepted and sets the next step.
    fn judge(&mut self, new: &[f64]) -> bool {
        let (old_size, new_size) = (slab::max_abs(&self.direction), slab::max_abs(new));
        let change: Vec<f64> = self.direction.iter().zip(new).map(|(f, n)| f - n).collect();
        let error = 0.5 * self.h * slab::max_abs(&change);
        let accepted = new_size <= old_size * (1.0 - C1 * self.h) || (new_size <= C2 * old_size && error <= RTOL);
        let secant = self.h * slab::dot(&self.direction, &change)
            / (slab::dot(&change, &change) + 1e-10 * slab::dot(&self.direction, &self.direction))
                .max(f64::MIN_POSITIVE);
        let secant = if secant.is_finite() && secant > 1e-8 { secant } else { f64::INFINITY };
        let by_error = 0.5 * self.h * (RTOL / error.max(f64::MIN_POSITIVE)).sqrt();
        let h = self.h;
        self.h = if accepted {
            (4.0 * h).min(by_error).min(secant).max(0.25 * h)
        } else {
            (0.25 * h).min(by_error).min(secant).max(0.1 * h)
        };
        accepted
    }
}

impl Optimiser for Ode12r {
    fn advance(&mut self, points: &mut [f64], slab: usize, direction: &[f64]) {
        let fresh = self.points.len() != points.len();
        if fresh {
            self.h = (0.5 * RTOL.sqrt() / slab::max_abs(direction).max(f64::MIN_POSITIVE)).min(1.0);
        }
        if fresh || self.judge(direction) {
            self.points = points.to_vec();
            self.direction = direction.to_vec();
        } else {
            points.copy_from_slice(&self.points);
        }
        move_points(points, &self.direction, slab, self.h);
    }

    fn memory(&self) -> Vec<Vec<f64>> {
        vec![self.points.clone(), self.direction.clone(), vec![self.h]]
    }

    fn remember(&mut self, memory: Vec<Vec<f64>>) {
        let mut rows = memory.into_iter();
        self.points = rows.next().unwrap_or_default();
        self.direction = rows.next().unwrap_or_default();
        self.h = rows.next().and_then(|row| row.first().copied()).unwrap_or_default();
    }
}
