//! The exchange Laplacian as a stand-in for the Hessian, where that has no band, and for measuring forces in radians.
//!
//! ```text
//! M_ij = −J_ij,   M_ii = Σ_j |J_ij| + c + spread      c: stiffness scale; spread: the on-site terms' largest curvature
//! predicted rotation y = Q M⁻¹ Q F,  Q = 1 − ττᵀ
//! ```
//! A tolerance on |y| means the same for every number of sites and every unit; one on |F| does not. Preconditioning with
//! the exchange operator follows Packwood et al., J. Chem. Phys. 144, 164109 (2016), doi:10.1063/1.4947024.

use super::Band;
use crate::energy::Hamiltonian;
use crate::linalg::{Banded, Dense, Factors, Layout, Matrix, SparseMatrix, eigenvalues_symmetric, slab};
use rayon::prelude::*;

/// The factorised operator, one for all images.
#[derive(Debug)]
pub struct Laplacian {
    factors: Factors,
    sites: usize,
    /// Unknowns a site, all alike: two where the matrix is kept by blocks of two.
    each: usize,
}

impl Laplacian {
    /// For a Hamiltonian with the stiffness scale `c` (meV).
    pub fn new(h: &Hamiltonian, c: f64) -> Laplacian {
        let blocks = h.constant_blocks();
        let sites = h.sites();
        let (mut m, each) = match h.layout() {
            Layout::Band { span, places } => (Matrix::Band(Banded::zeros(sites, *span), places.clone()), 1),
            Layout::Sparse(plan) => (Matrix::Sparse(SparseMatrix::zeros(plan.clone())), 2),
            Layout::Dense => (Matrix::Dense(Dense::zeros(2 * sites)), 2),
        };
        let mut add = |i: usize, j: usize, v: f64| (0..each).for_each(|a| m.add(each * i + a, each * j + a, v));
        let spread = blocks.sites().map(spread).fold(0.0, f64::max);
        (0..sites).for_each(|i| add(i, i, c.max(spread)));
        for bonds in &blocks.bond {
            for [i, next] in bonds.family.bonds() {
                let j = -bonds.mean(i);
                if j != 0.0 && !h.is_frozen(i) && !h.is_frozen(next) {
                    add(next, i, -j);
                }
                if j != 0.0 {
                    add(i, i, j.abs());
                    add(next, next, j.abs());
                }
            }
        }
        Laplacian { factors: m.factor(), sites, each }
    }

    /// M⁻¹ v for a slab of 3N numbers.
    pub fn solve(&self, v: &[f64], out: &mut [f64]) {
        let (n, columns) = (self.sites, if self.each == 1 { 3 } else { 2 });
        let numbers = self.each * columns;
        let mut x = vec![0.0; numbers * n];
        for i in 0..n {
            for c in 0..3 {
                x[numbers * i + c] = v[c * n + i];
            }
        }
        self.factors.solve(&mut x, columns);
        for i in 0..n {
            for c in 0..3 {
                out[c * n + i] = x[numbers * i + c];
            }
        }
    }

    /// The rotations Q M⁻¹ F⊥ (rad) that the images between the ends still seem to need.
    pub fn rotations(&self, band: &Band, y: &mut [f64]) {
        let slab = 3 * self.sites;
        y.par_chunks_mut(slab).enumerate().for_each(|(k, y)| {
            let t = band.tangent(k + 1);
            self.solve(band.perpendicular(k + 1), y);
            crate::field::project(band.path().image(k + 1), y);
            let along = slab::dot(y, t);
            slab::add_scaled(y, -along, t);
            band.hamiltonian().hold_frozen(y);
        });
    }
}

/// Largest minus smallest on-site curvature of a block, its isotropic part apart.
fn spread(b: [[f64; 3]; 3]) -> f64 {
    let e = eigenvalues_symmetric(&b.concat(), 3);
    e[2] - e[0]
}
