//! Valley Newton: Newton across the soft mode, a bracketed search of the reduced slope along it.
//!
//! ```text
//! [H  t][d]   [−g]        [H  t][w]   [0]        r = −ν: slope of the energy along the valley
//! [tᵀ 0][ν] = [ 0]        [tᵀ 0][·] = [1]        λ = wᵀHw: its curvature
//! m ← Exp_m(d + Δx w/|w|),   Δx = −(r/λ)|w| at a maximum, kept inside the bracket of r's sign change
//! ```
//! Where another direction than the soft mode is negative, t is re-aimed at it if it is the only one; else a shift μ keeps the step
//! finite.

use super::pinned::Pinned;
use super::polish::polish;
use super::search::STEPS;
use super::spectrum::Spectrum;
use super::state::State;
use super::tolerances::{ALIKE, LARGER, NEARLY, ROUNDING, SHARP, STEP};
use crate::energy::Evaluator;
use crate::linalg::{lowest_modes, slab};
use crate::sphere::rotation_of;
use serde::{Deserialize, Serialize};

/// Shifts begin at this part of c.
const SHIFT: f64 = 0.1;
/// How often a Hessian is pinned in another way at one place.
const TRIES: usize = 15;
/// A step across the valley that is shorter (rad, any component) is one beside it.
const BESIDE: f64 = 0.03;
/// What the valley tells of a slope or a curvature is to be so many times what is left across it.
const TOLD: f64 = 10.0;
/// The longest move along the valley may grow so far at a time; where the valley is not reached yet, a part of it is allowed.
const GROWTH: f64 = 1.6;
const CAREFUL: f64 = 0.3;
/// A torque of so many times the rounding error may be as small as it becomes.
const LAST: f64 = 1e2;

/// A refined saddle.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Refined {
    /// The search came to rest at a stationary point.
    pub arrived: bool,
    /// Where it ended.
    pub state: State,
    /// Unit tangent field (3N) of the valley there.
    pub valley: Vec<f64>,
    /// Factorisations that it took.
    pub factorisations: usize,
    /// Negative directions, zero modes apart.
    pub index: usize,
    /// The signs of its modes, if they were counted.
    pub spectrum: Option<Spectrum>,
}

impl Refined {
    /// A start from which no search led to a stationary point, and which is left as it is.
    pub fn not_found(h: Evaluator, m: &[f64], tau: &[f64]) -> Refined {
        let (state, valley) = (State::at(h, m.to_vec()), unit_tangent(m, tau));
        Refined { arrived: false, state, valley, factorisations: 0, index: 0, spectrum: None }
    }
}

/// The search's memory.
struct Search<'a> {
    h: Evaluator<'a>,
    c: f64,
    floor_mev: f64,
    kappa: f64,
    state: State,
    /// The soft mode as a unit field (3N).
    tau: Vec<f64>,
    x: f64,
    reach: f64,
    shift: f64,
    visited: Vec<(f64, f64)>,
    factorisations: usize,
    torques: Vec<f64>,
}

/// What a step decided.
enum Next {
    Move(Vec<f64>, Vec<f64>),
    Arrived,
    Lost,
}

/// Refines `m` to the saddle along the path direction `tau` (3N); `c` is the stiffness scale (meV). A search that falls below
/// `floor_mev` (meV above the Hamiltonian's reference) has left the valley's top for what lies beside it.
pub fn refine(h: Evaluator, m: &[f64], tau: &[f64], c: f64, floor_mev: f64) -> Refined {
    let state = State::at(h, m.to_vec());
    let tau = unit_tangent(&state.m, tau);
    let kappa = Pinned::strength_mev(h, c);
    let mut s = Search {
        h,
        c,
        floor_mev,
        kappa,
        state,
        tau,
        x: 0.0,
        reach: STEP,
        shift: 0.0,
        visited: Vec::new(),
        factorisations: 0,
        torques: Vec::new(),
    };
    let mut arrived = false;
    for _ in 0..STEPS {
        if h.is_stopped() {
            break;
        }
        match s.step() {
            Next::Move(v, tau) => {
                let m = s.state.moved(&h, &v);
                s.tau = unit_tangent(&m, &tau);
                s.state = State::at(h, m);
            }
            Next::Arrived => {
                arrived = true;
                break;
            }
            Next::Lost => break,
        }
    }
    s.report(arrived)
}

