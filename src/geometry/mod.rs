//! Geometry of unit vectors.
mod direction;
pub mod vector;
pub use direction::Direction;
pub use vector::Vector;
