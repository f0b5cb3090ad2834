//! A configuration with its Hessian.

use super::point::Point;
use crate::energy::Evaluator;
use crate::hessian::Resolvent;
use crate::linalg::{Matrix, Mode, Wanted, lowest_modes, softest};
use crate::sphere::move_points;
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// Modes are found sooner without factors where those take so many solutions' arithmetic: from films of some 130² sites on, cubes of 12³.
const DEAR: f64 = 36.0;

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
    pub fn lowest_mode(&self, h: Evaluator) -> Option<Mode> {
        self.lowest_modes(h, 1).into_iter().next()
    }

    /// The lowest modes, so many if there are, zero modes apart; where factors take long, without them if that can be had.
    pub fn lowest_modes(&self, h: Evaluator, count: usize) -> Vec<Mode> {
        self.modes(h, count, Wanted::Vectors)
    }

    /// Their eigenvalues (meV) alone.
    pub fn lowest_eigenvalues_mev(&self, h: Evaluator, count: usize) -> Vec<f64> {
        self.modes(h, count, Wanted::Values).into_iter().map(|mode| mode.value).collect()
    }

    fn modes(&self, h: Evaluator, count: usize, wanted: Wanted) -> Vec<Mode> {
        let iterated = || {
            let nearly = Resolvent::at(&h, &self.m, &self.gradient, &self.basis);
            let apply = |x: &mut [f64], theta: f64| nearly.apply(x, theta);
            softest(&self.hessian, count, &self.zeros, wanted, &apply, &|| h.is_stopped())
        };
        let found = (h.solutions_a_factor() > DEAR).then(iterated).flatten();
        found.unwrap_or_else(|| lowest_modes(&self.hessian, count, &self.zeros))
    }

    /// The spins after a move along a vector field.
    pub fn moved(&self, v: &[f64]) -> Vec<f64> {
        let mut m = self.m.clone();
        move_points(&mut m, v, v.len(), 1.0);
        m
    }
}
