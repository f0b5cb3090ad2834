//! Minimum-energy paths and barriers of spin chains.

pub mod band;
pub mod config;
pub mod drive;
pub mod energy;
pub mod error;
pub mod field;
pub mod geometry;
pub mod lattice;
pub mod linalg;
pub mod optimise;
pub mod output;
pub mod path;
pub mod registry;
pub mod saddle;
pub mod sphere;
pub mod spins;
pub mod state;
pub mod units;
pub mod words;
