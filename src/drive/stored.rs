//! What the computations of a run result in, as taken over from a record: checked, so that the run goes on with numbers that it can
//! bear.

use super::outcome::HistoryRow;
use super::{Scales, Stop};
use crate::energy::{Evaluator, Stored};
use crate::landscape::{are_counts, are_finite, fit};
use crate::path::Path;
use crate::stationary::{Relaxed, WayDown};

impl Stored for [Relaxed; 2] {
    fn restored(self, h: Evaluator) -> Option<Self> {
        let is_sound = |end: &Relaxed| {
            let left = end.left.as_ref().is_none_or(|WayDown { site, .. }| *site < h.sites());
            fit(h, &end.spins) && are_finite(&[end.max_torque_mev]) && are_counts(&[end.steps]) && left
        };
        self.iter().all(is_sound).then_some(self)
    }
}

impl Stored for Scales {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let Scales { stiffness_mev, exchange_mev, wall_width_sites } = self;
        (stiffness_mev > 0.0 && are_finite(&[stiffness_mev, exchange_mev, wall_width_sites])).then_some(self)
    }
}

impl Stored for Stop {
    fn restored(self, _: Evaluator) -> Option<Self> {
        let is_sound = match self {
            Stop::Converged { rotation, tolerance } => are_finite(&[rotation, tolerance]),
            Stop::MaxEvaluations { evaluations, rotation, tolerance }
            | Stop::Stalled { evaluations, rotation, tolerance } => {
                are_counts(&[evaluations]) && are_finite(&[rotation, tolerance])
            }
            Stop::NotFinite => true,
        };
        is_sound.then_some(self)
    }
}

impl Stored for HistoryRow {
    fn restored(self, _: Evaluator) -> Option<Self> {
        are_counts(&[self.iteration, self.images, self.hessian_products]).then_some(self)
    }
}

impl Stored for Path {
    fn restored(self, h: Evaluator) -> Option<Self> {
        (self.sites() == h.sites()).then_some(self)
    }
}
