//! The Riemannian Hessian in orthonormal tangent coordinates.
//!
//! ```text
//! H = Uᵀ A U − diag(m_i·g_i) ⊗ 1₂        A = ∂²E/∂m∂m, g = ∂E/∂m, U the 3N × 2N matrix of tangent bases
//! ```
//! (Absil, Mahony, Trumpf, LNCS 8085, 361 (2013), doi:10.1007/978-3-642-40020-9_39.) Unknown 2i + a is the component of site i
//! along its basis vector a. A row of sites whose bonds reach over r shells has a band, of half-bandwidth 2r + 1 if it is open and
//! 4r + 1 if it is closed and folded; other lattices have blocks of coupled sites, see
//! [`Lattice::layout`](crate::lattice::Lattice::layout). What a long-ranged term adds makes it dense,
//! or a band with a tail, see `far`. Where it is to be multiplied only, it need not be written: [`Free`].

#[cfg(test)]
mod any_lattice;
mod assembly;
mod basis;
mod bound;
mod complement;
mod far;
mod free;
mod resolvent;
mod stand_in;

pub use assembly::{Assembly, assemble, assemble_into};
pub use basis::{BasisTile, TangentBasis};
pub use bound::{Bound, bound};
pub use complement::{Complement, Place};
pub use free::Free;
pub use resolvent::Resolvent;
pub use stand_in::StandIn;

use crate::energy::Hamiltonian;
use crate::linalg::Layout;

/// About how many operations it takes to factorise a Hessian.
pub fn factorisation_flops(h: &Hamiltonian) -> f64 {
    if let (Layout::Sparse(plan), None) = (h.layout(), h.coupling().pairs()) {
        return plan.flops();
    }
    let order = 2.0 * h.sites() as f64;
    let width = match (h.coupling().pairs().is_some(), h.coupling().tail()) {
        (true, None) => return order * order * order / 3.0,
        (_, Some(tail)) => 4.0 * h.reach() as f64 + 2.0 + tail.cost() as f64,
        (false, None) => 4.0 * h.reach() as f64 + 2.0,
    };
    order * width * width
}
