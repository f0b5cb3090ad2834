//! Down from a saddle to the minimum on one side: the gradient's flow dm/dt = −g, which tells which minima a saddle joins.
//!
//! A first step goes along the valley, with everything across it relaxed; more follow as long as the slope is no plainer than rounding
//! error, as near a flat top. From there the flow is followed (`flow`), in steps whose error is controlled: the stiff directions stay
//! relaxed and cost nothing, and where several are soft the flow decides between valleys, as no step of Newton's does. Beside a point
//! of rest a few of Newton's steps end it. Where the forces vanish but a direction is still negative, the descent goes on along that
//! direction, and ends only where the inertia counts none. Where a direction across a slope that is next to none is about to fall, the
//! flow's steps become short: the valley is followed again. From a minimum that parts nothing the descent goes on along the valley
//! (`stroll`). Where factors are dear, gradients alone are tried first, from a step along the valley to where the slope ends: with what
//! stands in for the Hessian, to a minimum beside it that was given, else without, to any; where that ends between two places of the
//! lattice, the descent goes to the minimum beside it that was given.

use super::flow::{D, flow};
use super::point::Point;
use super::polish::polish;
use super::quench::quench;
use super::spectrum::Spectrum;
use super::state::State;
use super::stroll::SOFT;
use super::tolerances::{FAR, FEW, FLAT, LARGER, LAST_DIGITS, LAST_SHIFT, SHARP, STATIONARY, STEP};
use super::walk::{Downhill, GENTLE, NOISE, STEEP, STEPS, Walk};
use crate::energy::Evaluator;
use crate::field::project;
use crate::linalg::slab;
use crate::path::{blend, largest_angle};
use crate::sphere::rotation_of;
use crate::spins::Spins;
use std::mem::swap;

/// The flow's error a step, at most (rad, any spin).
const ERROR: f64 = 0.01;
/// A state whose spins are turned by less than this (rad, any spin) has been reached.
const REACHED: f64 = 0.03;
/// Most times that a descent goes on along a valley.
const ROUNDS: usize = 24;

/// Where a descent ended.
#[derive(Debug)]
pub struct Descent {
    /// The lowest point reached.
    pub m: Vec<f64>,
    /// Energy fallen (meV), positive.
    pub fallen_mev: f64,
    /// It ended at a stationary point without a negative direction.
    pub arrived: bool,
    /// It took as many steps as it might.
    pub given_up: bool,
    /// Steps by factors taken.
    pub steps: usize,
    /// Points on the way, each with a spin turned by 0.3 rad or more since the last (more on long chains, so that they
    /// fit into memory).
    pub way: Vec<Vec<f64>>,
}

/// Descends from a saddle along ± its valley (a unit field of 3N numbers).
pub fn descend(h: Evaluator, saddle: &State, valley: &[f64], to: Downhill) -> Descent {
    let mut walk = Walk::from(h, saddle, valley, to);
    let nearly = walk.unfactored.is_some() && !to.beside.is_empty();
    let arrived = h.has_dear_factors() && (nearly && walk.roll(true) || walk.roll(false)) || walk.down();
    let given_up = !arrived && walk.left == 0;
    Descent {
        fallen_mev: saddle.above_mev(&walk.here),
        arrived,
        given_up,
        steps: to.most - walk.left,
        m: walk.here.m,
        way: walk.trail.into_points(),
    }
}

/// How a fall ended.
enum Fall {
    /// Where the gradient vanishes.
    Arrived,
    /// On a slope that is next to none, where the flow's steps are short; `tau` is the last one.
    Crawling,
    /// Nowhere.
    Stuck,
}

