//! Why a relaxation stopped.

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
    /// The path rises to no maximum between its ends: the barrier is the higher end.
    NoMaximum,
    /// Only a saddle with more than one descending mode was found, which is no barrier.
    HigherIndex,
    /// The highest point of the path is an end that was kept as given, which is no barrier.
    KeptEnd,
    /// The run was stopped from outside.
    Interrupted,
}

/// The end of a band's relaxation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Stop {
    /// The goal was met.
    Converged {
        /// Largest predicted rotation (rad).
        rotation: f64,
        /// The goal (rad).
        tolerance: f64,
    },
    /// The evaluations allowed were used up.
    MaxEvaluations {
        /// How many.
        evaluations: usize,
        /// Largest predicted rotation (rad).
        rotation: f64,
        /// The goal (rad).
        tolerance: f64,
    },
    /// No more progress.
    Stalled {
        /// Evaluations since the last progress.
        evaluations: usize,
        /// Largest predicted rotation (rad).
        rotation: f64,
        /// The goal (rad).
        tolerance: f64,
    },
    /// Numbers that are not finite appeared.
    NotFinite,
}

impl Stop {
    /// Whether the goal was met.
    pub fn is_converged(&self) -> bool {
        matches!(self, Stop::Converged { .. })
    }

    /// The same without numbers.
    pub fn code(&self) -> StopCode {
        match self {
            Stop::Converged { .. } => StopCode::Converged,
            Stop::MaxEvaluations { .. } => StopCode::MaxEvaluations,
            Stop::Stalled { .. } => StopCode::Stalled,
            Stop::NotFinite => StopCode::NotFinite,
        }
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Stop::Converged { rotation, tolerance } => {
                write!(
                    f,
                    "converged: no spin is predicted to turn by more than {rotation:.1e} rad (tolerance {tolerance:.1e} rad)"
                )
            }
            Stop::MaxEvaluations { evaluations, rotation, tolerance } => write!(
                f,
                "not converged: all {evaluations} band evaluations were used; a spin is still predicted to turn by {rotation:.1e} rad (tolerance {tolerance:.1e} rad)"
            ),
            Stop::Stalled { evaluations, rotation, tolerance } => write!(
                f,
                "not converged: no progress in {evaluations} band evaluations; a spin is still predicted to turn by {rotation:.1e} rad (tolerance {tolerance:.1e} rad)"
            ),
            Stop::NotFinite => f.write_str("not converged: the forces are no longer finite numbers"),
        }
    }
}
