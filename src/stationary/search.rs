//! The search for a saddle of index one, from any state.

use super::point::Point;
use super::polish::polish_on;
use super::spectrum::Spectrum;
use super::state::State;
use super::step::{Region, Step};
use super::tolerances::{FLAT, LAST_DIGITS, ROUGHLY, SHARP, STEP};
use crate::energy::Evaluator;
use crate::linalg::slab;
use std::mem::{swap, take};

/// Most steps of a search.
pub const STEPS: usize = 40;

/// What bounds a climb.
pub struct Limits<'a> {
    /// Most steps.
    pub steps: usize,
    /// Most steps in a row without a descending mode.
    pub without_mode: usize,
    /// Largest rotation of a spin in a step (rad).
    pub radius: f64,
    /// A saddle above this energy (meV, above the Hamiltonian's reference) is not wanted.
    pub ceiling_mev: f64,
    /// Whether spins (3N, with their energy in meV above the reference) are beside a saddle that is known already.
    pub known: &'a (dyn Fn(&[f64], f64) -> bool + Sync),
}

/// Why a search ended without what it looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GaveUp {
    /// Too many steps.
    Steps,
    /// Too many steps without a descending mode.
    NoMode,
    /// It headed for a saddle above the ceiling.
    TooHigh,
    /// It came beside a known saddle.
    Known,
    /// It came to rest where there is no such state.
    Stuck,
    /// Its first step led too far.
    Strayed,
    /// It was told to stop.
    Stopped,
}

/// Where a climb ended.
#[derive(Debug)]
pub struct Climb {
    /// A saddle of index one, or why there is none.
    pub saddle: Result<Saddle, GaveUp>,
    /// Hessians that it took.
    pub steps: usize,
}

/// A saddle of index one.
#[derive(Debug)]
pub struct Saddle {
    /// Spins, energy, torque and Hessian.
    pub state: State,
    /// The signs of its modes.
    pub spectrum: Spectrum,
    /// The descending mode: a unit field of 3N numbers.
    pub mode: Vec<f64>,
    /// Its curvature (meV), negative.
    pub curvature_mev: f64,
}

/// Climbs from any state to a saddle of index one: up along the lowest mode, down along all others.
pub fn climb(h: Evaluator, start: &[f64], limits: &Limits) -> Climb {
    let mut search = Search::from(h, start, limits.radius);
    let mut without = 0;
    let saddle = search.saddle(limits.steps, false, |here, step| {
        without = if step.negative == 0 { without + 1 } else { 0 };
        if without > limits.without_mode {
            return Some(GaveUp::NoMode);
        }
        if step.negative != 1 {
            return None;
        }
        if (limits.known)(&here.m, here.energy_mev) {
            return Some(GaveUp::Known);
        }
        // a short step of Newton's tells how high the saddle is
        let there = here.energy_mev + step.rise_mev - ROUGHLY * step.rise_mev.abs();
        (step.is_newton && step.rotation < STEP && there > limits.ceiling_mev).then_some(GaveUp::TooHigh)
    });
    Climb { saddle, steps: search.steps }
}

/// A search on its way.
pub(super) struct Search<'a> {
    h: Evaluator<'a>,
    region: Region<'a>,
    here: Point,
    next: Point,
    /// The last way along a wrong mode (3N).
    away: Vec<f64>,
    /// What may be like the mode along which the saddle falls (3N).
    pub along: Option<Vec<f64>>,
    pub steps: usize,
}

impl<'a> Search<'a> {
    pub fn from(h: Evaluator<'a>, start: &[f64], radius: f64) -> Search<'a> {
        let here = Point::at(h, start.to_vec());
        Search {
            h,
            region: Region::new(h, radius),
            here,
            next: Point::default(),
            away: Vec::new(),
            along: None,
            steps: 0,
        }
    }

    /// To a saddle of index one, or, if it `may_be_flat`, with one mode flat to rounding and none that falls, by `most` steps; `each` may
    /// end it before any.
    pub fn saddle(
        &mut self,
        most: usize,
        may_be_flat: bool,
        mut each: impl FnMut(&Point, &Step) -> Option<GaveUp>,
    ) -> Result<Saddle, GaveUp> {
        loop {
            self.run(most, &mut each)?;
            let state = State::of(self.h, self.here.clone());
            let like = self.region.modes.first().or(self.along.as_ref());
            let (spectrum, lowest) = Spectrum::of_saddle(self.h, &state, like);
            let is_saddle = spectrum.negative == 1 || may_be_flat && spectrum.negative == 0 && spectrum.flat == 1;
            if let Some(lowest) = lowest.filter(|_| is_saddle) {
                let (mut mode, curvature_mev) = (state.field(&lowest), state.curvature_mev(&lowest));
                self.h.hold_frozen(&mut mode);
                return Ok(Saddle { state, mode, curvature_mev, spectrum });
            }
            // a mode that steps leave alone may be one too many
            if !self.leave(spectrum.negative) {
                return Err(GaveUp::Stuck);
            }
        }
    }

    /// Until the torque is rounding error.
    fn run(&mut self, most: usize, each: &mut impl FnMut(&Point, &Step) -> Option<GaveUp>) -> Result<(), GaveUp> {
        let [sharp, loose] = [SHARP, FLAT].map(|part| part * self.h.stiffness_mev());
        while self.steps < most {
            if self.h.is_stopped() {
                return Err(GaveUp::Stopped);
            }
            self.steps += 1;
            let step = self.region.step(&self.here);
            if let Some(why) = each(&self.here, &step) {
                return Err(why);
            }
            let torque = self.here.max_torque_mev();
            if !torque.is_finite() {
                return Err(GaveUp::Stuck);
            }
            if torque > loose || torque > sharp && step.is_underway {
                // Newton's steps leave the negative directions as many as they are
                self.go(&step);
                if step.is_newton && self.here.max_torque_mev() <= sharp {
                    return Ok(());
                }
            } else if step.negative <= 1 {
                // the first step of the last ones is known
                if step.is_newton {
                    self.next.go(self.h, &self.here, &self.region.v);
                    if self.next.max_torque_mev() < torque {
                        swap(&mut self.here, &mut self.next);
                    }
                }
                self.here = polish_on(&mut self.region, take(&mut self.here));
                return Ok(());
            } else if !self.leave(step.negative) {
                return Err(GaveUp::Stuck);
            }
        }
        Err(GaveUp::Steps)
    }

    fn go(&mut self, step: &Step) {
        self.next.go(self.h, &self.here, &self.region.v);
        self.region.judge(step, self.next.above_mev(&self.here));
        swap(&mut self.here, &mut self.next);
    }

    /// Leaves a stationary state along the lowest of its wrong modes, on the way that it left one before; not one that has none too many.
    fn leave(&mut self, negative: usize) -> bool {
        let leads_away = negative > 1 && self.region.along_second(&self.here, LAST_DIGITS);
        if leads_away {
            let v = &mut self.region.v;
            if self.away.len() == v.len() && slab::dot(&self.away, v) < 0.0 {
                slab::scale(v, -1.0);
            }
            self.away.clone_from(v);
            self.here.move_by(self.h, v);
        }
        leads_away
    }
}
