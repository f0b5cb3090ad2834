//! Relaxing a state to its minimum: Newton's method with a shift that keeps the Hessian positive, and descent checked.

use super::polish::polish;
use super::tolerances::{
    ALIKE, FIRST_SHIFT, LARGER, LAST_DIGITS, LAST_SHIFT, MANY, NEARLY, ROUNDING, STATIONARY, STRIDE,
};
use super::unfactored::Unfactored;
use super::walk::{NOISE, STEPS};
use super::{Downhill, Point, Spectrum, State, descend, pin_all};
use crate::energy::Evaluator;
use crate::error::{Error, Result};
use crate::field::Components;
use crate::geometry::{Vector, vector};
use crate::linalg::{Factors, Matrix, remove, slab};
use crate::path::largest_angle;
use crate::sphere::rotation_of;
use crate::spins::Spins;
use serde::{Deserialize, Serialize};
use std::mem::take;

/// A shift below this part of the largest stiffness gives way to none where it can.
const SMALL: f64 = 1e-4;

/// A relaxed state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Relaxed {
    /// The spins.
    pub spins: Spins,
    /// Largest component of the remaining force (meV).
    pub max_torque_mev: f64,
    /// Newton steps taken.
    pub steps: usize,
    /// Largest rotation of any spin from where it was put (rad).
    pub largest_rotation_rad: f64,
    /// How a stationary state that is no minimum was left, if the relaxation came to one: the first of them.
    pub left: Option<WayDown>,
    /// The force fell below the tolerance.
    pub converged: bool,
    /// The signs of its modes, if they were counted.
    pub spectrum: Option<Spectrum>,
    /// Its lowest eigenvalue (meV), roughly, if that came with them.
    pub stiffness_mev: Option<f64>,
}

/// How a saddle was left for a minimum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct WayDown {
    /// The site that its lowest mode turns most.
    pub site: usize,
    /// Where that site's spin turns to first, of unit length.
    pub direction: Vector,
    /// How far the energy fell (meV).
    pub fallen_mev: f64,
}

/// The minimum that `start` relaxes to, with every force component below `tolerance_mev`. Stationary states on the way that are
/// no minima are left, however many, as long as the energy falls by more than rounding; where the Hessian is not that of the energy, the
/// search ends after a bounded number of steps with what it has come to.
pub fn relax_to_minimum(h: Evaluator, start: &Spins, tolerance_mev: f64) -> Result<Relaxed> {
    relax(h, start, tolerance_mev, |state| (Spectrum::of(h, state, 0), None))
}

/// The same, and how stiff that minimum is.
pub fn relax_end(h: Evaluator, start: &Spins, tolerance_mev: f64) -> Result<Relaxed> {
    relax(h, start, tolerance_mev, |state| Spectrum::of_minimum(h, state))
}

fn relax(
    h: Evaluator,
    start: &Spins,
    tolerance_mev: f64,
    look: impl Fn(&State) -> (Spectrum, Option<f64>),
) -> Result<Relaxed> {
    let mut p = Point::at(h, start.as_slice().to_vec());
    let mut left = None;
    let mut steps = 0;
    let mut memory = Matrix::default();
    let (mut left_to_take, mut in_vain) = (STEPS, 0);
    let (spectrum, stiffness_mev) = loop {
        let before = steps;
        p = stationary(h, p, tolerance_mev, &mut steps, &mut memory)?;
        let state = State::of(h, p);
        let seen = look(&state);
        let here = &seen.0;
        let (is_saddle, rests) = (here.negative > 0, state.max_torque_mev() <= NEARLY * tolerance_mev);
        let goes_on = (is_saddle || !rests) && left_to_take > 0 && in_vain <= 1;
        let down = if goes_on { way_down(h, &state, rests, left_to_take) } else { None };
        let Some((below, way, taken)) = down.filter(|(_, way, _)| way.fallen_mev > 0.0) else {
            p = state.point;
            break seen;
        };
        in_vain = if way.fallen_mev > NOISE * h.stiffness_mev() { 0 } else { in_vain + 1 };
        left_to_take = left_to_take.saturating_sub(1 + steps - before + taken);
        if is_saddle {
            left.get_or_insert(way);
        }
        steps += 1;
        p = below;
    };
    Ok(Relaxed {
        spectrum: Some(spectrum),
        stiffness_mev,
        max_torque_mev: p.max_torque_mev(),
        steps,
        largest_rotation_rad: largest_angle(start.as_slice(), &p.m),
        left,
        converged: p.max_torque_mev() <= NEARLY * tolerance_mev,
        spins: Spins::from_unit_components(&p.m),
    })
}

