//! Minimum-energy paths between states of spins on a lattice, the barriers on them, certified saddles, and lifetimes.
//!
//! Everything that the program `spinneb` does is here; the program is the module `cli`. Energies are in meV, moments in μ_B, fields
//! in T, lengths in nm, times in ps, angles in rad. Tutorial, how-to pages, the reference of configs, validation and costs are in the
//! book of the repository, `docs/`.
//!
//! # The modules
//!
//! Each imports only modules of the rows below its own, those of the last row also one another.
//!
//! | | |
//! |---|---|
//! | `cli` | the program `spinneb`; the feature `cli`, which is on unless default features are off |
//! | [`config`] | the JSON of a run |
//! | [`import`] | models from the files of other codes |
//! | [`output`] | files and figures |
//! | [`drive`] | a whole run: ends, first paths, band, saddles, proof |
//! | [`landscape`] | minima, the passes between them, and the routes over these |
//! | [`rates`] | lifetimes of states |
//! | [`network`], [`dynamics`] | networks of states and their times; spins in a bath |
//! | [`band`], [`stationary`], [`symmetry`] | the force on a path; saddles and minima to machine precision; what leaves an energy as it is |
//! | [`path`], [`optimise`] | first paths; methods that move spins |
//! | [`state`], [`hessian`] | spin states; the Hessian in tangent coordinates |
//! | [`energy`] | energy terms |
//! | [`control`] | how often gradients were computed, and whether a computation is to stop |
//! | [`record`] | what is kept of a run that is interrupted |
//! | [`files`] | files of spins: OVF, npz, npy, csv, VTK |
//! | [`spins`], [`sphere`] | configurations and the product of spheres they live on |
//! | [`lattice`], [`profile`], [`geometry`], [`units`], [`field`], [`linalg`], [`registry`], [`words`], [`error`] | the ground |
//!
//! # A run
//!
//! ```
//! use spinneb::drive::{Problem, Silent, run};
//! use spinneb::energy::{Anisotropy, Exchange, Hamiltonian};
//! use spinneb::{geometry::Direction, lattice::Chain, spins::Spins};
//!
//! let chain = Chain::open(50).resolve()?;
//! let exchange = Exchange::uniform(&chain, &[10.0]); // meV, nearest neighbours
//! let easy_axis = Anisotropy::uniform(50, 0.5, Direction::Z); // meV
//! let hamiltonian = Hamiltonian::new(&chain, vec![Box::new(exchange), Box::new(easy_axis)])?;
//! let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(50, d));
//! let outcome = run(&Problem::new(hamiltonian, up, down), &mut Silent)?;
//! assert!(outcome.barrier.is_some_and(|b| (b.forward_mev - 6.297777507).abs() < 1e-9));
//! # Ok::<(), spinneb::error::Error>(())
//! ```
//!
//! [`config::load`] makes the [`Problem`](drive::Problem) from a config; [`energy::CustomEnergy`] is a term of one's own;
//! [`Loaded::report`](config::Loaded::report) with [`output::render_files`] makes the files of a result.

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
pub mod import;
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

/// The Rust examples of the book.
#[cfg(doctest)]
mod book {
    #[doc = include_str!("../docs/src/library.md")]
    mod library {}
    #[doc = include_str!("../docs/src/own_term.md")]
    mod own_term {}
}
