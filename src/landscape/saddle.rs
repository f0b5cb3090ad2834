//! From a peak of a band to the refined saddle.

use super::peaks::Peak;
use crate::energy::{Evaluator, recorded};
use crate::error::Result;
use crate::stationary::{self, ALIKE, Limits, Refined, STATIONARY, State, climb, refine, refine_unless_it_strays};
use crate::symmetry::Operation;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// Where a refined saddle was looked for, and what was found: shared by all that hold the saddle, as both are large.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Saddle {
    /// The start.
    pub top: Arc<Peak>,
    /// The end.
    pub refined: Arc<Refined>,
}

impl Saddle {
    /// Of a start and an end.
    pub fn new(top: Peak, refined: Refined) -> Saddle {
        Saddle { top: Arc::new(top), refined: Arc::new(refined) }
    }

    /// Refines a top.
    pub fn at(h: Evaluator, top: Peak) -> Saddle {
        let refined = refine(h, &top.m, &top.tau, top.floor_mev);
        Saddle::new(top, refined)
    }

    /// The same, unless the search strays.
    fn near(h: Evaluator, top: Peak) -> Saddle {
        let refined = refine_unless_it_strays(h, &top.m, &top.tau, top.floor_mev);
        Saddle::new(top, refined)
    }

    /// The saddle of index one that a climb from any state leads to, if it leads to one within the limits.
    pub fn climbed(h: Evaluator, start: &[f64], limits: &Limits) -> Option<Saddle> {
        let stationary::Saddle { state, mode, spectrum, .. } = climb(h, start, limits).saddle.ok()?;
        let top = Peak {
            m: start.to_vec(),
            tau: mode.clone(),
            energy_mev: state.energy_mev,
            s: 0.0,
            image: 0,
            floor_mev: f64::NEG_INFINITY,
        };
        Some(Saddle::new(top, Refined { valley: mode, spectrum: Some(spectrum), state }))
    }

    /// Its spins (3N).
    pub fn spins(&self) -> &[f64] {
        &self.refined.state.m
    }

    /// What a symmetry of the energy makes of it.
    pub fn image(&self, h: Evaluator, operation: &Operation) -> Saddle {
        let Saddle { top, refined } = self;
        let (m, tau) = (operation.apply(&top.m), operation.apply_field(&top.tau));
        let state = State::at(h, operation.apply(self.spins()));
        let valley = operation.apply_field(&refined.valley);
        let spectrum = refined.spectrum.clone();
        Saddle::new(Peak { m, tau, ..**top }, Refined { state, valley, spectrum })
    }

    /// [`at`](Self::at) a top, or near it if the search may not stray, as far as it is not on record.
    pub fn recorded(h: Evaluator, top: Peak, may_stray: bool) -> Result<Saddle> {
        let [m, tau] = [&top.m, &top.tau].map(Vec::clone);
        let strays = [f64::from(may_stray)];
        recorded(h, "saddle", &[&m, &tau, &strays], || {
            Ok(if may_stray { Saddle::at(h, top) } else { Saddle::near(h, top) })
        })
    }

    /// Stationary to machine precision, and near the start's height.
    pub fn is_stationary(&self, c: f64) -> bool {
        let zero = (ALIKE * c).max(STATIONARY * self.refined.state.hessian.norm1());
        let near = self.refined.state.energy_mev >= self.top.floor_mev;
        // a minimum is no saddle
        let is_one = self.refined.spectrum.as_ref().is_some_and(|s| s.negative + s.flat > 0);
        is_one && near && self.refined.state.max_torque_mev() < zero
    }

    /// A stationary state with at most one negative direction.
    pub fn is_saddle(&self, c: f64) -> bool {
        self.is_stationary(c) && self.refined.index() <= 1
    }
}
