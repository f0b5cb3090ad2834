//! From two states to a barrier: relax the ends, make a first path, relax the band, read off what it found.

mod course;
mod ends;
mod escape;
mod explore;
mod first_path;
mod first_paths;
mod heights;
mod judge;
pub mod memory;
mod network;
mod outcome;
mod path_warnings;
mod places;
mod points;
mod problem;
mod rate_warnings;
mod rates;
mod relaxation;
mod relaxed;
mod report;
mod run;
mod scales;
mod search;
mod settle;
mod settled;
mod stop;
mod stored;
mod stored_rates;
pub mod survey;
mod tables;
mod verdict;

pub use course::run;
pub use explore::natural_guesses;
pub use heights::prominent_maxima;
pub use outcome::*;
pub use problem::{Images, NebSettings, Problem, checked_evaluations, checked_smoothing, checked_tolerance};
pub use rate_warnings::{is_said_of_rates, warnings as rates_warnings};
pub use relaxation::{Goal, Relaxation, image_levels, refined};
pub use relaxed::{RelaxedState, relaxed_state};
pub use report::partial;
pub use run::FEWEST_IMAGES;
pub use scales::Scales;
pub use search::third_states;
pub use stop::Stop;
pub use stored_rates::stored_rates;
pub use verdict::{StopCode, Verdict};

use crate::landscape::Standing;
use crate::path::Path;

/// A band as it stood when a run was stopped.
#[derive(Clone, Debug)]
pub struct Partial {
    /// Its images.
    pub path: Path,
    /// Its iterations.
    pub history: Vec<HistoryRow>,
}

/// Watches a run.
pub trait Observer: Send {
    /// A band was evaluated.
    fn iteration(&mut self, row: &HistoryRow);

    /// A stage begins, in words.
    fn stage(&mut self, _what: &str) {}

    /// A search has made another batch of climbs.
    fn searching(&mut self, _standing: &Standing) {}

    /// A band as its relaxation left it, finished or stopped.
    fn relaxed(&mut self, _path: &Path, _history: &[HistoryRow]) {}

    /// The relaxation of a band begins. A tight one ends once no spin is predicted to turn by more than `_tolerance_rad`.
    fn relaxing(&mut self, _goal: Goal, _tolerance_rad: f64) {}
}

/// Watches nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Observer for Silent {
    fn iteration(&mut self, _: &HistoryRow) {}
}