impl Walk<'_> {
    /// To a minimum; whether it is one.
    fn down(&mut self) -> bool {
        let noise = NOISE * self.h.stiffness_mev();
        let mut enough = STATIONARY * self.h.stiffness_mev();
        let mut in_vain = 0;
        for _ in 0..ROUNDS {
            let from = self.here.clone();
            let moved = self.march(enough);
            enough = STATIONARY * self.h.stiffness_mev();
            let end = self.fall();
            if self.left == 0 {
                return false;
            }
            in_vain = if from.above_mev(&self.here) > noise { 0 } else { in_vain + 1 };
            if matches!(end, Fall::Crawling) && moved {
                enough = STEEP * self.h.stiffness_mev();
                continue;
            }
            // where nothing is softer than a well that parts nothing one look tells a minimum
            let is_firm = self.h.is_stopped() || self.has_none_softer(SOFT * self.level_mev);
            let is_minimum = is_firm || self.level_mev > 0.0 && self.has_none_softer(0.0);
            if is_firm || is_minimum && !self.stroll() {
                return matches!(end, Fall::Arrived);
            }
            if is_minimum {
                enough = STEEP * self.h.stiffness_mev();
                continue;
            }
            // once along the direction that was given, and once along the lowest mode
            if in_vain > 1 {
                return false;
            }
            project(&self.here.m, &mut self.tau);
            let state = State::of(self.h, self.here.clone());
            let Some(mode) = state.lowest_mode(self.h) else { return false };
            let mut on = state.field(&mode.vector);
            if slab::dot(&on, &self.tau) < 0.0 {
                slab::scale(&mut on, -1.0);
            }
            self.tau = on;
        }
        false
    }

    /// Down the gradient's flow to a point where it vanishes.
    fn fall(&mut self) -> Fall {
        let scale = self.h.stiffness_mev();
        let mut short = 0;
        // a step of the first's length, if the slope stays as it is
        let mut rate = self.here.max_torque_mev() / (D * LAST_DIGITS);
        for _ in 0..STEPS {
            if self.here.max_torque_mev() <= SHARP * scale || self.h.is_stopped() {
                return Fall::Arrived;
            }
            if rate > LAST_SHIFT * scale || self.left == 0 {
                return Fall::Stuck;
            }
            self.left -= 1;
            let Some(step) =
                flow(self.h, &self.here, &mut self.next, rate, &mut self.room.matrix, self.unfactored.as_mut())
            else {
                rate *= LARGER;
                continue;
            };
            let [slope, there] = step.slopes_mev;
            let longer = (0.8 * (ERROR / step.error).cbrt()).min(0.9 * STEP / step.rotation);
            if !(step.error <= ERROR && step.rotation <= STEP && slope > 0.0) {
                rate *= if longer < 1.0 { (1.0 / longer).min(LARGER) } else { LARGER };
                continue;
            }
            // on a slope that grows the next step is as long in less time
            let longer = longer / (there / slope).max(1.0);
            rate = (rate / longer.clamp(1.0 / LARGER, LARGER)).max(FLAT * scale);
            swap(&mut self.here, &mut self.next);
            self.trail.pass(&self.here.m);
            if step.rotation < LAST_DIGITS && there < slope && self.rest() {
                return Fall::Arrived;
            }
            short = if step.rotation < LAST_DIGITS && slope < GENTLE * scale { short + 1 } else { 0 };
            if short >= FEW {
                // no flow any more, but rounding
                if slope < STATIONARY * scale {
                    return Fall::Arrived;
                }
                self.tau = step.v;
                project(&self.here.m, &mut self.tau);
                return Fall::Crawling;
            }
        }
        Fall::Stuck
    }

    /// To a point of rest beside the descent, by Newton's steps, if these lead down to one; whether they do.
    fn rest(&mut self) -> bool {
        let scale = self.h.stiffness_mev();
        let there = polish(self.h, self.here.clone());
        let rests = there.max_torque_mev() <= STATIONARY * scale && self.here.above_mev(&there) >= -NOISE * scale;
        if rests {
            self.here = there;
        }
        rests
    }

    /// A step along the valley, and down by gradients alone from there; whether that leads to a minimum. Where it does not, the descent
    /// is back where it began. With what stands in for the Hessian it is one that was given: where a slope forks by symmetry, the descent
    /// ends anywhere between two of them.
    fn roll(&mut self, nearly: bool) -> bool {
        let (from, tau, trail) = (self.here.clone(), self.tau.clone(), self.trail.clone());
        self.room.v.clone_from(&self.tau);
        slab::scale(&mut self.room.v, LAST_DIGITS / rotation_of(&self.tau));
        self.here.go(self.h, &from, &self.room.v);
        let arrived = self.quench(nearly)
            && from.above_mev(&self.here) > self.h.rounding_mev()
            && (self.join()
                || !nearly && matches!(self.fall(), Fall::Arrived) && (self.has_none_softer(0.0) || self.fork()));
        if !arrived {
            (self.here, self.tau, self.trail) = (from, tau, trail);
        }
        arrived
    }

    /// Down by gradients alone, with what stands in for the Hessian or without; whether to where the slope ends.
    fn quench(&mut self, nearly: bool) -> bool {
        let nearly = self.unfactored.as_mut().filter(|_| nearly);
        quench(self.h, &mut self.here, &mut self.next, &mut self.trail, nearly)
    }

    /// To a state beside the descent that is all but reached; whether there is one.
    fn join(&mut self) -> bool {
        let Some(end) = self.nearest().filter(|end| largest_angle(end.as_slice(), &self.here.m) < REACHED) else {
            return false;
        };
        let end = Point::at(self.h, end.as_slice().to_vec());
        let falls = self.here.above_mev(&end) > -self.h.rounding_mev();
        if falls {
            self.here = end;
        }
        falls
    }

    /// The nearest of the states beside the descent.
    fn nearest(&self) -> Option<&Spins> {
        let far = |end: &Spins| largest_angle(end.as_slice(), &self.here.m);
        self.beside.iter().copied().min_by(|p, q| far(p).total_cmp(&far(q)))
    }

    /// From a stationary state that is no minimum, where the slope forks, as by symmetry at a skyrmion between two places of its
    /// lattice: to a state beside it, if the valley falls all the way, as the place half-way tells; whether it does.
    fn fork(&mut self) -> bool {
        let (from, rounding) = (self.here.clone(), self.h.rounding_mev());
        let Some(end) = self.nearest().filter(|end| largest_angle(end.as_slice(), &from.m) < FAR) else {
            return false;
        };
        let end = Point::at(self.h, end.as_slice().to_vec());
        let mut half = vec![0.0; end.m.len()];
        blend(&from.m, &end.m, 0.5, &mut half);
        self.here = Point::at(self.h, half.clone());
        // along a valley that is all but level its steps do not end, and need not
        self.quench(false);
        let falls = largest_angle(&self.here.m, &half) < 0.5 * FAR
            && from.above_mev(&self.here) > rounding
            && self.here.above_mev(&end) > rounding;
        self.here = end;
        falls
    }

    /// Whether in no direction the energy's curvature here is less than this (meV).
    fn has_none_softer(&mut self, curvature_mev: f64) -> bool {
        Spectrum::softer(self.h, &self.here, curvature_mev, &mut self.room.matrix) == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Hamiltonian};
    use crate::geometry::Direction;
    use crate::lattice::Chain;

    #[test]
    fn where_a_slope_is_rounding_no_flow_is_followed() {
        let lattice = Chain::open(3).resolve().unwrap();
        // two spins all but free on the top of a hill: along the one that has left it steps are short, as the other may fall sooner
        let hills = Anisotropy { k: vec![1.0, -1e-10, -1e-8], ..Anisotropy::uniform(3, 1.0, Direction::Z) };
        let h = Hamiltonian::new(&lattice, vec![Box::new(hills) as Box<dyn EnergyTerm>]).unwrap();
        let h = Evaluator::from(&h);
        let m = Spins::from_vectors(&[[0.0, 0.0, 1.0], [1e-4, 0.0, 1.0], [0.0, 0.0, 1.0]]).unwrap();
        let state = State::of(h, Point::at(h, m.as_slice().to_vec()));
        let to = Downhill { c: h.stiffness_mev(), level_mev: 0.0, beside: &[], most: STEPS };
        let mut walk = Walk::from(h, &state, &[0.0; 9], to);
        assert!(matches!(walk.fall(), Fall::Arrived));
        let steps = STEPS - walk.left;
        assert!((FEW..8 * FEW).contains(&steps), "{steps} steps");
    }

    #[test]
    fn a_level_valley_that_closes_is_followed_once() {
        let lattice = Chain::open(2).resolve().unwrap();
        // the first spin is free in a plane about no axis of the second, so that no symmetry tells that the valley is level
        let along = |k: [f64; 2], axis: Direction| {
            let term = Anisotropy { k: k.to_vec(), ..Anisotropy::uniform(2, 1.0, axis) };
            Box::new(term) as Box<dyn EnergyTerm>
        };
        let h = Hamiltonian::new(&lattice, vec![along([-1.0, 0.0], Direction::Z), along([0.0, 1.0], Direction::X)])
            .unwrap();
        let h = Evaluator::from(&h);
        let m = Spins::from_vectors(&[[1.0, 0.0, 0.0]; 2]).unwrap();
        let state = State::of(h, Point::at(h, m.as_slice().to_vec()));
        let to = Downhill { c: h.stiffness_mev(), level_mev: 0.0, beside: &[], most: STEPS };
        let mut walk = Walk::from(h, &state, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0], to);
        assert!(walk.march(STATIONARY * h.stiffness_mev()));
        let steps = STEPS - walk.left;
        assert!((20..60).contains(&steps), "{steps} steps");
        assert!(largest_angle(&walk.here.m, m.as_slice()) < STEP);
    }
}
