//! Minimum-energy paths and barriers of spin chains.
pub mod drive;
pub mod error;
pub mod geometry;
pub mod lattice;
pub mod output;
pub mod path;
pub mod spins;
pub mod units;
