//! Sparse symmetric matrices of any lattice, two unknowns a site, and their LDLᵀ.
//!
//! ```text
//! positions, bonds ─▶ Graph ─▶ nested dissection ─▶ Symbolic        once a lattice, shared
//!                                                      │
//!                       entries ─▶ SparseMatrix ─▶ SparseLdl         once a factorisation
//! ```
//! Multifrontal (Duff, Reid, ACM Trans. Math. Softw. 9, 302 (1983), doi:10.1145/356044.356047): the sites are gathered into
//! fronts, dense matrices of some sites that are eliminated and of those they reach; what an elimination leaves behind is added
//! to the next front of a tree.

mod assembly;
mod dissection;
mod elimination;
mod graph;
mod ldl;
mod matrix;
mod memory;
#[cfg(test)]
pub(super) mod samples;
mod solve;
mod supernodes;
mod symbolic;

pub use dissection::nested_dissection;
pub use graph::Graph;
pub use ldl::SparseLdl;
pub use matrix::SparseMatrix;
pub use symbolic::Symbolic;