/// Newton's method down to a stationary state, minimum or not. Beside a saddle that the forces do not lead away from, its steps
/// along soft modes are short, and it ends before.
fn stationary(h: Evaluator, mut p: Point, tolerance_mev: f64, steps: &mut usize, memory: &mut Matrix) -> Result<Point> {
    let mut shift = 0.0;
    let mut stalled = 0;
    let most = *steps + MANY;
    let mut best: Option<Point> = None;
    while *steps < most {
        if h.is_stopped() {
            return Err(Error::Stopped);
        }
        if !p.max_torque_mev().is_finite() {
            return Err(Error::Numerical(
                "the forces on the state are not finite numbers: are the energies absurdly large?".into(),
            ));
        }
        if p.max_torque_mev() <= tolerance_mev || stalled >= 2 {
            break;
        }
        let (before, shifted) = (p.max_torque_mev(), shift);
        let Some(next) = newton_step(h, &p, &mut shift, memory) else { break };
        let torque = next.max_torque_mev();
        let nearly = NEARLY * tolerance_mev;
        // a smaller shift is a longer step, which may be what it takes; along a soft mode it first costs torque across it
        stalled = if torque > 0.5 * before && torque < nearly && shift >= shifted { stalled + 1 } else { 0 };
        let is_near = || torque > tolerance_mev && shift == 0.0 && largest_angle(&p.m, &next.m) < LAST_DIGITS;
        // from here on the factors of one step serve
        let is_last = h.has_dear_factors() && !h.forgoes_factors() && is_near();
        if before < nearly && before < torque && best.as_ref().is_none_or(|b| before < b.max_torque_mev()) {
            best = Some(p);
        }
        p = next;
        *steps += 1;
        if is_last {
            p = polish(h, p);
        }
    }
    let least = p.max_torque_mev();
    Ok(best.filter(|best| best.max_torque_mev() < least).unwrap_or(p))
}

/// One accepted step: (H + shift) v = F, capped, with a larger shift as long as the energy would rise. The shift to go on with
/// comes down while H stays indefinite, to the size of its lowest eigenvalue: near a saddle the falling mode then grows from step
/// to step by a part that does not depend on how soft it is.
fn newton_step(h: Evaluator, p: &Point, shift: &mut f64, memory: &mut Matrix) -> Option<Point> {
    let scale = h.stiffness_mev();
    let slack = ROUNDING * (p.energy_mev.abs() + scale);
    let [first, least, small] = [FIRST_SHIFT, ALIKE, SMALL].map(|part| part * scale);
    let mut trial = if *shift > small { *shift } else { 0.0 };
    while trial < LAST_SHIFT * scale && !h.is_stopped() {
        if let Some(mut v) = newton(h, p, trial + STATIONARY * scale, memory) {
            let rotation = rotation_of(&v);
            if rotation > STRIDE {
                slab::scale(&mut v, STRIDE / rotation);
            }
            let mut next = Point::default();
            next.go(h, p, &v);
            if next.energy_mev <= p.energy_mev + slack {
                *shift = if trial > 0.0 { (trial / LARGER).max(least) } else { 0.0 };
                return Some(next);
            }
        }
        trial = match (trial > 0.0, *shift > 0.0) {
            (true, _) => LARGER * trial,
            (false, true) => *shift,
            (false, false) => first,
        };
    }
    None
}

/// The solution v of (H + shift) v = F, a field; none where H + shift is not positive definite.
fn newton(h: Evaluator, p: &Point, shift: f64, memory: &mut Matrix) -> Option<Vec<f64>> {
    // what rounding leaves of a force along a free rotation would be a long step, and a straight one: no rotation any more
    let mut x = p.downhill();
    remove(&mut x, &p.zeros);
    if h.forgoes_factors() {
        let force = p.field(&x);
        return Unfactored::about(&h, p, shift).solve(&h, p, shift, &[], &force).map(<[f64]>::to_vec);
    }
    let mut matrix = take(memory);
    p.write_hessian(h, shift, &mut matrix);
    pin_all(&mut matrix, &p.zeros, h.stiffness_mev());
    let factors = Factors::solving(matrix, &mut x, 1);
    let positive = factors.negatives() == 0;
    *memory = factors.into_memory();
    remove(&mut x, &p.zeros);
    positive.then(|| p.field(&x))
}

