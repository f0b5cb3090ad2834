//! From two states to a barrier: relax the ends, make a first path, relax the band, read off what it found.

mod bytes;
mod candidate;
mod climb;
mod connect;
mod ends;
mod explore;
mod join;
mod lower;
mod minimum;
mod outcome;
mod problem;
mod rates;
mod recorder;
mod relaxation;
mod relaxed;
mod report;
mod run;
mod scales;
mod stop;
mod stored;
mod top;

pub use ends::{Relaxed, WayDown, relax_to_minimum};
pub use explore::natural_guesses;
pub use minimum::{Link, Minimum};
pub use outcome::*;
pub use problem::{Images, NebSettings, Problem};
pub use rates::{is_said_of_rates, stored_rates, warnings as rates_warnings};
pub use recorder::{Keep, Partial, Recorder};
pub use relaxation::{Goal, Relaxation, image_levels, prominent_maxima, refined};
pub use relaxed::{RelaxedState, relaxed_state};
pub use report::partial;
pub use run::{FEWEST_IMAGES, run, run_recorded};
pub use scales::Scales;
pub use stop::{Stop, StopCode};
pub use top::{Top, tops};

/// Watches a run.
pub trait Observer: Send {
    /// A band was evaluated.
    fn iteration(&mut self, row: &HistoryRow);

    /// A stage begins, in words.
    fn stage(&mut self, _what: &str) {}

    /// The relaxation of a band begins. A tight one ends once no spin is predicted to turn by more than `_tolerance_rad`.
    fn relaxing(&mut self, _goal: Goal, _tolerance_rad: f64) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn iteration(&mut self, _: &HistoryRow) {}
}
