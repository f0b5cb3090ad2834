//! Linear algebra of short-ranged chains: banded symmetric matrices, their LDLᵀ, and the small dense matrices beside them.

mod banded;
mod small;
pub mod slab;

pub use banded::{Banded, Ldl};
pub use small::{eigenvalues_symmetric, solve_dense};
