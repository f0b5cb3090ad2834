//! The ways that a state takes when it is moved.

use super::super::Unstable;
use super::super::bordered::Bordered;
use super::moves::towards;
use crate::energy::Evaluator;
use crate::linalg::{Factors, Matrix, combination, eigen_symmetric, orthonormal, remove, slab};
use crate::stationary::{Pin, State, pin};

/// The way that a state takes when it is moved.
#[derive(Debug)]
pub(super) struct Valley {
    /// Unit, tangent coordinates (2N).
    pub along: Vec<f64>,
    /// Of the energy as the state is moved along it and all else follows (meV), not negative.
    pub stiffness_mev: f64,
    /// Of the energy along it (meV).
    pub curvature_mev: f64,
}

/// A stationary state, held against rotations about symmetry axes and against its descent.
pub(super) struct Held<'a> {
    pub state: &'a State,
    /// Orthonormal, tangent coordinates.
    against: Vec<Vec<f64>>,
    /// Stiffness of pins (meV).
    kappa: f64,
}

impl<'a> Held<'a> {
    /// A state with its descending mode; κ of the Hessian's size (meV).
    pub fn new(state: &'a State, unstable: Option<&Unstable>, kappa: f64) -> Held<'a> {
        let against = state.zeros.iter().chain(unstable.map(|u| &u.mode)).cloned().collect();
        Held { state, against, kappa }
    }

    /// A field (3N) in tangent coordinates (2N), but for what the state is held against; nothing where that is no motion, or is most of
    /// it.
    pub fn tangent(&self, field: &[f64]) -> Option<Vec<f64>> {
        let mut along = self.state.basis.coordinates(field);
        let whole = slab::norm(&along);
        remove(&mut along, &self.against);
        let size = slab::norm(&along);
        (size * size > 0.5 * whole * whole && size > 1e-6).then_some(along)
    }

    /// How much higher (meV) the state is half-way along a hop (3N), at rest by a step of Newton but for the hop and what it is held
    /// against.
    pub fn top_between_mev(&self, h: Evaluator, hop: &[f64]) -> Option<f64> {
        let half: Vec<f64> = hop.iter().map(|x| 0.5 * x).collect();
        let State { point: between, hessian } = State::at(h, self.state.moved(&half));
        let back = towards(&between.m, &self.state.m);
        let held =
            self.against[self.state.zeros.len()..].iter().map(|t| between.basis.coordinates(&self.state.field(t)));
        let own = std::iter::once(between.basis.coordinates(&back)).chain(held);
        let directions = orthonormal(between.zeros.iter().cloned().chain(own).collect(), 0.0);
        let (factors, pins) = self.pinned(hessian, directions.iter());
        let bordered = Bordered::new(&factors, directions.iter().collect(), &pins, self.kappa);
        let fall = bordered.fall_mev(&between.basis.coordinates(&between.gradient))?;
        Some(h.difference_mev(&between.m, &self.state.m) - fall)
    }

    /// The factors of a Hessian with a pin for each of some directions.
    fn pinned<'b>(&self, mut hessian: Matrix, directions: impl Iterator<Item = &'b Vec<f64>>) -> (Factors, Vec<Pin>) {
        let mut used = Vec::new();
        let pins = directions.map(|z| pin(&mut hessian, z, &mut used, self.kappa)).collect();
        (hessian.factor(), pins)
    }

    /// The valleys along a space of orthonormal directions, the softest first.
    pub fn valleys(&self, span: &[Vec<f64>]) -> Vec<Valley> {
        if span.is_empty() {
            return Vec::new();
        }
        let zeros = &self.state.zeros;
        let (factors, pins) = self.pinned(self.state.hessian.clone(), zeros.iter().chain(span));
        let along = |space: &[Vec<f64>]| -> Vec<(Vec<f64>, Vec<f64>)> {
            let bordered = Bordered::new(&factors, zeros.iter().chain(space).collect(), &pins, self.kappa);
            (zeros.len()..pins.len()).filter_map(|k| bordered.valley(k)).collect()
        };
        let ways = along(span).into_iter().map(|(mut y, _)| {
            remove(&mut y, &self.against);
            y
        });
        let space = orthonormal(ways.collect(), 0.0);
        let rows = along(&space);
        if rows.len() < span.len() {
            return Vec::new();
        }
        let stiffness = |a: usize, b: usize| 0.5 * (rows[a].1[zeros.len() + b] + rows[b].1[zeros.len() + a]);
        let n = rows.len();
        let (values, vectors) = eigen_symmetric(&(0..n * n).map(|k| stiffness(k / n, k % n)).collect::<Vec<_>>(), n);
        let valley = |(value, weights): (f64, &Vec<f64>)| {
            let along = combination(weights, &space);
            let mut force = vec![0.0; along.len()];
            self.state.hessian.multiply(&along, &mut force);
            Valley { curvature_mev: slab::dot(&along, &force), stiffness_mev: value.max(0.0), along }
        };
        values.into_iter().zip(&vectors).map(valley).collect()
    }
}
