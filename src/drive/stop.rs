//! Why a relaxation stopped.

use crate::words::counted;
use serde::{Deserialize, Serialize};
use std::fmt;

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
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Stop::Converged { rotation, tolerance } if rotation > tolerance => write!(
                f,
                "converged: no image's energy is predicted to fall by more than rounding, though a spin may still turn by \
                 {rotation:.1e} rad along a mode that is all but free"
            ),
            Stop::Converged { rotation, tolerance } => {
                write!(
                    f,
                    "converged: no spin is predicted to turn by more than {rotation:.1e} rad (tolerance {tolerance:.1e} rad)"
                )
            }
            Stop::MaxEvaluations { evaluations, rotation, tolerance } => write!(
                f,
                "not converged: stopped after {} of the band, all that was allowed; a spin is still predicted to turn by {rotation:.1e} rad (tolerance {tolerance:.1e} rad)",
                counted(*evaluations, "evaluation", "evaluations")
            ),
            Stop::Stalled { evaluations, rotation, tolerance } => write!(
                f,
                "not converged: no progress in {}; a spin is still predicted to turn by {rotation:.1e} rad (tolerance {tolerance:.1e} rad)",
                counted(*evaluations, "band evaluation", "band evaluations")
            ),
            Stop::NotFinite => f.write_str("not converged: the forces are no longer finite numbers"),
        }
    }
}
