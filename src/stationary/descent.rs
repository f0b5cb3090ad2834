//! Down from a saddle to the minimum on one side.
//!
//! First along the valley, with everything across it relaxed, as long as it becomes steeper: near a flat top and on a plateau the
//! gradient is rounding error and no guide, and its flow is slow. Then down the gradient by implicit Euler steps,
//! (H + 1/Δt) v = −g, whose Δt grows as long as H + 1/Δt stays positive definite and the energy falls as foretold: the steepest
//! descent with its stiff directions relaxed. Where the forces vanish in double precision but a direction is still negative, the
//! descent goes on along that direction, and ends only where the inertia counts none. Where factors are dear, gradients alone are tried
//! first, from a step along the valley to where the slope ends; then Δt grows as the torque falls.

use super::pinned::Pinned;
use super::point::Point;
use super::quench::quench;
use super::spectrum::Spectrum;
use super::state::State;
use super::tolerances::{ALIKE, LARGER, LAST_SHIFT, RELAXED, SHARP, STEP};
use super::trail::Trail;
use super::unfactored::Unfactored;
use crate::energy::Evaluator;
use crate::field::project;
use crate::linalg::{Factors, Matrix, slab};
use crate::path::{blend, largest_angle};
use crate::sphere::rotation_of;
use crate::spins::Spins;
use std::mem::{swap, take};

/// The first step along a valley, the longest one, and how fast they grow (rad, any spin). Between two soft modes the first one
/// may be shorter, down to the shortest.
const FIRST: f64 = 0.05;
const SHORTEST: f64 = 1e-4;
const LONGEST: f64 = 0.4;
const GROWTH: f64 = 1.4;
/// Most Newton steps across a valley after each step along it, which end when one is less than this part of that step; and most that
/// are taken more where the slope is not the valley's.
const CORRECTIONS: usize = 3;
const ON_THE_WAY: f64 = 0.1;
/// What is added to the Hessian across the valley, in parts of the stiffness scale.
const SHIFT: f64 = 1e-6;
/// A step that ends by a correction larger than this part of it, or falls by another amount than the slopes at its ends tell,
/// to this factor, may have left its valley for the next: a shorter one is taken.
const ASTRAY: f64 = 0.5;
const AS_TOLD: f64 = 1.25;
/// A valley whose slope is less than this part of the steepest has left its top behind.
const LESS_STEEP: f64 = 0.8;
/// Slopes below this part of the stiffness (a radian) may be rounding error: the top is flat there.
const FLAT: f64 = 256.0 * f64::EPSILON;
/// Differences of energies below this part of it may be.
const NOISE: f64 = 64.0 * f64::EPSILON;
/// A fall of so many times as much can be compared with what it was told to be.
const PLAIN: f64 = 1e3;
/// A slope below this part of the torque is not the valley's, but of what is left across it.
const ROUGH: f64 = 1e-3;
/// Most steps along a valley at a time, and most times.
const MARCH: usize = 600;
const ROUNDS: usize = 24;
/// Most steps down the gradient.
const STEPS: usize = 20_000;
/// So many steps down the gradient shorter than the first along a valley are a crawl.
const CRAWL: usize = 4;
/// A state whose spins are turned by less than this (rad, any spin) is beside another, and by less than that has reached it.
const BESIDE: f64 = 1.5;
const REACHED: f64 = 0.03;

/// Where a descent ended.
#[derive(Debug)]
pub struct Descent {
    /// The lowest point reached.
    pub m: Vec<f64>,
    /// Energy fallen (meV), positive.
    pub fallen_mev: f64,
    /// It ended at a stationary point without a negative direction.
    pub arrived: bool,
    /// Points on the way, each with a spin turned by a quarter radian or more since the last (more on long chains, so that they
    /// fit into memory).
    pub way: Vec<Vec<f64>>,
}

/// Descends from a saddle along ± its valley (a unit field of 3N numbers); c is the stiffness scale (meV). Where its slope forks, and
/// where it has all but reached one, it goes to one of the minima `beside` it, which are proven.
pub fn descend(h: Evaluator, saddle: &State, valley: &[f64], c: f64, beside: &[&Spins]) -> Descent {
    let mut walk = Walk {
        h,
        c,
        beside,
        here: saddle.point.clone(),
        next: Point::default(),
        tau: valley.to_vec(),
        last: None,
        trail: Trail::from(&saddle.m),
        room: Room::default(),
        // where a state that came to rest is left, with no minimum beside it, the fall may be of 1e-9 meV, less than the noise without factors
        unfactored: match beside {
            [] if !h.forgoes_factors() => None,
            _ => Unfactored::below(&h, &saddle.point, c),
        },
    };
    let arrived = h.has_dear_factors() && walk.roll() || walk.down();
    Descent { fallen_mev: saddle.above_mev(&walk.here), arrived, m: walk.here.m, way: walk.trail.into_points() }
}

