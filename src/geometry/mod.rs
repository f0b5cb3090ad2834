//! Geometry of unit vectors: the sphere S² on which one spin lives.
//!
//! Angles are in rad, vectors are `[f64; 3]`, and a "unit vector" is unit to rounding. Only `libm` and `sqrt` are
//! used, never the platform's sin, cos or atan2, so the same input gives the same bits on every machine.
//!
//! # Opposite vectors
//! Between a and −a the great circle is undefined. Whatever needs one takes an axis and means the right-handed
//! rotation from a to b about the part of that axis normal to a; [`midpoint()`] has the rule for every direction of a.
mod angle;
mod arc;
mod basis;
mod direction;
mod exp_log;
mod filter;
mod lerp;
pub mod matrix;
mod midpoint;
mod quaternion;
mod rotate;
mod slerp;
mod transport;
pub mod vector;
mod velocity;
mod waypoints;

pub use angle::angle;
pub use arc::{Arc, Steps};
pub use basis::tangent_basis;
pub use direction::Direction;
pub(crate) use exp_log::exp_short;
pub use exp_log::{exp, log, log_about};
pub use filter::low_pass;
pub use lerp::nlerp;
pub use matrix::Matrix;
pub use midpoint::midpoint;
pub use quaternion::Quaternion;
pub use rotate::rotate;
pub use slerp::{rotation_axis, slerp};
pub use transport::{transport, transport_about};
pub use vector::{Vector, lerp};
pub use velocity::{angular_velocity, unevenness};
pub use waypoints::Waypoints;

#[cfg(test)]
mod test_vectors;
