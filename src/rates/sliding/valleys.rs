//! The ways that a state takes when it is moved.

use super::super::Unstable;
use super::super::bordered::Bordered;
use super::pinning::Pinning;
use crate::energy::Evaluator;
use crate::field::Components;
use crate::linalg::{Factors, Matrix, combination, eigen_symmetric, orthonormal, remove, slab};
use crate::sphere::write_logs;
use crate::stationary::{Pin, Point, State, pin};

/// What turns the spins by less (rad) moves nothing.
pub const LEAST: f64 = 1e-6;
/// Most steps to where a state rests half-way, and the part of its height that it may fall short of it by.
const STEPS: usize = 12;
const SETTLED: f64 = 1e-2;
/// How often a step that does not lead down is halved.
const HALVINGS: i32 = 6;

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
        (size * size > 0.5 * whole * whole && size > LEAST).then_some(along)
    }

    /// How much higher (meV) the state is half-way to the next place: from these spins (3N) down to where it is at rest, by steps of
    /// Newton, but for the directions `along` the valley and others as soft there (3N), and the descent, which `carried` brings there
    /// (3N). No less than that where it does not come to rest soon, and nothing where it comes back.
    pub fn top_mev(
        &self,
        h: Evaluator,
        start: Vec<f64>,
        along: impl Fn(&Point) -> Vec<Vec<f64>>,
        carried: impl Fn(Vec<f64>) -> Vec<f64>,
    ) -> Option<f64> {
        let descents = &self.against[self.state.zeros.len()..];
        let descents: Vec<Vec<f64>> = descents.iter().map(|t| carried(self.state.field(t))).collect();
        let mut here = Point::at(h, start.clone());
        for _ in 0..STEPS {
            let own = along(&here).into_iter().chain(descents.iter().cloned());
            let own = own.map(|field| here.basis.coordinates(&field));
            let directions = orthonormal(here.zeros.iter().cloned().chain(own).collect(), LEAST);
            let (factors, pins) = self.pinned(State::of(h, here.clone()).hessian, directions.iter());
            let bordered = Bordered::new(&factors, directions.iter().collect(), &pins, self.kappa);
            let way = bordered.to_rest(&here.slope)?;
            let falls_mev = -0.5 * slab::dot(&here.slope, &way);
            let top_mev = here.above_mev(&self.state.point) - falls_mev;
            if falls_mev.abs() <= SETTLED * top_mev.abs() {
                return Some(top_mev);
            }
            let field = here.field(&way);
            let mut parts = (0..HALVINGS).map(|k| {
                let mut there = Point::default();
                there.go(h, &here, &field.iter().map(|x| 0.5f64.powi(k) * x).collect::<Vec<f64>>());
                there
            });
            let Some(lower) = parts.find(|there| there.above_mev(&here) < 0.0) else { break };
            if slab::norm(&towards(&lower.m, &self.state.m)) < slab::norm(&towards(&lower.m, &start)) {
                return None;
            }
            here = lower;
        }
        Some(here.above_mev(&self.state.point))
    }

    /// What a place costs along a move ∂m/∂x (2N), all else following, with its top half-way to the next (meV).
    pub fn pinning(&self, derivative: &[f64], top_mev: f64) -> Pinning {
        let valley = self.valleys(&[unit(derivative)]).into_iter().next();
        let [stiffness_mev, hop] = valley.map_or([0.0; 2], |w| [w.stiffness_mev, slab::dot(derivative, &w.along)]);
        Pinning::new(stiffness_mev, hop, top_mev)
    }

    /// zᵀH⁻¹z (1/meV) of unit directions z in a space that these directions span, all else following.
    pub fn softness(&self, directions: Vec<Vec<f64>>) -> impl Fn(&[f64]) -> f64 {
        let valleys = self.valleys(&orthonormal(directions, LEAST));
        move |z| valleys.iter().map(|w| slab::dot(z, &w.along).powi(2) / w.stiffness_mev.max(f64::MIN_POSITIVE)).sum()
    }

    /// The same of one unit direction, whose part down the descent is as soft as that falls.
    pub fn across(&self, direction: &[f64]) -> f64 {
        let mut rest = direction.to_vec();
        let (mut softness, mut whole) = (0.0, 1.0);
        for descent in &self.against[self.state.zeros.len()..] {
            let part = slab::dot(direction, descent);
            softness += part * part / self.state.curvature_mev(descent).abs();
            whole -= part * part;
        }
        remove(&mut rest, &self.against);
        if whole > LEAST { softness + whole * self.softness(vec![unit(&rest)])(&unit(&rest)) } else { softness }
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

/// The geodesic from a state to another (3N), spin by spin.
pub(super) fn towards(from: &[f64], to: &[f64]) -> Vec<f64> {
    let (a, b, mut field) = (Components::new(from), Components::new(to), vec![0.0; from.len()]);
    write_logs(a, b, &mut field);
    field
}

/// A vector divided by its length.
pub(super) fn unit(v: &[f64]) -> Vec<f64> {
    let size = slab::norm(v);
    v.iter().map(|x| x / size).collect()
}