/// A descent on its way.
struct Walk<'a> {
    h: Evaluator<'a>,
    c: f64,
    beside: &'a [&'a Spins],
    here: Point,
    /// Where the step that is being tried leads.
    next: Point,
    /// The valley's direction (3N), of any length.
    tau: Vec<f64>,
    /// The direction at the start of the last step along the valley, a radian a unit of length, and that step's length (rad).
    last: Option<(Vec<f64>, f64)>,
    trail: Trail,
    room: Room,
    /// In place of factors.
    unfactored: Option<Unfactored>,
}

/// Memory for the linear algebra.
#[derive(Default)]
struct Room {
    pinned: Pinned,
    matrix: Matrix,
    x: Vec<f64>,
    v: Vec<f64>,
}

/// How a fall ended.
enum Fall {
    /// Where the gradient vanishes.
    Arrived,
    /// On a slope where steps down the gradient are short and a valley is the quicker way; the last one is in `tau`.
    Crawling,
    /// Where no step lowers the energy.
    Stuck,
}

impl Walk<'_> {
    /// To a minimum; whether it is one.
    fn down(&mut self) -> bool {
        let mut less_steep = LESS_STEEP;
        let mut in_vain = 0;
        for _ in 0..ROUNDS {
            let from = self.here.energy_mev;
            let moved = self.march(less_steep);
            let end = self.fall(false);
            in_vain = if moved || self.here.energy_mev != from { 0 } else { in_vain + 1 };
            if matches!(end, Fall::Crawling) {
                less_steep = 0.0;
                continue;
            }
            less_steep = LESS_STEEP;
            if self.is_minimum() || self.h.is_stopped() {
                return matches!(end, Fall::Arrived);
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

    /// A step along the valley, and down by gradients alone from there; whether that leads to a minimum. Where it does not, the descent
    /// is back where it began.
    fn roll(&mut self) -> bool {
        let (from, tau, points) = (self.here.clone(), self.tau.clone(), self.trail.len());
        self.room.v.clone_from(&self.tau);
        slab::scale(&mut self.room.v, FIRST / rotation_of(&self.tau));
        self.here.go(self.h, &from, &self.room.v);
        let arrived = self.quench()
            && from.above_mev(&self.here) > self.h.rounding_mev()
            && (self.join() || matches!(self.fall(true), Fall::Arrived) && (self.is_minimum() || self.fork()));
        if !arrived {
            self.trail.go_back_to(points);
            (self.here, self.tau) = (from, tau);
        }
        arrived
    }

    /// Down by gradients alone; whether to where the slope ends.
    fn quench(&mut self) -> bool {
        quench(self.h, &mut self.here, &mut self.next, &mut self.trail, [FIRST, STEP])
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
        let Some(end) = self.nearest().filter(|end| largest_angle(end.as_slice(), &from.m) < BESIDE) else {
            return false;
        };
        let end = Point::at(self.h, end.as_slice().to_vec());
        let mut half = vec![0.0; end.m.len()];
        blend(&from.m, &end.m, 0.5, &mut half);
        self.here = Point::at(self.h, half.clone());
        let falls = self.quench()
            && largest_angle(&self.here.m, &half) < 0.5 * BESIDE
            && from.above_mev(&self.here) > rounding
            && self.here.above_mev(&end) > rounding;
        self.here = end;
        falls
    }

    /// Whether no direction is negative here.
    fn is_minimum(&mut self) -> bool {
        Spectrum::negatives(self.h, &self.here, &mut self.room.matrix) == 0
    }

    /// Along the valley as long as it falls, and its slope is more than a part of the steepest; whether it went any way.
    fn march(&mut self, part: f64) -> bool {
        let noise = NOISE * self.h.stiffness_mev();
        let flat = FLAT * self.h.stiffness_mev();
        let (mut slope, mut steepest) = (0.0f64, 0.0f64);
        let mut step = FIRST;
        let mut moved = false;
        self.last = None;
        for _ in 0..MARCH {
            let length = self.predict(step);
            let kept = self.cross(step) && self.settle(noise, flat);
            let fallen = self.here.above_mev(&self.next);
            if fallen < -noise && !moved && step > SHORTEST && !self.h.is_stopped() {
                self.turn_back();
                step /= LARGER;
                continue;
            }
            if fallen < -noise || self.h.is_stopped() {
                break;
            }
            let there = self.slope_ahead();
            let told = 0.5 * (slope + there) * length;
            let foretold = fallen < PLAIN * noise || (told / AS_TOLD..told * AS_TOLD).contains(&fallen);
            if step > FIRST && !(kept && foretold) {
                self.turn_back();
                step /= 2.0;
                continue;
            }
            slope = there;
            swap(&mut self.here, &mut self.next);
            self.trail.pass(&self.here.m);
            moved = true;
            if slope < part * steepest - flat {
                break;
            }
            steepest = steepest.max(slope);
            step = (GROWTH * step).min(LONGEST);
        }
        moved
    }

    /// A step along the valley, bent as the last one was: ds (t + ½ ds ∂t/∂s), the change ∂t/∂s of its direction from
    /// the last place to this; its length in the space of all spins (rad).
    fn predict(&mut self, step: f64) -> f64 {
        let speed = rotation_of(&self.tau);
        slab::scale(&mut self.tau, 1.0 / speed);
        let along = &mut self.room.v;
        along.clone_from(&self.tau);
        slab::scale(along, step);
        if let Some((before, length)) = &mut self.last {
            project(&self.here.m, before);
            let half = 0.5 * step * step / *length;
            slab::add_scaled(along, half, &self.tau);
            slab::add_scaled(along, -half, before);
            let rotation = rotation_of(along);
            slab::scale(along, step / rotation);
        }
        let (before, length) = self.last.get_or_insert_with(Default::default);
        before.clone_from(&self.tau);
        *length = step;
        self.next.go(self.h, &self.here, along);
        project(&self.next.m, &mut self.tau);
        slab::norm(along)
    }

    /// Newton's method across the valley, after a step along it; whether it stayed near.
    fn cross(&mut self, step: f64) -> bool {
        for _ in 0..CORRECTIONS {
            let Some(rotation) = self.correct() else { return false };
            if rotation > ASTRAY * step {
                return false;
            }
            if rotation < ON_THE_WAY * step {
                break;
            }
        }
        true
    }

    /// More steps across the valley, where the energy seems to rise or what is left of the torque across could hide the slope;
    /// whether the valley is still there.
    fn settle(&mut self, noise: f64, flat: f64) -> bool {
        for _ in 0..CORRECTIONS {
            let rises = self.here.above_mev(&self.next) < -noise;
            let torque = self.next.max_torque_mev();
            let hidden = torque > flat && self.slope_ahead() < ROUGH * torque;
            if !(rises || hidden) {
                break;
            }
            if self.correct().is_none() {
                return false;
            }
        }
        true
    }

    /// By how much the energy falls along the valley at `next` (meV/rad).
    fn slope_ahead(&mut self) -> f64 {
        let t = &mut self.room.x;
        self.next.basis.write_coordinates(&self.tau, t);
        -slab::dot(&self.next.slope, t) / slab::norm(t)
    }

    /// Back to the start of the last step.
    fn turn_back(&mut self) {
        if let Some((before, _)) = self.last.take() {
            self.tau = before;
        }
    }

    /// One Newton step across the valley, which bends away from any step along it, and the valley's direction there; its size
    /// (rad, any spin). None where the valley is lost: straight on, the descent will find the way.
    fn correct(&mut self) -> Option<f64> {
        if self.unfactored.is_some() {
            self.iterate_across()?
        } else {
            self.solve_across()?
        }
        let v = &mut self.room.v;
        let rotation = rotation_of(v);
        if rotation > STEP {
            slab::scale(v, STEP / rotation);
        }
        self.next.move_by(self.h, v);
        project(&self.next.m, &mut self.tau);
        Some(rotation)
    }

    /// Newton's step across the valley, in `v`, and its direction, in `tau`, by factors.
    fn solve_across(&mut self) -> Option<()> {
        let Room { pinned: p, x, v, .. } = &mut self.room;
        let kappa = Pinned::strength_mev(self.h, self.c);
        let mut matrix = p.take_memory();
        self.next.write_hessian(self.h, SHIFT * self.c, &mut matrix);
        self.next.basis.write_coordinates(&self.tau, x);
        p.factor(matrix, &self.next.zeros, x, kappa);
        p.write_valley(x);
        if p.complement_negatives > 0 || slab::dot(x, p.soft()).abs() < ON_THE_WAY * slab::norm(x) {
            return None;
        }
        self.next.write_field(x, &mut self.tau);
        self.next.write_downhill(x);
        p.solve_in_place(x);
        self.next.write_field(x, v);
        Some(())
    }

    /// The same without.
    fn iterate_across(&mut self) -> Option<()> {
        let Room { x, v, .. } = &mut self.room;
        let unfactored = self.unfactored.as_mut()?;
        let size = slab::norm(&self.tau);
        slab::scale(&mut self.tau, 1.0 / size);
        let valley = unfactored.valley(&self.h, &self.next, SHIFT * self.c, &self.tau)?;
        if 1.0 < ON_THE_WAY * slab::norm(&valley) {
            return None;
        }
        self.next.write_downhill(x);
        self.next.write_field(x, v);
        let across = unfactored.solve(&self.h, &self.next, SHIFT * self.c, &[&self.tau], v)?;
        v.copy_from_slice(across);
        self.tau = valley;
        Some(())
    }

    /// Implicit Euler down the gradient, to a point where it vanishes; `near` such a point 1/Δt is no larger than the torque.
    fn fall(&mut self, near: bool) -> Fall {
        let scale = self.h.stiffness_mev();
        let tolerance = SHARP * scale;
        let mut rate = if near { self.c.min(self.here.max_torque_mev()) } else { self.c };
        let mut short = 0;
        let mut refusals: usize = 0;
        for _ in 0..STEPS {
            if self.here.max_torque_mev() <= tolerance || self.h.is_stopped() {
                return Fall::Arrived;
            }
            let Some(refused) = self.euler(&mut rate, scale) else { return Fall::Stuck };
            if near && !refused {
                rate = rate.min(self.next.max_torque_mev());
            }
            refusals = if refused { CRAWL } else { refusals.saturating_sub(1) };
            // plain Newton steps that gain nothing: the rest is rounding
            let settled = rate == 0.0
                && self.next.max_torque_mev() < ALIKE * self.c
                && self.next.max_torque_mev() > 0.5 * self.here.max_torque_mev()
                && self.here.above_mev(&self.next) <= NOISE * scale;
            swap(&mut self.here, &mut self.next);
            self.trail.pass(&self.here.m);
            if settled {
                return Fall::Arrived;
            }
            short = if refusals > 0 && rotation_of(&self.room.v) < FIRST { short + 1 } else { 0 };
            if short >= CRAWL {
                self.tau.clone_from(&self.room.v);
                project(&self.here.m, &mut self.tau);
                return Fall::Crawling;
            }
        }
        Fall::Stuck
    }

    /// Takes one step to `next`; whether a longer one was refused. The rate 1/Δt rises until H + rate is positive definite and the
    /// energy falls as foretold, and falls again after a step that succeeds at once.
    fn euler(&mut self, rate: &mut f64, scale: f64) -> Option<bool> {
        let noise = FLAT * scale;
        let smallest = RELAXED * scale;
        let mut refused = false;
        while *rate < LAST_SHIFT * scale {
            if let Some(told) = self.leap(*rate + smallest) {
                let fallen = self.here.above_mev(&self.next);
                // a fall that was not foretold leads over a maximum into another valley
                let foretold = told < noise || (told / AS_TOLD..told * LARGER).contains(&fallen);
                if foretold && fallen >= -noise {
                    if !refused {
                        *rate = if *rate < LARGER * smallest { 0.0 } else { *rate / LARGER };
                    }
                    return Some(refused);
                }
            }
            refused = true;
            *rate = (LARGER * *rate).max(smallest);
        }
        None
    }

    /// Takes the step v of (H + rate) v = −g to `next`; by how much the energy is to fall (meV): −g·v − ½ v·Hv. None where
    /// H + rate is not positive definite.
    fn leap(&mut self, rate: f64) -> Option<f64> {
        let Room { matrix, x, v, .. } = &mut self.room;
        self.here.write_downhill(x);
        if let Some(unfactored) = &mut self.unfactored {
            self.here.write_field(x, v);
            let down = unfactored.solve(&self.h, &self.here, rate, &[], v)?;
            v.copy_from_slice(down);
            self.here.basis.write_coordinates(v, x);
        } else {
            self.here.write_hessian(self.h, rate, matrix);
            let factors = Factors::solving(take(matrix), x, 1);
            let positive = factors.negatives() == 0;
            *matrix = factors.into_memory();
            if !positive {
                return None;
            }
            self.here.write_field(x, v);
        }
        let rotation = rotation_of(v);
        let part = if rotation > STEP { STEP / rotation } else { 1.0 };
        slab::scale(v, part);
        self.next.go(self.h, &self.here, v);
        let down = -slab::dot(&self.here.slope, x);
        Some(part * down - 0.5 * part * part * (down - rate * slab::dot(x, x)))
    }
}
