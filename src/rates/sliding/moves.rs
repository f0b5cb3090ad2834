//! What shifts do to a state.

use super::valleys::Held;
use crate::energy::Evaluator;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{log, vector};
use crate::lattice::Lattice;
use crate::linalg::{orthonormal, remove, slab};
use crate::symmetry::{Group, Operation};

/// A move of which less than this part is its own is none beside the others.
const OWN: f64 = 1e-3;

/// The ways in which shifts of a group move a state, each by something of its own; tangent coordinates (2N).
#[derive(Debug, Default)]
pub(super) struct Moves {
    /// ∂m/∂x by a shift each.
    pub derivatives: Vec<Vec<f64>>,
    /// Log_m(T m).
    pub hops: Vec<Vec<f64>>,
}

impl Moves {
    /// Along these directions of the lattice, by shifts that are free, where a k_BT (meV) lifts the state over the top between its places.
    pub fn of(
        h: Evaluator,
        held: &Held,
        group: &Group,
        directions: &[usize],
        free: &[bool],
        thermal_mev: f64,
    ) -> Moves {
        let (lattice, mut found) = (h.lattice(), Moves::default());
        for &d in directions {
            let Some((_, shift)) = shift_along(group, d).filter(|(k, _)| free[*k]) else { continue };
            let m = &held.state.m;
            let Some(mut derivative) = held.tangent(&derivative(lattice, m, d)) else { continue };
            let hop = towards(m, &shift.apply(m));
            let goes = goes_on(shift, m, &hop) && held.top_between_mev(h, &hop).is_some_and(|top| top < thermal_mev);
            let Some(hop) = held.tangent(&hop).filter(|_| goes) else { continue };
            let mut own = derivative.clone();
            remove(&mut own, &orthonormal(found.derivatives.clone(), 0.0));
            if slab::norm(&own) < OWN * slab::norm(&derivative) {
                continue;
            }
            let cells = shift.motion.shifts_by().map_or(1, |by| by[d]);
            slab::scale(&mut derivative, cells as f64);
            found.derivatives.push(derivative);
            found.hops.push(hop);
        }
        found
    }
}

/// The group's shift along a direction that moves sites and nothing else, with its number.
pub(super) fn shift_along(group: &Group, direction: usize) -> Option<(usize, &Operation)> {
    let goes = |o: &Operation| o.motion.shifts_by().filter(|_| o.moves_sites_alone())?.iter().position(|by| *by != 0);
    group.shifts().iter().map(|s| &s.operation).enumerate().find(|(_, o)| goes(o) == Some(direction))
}

/// How far the longest of some moves goes along a unit vector.
pub(super) fn longest(moves: &[Vec<f64>], along: &[f64]) -> f64 {
    moves.iter().map(|v| slab::dot(v, along).abs()).fold(0.0, f64::max)
}

/// The geodesic from a state to another (3N), spin by spin.
pub(super) fn towards(from: &[f64], to: &[f64]) -> Vec<f64> {
    let (a, b, mut field) = (Components::new(from), Components::new(to), vec![0.0; from.len()]);
    (0..a.sites()).for_each(|i| ComponentsMut::new(&mut field).set(i, log(a.get(i), b.get(i))));
    field
}

/// Whether a state goes on by this hop to the next place in the direction in which it came from the one before.
fn goes_on(shift: &Operation, m: &[f64], hop: &[f64]) -> bool {
    let (a, ahead) = (Components::new(m), Components::new(hop));
    let back = |i: usize| vector::dot(ahead.get(shift.source(i)), log(a.get(shift.source(i)), a.get(i)));
    (0..a.sites()).map(back).sum::<f64>() < 0.0
}

/// dm/dx (3N numbers a site) along a direction, to sixth order in the distance of two sites, to second order near an edge; 0 at it.
pub(super) fn derivative(lattice: &Lattice, m: &[f64], direction: usize) -> Vec<f64> {
    const SIXTH: [f64; 3] = [45.0, -9.0, 1.0];
    let m = Components::new(m);
    let mut d = vec![0.0; 3 * m.sites()];
    for i in 0..m.sites() {
        let beside = |k: isize| {
            let [ahead, behind] = [k, -k].map(|by| lattice.step_from(i, direction, by));
            Some(vector::sub(m.get(ahead?), m.get(behind?)))
        };
        let sum = match (beside(1), beside(2), beside(3)) {
            (Some(one), Some(two), Some(three)) => [one, two, three]
                .iter()
                .zip(SIXTH)
                .fold([0.0; 3], |sum, (v, w)| vector::add(sum, vector::scale(w / 60.0, *v))),
            (Some(one), ..) => vector::scale(0.5, one),
            _ => continue,
        };
        ComponentsMut::new(&mut d).set(i, sum);
    }
    d
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lattice::Chain;
    use std::f64::consts::PI;

    #[test]
    fn the_derivative_of_a_spiral_is_its_wave_number() {
        let n = 60;
        let k = 2.0 * PI / n as f64;
        let m: Vec<f64> = (0..3 * n)
            .map(|c| match c / n {
                0 => libm::cos(k * (c % n) as f64),
                1 => libm::sin(k * (c % n) as f64),
                _ => 0.0,
            })
            .collect();
        assert!(
            (slab::norm(&derivative(&Chain::ring(n).resolve().unwrap(), &m, 0)) - k * (n as f64).sqrt()).abs() < 1e-8
        );
    }
}
