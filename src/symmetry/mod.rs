//! The discrete symmetry group of an energy, found from what it does to random states, not from what its terms are called.
//!
//! ```text
//! m'_i = R m_p(i)          R orthogonal, p a motion of the sites: an operation of the group if E(m') = E(m) for every m
//! f(m')_i = R f(m)_p(i)    then the forces f = −∂E/∂m move along with the spins
//! ```
//! One random state decides: 2N equations that an operation that is none fulfils with probability zero; the energy of another state
//! confirms it. Frozen spins have to be taken to themselves, vacant sites stay as they are.
//!
//! # What is tried
//! R: the 48 matrices that take the axes of a frame to each other, for x, y, z, for the principal axes of the on-site energy, and for
//! the frames that the axes of the terms and the frozen spins span (the first eight frames). m ↦ −m, reversal of time, is among
//! them. About an axis of symmetry, operations that differ by a rotation count as one; where the energy has no axis at all, m ↦ −m
//! alone is tried. Where the lattice is no chain, also the matrix that turns its sites, that with the normal of a film reversed, and
//! their opposites; and, whatever p is, the matrices that take the tensors of a site's bonds to those of the bonds that p takes them
//! from, where these tell all three axes: exchange matrices may be written in any frame of spins.
//!
//! p: turns and mirror images of the lattice, of a cluster or a wire all that its sites allow, shifts along periodic directions, and
//! their products; those that take sites to unlike ones are left out: of other moments, frozen or not, or with other gradients
//! Σ |∂E/∂m_i|² over the uniform states along ±x, ±y, ±z. An R of a frame must take the Σ_i ∂E/∂m_i of uniform states to each other. If
//! p goes with one R, it goes with R R' for every R' that goes with no motion at all, and with no others; if a shift is an operation,
//! so are its multiples. So the group is held as a few generators.
//!
//! An operation costs a gradient to try; a search some dozens to a few hundred, and no memory beyond a few states.
//!
//! # What is not found
//! Matrices that are of none of these: where the tensors of bonds tell but one axis, those that take it elsewhere than a frame or the
//! turned lattice does (a ring whose anisotropy turns by 30° from site to site). Operations that turn each site by another matrix (an
//! open chain with D along its one axis, whose spins can be reflected in planes that turn from site to site; bonds whose signs a
//! reversal of some spins makes alike; parts of a chain that a vacancy cuts apart, each turned alone). Turns of a torus that take its
//! cells to parts of others, as where n × 1 cells of n atoms are periodic. And, beyond 512 trials of operations that move sites,
//! whatever would come later.

mod frames;
mod group;
mod marks;
mod operation;
mod same;
mod search;
mod shift;
mod tensors;

pub use group::Group;
pub use operation::Operation;
pub use search::WEAK;
pub use shift::Shift;
