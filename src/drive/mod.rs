//! The drive.
mod outcome;
pub use outcome::*;
