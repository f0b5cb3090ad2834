//! From a peak of a band to the refined saddle.

use super::peaks::Peak;
use crate::energy::{Evaluator, recorded};
use crate::error::Result;
use crate::linalg::Matrix;
use crate::stationary::{
    self, ALIKE, Climb, Limits, Refined, STATIONARY, Spectrum, State, climb, follow_modes, refine,
};
use crate::symmetry::Operation;
use serde::{Deserialize, Serialize};

/// Where a refined saddle was looked for, and what was found.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Saddle {
    /// The start.
    pub top: Peak,
    /// The end.
    pub refined: Refined,
}

impl Saddle {
    /// Refines a top.
    pub fn at(h: Evaluator, top: Peak, c: f64) -> Saddle {
        let mut found = Saddle::near(h, top, c);
        found.sharpen(h, c);
        if found.refined.index > 1 {
            // a mode within the rounding error has no sign to count
            found.refined.index = Spectrum::negatives(h, &found.refined.state, &mut Matrix::default());
        }
        found
    }

    /// The saddle of index one that a climb from any state leads to, if it leads to one within the limits.
    pub fn climbed(h: Evaluator, start: &[f64], limits: &Limits) -> Option<Saddle> {
        let Climb { saddle, steps: factorisations } = climb(h, start, limits);
        let stationary::Saddle { state, mode, spectrum, .. } = saddle.ok()?;
        let top = Peak {
            m: start.to_vec(),
            tau: mode.clone(),
            energy_mev: state.energy_mev,
            s: 0.0,
            image: 0,
            floor_mev: f64::NEG_INFINITY,
        };
        let refined =
            Refined { arrived: true, valley: mode, factorisations, index: 1, spectrum: Some(spectrum), state };
        Some(Saddle { top, refined })
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
        Saddle {
            top: Peak { m, tau, ..*top },
            refined: Refined { state, valley, spectrum: refined.spectrum.clone(), ..*refined },
        }
    }

    /// Follows the modes of a saddle that the valley's search left where sliding over the lattice still has a torque.
    fn sharpen(&mut self, h: Evaluator, c: f64) {
        let rest = |r: &Refined| r.state.max_torque_mev() / (STATIONARY * r.state.hessian.norm1());
        if !self.is_stationary(c) || rest(&self.refined) <= 1.0 {
            return;
        }
        for start in [self.refined.state.m.clone(), self.top.m.clone()] {
            if let Some(refined) = follow_modes(h, &start, self.top.floor_mev).filter(|r| rest(r) <= 1.0) {
                let found = Saddle { top: self.top.clone(), refined };
                if found.is_stationary(c) {
                    *self = found;
                    return;
                }
            }
        }
    }

    /// In a row walls stand between one site and the next in valleys that are flat to rounding, and the valley's search comes first;
    /// on other lattices following the lowest mode takes a step less, and arrives from farther away.
    fn near(h: Evaluator, top: Peak, c: f64) -> Saddle {
        let is_row = h.lattice().is_row();
        let follow = |top: &Peak| follow_modes(h, &top.m, top.floor_mev);
        if !is_row && let Some(refined) = follow(&top) {
            let found = Saddle { top: top.clone(), refined };
            if found.is_stationary(c) {
                return found;
            }
        }
        if h.forgoes_factors() {
            return Saddle { refined: Refined::not_found(h, &top.m, &top.tau), top };
        }
        let refined = refine(h, &top.m, &top.tau, c, top.floor_mev);
        let mut found = Saddle { top, refined };
        if is_row
            && !found.is_stationary(c)
            && let Some(refined) = follow(&found.top)
        {
            found.refined = refined;
        }
        found
    }

    /// The same, as far as it is not on record.
    pub fn recorded(h: Evaluator, top: Peak, c: f64) -> Result<Saddle> {
        let [m, tau] = [&top.m, &top.tau].map(Vec::clone);
        recorded(h, "saddle", &[&m, &tau], || Ok(Saddle::at(h, top, c)))
    }

    /// Stationary to machine precision, and near the start's height.
    pub fn is_stationary(&self, c: f64) -> bool {
        let zero = (ALIKE * c).max(STATIONARY * self.refined.state.hessian.norm1());
        let near = self.refined.state.energy_mev >= self.top.floor_mev;
        self.refined.arrived && near && self.refined.state.max_torque_mev() < zero
    }

    /// A stationary state with at most one negative direction.
    pub fn is_saddle(&self, c: f64) -> bool {
        self.is_stationary(c) && self.refined.index <= 1
    }
}
