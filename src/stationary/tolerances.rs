//! What is zero and what is alike, for all searches and for what is made of their results.
//!
//! An energy is a sum of densities of the size of the stiffness c of the stiffest spin, so that a torque has a rounding error of some eps c,
//! and what a search leaves of it shifts energies by its square. All are parts of c, but where something else is said.

/// A torque of this size is rounding error.
pub const SHARP: f64 = 4e-15;

/// A state with no larger torque is relaxed.
pub const RELAXED: f64 = 1e-14;

/// A torque that is zero, in parts of the Hessian's norm ‖H‖₁.
pub const STATIONARY: f64 = 1e-12;

/// A search below this torque is at its last digits; and energies that differ by less all along a way make it flat.
pub const FLAT: f64 = 1e-11;

/// Energies that differ by less are one energy; barriers, if by less than this part of them.
pub const ALIKE: f64 = 1e-9;

/// A barrier counts as lower than another if it is so by more than this part of it.
pub const LOWER: f64 = 1e-7;
