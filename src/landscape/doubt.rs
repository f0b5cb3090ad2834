//! What can stand against a certificate, from a closed list.

use std::fmt;
use thiserror::Error;

/// How the warning of a doubt begins.
const NOT_CERTIFIED: &str = "not certified: ";

/// Why a path is not certified. Energies and torques in meV.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Doubt {
    /// Nobody asked.
    #[error("certification was not asked for (saddle.certify is false)")]
    NotAskedFor,
    /// The maxima were not followed to their saddles.
    #[error("the saddles were not refined (saddle.refine and neb.climb are false)")]
    NotRefined,
    /// No maximum led to a saddle.
    #[error("no saddle could be refined to machine precision")]
    NoSaddle,
    /// The work that was allowed is done.
    #[error("the evaluations that neb.max_evaluations allows were used up")]
    Spent,
    /// An end is no proven minimum.
    #[error("the {0} state is not proven to be a minimum")]
    NoMinimum(PathEnd),
    /// The ends are one minimum turned, and the turn costs something.
    #[error(
        "the two states are one minimum turned about a symmetry axis, but the turn between them is not flat to rounding"
    )]
    CostlyTurn,
    /// The highest saddle of the path has more than one descending mode.
    #[error("the path passes a saddle of higher index")]
    HigherIndex,
    /// The path passes higher than its saddles.
    #[error("an image of the path lies above every refined saddle; the barrier is that image's energy")]
    HigherImage,
    /// The path is highest at an end that was not relaxed.
    #[error("the highest point of the path is the {0} state, kept as given: that is no barrier")]
    KeptEnd(PathEnd),
    /// The route over proven saddles rises so high, and a path that was found does not.
    #[error(
        "the lowest route over proven saddles that was found rises by {route_mev:.6} meV, and a path that stays below {path_mev:.6} \
         meV is known"
    )]
    HigherRoute {
        /// Highest saddle of the route above the initial state.
        route_mev: f64,
        /// What the path stays below.
        path_mev: f64,
    },
    /// A lower route over proven saddles is known, which no path was made of.
    #[error(
        "proven passes are known that rise to {top_mev:.6} meV alone, but a path over them could not be put together; this one rises to \
         {path_mev:.6} meV"
    )]
    Unassembled {
        /// The highest of the passes above the initial state.
        top_mev: f64,
        /// The top of the path.
        path_mev: f64,
    },
    /// A saddle is not stationary.
    #[error("a torque of {0:.1e} meV remains on the saddle")]
    Torque(f64),
    /// A saddle has so many descending modes.
    #[error("the saddle has {0} negative modes")]
    NegativeModes(usize),
    /// A saddle has none.
    #[error("the saddle has no negative mode")]
    NoNegativeMode,
    /// The energy falls on one side at most by more than this rounding error.
    #[error("the energy does not fall on both sides of the saddle by more than its rounding error of {0:.1e} meV")]
    NoFall(f64),
    /// A descent from a saddle came to a state with so many descending modes and this torque.
    #[error(
        "a descent from the saddle ended in a state that is not proven to be a minimum ({negative} negative modes, a torque of \
         {torque_mev:.1e} meV)"
    )]
    Descent {
        /// Descending modes of the state.
        negative: usize,
        /// Largest torque that is left on it.
        torque_mev: f64,
    },
    /// No route where so many pairs of minima were tried, or all that could be.
    #[error(
        "no route over proven saddles was found from the initial to the final state, {0} pairs of minima having been tried"
    )]
    NoRoute(usize),
}

impl Doubt {
    /// As a warning of the result.
    pub fn warning(&self) -> String {
        format!("{NOT_CERTIFIED}{self}")
    }

    /// The words of the doubt that a warning of a result tells of, if it is one.
    pub fn of_warning(warning: &str) -> Option<&str> {
        warning.strip_prefix(NOT_CERTIFIED)
    }
}

/// An end of the path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PathEnd {
    /// Where it starts.
    Initial,
    /// Where it ends.
    Final,
}

impl PathEnd {
    /// Both, in path order.
    pub const BOTH: [PathEnd; 2] = [PathEnd::Initial, PathEnd::Final];
}

impl fmt::Display for PathEnd {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            PathEnd::Initial => "initial",
            PathEnd::Final => "final",
        })
    }
}
