//! Linear algebra of short-ranged chains: banded symmetric matrices, their LDLᵀ, and the small dense matrices beside them.

mod banded;
mod general;
mod lowest;
pub mod slab;
mod small;

pub use banded::{Banded, Ldl};
pub use general::{General, Lu};
pub use lowest::{Mode, lowest_modes, rayleigh_ritz};
pub use small::{eigen_symmetric, eigenvalues_symmetric, solve_dense};
