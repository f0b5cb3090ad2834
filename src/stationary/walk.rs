//! A descent on its way: where it is, where it is going, and what it may do yet.

use super::pinned::Pinned;
use super::point::Point;
use super::state::State;
use super::tolerances::{FLAT, LARGER};
use super::trail::Trail;
use super::unfactored::Unfactored;
use crate::energy::Evaluator;
use crate::linalg::Matrix;
use crate::spins::Spins;

/// A few of the flow's steps shorter than the first are a crawl, where the slope is below this part of the stiffness (a radian): what
/// lies across the valley relaxes long before it bends.
pub(super) const GENTLE: f64 = 1e-5;
/// Where the valley itself was followed, the flow takes over at this slope.
pub(super) const STEEP: f64 = LARGER * GENTLE;
/// Differences of energies below this part of the stiffness may be rounding error.
pub(super) const NOISE: f64 = 64.0 * f64::EPSILON;
/// Most steps of the flow at a time.
pub(super) const STEPS: usize = 20_000;

/// What a descent needs to know.
#[derive(Clone, Copy)]
pub struct Downhill<'a> {
    /// The stiffness scale (meV).
    pub c: f64,
    /// What rises by less is level (meV): where that is more than rounding, a descent goes on over minima that no more parts.
    pub level_mev: f64,
    /// Proven minima beside the saddle: a descent ends in one where its slope forks, where it has all but reached it, and where it comes
    /// by on a level with it.
    pub beside: &'a [&'a Spins],
    /// Most steps by factors: a descent that takes more is given up.
    pub most: usize,
}

/// A descent on its way.
pub(super) struct Walk<'a> {
    pub(super) h: Evaluator<'a>,
    pub(super) c: f64,
    pub(super) beside: &'a [&'a Spins],
    /// Over minima that so little of a rise parts (meV) the descent goes on; over none if 0.
    pub(super) level_mev: f64,
    pub(super) here: Point,
    /// Where the step that is being tried leads.
    pub(super) next: Point,
    /// So many steps by factors may be taken yet.
    pub(super) left: usize,
    /// The valley's direction (3N), of any length.
    pub(super) tau: Vec<f64>,
    /// The direction at the start of the last step along the valley, a radian a unit of length, and that step's length (rad).
    pub(super) last: Option<(Vec<f64>, f64)>,
    pub(super) trail: Trail,
    pub(super) room: Room,
    /// In place of factors.
    pub(super) unfactored: Option<Unfactored>,
}

/// Memory for the linear algebra.
#[derive(Default)]
pub(super) struct Room {
    pub pinned: Pinned,
    pub matrix: Matrix,
    pub x: Vec<f64>,
    pub v: Vec<f64>,
}

impl<'a> Walk<'a> {
    /// At a saddle, about to go along ± its valley.
    pub(super) fn from(h: Evaluator<'a>, saddle: &State, valley: &[f64], to: Downhill<'a>) -> Walk<'a> {
        let Downhill { c, level_mev, beside, most } = to;
        Walk {
            h,
            c,
            beside,
            level_mev: if level_mev > FLAT * h.stiffness_mev() && !h.forgoes_factors() { level_mev } else { 0.0 },
            here: saddle.point.clone(),
            next: Point::default(),
            left: most,
            tau: valley.to_vec(),
            last: None,
            trail: Trail::from(&saddle.m),
            room: Room::default(),
            // where a state that came to rest is left, with no minimum beside it, the fall may be of 1e-9 meV, less than the noise without factors
            unfactored: match beside {
                [] if !h.forgoes_factors() => None,
                _ => h.has_dear_factors().then(|| Unfactored::about(&h, &saddle.point, c)),
            },
        }
    }
}
