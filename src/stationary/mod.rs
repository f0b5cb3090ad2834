//! Minima and saddles to machine precision, and what kind of stationary state they are.
//!
//! From any state one search, in steps inside a trust region, leads to a saddle of index one (`search`, `step`): climbs and the
//! refinement of a path's maximum are uses of it.
//!
//! Down from a saddle a descent follows the gradient's flow (`descent`, `flow`), which tells which minima it joins.
//!
//! A wall that can slide gives a chain's Hessian one eigenvalue of either sign that may be 1e-12 of the others. On the way down the soft
//! mode is split off there (`valley`; Lyapunov–Schmidt): Newton's method across it, steps along it.

mod border;
mod circuit;
mod descent;
mod flow;
mod iterated;
mod pinned;
mod point;
mod polish;
mod quench;
mod refine;
mod relax;
mod search;
mod spectrum;
mod state;
mod step;
mod stroll;
mod tolerances;
mod trail;
mod unfactored;
mod valley;
mod walk;

pub(crate) use border::{Border, Pin, pin, pin_all};
pub use descent::{Descent, descend};
pub use pinned::Pinned;
pub use point::{Point, move_free};
pub use refine::{Refined, refine, refine_unless_it_strays};
pub use relax::{Relaxed, WayDown, relax_end, relax_to_minimum};
pub use search::{Climb, GaveUp, Limits, STEPS, Saddle, climb};
pub use spectrum::{Spectrum, lowest_eigenvalues_mev};
pub use state::{State, both_by_factors, is_very_dear};
pub use tolerances::{
    ALIKE, FAR, FEW, FLAT, INDEPENDENT, LAST_DIGITS, LOWER, MANY, RELAXED, ROUGHLY, STATIONARY, STEP, STRIDE,
};
pub use walk::Downhill;
