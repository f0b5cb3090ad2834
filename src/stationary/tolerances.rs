//! What is zero and what is alike, for all searches and for what is made of their results.
//!
//! An energy is a sum of densities of the size of the stiffness c of the stiffest spin, so that a torque has a rounding error of some eps c,
//! and what a search leaves of it shifts energies by its square. All are parts of c, but where something else is said.

use std::f64::consts::FRAC_PI_2;

/// Steps that turn no spin by more (rad) stay in their valley.
pub const STEP: f64 = 0.3;

/// Steps that may lead into another valley turn no spin by more (rad).
pub const STRIDE: f64 = 0.5;

/// Spins that turn by more (rad) are those of another state.
pub const FAR: f64 = FRAC_PI_2;

/// What a quadratic model tells of an energy or a mode is right to this part of it; and so is what a valley tells of the mode of its
/// saddle, and what a path's maximum tells of the height of that.
pub const ROUGHLY: f64 = 0.3;

/// States that differ by less (rad, any spin) are beside each other: no step at the last digits of a stationary state is longer, and a
/// descent begins with one that long.
pub const LAST_DIGITS: f64 = 0.05;

/// Fields of which less than this part is left beside others depend on them.
pub const INDEPENDENT: f64 = 1e-6;

/// Shifts of a Hessian that is to be positive begin at this part of c, and end at so many times c.
pub const FIRST_SHIFT: f64 = 1e-3;
pub const LAST_SHIFT: f64 = 1e6;

/// What is too small or too large, a shift or a step, becomes so many times as large or as small.
pub const LARGER: f64 = 4.0;

/// What ends by itself, or not at all, ends after so many steps or tries.
pub const MANY: usize = 500;

/// So many modes, vectors or steps are few, where each costs little and none of them need be the one.
pub const FEW: usize = 8;

/// An energy that changes by less than this part of its size is rounding.
pub const ROUNDING: f64 = 1e-13;

/// A torque of this size is rounding error.
pub const SHARP: f64 = 4e-15;

/// A torque of so many times the tolerance may be as small as it becomes.
pub const NEARLY: f64 = 1e3;

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
