//! Spins in a bath: the stochastic Landau–Lifshitz–Gilbert equation, and rates of rare events by forward flux. For validation: what
//! theories of rates say can be seen to happen.

mod field;
mod flux;
mod llg;
mod noise;

pub use flux::{Flux, FluxRate, Order, escape_rate, forward_flux, total};
pub use llg::{Bath, Walkers};

/// So many walkers go side by side, each in a lane of its own.
pub const LANES: usize = 8;

/// A number of each walker.
type Lanes = [f64; LANES];
/// The components of a site's spin, of each walker.
type Spin = [Lanes; 3];
