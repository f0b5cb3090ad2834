//! The Riemannian Hessian of a chain in orthonormal tangent coordinates, as a banded matrix.
//!
//! ```text
//! H = Uᵀ A U − diag(m_i·g_i) ⊗ 1₂        A = ∂²E/∂m∂m, g = ∂E/∂m, U the 3N × 2N matrix of tangent bases
//! ```
//! (Absil, Mahony, Trumpf, LNCS 8085, 361 (2013), doi:10.1007/978-3-642-40020-9_39.) Unknown 2i + a is the component of site i
//! along its basis vector a; shells 1 … r give the half-bandwidth 2r + 1, and the last r sites of a ring are the rim.

use super::Hamiltonian;
use super::blocks::{Blocks, multiply};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, tangent_basis, vector};
use crate::linalg::Banded;

/// Two orthonormal tangent vectors a site.
#[derive(Clone, Debug, Default)]
pub struct TangentBasis {
    pairs: Vec<[Vector; 2]>,
}

impl TangentBasis {
    /// The basis at a configuration.
    pub fn at(m: &[f64]) -> TangentBasis {
        let m = Components::new(m);
        let pairs = (0..m.sites()).map(|i| tangent_basis(m.get(i)).into()).collect();
        TangentBasis { pairs }
    }

    /// Tangent coordinates (2N) of a vector field (3N).
    pub fn coordinates(&self, v: &[f64]) -> Vec<f64> {
        let v = Components::new(v);
        let mut t = Vec::with_capacity(2 * v.sites());
        for (i, [e, f]) in self.pairs.iter().enumerate() {
            t.push(vector::dot(*e, v.get(i)));
            t.push(vector::dot(*f, v.get(i)));
        }
        t
    }

    /// Writes the vector field (3N) of tangent coordinates (2N).
    pub fn field(&self, t: &[f64], v: &mut [f64]) {
        let mut v = ComponentsMut::new(v);
        for (i, [e, f]) in self.pairs.iter().enumerate() {
            v.set(i, vector::add(vector::scale(t[2 * i], *e), vector::scale(t[2 * i + 1], *f)));
        }
    }
}

/// An empty matrix of the shape that [`assemble`] fills.
pub(super) fn shape(sites: usize, reach: usize, periodic: bool) -> Banded {
    let rim = if periodic { reach } else { 0 };
    Banded::zeros(2 * (sites - rim), 2 * reach + 1, 2 * rim)
}

/// The Riemannian Hessian at `m`, where the Euclidean gradient is `g`. A frozen site has a stiff diagonal and no couplings.
pub fn assemble(h: &Hamiltonian, m: &[f64], g: &[f64], basis: &TangentBasis) -> Banded {
    let mut matrix = shape(h.sites(), h.reach(), h.periodic());
    let own;
    let blocks = match h.varying_blocks(Components::new(m)) {
        Some(b) => {
            own = b;
            &own
        }
        None => h.constant_blocks(),
    };
    let (m, g) = (Components::new(m), Components::new(g));
    for i in 0..h.sites() {
        if h.is_frozen(i) {
            matrix.add(2 * i, 2 * i, h.stiffness_mev());
            matrix.add(2 * i + 1, 2 * i + 1, h.stiffness_mev());
            continue;
        }
        let radial = vector::dot(m.get(i), g.get(i));
        let [e, f] = basis.pairs[i];
        let (ae, af) = (multiply(&blocks.site[i], e), multiply(&blocks.site[i], f));
        matrix.add(2 * i, 2 * i, vector::dot(e, ae) - radial);
        matrix.add(2 * i + 1, 2 * i, vector::dot(f, ae));
        matrix.add(2 * i + 1, 2 * i + 1, vector::dot(f, af) - radial);
    }
    add_bonds(h, blocks, basis, &mut matrix);
    matrix
}

fn add_bonds(h: &Hamiltonian, blocks: &Blocks, basis: &TangentBasis, matrix: &mut Banded) {
    let sites = h.sites();
    for (k, bonds) in blocks.bond.iter().enumerate() {
        let n = k + 1;
        let last = if h.periodic() { sites } else { sites.saturating_sub(n) };
        for i in 0..last {
            let j = (i + n) % sites;
            if h.is_frozen(i) || h.is_frozen(j) {
                continue;
            }
            for (b, f) in basis.pairs[j].iter().enumerate() {
                let column = multiply(&bonds[i], *f);
                for (a, e) in basis.pairs[i].iter().enumerate() {
                    matrix.add(2 * j + b, 2 * i + a, vector::dot(*e, column));
                }
            }
        }
    }
}