/// From a state with a negative direction, or one that Newton's steps were too many for and that does not rest: the minimum below it, and
/// the steps that it took, no more than `most`.
fn way_down(h: Evaluator, state: &State, rests: bool, most: usize) -> Option<(Point, WayDown, usize)> {
    let mut mode = state.field(&state.lowest_mode(h)?.vector);
    if !rests && slab::dot(&mode, &state.gradient) > 0.0 {
        slab::scale(&mut mode, -1.0);
    }
    let to = Downhill { c: h.stiffness_mev(), level_mev: 0.0, beside: &[], most };
    let descent = descend(h, state, &mode, to);
    let below = Point::at(h, descent.m);
    let turns = Components::new(&mode);
    let largest = (0..h.sites()).max_by(|i, j| vector::norm(turns.get(*i)).total_cmp(&vector::norm(turns.get(*j))));
    let site = largest.unwrap_or(0);
    let way =
        WayDown { site, direction: vector::unit_or(turns.get(site), [0.0; 3]), fallen_mev: state.above_mev(&below) };
    Some((below, way, descent.steps))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Control;
    use crate::energy::{Anisotropy, Blocks, EnergyTerm, Exchange, Hamiltonian};
    use crate::field::ComponentsMut;
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use std::ops::Range;

    /// −K (m·z)^p, and what it says of its Hessian, which is wrong: nothing, its opposite, or that it is constant.
    #[derive(Clone, Copy, Debug)]
    struct Wrong {
        k: f64,
        power: i32,
        blocks: f64,
        quadratic: bool,
    }

    impl EnergyTerm for Wrong {
        fn name(&self) -> &str {
            "wrong"
        }

        fn sites(&self) -> Option<usize> {
            None
        }

        fn reference_mev(&self) -> f64 {
            0.0
        }

        fn add_gradient(&self, m: Components, mut g: ComponentsMut, density: &mut [f64], range: Range<usize>) {
            for (k, i) in range.enumerate() {
                density[k] -= self.k * m.z[i].powi(self.power);
                g.add(k, [0.0, 0.0, -self.k * f64::from(self.power) * m.z[i].powi(self.power - 1)]);
            }
        }

        fn add_hessian_product(&self, _: Components, v: Components, mut out: ComponentsMut) {
            (0..v.sites()).for_each(|i| out.add(i, [0.0, 0.0, self.blocks * v.z[i]]));
        }

        fn add_blocks(&self, _: Components, blocks: &mut Blocks) {
            (0..blocks.site[0].len()).for_each(|i| blocks.add_axial(i, self.blocks, [0.0, 0.0, 1.0]));
        }

        fn is_quadratic(&self) -> bool {
            self.quadratic
        }

        fn axes(&self) -> Vec<Vector> {
            Vec::new()
        }
    }

    #[test]
    fn a_hessian_that_is_not_that_of_the_energy_ends_in_bounded_work() {
        let chain = Chain::open(6).resolve().unwrap();
        for (k, power) in [(-0.3, 4), (0.3, 4), (0.7, 2), (-0.7, 2)] {
            for blocks in [0.0, -1.0, 1.0, -5.0] {
                for seed in 0..2 {
                    let wrong = Wrong { k, power, blocks, quadratic: seed == 0 };
                    let terms: Vec<Box<dyn EnergyTerm>> = vec![
                        Box::new(Exchange::uniform(&chain, &[10.0])),
                        Box::new(Anisotropy::uniform(6, 0.5, Direction::X)),
                        Box::new(wrong),
                    ];
                    let (h, control) = (Hamiltonian::new(&chain, terms).unwrap(), Control::default());
                    let h = Evaluator::new(&h, &control);
                    relax_to_minimum(h, &Spins::random(6, seed), 1e-13).unwrap();
                    let evaluations = h.evaluated().evaluations;
                    assert!(evaluations < 4 * STEPS, "{wrong:?} {seed}: {evaluations}");
                }
            }
        }
    }
}
