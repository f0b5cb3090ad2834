//! A configuration with its energy, gradient, tangent basis and Hessian.

use crate::energy::{Hamiltonian, TangentBasis, assemble};
use crate::linalg::{Banded, Mode, lowest_modes, slab};
use crate::sphere::move_points;

/// Everything a Newton step needs, at one configuration.
#[derive(Clone, Debug)]
pub struct State {
    /// Spins, component-major.
    pub m: Vec<f64>,
    /// Energy above the Hamiltonian's reference (meV).
    pub energy_mev: f64,
    /// Euclidean gradient (meV).
    pub gradient: Vec<f64>,
    /// Tangent basis.
    pub basis: TangentBasis,
    /// Riemannian gradient in tangent coordinates (meV).
    pub slope: Vec<f64>,
    /// Riemannian Hessian in tangent coordinates (meV).
    pub hessian: Banded,
    /// Orthonormal zero modes: rotations about the symmetry axes, in tangent coordinates.
    pub zeros: Vec<Vec<f64>>,
}

impl State {
    /// At the spins `m`.
    pub fn at(h: &Hamiltonian, m: Vec<f64>) -> State {
        let mut gradient = vec![0.0; m.len()];
        let energy_mev = h.energy_gradient(&m, &mut gradient);
        let mut force = vec![0.0; m.len()];
        h.force(&m, &gradient, &mut force);
        let basis = TangentBasis::at(&m);
        let mut slope = basis.coordinates(&force);
        slab::scale(&mut slope, -1.0);
        let hessian = assemble(h, &m, &gradient, &basis);
        let zeros = h.symmetry_axes_at(&m).iter().map(|axis| basis.rotation(*axis)).collect();
        let zeros = orthonormal(zeros, 1e-6);
        State { m, energy_mev, gradient, basis, slope, hessian, zeros }
    }

    /// Largest component of the Riemannian gradient (meV).
    pub fn max_torque_mev(&self) -> f64 {
        slab::max_abs(&self.slope)
    }

    /// −g in tangent coordinates (meV).
    pub fn downhill(&self) -> Vec<f64> {
        self.slope.iter().map(|g| -g).collect()
    }

    /// g·x + ½ xᵀHx: by how much the energy is to rise along the tangent coordinates x (meV).
    pub fn predicted_mev(&self, x: &[f64]) -> f64 {
        let mut hx = vec![0.0; x.len()];
        self.hessian.multiply(x, &mut hx);
        slab::dot(&self.slope, x) + 0.5 * slab::dot(x, &hx)
    }

    /// The lowest mode, zero modes apart; none where there is no other direction.
    pub fn lowest_mode(&self) -> Option<Mode> {
        lowest_modes(&self.hessian, 1, &self.zeros).into_iter().next()
    }

    /// The vector field (3N) of tangent coordinates.
    pub fn field(&self, t: &[f64]) -> Vec<f64> {
        let mut v = vec![0.0; self.m.len()];
        self.basis.field(t, &mut v);
        v
    }

    /// The spins after a move along a vector field.
    pub fn moved(&self, v: &[f64]) -> Vec<f64> {
        let mut m = self.m.clone();
        move_points(&mut m, v, v.len(), 1.0);
        m
    }
}

/// Gram–Schmidt; a vector of which less than `least` is left is left out.
pub fn orthonormal(vectors: Vec<Vec<f64>>, least: f64) -> Vec<Vec<f64>> {
    let mut done: Vec<Vec<f64>> = Vec::new();
    for mut v in vectors {
        remove(&mut v, &done);
        let size = slab::norm(&v);
        if size > least {
            slab::scale(&mut v, 1.0 / size);
            done.push(v);
        }
    }
    done
}

/// v minus its parts along orthonormal vectors.
pub fn remove(v: &mut [f64], directions: &[Vec<f64>]) {
    for d in directions {
        let overlap = slab::dot(d, v);
        slab::add_scaled(v, -overlap, d);
    }
}
