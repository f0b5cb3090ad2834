//! Linear algebra of short-ranged chains: banded symmetric matrices and their LDLᵀ, banded ones
//! without symmetry and their LU, and the small dense matrices beside them.

mod banded;
mod general;
mod ldl;
mod lowest;
pub mod slab;
mod small;
mod tridiagonal;
mod twisted;

pub use banded::Banded;
pub use general::{General, Lu};
pub use ldl::Ldl;
pub use lowest::{Mode, lowest_modes, rayleigh_ritz, soft_modes};
pub use small::{eigen_symmetric, eigenvalues_symmetric, solve_dense};
