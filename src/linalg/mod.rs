//! Linear algebra of chains and lattices: one [`Matrix`], symmetric, kept as a band, with or without a long-ranged tail, as blocks of
//! coupled sites or whole, behind one set of [`Factors`]; banded ones without symmetry and their LU, small dense ones, the Fourier
//! transform, and numbers of twice the digits.

mod banded;
mod blocks;
mod dense;
mod double_double;
mod factors;
mod fft;
mod front;
mod general;
mod gmres;
mod krylov;
mod layout;
mod ldl;
mod logarithms;
mod lowest;
mod matrix;
pub mod multigrid;
mod orthonormal;
mod panels;
mod pivot;
mod ritz;
mod secants;
pub mod slab;
mod slices;
mod small;
mod softest;
mod sparse;
mod tail;
mod tail_ldl;
mod together;
mod tridiagonal;
mod twisted;

pub use banded::Banded;
pub use dense::{Dense, DenseLdl};
pub use double_double::DoubleDouble;
pub use factors::Factors;
pub use fft::Fft;
pub use general::{General, Lu};
pub use gmres::gmres;
pub use layout::{Layout, Places};
pub use ldl::Ldl;
pub use logarithms::log_sum;
pub use lowest::{lowest_modes, lowest_modes_beside, modes_by_factors, soft_modes};
pub use matrix::Matrix;
pub use multigrid::{Coarsening, Multigrid, Rows};
pub use orthonormal::{orthonormal, remove};
pub use ritz::{Mode, combination, rayleigh_ritz};
pub use secants::Secants;
pub use small::{eigen_symmetric, eigenvalues_symmetric, invert_dense, solve_dense};
pub use softest::{Asked, Wanted, softest};
pub use sparse::{Graph, SparseLdl, SparseMatrix, Symbolic, nested_dissection};
pub use tail::{Decays, Tail, TailedBand};
pub use tail_ldl::TailLdl;
