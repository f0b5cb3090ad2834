//! What a run came to: in words, and as a code from a closed list.

use super::Stop;
use crate::landscape::{Doubt, PathEnd};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Why a run ended, from a closed list: `stop_code` in `summary.json`, beside the reason in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum StopCode {
    /// The band met its tolerance.
    Converged,
    /// The evaluations allowed were used up.
    MaxEvaluations,
    /// No more progress.
    Stalled,
    /// Numbers that are not finite appeared.
    NotFinite,
    /// Both ends relaxed to the same state: there is no path.
    SameMinimum,
    /// The ends are joined by a valley flat to rounding: the barrier is zero.
    FlatValley,
    /// The path is flat to the rounding of its energies, which is large enough to hide a barrier.
    BelowRounding,
    /// The path rises to no maximum between its ends: the barrier is the higher end.
    NoMaximum,
    /// Only a saddle with more than one descending mode was found, which is no barrier.
    HigherIndex,
    /// The highest point of the path is an end that was kept as given, which is no barrier.
    KeptEnd,
    /// The run was stopped from outside.
    Interrupted,
}

/// What a run came to; its words are the `stop_reason` of `summary.json`.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// A path with a barrier, whose relaxation ended so.
    Path(Stop),
    /// The path rises to no maximum between its ends: the barrier is the higher end.
    NoMaximum(Stop),
    /// The ends are joined by a valley flat to this rounding of its energies (meV): the barrier is zero.
    FlatValley {
        /// What the energies are uncertain by (meV).
        rounding_mev: f64,
    },
    /// The path is flat to this rounding of its energies (meV), which is large enough to hide a barrier: none is known.
    BelowRounding {
        /// What the energies are uncertain by (meV).
        rounding_mev: f64,
    },
    /// Only a saddle with more than one descending mode was found, which is no barrier.
    HigherIndex(Stop),
    /// The highest point of the path is an end that was kept as given, which is no barrier.
    KeptEnd(Stop, PathEnd),
    /// Both ends relaxed to the same state: there is no path.
    SameMinimum,
    /// The run was stopped from outside, in the words of who stopped it.
    Interrupted(String),
}

impl Verdict {
    /// The same without numbers.
    pub fn code(&self) -> StopCode {
        match self {
            Verdict::Path(Stop::Converged { .. }) => StopCode::Converged,
            Verdict::Path(Stop::MaxEvaluations { .. }) => StopCode::MaxEvaluations,
            Verdict::Path(Stop::Stalled { .. }) => StopCode::Stalled,
            Verdict::Path(Stop::NotFinite) => StopCode::NotFinite,
            Verdict::NoMaximum(_) => StopCode::NoMaximum,
            Verdict::FlatValley { .. } => StopCode::FlatValley,
            Verdict::BelowRounding { .. } => StopCode::BelowRounding,
            Verdict::HigherIndex(_) => StopCode::HigherIndex,
            Verdict::KeptEnd(..) => StopCode::KeptEnd,
            Verdict::SameMinimum => StopCode::SameMinimum,
            Verdict::Interrupted(_) => StopCode::Interrupted,
        }
    }

    /// Whether there is a barrier, of a path as good as was asked for.
    pub fn is_converged(&self) -> bool {
        match self {
            Verdict::Path(stop) | Verdict::NoMaximum(stop) => stop.is_converged(),
            Verdict::FlatValley { .. } => true,
            _ => false,
        }
    }
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Verdict::Path(stop) => stop.fmt(f),
            Verdict::NoMaximum(stop) => write!(
                f,
                "{stop}; the path rises to no maximum between its ends, so there is no barrier beyond the higher end"
            ),
            Verdict::FlatValley { rounding_mev } => write!(
                f,
                "a valley that is flat to rounding ({rounding_mev:.0e} meV) joins the two minima: there is no barrier"
            ),
            Verdict::BelowRounding { rounding_mev } => write!(
                f,
                "the path is flat to the rounding of its energies, {rounding_mev:.1e} meV, which may hide a barrier: a term that \
                 changes along it is no larger than that for a spin"
            ),
            Verdict::HigherIndex(stop) => {
                write!(f, "{stop}; only a saddle of higher index was found, which is no barrier")
            }
            Verdict::KeptEnd(stop, end) => write!(f, "{stop}; {}", Doubt::KeptEnd(*end)),
            Verdict::SameMinimum => f.write_str("the initial and the final state are the same minimum"),
            Verdict::Interrupted(why) => f.write_str(why),
        }
    }
}
