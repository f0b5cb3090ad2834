//! A configuration with its Hessian.

use super::point::Point;
use crate::energy::Evaluator;
use crate::linalg::{Matrix, Mode, lowest_modes};
use crate::sphere::move_points;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// Everything a Newton step needs, at one configuration: all that a [`Point`] has, and the Hessian.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct State {
    /// Spins, energy and gradient.
    pub point: Point,
    /// Riemannian Hessian in tangent coordinates (meV).
    #[serde(skip)]
    pub hessian: Matrix,
}

impl Deref for State {
    type Target = Point;

    fn deref(&self) -> &Point {
        &self.point
    }
}

impl State {
    /// At the spins `m`.
    pub fn at(h: Evaluator, m: Vec<f64>) -> State {
        State::of(h, Point::at(h, m))
    }

    /// At a point.
    pub fn of(h: Evaluator, point: Point) -> State {
        let mut hessian = Matrix::default();
        point.write_hessian(h, 0.0, &mut hessian);
        State { point, hessian }
    }

    /// The lowest mode, zero modes apart; none where there is no other direction.
    pub fn lowest_mode(&self) -> Option<Mode> {
        lowest_modes(&self.hessian, 1, &self.zeros).into_iter().next()
    }

    /// The spins after a move along a vector field.
    pub fn moved(&self, v: &[f64]) -> Vec<f64> {
        let mut m = self.m.clone();
        move_points(&mut m, v, v.len(), 1.0);
        m
    }
}
