#![doc = include_str!("../README.md")]
//!
//! # The modules
//!
//! Each imports only modules of the rows below its own, those of the last row also one another.
//!
//! | | |
//! |---|---|
//! | `cli` | the program `spinneb`; the feature `cli`, which is on unless default features are off |
//! | [`config`] | the JSON of a run |
//! | [`output`] | files and figures |
//! | [`drive`] | a whole run: ends, first paths, band, saddles, proof |
//! | [`rates`] | lifetimes of states |
//! | [`network`], [`dynamics`] | networks of states and their times; spins in a bath |
//! | [`band`], [`stationary`], [`symmetry`] | the force on a path; saddles and minima to machine precision; what leaves an energy as it is |
//! | [`energy`], [`path`], [`optimise`] | energy terms; first paths; methods that move spins |
//! | [`state`] | spin states |
//! | [`files`] | files of spins: OVF, npz, npy, csv, VTK |
//! | [`spins`], [`sphere`] | configurations and the product of spheres they live on |
//! | [`lattice`], [`profile`], [`geometry`], [`units`], [`field`], [`linalg`], [`registry`], [`words`], [`error`] | the ground |

pub mod band;
mod base64;
#[cfg(feature = "cli")]
pub mod cli;
pub mod config;
pub mod control;
pub mod drive;
pub mod dynamics;
pub mod energy;
pub mod error;
pub mod field;
pub mod files;
pub mod geometry;
pub mod hessian;
pub mod landscape;
pub mod lattice;
pub mod linalg;
pub mod network;
pub mod optimise;
pub mod output;
pub mod path;
pub mod profile;
pub mod rates;
pub mod record;
pub mod registry;

pub mod sphere;
pub mod spins;
pub mod state;
pub mod stationary;
pub mod symmetry;
mod threads;
pub mod units;
pub mod words;
