//! Energies of simple states in the unbounded lattice, to be compared with a paper.
//!
//! ```text
//! m(r) = u cos(q·r) + v sin(q·r),   averaged over its phase, φ = q·(r_j − r_i):
//! m_iᵀ M m_j  →  ½ (uᵀM u + vᵀM v) cos φ + ½ (uᵀM v − vᵀM u) sin φ
//! (m·e)²  →  ½ A²,   (m·e)⁴  →  ⅜ A⁴,   A² = (u·e)² + (v·e)²
//! ```
//! With q = 0 and v = 0 instead of the average it is the ferromagnet along u. For J alone that is E(q) = −Σ J cos φ.

use super::atoms::{place, reciprocal};
use super::{Anisotropy, Model};
use crate::geometry::matrix::times;
use crate::geometry::{Vector, vector};
use std::f64::consts::TAU;

/// A spiral: the planes of its spins and how it advances.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spiral {
    /// In units of the reciprocal vectors b_k, a_j·b_k = 2π δ_jk.
    pub q: Vector,
    /// Unit vector, the spin at phase 0.
    pub u: Vector,
    /// Unit vector normal to u, the spin at phase 90°.
    pub v: Vector,
}

impl Model {
    /// Energies an atom of the cell (meV) of the ferromagnet along a unit vector: bonds, anisotropy, field.
    pub fn ferromagnet_mev(&self, m: Vector) -> [f64; 3] {
        let bonds = self.bonds.iter().map(|bond| vector::dot(m, times(&bond.matrix, m))).sum();
        let own = self.atoms.iter().flat_map(|atom| &atom.anisotropies).map(|a| match a {
            Anisotropy::Uniaxial { k, axis } => -k * vector::dot(m, axis.vector()).powi(2),
            Anisotropy::Cubic { k } => 0.5 * k * (1.0 - m.iter().map(|x| x.powi(4)).sum::<f64>()),
        });
        let moment: f64 = self.atoms.iter().map(|atom| atom.moment_mub).sum();
        let field = -crate::units::MU_B_MEV_PER_T * moment * vector::dot(m, self.field_t);
        // + 0 turns −0 into 0
        [bonds, own.sum(), field].map(|e: f64| e / self.atoms.len() as f64 + 0.0)
    }

    /// Energies an atom of the cell (meV) of a spiral, averaged over its phase: bonds, anisotropy. A field has no part in it.
    pub fn spiral_mev(&self, Spiral { q, u, v }: Spiral) -> [f64; 2] {
        let bonds = self.bonds.iter().map(|bond| {
            let [from, to] = bond.hop.atoms.map(|atom| self.atoms[atom].at);
            let turns: f64 = (0..3).map(|d| q[d] * (bond.hop.shift[d] as f64 + to[d] - from[d])).sum();
            let (sin, cos) = (TAU * turns).sin_cos();
            let between = |a: Vector, b: Vector| vector::dot(a, times(&bond.matrix, b));
            0.5 * ((between(u, u) + between(v, v)) * cos + (between(u, v) - between(v, u)) * sin)
        });
        let part = |e: Vector| vector::dot(u, e).powi(2) + vector::dot(v, e).powi(2);
        let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let own = self.atoms.iter().flat_map(|atom| &atom.anisotropies).map(|a| match a {
            Anisotropy::Uniaxial { k, axis } => -0.5 * k * part(axis.vector()),
            Anisotropy::Cubic { k } => 0.5 * k * (1.0 - 0.375 * axes.iter().map(|e| part(*e).powi(2)).sum::<f64>()),
        });
        [bonds.sum(), own.sum::<f64>()].map(|e: f64| e / self.atoms.len() as f64)
    }

    /// The direction of a wave vector given in units of the reciprocal vectors.
    fn direction(&self, q: Vector) -> Option<Vector> {
        vector::unit(place(&reciprocal(&self.vectors), q))
    }

    /// The cycloid of a wave vector, its spins in the plane of q and z (of z and x, where q is along z).
    pub fn cycloid(&self, q: Vector) -> Option<Spiral> {
        let along = self.direction(q)?;
        let u = [0.0, 0.0, 1.0];
        let v = vector::unit(vector::normal_part(along, u)).unwrap_or([1.0, 0.0, 0.0]);
        // near z what is left of q is rounding
        let v = if along[2].abs() > 1.0 - 1e-9 { [1.0, 0.0, 0.0] } else { v };
        Some(Spiral { q, u, v })
    }

    /// The right-handed helix of a wave vector, its spins normal to q.
    pub fn helix(&self, q: Vector) -> Option<Spiral> {
        let along = self.direction(q)?;
        let seed = if along[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
        let u = vector::unit(vector::normal_part(seed, along))?;
        Some(Spiral { q, u, v: vector::cross(along, u) })
    }
}
