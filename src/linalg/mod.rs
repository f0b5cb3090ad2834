//! Linear algebra of chains and lattices: banded symmetric matrices, with or without a long-ranged tail, and their LDLᵀ, banded ones without
//! symmetry and their LU, sparse symmetric ones of any lattice, the small dense matrices beside them, the Fourier transform, and
//! numbers of twice the digits.

mod banded;
mod double_double;
mod fft;
mod general;
mod ldl;
mod lowest;
mod orthonormal;
mod pivot;
mod ritz;
pub mod slab;
mod slices;
mod small;
mod sparse;
mod tail;
mod tail_ldl;
mod tridiagonal;
mod twisted;

pub use banded::Banded;
pub use double_double::DoubleDouble;
pub use fft::Fft;
pub use general::{General, Lu};
pub use ldl::Ldl;
pub use lowest::{lowest_modes, soft_modes};
pub use orthonormal::{orthonormal, remove};
pub use ritz::{Mode, rayleigh_ritz};
pub use small::{eigen_symmetric, eigenvalues_symmetric, solve_dense};
pub use sparse::{Graph, SparseLdl, SparseMatrix, Symbolic, nested_dissection};
pub use tail::{Decays, Tail};
pub use tail_ldl::TailLdl;
