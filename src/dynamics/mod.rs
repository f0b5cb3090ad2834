//! Spins in a bath: the stochastic Landau–Lifshitz–Gilbert equation, and rates of rare events by forward flux. For validation: what
//! theories of rates say can be seen to happen.

mod flux;
mod llg;

pub use flux::{Flux, FluxRate, escape_rate, forward_flux};
pub use llg::{Bath, Walker};
