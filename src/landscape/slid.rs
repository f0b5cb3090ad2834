//! Whether two saddles are places of one that slides: along a valley that is flat to rounding, as over a ring that holds no wall, every
//! climb ends somewhere else.
//!
//! Symmetry brings two such places to within half a cell of each other. They are of one saddle where the state half-way between, at rest
//! but for the way itself, is as high as both.

use super::{turned, turns};
use crate::energy::Evaluator;
use crate::field::Components;
use crate::linalg::Matrix;
use crate::path::is_within;
use crate::sphere::{SAME, rotation_of, write_logs};
use crate::spins::Spins;
use crate::stationary::{FEW, FLAT, LAST_DIGITS, Pinned, Point, STEP};

/// Whether a valley flat to rounding joins two states of rest (3N each) that are less than a step apart, rotations about the symmetry
/// axes aside.
pub fn is_slid(h: Evaluator, a: &[f64], b: &[f64]) -> bool {
    let [from, to] = [a, b].map(Spins::from_unit_components);
    let from = turned(&from, &turns(h, &from, &to));
    if h.forgoes_factors() || !is_within(from.as_slice(), b, STEP) {
        return false;
    }
    let half: Vec<f64> = towards(b, from.as_slice()).iter().map(|x| 0.5 * x).collect();
    let mut start = Point::at(h, b.to_vec());
    start.move_by(h, &half);
    rest(h, start, b).is_some_and(|m| h.difference_mev(&m, b).abs() < FLAT * h.stiffness_mev())
}

/// Where a state that lies between two others comes to rest, but along the way to one of them; nothing where that is not beside it.
fn rest(h: Evaluator, mut here: Point, to: &[f64]) -> Option<Vec<f64>> {
    let mut pinned = Pinned::default();
    for _ in 0..FEW {
        let way = here.basis.coordinates(&towards(&here.m, to));
        let mut hessian = Matrix::default();
        here.write_hessian(h, 0.0, &mut hessian);
        pinned.factor(hessian, &here.zeros, &way, h.stiffness_mev() / 3.0);
        let mut step = here.downhill();
        pinned.solve_in_place(&mut step);
        let step = here.field(&step);
        let rotation = rotation_of(&step);
        if rotation.is_nan() || rotation > LAST_DIGITS {
            return None;
        }
        here.move_by(h, &step);
        if rotation < SAME {
            return Some(here.m);
        }
    }
    None
}

fn towards(from: &[f64], to: &[f64]) -> Vec<f64> {
    let mut field = vec![0.0; from.len()];
    write_logs(Components::new(from), Components::new(to), &mut field);
    field
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::{Anisotropy, EnergyTerm, Exchange, Hamiltonian, Zeeman};
    use crate::geometry::Direction;
    use crate::landscape::{Landscape, Pass, Saddle, Sides};
    use crate::lattice::Chain;
    use crate::stationary::{Limits, STEPS, relax_to_minimum};
    use crate::symmetry::Group;

    const SITES: usize = 48;

    /// A ring on which walls of some four sites slide as freely as double precision tells.
    fn ring() -> Hamiltonian {
        let lattice = Chain::ring(SITES).resolve().unwrap();
        let along = |k: f64, axis: Direction| Box::new(Anisotropy::uniform(SITES, k, axis)) as Box<dyn EnergyTerm>;
        let exchange = Box::new(Exchange::uniform(&lattice, &[5.0]));
        Hamiltonian::new(&lattice, vec![exchange, along(0.15, Direction::Y), along(-0.6, Direction::Z)]).unwrap()
    }

    /// The pass over the saddle that two walls half the ring apart are, about a centre.
    fn pass(h: &Hamiltonian, center: f64) -> Pass {
        let spin = |i: usize| {
            let apart = (i as f64 - center).rem_euclid(SITES as f64);
            let depth = (apart.min(SITES as f64 - apart) - 0.25 * SITES as f64) / 4.0;
            [1.0 / libm::cosh(depth), libm::tanh(depth), 0.0]
        };
        let start = Spins::from_vectors(&(0..SITES).map(spin).collect::<Vec<_>>()).unwrap();
        let limits =
            Limits { steps: STEPS, without_mode: FEW, radius: STEP, ceiling_mev: f64::INFINITY, known: &|_, _| false };
        let saddle = Saddle::climbed(h.into(), start.as_slice(), &limits).unwrap();
        Pass::of(h.into(), saddle, Sides { c: 1.0, level_mev: 0.0, beside: &[], most: usize::MAX }).unwrap()
    }

    #[test]
    fn a_saddle_that_slides_freely_is_one_wherever_a_climb_ends() {
        let h = ring();
        let [here, there] = [20.13, 31.55].map(|center| pass(&h, center));
        let group = Group::of(&h, here.before.spins.as_slice(), &[]);
        let mut land = Landscape::new((&h).into(), here.before.spins.as_slice());
        land.unfold_all(&group, 1);
        assert!(land.add(here) && !land.knows(&there.saddle) && !land.add(there));
        assert_eq!(land.passes().len(), 1);
    }

    #[test]
    fn states_that_lie_side_by_side_in_wells_of_their_own_are_two() {
        let lattice = Chain::open(1).resolve().unwrap();
        // minima at ±0.12 rad from the field's axis
        let terms: Vec<Box<dyn EnergyTerm>> = vec![
            Box::new(Anisotropy::uniform(1, 1.0, Direction::Y)),
            Box::new(Anisotropy::uniform(1, -1.0, Direction::Z)),
            Box::new(Zeeman::uniform(1, [2.0 * libm::cos(0.12), 0.0, 0.0])),
        ];
        let hamiltonian = Hamiltonian::new(&lattice, terms).unwrap();
        let h = Evaluator::from(&hamiltonian);
        let well = |y: f64| {
            let start = Spins::from_vectors(&[[1.0, y, 0.0]]).unwrap();
            relax_to_minimum(h, &start, 1e-13).unwrap().spins
        };
        let [a, b] = [0.2, -0.2].map(well);
        assert!(a.as_slice()[1] > 0.1 && is_within(a.as_slice(), b.as_slice(), STEP));
        assert!(!is_slid(h, a.as_slice(), b.as_slice()));
    }
}
