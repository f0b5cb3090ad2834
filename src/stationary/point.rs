//! A configuration with its energy, gradient and tangent basis, in memory that is used again for the next one.

use super::tolerances::INDEPENDENT;
use crate::energy::{Evaluator, Hamiltonian};
use crate::field::{Components, TILE};
use crate::hessian::{TangentBasis, assemble_into};
use crate::linalg::{Matrix, orthonormal, slab};
use crate::sphere::move_points;
use serde::{Deserialize, Serialize};

/// Everything a step down the gradient needs, at one configuration; a Newton step needs its Hessian too. It is stored as its
/// spins: all else follows from them to the last bit.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Point {
    /// Spins, component-major.
    pub m: Vec<f64>,
    /// Energy above the Hamiltonian's reference (meV).
    #[serde(skip)]
    pub energy_mev: f64,
    /// Each site's share of it (meV).
    #[serde(skip)]
    density: Vec<f64>,
    /// Euclidean gradient (meV).
    #[serde(skip)]
    pub gradient: Vec<f64>,
    /// Tangent basis.
    #[serde(skip)]
    pub basis: TangentBasis,
    /// Riemannian gradient in tangent coordinates (meV).
    #[serde(skip)]
    pub slope: Vec<f64>,
    /// Orthonormal zero modes: rotations about the symmetry axes, in tangent coordinates.
    #[serde(skip)]
    pub zeros: Vec<Vec<f64>>,
}

/// Moves spins along a vector field; those that are frozen stay where they are, to the bit: a mode of the Hessian is zero there to
/// rounding alone, and a turn of a frozen spin by as little breaks a symmetry that is exact.
pub fn move_free(h: &Hamiltonian, m: &mut [f64], v: &[f64]) {
    if !h.has_frozen() {
        return move_points(m, v, v.len(), 1.0);
    }
    let mut free = v.to_vec();
    h.hold_frozen(&mut free);
    move_points(m, &free, v.len(), 1.0);
}

impl Point {
    /// At the spins `m`.
    pub fn at(h: Evaluator, m: Vec<f64>) -> Point {
        let mut point = Point { m, ..Point::default() };
        point.evaluate(h);
        point
    }

    /// Goes where a move of another point's spins along a vector field leads.
    pub fn go(&mut self, h: Evaluator, from: &Point, v: &[f64]) {
        self.m.clone_from(&from.m);
        self.move_by(h, v);
    }

    /// Goes on along a vector field.
    pub fn move_by(&mut self, h: Evaluator, v: &[f64]) {
        move_free(&h, &mut self.m, v);
        self.evaluate(h);
    }

    fn evaluate(&mut self, h: Evaluator) {
        let Point { m, density, gradient, basis, slope, .. } = self;
        let n = m.len() / 3;
        gradient.resize(3 * n, 0.0);
        density.resize(n, 0.0);
        slope.resize(2 * n, 0.0);
        basis.resize(n);
        let spins = Components::new(m);
        let rows = basis.tiles().zip(slope.chunks_mut(2 * TILE));
        self.energy_mev = h.density_gradient(m, gradient, density, rows, |row, g, (mut basis, slope)| {
            basis.set(spins.range(row.clone()));
            // the basis vectors are tangent, so that the gradient need not be projected
            basis.write_coordinates(g, slope);
            if h.has_frozen() {
                let frozen = slope.chunks_exact_mut(2).zip(row).filter(|(_, i)| h.is_frozen(*i));
                frozen.for_each(|(slope, _)| slope.fill(0.0));
            }
        });
        let mut memory = std::mem::take(&mut self.zeros).into_iter();
        let axes = h.symmetry_axes_at(&self.m);
        let rotations = axes.iter().map(|axis| {
            let mut t = memory.next().unwrap_or_default();
            self.basis.write_rotation(*axis, &mut t);
            t
        });
        self.zeros = orthonormal(rotations.collect(), INDEPENDENT);
    }

    /// Largest component of the Riemannian gradient (meV).
    pub fn max_torque_mev(&self) -> f64 {
        slab::max_abs(&self.slope)
    }

    /// −g in tangent coordinates (meV).
    pub fn downhill(&self) -> Vec<f64> {
        let mut x = Vec::new();
        self.write_downhill(&mut x);
        x
    }

    /// [`downhill`](Self::downhill) into the memory of `x`.
    pub fn write_downhill(&self, x: &mut Vec<f64>) {
        x.clear();
        x.extend(self.slope.iter().map(|g| -g));
    }

    /// The Riemannian Hessian plus shift·1 in tangent coordinates (meV), in the memory of `matrix`.
    pub fn write_hessian(&self, h: Evaluator, shift: f64, matrix: &mut Matrix) {
        h.count_hessian();
        assemble_into(&h, &self.m, &self.gradient, &self.basis, shift, matrix);
    }

    /// g·x + ½ xᵀHx, with the Hessian H here: by how much the energy is to rise along the tangent coordinates x (meV).
    pub fn predicted_mev(&self, hessian: &Matrix, x: &[f64]) -> f64 {
        let mut hx = vec![0.0; x.len()];
        hessian.multiply(x, &mut hx);
        slab::dot(&self.slope, x) + 0.5 * slab::dot(x, &hx)
    }

    /// Energy above that of another point (meV), summed from differences of densities.
    pub fn above_mev(&self, other: &Point) -> f64 {
        slab::sum_of_differences(&self.density, &other.density)
    }

    /// The vector field (3N) of tangent coordinates.
    pub fn field(&self, t: &[f64]) -> Vec<f64> {
        let mut v = Vec::new();
        self.write_field(t, &mut v);
        v
    }

    /// [`field`](Self::field) into the memory of `v`.
    pub fn write_field(&self, t: &[f64], v: &mut Vec<f64>) {
        v.resize(self.m.len(), 0.0);
        self.basis.field(t, v);
    }
}