impl Search<'_> {
    fn tolerance(&self) -> f64 {
        SHARP * self.h.stiffness_mev()
    }

    /// The Hessian pinned along the soft mode, without negative directions beside it if that can be had.
    fn pinned(&mut self) -> Pinned {
        self.shift = if self.shift < SHIFT * self.c { 0.0 } else { self.shift / LARGER };
        for _ in 0..TRIES {
            let p = self.pin();
            if p.complement_negatives == 0 {
                return p;
            }
            if !self.aim_lower(&p) {
                self.shift = (LARGER * self.shift).max(SHIFT * self.c);
            }
        }
        self.pin()
    }

    /// The same along the soft mode as it is.
    fn pin(&mut self) -> Pinned {
        let t = self.state.basis.coordinates(&self.tau);
        self.factorisations += 1;
        Pinned::new(&self.state, &t, self.shift, self.kappa)
    }

    /// With one negative direction in all, makes that the soft mode.
    fn aim_lower(&mut self, p: &Pinned) -> bool {
        if p.index > 1 || self.shift != 0.0 {
            return false;
        }
        let Some(lowest) = lowest_modes(&self.state.hessian, 1, p.zeros()).into_iter().next() else { return false };
        let sign = if slab::dot(&lowest.vector, p.soft()) >= 0.0 { 1.0 } else { -1.0 };
        let mut field = self.state.field(&lowest.vector);
        slab::scale(&mut field, sign);
        self.tau = field;
        self.visited.clear();
        true
    }

    fn step(&mut self) -> Next {
        let p = self.pinned();
        let c = self.c;
        let g = self.state.slope.clone();
        let minus: Vec<f64> = g.iter().map(|x| -x).collect();
        let (d, nu) = p.solve(&minus);
        let (w, nl) = p.valley();
        let size = slab::norm(&w);
        let (slope, curvature) = (-nu, -nl - self.shift * size * size);
        let across = slab::max_abs(&d);
        let torque = slab::max_abs(&g);
        let trusted =
            across < BESIDE && slope.abs() > TOLD * c * across * across && curvature.abs() > TOLD * c * across
                || across < ALIKE;
        if torque <= self.tolerance() && across < ALIKE {
            return Next::Arrived;
        }
        if trusted {
            self.visited.push((self.x, slope));
        }
        let along = self.along(slope, curvature, size, across, trusted);
        if self.state.energy_mev < self.floor_mev {
            return Next::Lost;
        }
        if across > BESIDE {
            self.reach = (0.5 * self.reach).max(BESIDE);
        } else if trusted && along.abs() >= self.reach {
            self.reach = (GROWTH * self.reach).min(2.0);
        }
        self.leave(&p, &g, d, w, size, along, torque, curvature)
    }

    /// The move along the valley, in rad.
    fn along(&self, slope: f64, curvature: f64, size: f64, across: f64, trusted: bool) -> f64 {
        let newton = if curvature < 0.0 { -slope / curvature * size } else { f64::INFINITY * slope.signum() };
        let newton = if newton.is_nan() { 0.0 } else { newton.clamp(-self.reach, self.reach) };
        if !trusted {
            return if across < BESIDE { 0.0 } else { newton.clamp(-CAREFUL * self.reach, CAREFUL * self.reach) };
        }
        match self.bracket() {
            Some((a, b)) if b - a > ALIKE && !(a - ALIKE..b + ALIKE).contains(&(self.x + newton)) => {
                0.5 * (a + b) - self.x
            }
            _ => newton,
        }
    }

    /// The nearest places with slope up on the left and down on the right, nothing visited between them.
    fn bracket(&self) -> Option<(f64, f64)> {
        let mut best: Option<(f64, f64)> = None;
        for &(a, _) in self.visited.iter().filter(|v| v.1 > 0.0) {
            for &(b, _) in self.visited.iter().filter(|v| v.1 < 0.0 && v.0 > a) {
                let clear = !self.visited.iter().any(|v| v.0 > a && v.0 < b);
                let nearer = |(p, q): (f64, f64)| (0.5 * (a + b) - self.x).abs() < (0.5 * (p + q) - self.x).abs();
                if clear && best.is_none_or(nearer) {
                    best = Some((a, b));
                }
            }
        }
        best
    }

    /// The step itself, unless nothing is left to gain.
    #[allow(clippy::too_many_arguments)]
    fn leave(
        &mut self,
        p: &Pinned,
        g: &[f64],
        mut d: Vec<f64>,
        w: Vec<f64>,
        size: f64,
        along: f64,
        torque: f64,
        curvature: f64,
    ) -> Next {
        let tolerance = self.tolerance();
        slab::add_scaled(&mut d, along / size, &w);
        let mut v = self.state.field(&d);
        let rotation = rotation_of(&v);
        if rotation < SHARP && !self.torques.is_empty() {
            return if torque < NEARLY * tolerance { Next::Arrived } else { Next::Lost };
        }
        let factor = if rotation > STEP { STEP / rotation } else { 1.0 };
        slab::scale(&mut v, factor);
        let mut hs = vec![0.0; d.len()];
        self.state.hessian.multiply(p.soft(), &mut hs);
        let softer = curvature / (size * size) <= slab::dot(p.soft(), &hs);
        let tau = if softer { self.state.field(&w) } else { self.state.field(p.soft()) };
        self.x += factor * along;
        let predicted = slab::dot(g, &d).abs();
        let scale = self.state.energy_mev.abs().max(self.c);
        let history = &self.torques;
        let n = history.len();
        let before = history.last().copied().unwrap_or(f64::INFINITY);
        let is_last = torque <= LAST * tolerance;
        let tiny = predicted < ROUNDING * scale && n >= 2 && is_last;
        if tiny && (self.shift > 0.0 || torque > 0.5 * before) {
            return Next::Arrived;
        }
        if is_last && n > 3 && torque > 0.5 * history[n - 1] && torque > 0.5 * history[n - 2] {
            return Next::Arrived;
        }
        self.torques.push(torque);
        Next::Move(v, tau)
    }

    fn report(mut self, arrived: bool) -> Refined {
        if arrived {
            self.state = State::of(self.h, polish(self.h, self.state.point));
            self.tau = unit_tangent(&self.state.m, &self.tau);
        }
        self.shift = 0.0;
        let p = self.pin();
        Refined {
            arrived,
            valley: self.state.field(p.soft()),
            factorisations: self.factorisations,
            index: p.index,
            spectrum: None,
            state: self.state,
        }
    }
}

/// The tangent part of a field at m, of unit length.
fn unit_tangent(m: &[f64], v: &[f64]) -> Vec<f64> {
    let mut t = v.to_vec();
    crate::field::project(m, &mut t);
    let size = slab::norm(&t);
    slab::scale(&mut t, 1.0 / size.max(f64::MIN_POSITIVE));
    t
}
