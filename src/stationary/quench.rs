//! Down a slope by gradients alone, where factors of Hessians take longer than hundreds of them: limited-memory BFGS, every step
//! short, none of which raises the energy. What the gradient has no part of, as a translation of a state that is symmetric,
//! no step has. With what stands in for the Hessian fewer steps do, of large lattices by far, but that knows how sites are numbered.

use super::point::Point;
use super::tolerances::{FEW, LARGER, LAST_DIGITS, STEP};
use super::trail::Trail;
use super::unfactored::Unfactored;
use crate::energy::Evaluator;
use crate::field::project;
use crate::linalg::{Secants, slab};
use crate::sphere::rotation_of;
use std::mem::swap;

/// Most steps: on a plateau gradients lead nowhere.
const STEPS: usize = 100;
/// How much longer than the last a step may be that nothing remembered tells the length of.
const GROWTH: f64 = 2.0;
/// The part of the largest torque that is left.
const LEFT: f64 = 1e-4;

/// Goes down from `here` until the torque is less than a part of the largest on the way, in steps that turn no spin by more than
/// [`STEP`] (rad), the first one by [`LAST_DIGITS`]; `next` is memory, `nearly` stands in for the Hessian, if it is to. Whether it came so
/// far.
pub fn quench(
    h: Evaluator,
    here: &mut Point,
    next: &mut Point,
    trail: &mut Trail,
    mut nearly: Option<&mut Unfactored>,
) -> bool {
    let mut secants = Secants::of(FEW);
    let (mut force, mut step, mut length) = (here.field(&here.downhill()), Vec::new(), LAST_DIGITS);
    let (mut largest, mut shorter) = (0.0f64, 0);
    for _ in 0..STEPS {
        let torque = here.max_torque_mev();
        largest = largest.max(torque);
        if torque <= LEFT * largest {
            return true;
        }
        if h.is_stopped() {
            return false;
        }
        step.clone_from(&force);
        let told = match &mut nearly {
            Some(nearly) => secants.apply_beside(&mut step, |q| nearly.step(&h, here, q)),
            None => secants.apply(&mut step),
        };
        project(&here.m, &mut step);
        let rotation = rotation_of(&step);
        length = if told { rotation.min(STEP) } else { length.min(STEP) };
        slab::scale(&mut step, length / rotation);
        next.go(h, here, &step);
        let risen = next.above_mev(here) > 0.0;
        if risen {
            // a shorter one, straight down
            secants = Secants::of(FEW);
            length /= LARGER;
            shorter += 1;
            if shorter > FEW {
                return false;
            }
            continue;
        }
        shorter = 0;
        length *= GROWTH;
        let mut change = std::mem::replace(&mut force, next.field(&next.downhill()));
        slab::add_scaled(&mut change, -1.0, &force);
        secants.learn(step.clone(), change);
        swap(here, next);
        trail.pass(&here.m);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::Hamiltonian;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::{Vector, vector};
    use crate::path::largest_angle;
    use crate::spins::Spins;

    const CELLS: usize = 13;

    fn film() -> Hamiltonian {
        let lattice = lattice(&format!(r#"{{"square": {{"cells": [{CELLS}, {CELLS}]}}}}"#));
        let easy = r#"{"anisotropy": {"K": "0.2 meV", "axis": [0, 0, 1]}}"#;
        hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy])
    }

    /// A bubble about the middle, whose spins lean along x.
    fn bubble() -> Spins {
        let middle = (CELLS / 2) as f64;
        let spin = |i: usize| -> Vector {
            let (x, y) = ((i % CELLS) as f64 - middle, (i / CELLS) as f64 - middle);
            let angle = 3.0 * libm::exp(-0.1 * (x * x + y * y));
            vector::unit_or([libm::sin(angle), 0.0, libm::cos(angle)], [0.0, 0.0, 1.0])
        };
        let vectors: Vec<Vector> = (0..CELLS * CELLS).map(spin).collect();
        Spins::from_components(&(0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect::<Vec<f64>>()).unwrap()
    }

    #[test]
    fn a_bubble_shrinks_downhill_in_short_steps_and_stays_as_symmetric_as_it_was() {
        let h = film();
        let h = Evaluator::from(&h);
        let start = Point::at(h, bubble().as_slice().to_vec());
        let (mut here, mut next, mut trail) = (start.clone(), Point::default(), Trail::from(&start.m));
        assert!(quench(h, &mut here, &mut next, &mut trail, None), "it comes to rest");
        let points = trail.into_points();
        // a bubble that shrinks is steeper than the one it began as; the steepest place may lie between two points
        let largest = points.iter().map(|m| Point::at(h, m.clone()).max_torque_mev()).fold(0.0, f64::max);
        assert!(here.max_torque_mev() < 2.0 * LEFT * largest, "{}", here.max_torque_mev());
        assert!(start.above_mev(&here) > 1.0, "{}", start.above_mev(&here));
        let uniform = Spins::uniform(h.sites(), crate::geometry::Direction::Z);
        assert!(largest_angle(&here.m, uniform.as_slice()) < 0.01);
        assert!(points.len() > 3);
        for m in points.iter().chain([&here.m]) {
            for i in 0..CELLS * CELLS {
                let mirrored = (CELLS - 1 - i % CELLS) + CELLS * (i / CELLS);
                (0..3).for_each(|c| {
                    let at = |i: usize| m[c * CELLS * CELLS + i];
                    assert!((at(i) - at(mirrored)).abs() < 1e-10);
                });
            }
        }
    }

    #[test]
    fn what_stands_in_for_the_hessian_leads_down_in_few_steps() {
        let size = 40;
        let lattice = lattice(&format!(r#"{{"square": {{"cells": [{size}, {size}]}}}}"#));
        let easy = r#"{"anisotropy": {"K": "1 µeV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let h = Evaluator::from(&h);
        // a slope that is long and soft
        let spin = |i: usize| {
            let angle = 1.2 * libm::sin(2.0 * (i % size) as f64 / size as f64);
            [libm::sin(angle), 0.0, libm::cos(angle)]
        };
        let m = Spins::from_vectors(&(0..size * size).map(spin).collect::<Vec<_>>()).unwrap().as_slice().to_vec();
        let start = Point::at(h, m);
        let uniform = Spins::uniform(h.sites(), crate::geometry::Direction::Z);
        let rests = |nearly: bool| {
            let mut unfactored = nearly.then(|| Unfactored::about(&h, &start, 2e-3));
            let (mut here, mut next, mut trail) = (start.clone(), Point::default(), Trail::from(&start.m));
            let rests = quench(h, &mut here, &mut next, &mut trail, unfactored.as_mut());
            assert!(start.above_mev(&here) > 0.0);
            rests && largest_angle(&here.m, uniform.as_slice()) < 0.01
        };
        assert!(rests(true) && !rests(false));
    }

    #[test]
    fn at_rest_nothing_moves() {
        let h = film();
        let h = Evaluator::from(&h);
        let m = Spins::uniform(h.sites(), crate::geometry::Direction::Z).as_slice().to_vec();
        let (mut here, mut next, mut trail) = (Point::at(h, m.clone()), Point::default(), Trail::from(&m));
        assert!(quench(h, &mut here, &mut next, &mut trail, None));
        assert_eq!(here.m, m);
    }
}
