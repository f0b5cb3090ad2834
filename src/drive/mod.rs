//! From two states to a barrier: relax the ends, make a first path, relax the band, read off what it found.

mod candidate;
mod climb;
mod connect;
mod ends;
mod explore;
mod join;
mod minimum;
mod outcome;
mod problem;
mod rates;
mod relaxation;
mod relaxed;
mod report;
mod run;
mod scales;
mod stop;
mod top;

pub use ends::{Relaxed, relax_to_minimum};
pub use explore::natural_guesses;
pub use minimum::{Link, Minimum};
pub use outcome::*;
pub use problem::{Images, NebSettings, Problem};
pub use relaxation::{Goal, Relaxation, image_levels, prominent_maxima, refined};
pub use relaxed::{RelaxedState, relaxed_state};
pub use run::run;
pub use scales::Scales;
pub use stop::Stop;
pub use top::{Top, tops};

/// Watches a run.
pub trait Observer {
    /// A band was evaluated.
    fn iteration(&mut self, row: &HistoryRow);

    /// A stage begins, in words.
    fn stage(&mut self, _what: &str) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn iteration(&mut self, _: &HistoryRow) {}
}
