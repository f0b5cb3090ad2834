//! The axes that two states name: of the turns that bring one to the other.

use super::rotation::{best_turn, one_rotation};
use crate::energy::Hamiltonian;
use crate::field::Components;
use crate::geometry::matrix::UNIT;
use crate::geometry::{Direction, vector};
use crate::sphere::{SAME, best_overlap};
use crate::spins::Spins;
use std::f64::consts::PI;

/// A rotation that leaves no more than this part of how the states differ brings them together: edges are canted, each its own way.
const LEFT: f64 = 0.1;

/// The axis of the one rotation that brings a near b, where one does and no other as well: spins of one line leave it open.
pub fn own_axis(a: &Spins, b: &Spins) -> Option<Direction> {
    let (axis, overlap) = one_rotation(a, b)?;
    let n = a.sites() as f64;
    let before: f64 = a.as_slice().iter().zip(b.as_slice()).map(|(p, q)| p * q).sum();
    (n - overlap < LEFT * (n - before)).then_some(axis)
}

/// Axes about which a rigid turn brings a to b (both senses of a half turn): x, y, z and the symmetry axes, where it does so to a degree
/// or so, and that of the best rotation. Where every spin is reversed the geodesic is such a turn already.
pub fn joining_axes(h: &Hamiltonian, a: &Spins, b: &Spins) -> Vec<Direction> {
    let n = a.sites() as f64;
    if (0..a.sites()).all(|i| vector::dot(a.get(i), b.get(i)) < -0.99) {
        return Vec::new();
    }
    let given = UNIT.iter().chain(h.symmetry_axes()).filter_map(|v| Direction::new(*v).ok());
    let joins = |axis: &Direction| {
        let [p, q] = [a, b].map(|s| Components::new(s.as_slice()));
        best_overlap(p, q, axis.vector()) > n - 1e-3 * n.max(10.0)
    };
    let mut axes: Vec<Direction> = Vec::new();
    for axis in given.filter(joins).chain(own_axis(a, b)) {
        if axes.iter().all(|k| vector::norm(vector::cross(k.vector(), axis.vector())) > SAME) {
            axes.push(axis);
            if best_turn(a, b, axis).abs() > PI - 1e-3 {
                axes.push(axis.reversed());
            }
        }
    }
    axes
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Quaternion, Vector};

    fn turned(spins: &[Vector], axis: Direction, angle: f64) -> Spins {
        let turn = Quaternion::from_axis_angle(axis, angle);
        Spins::from_vectors(&spins.iter().map(|v| turn.rotate(*v)).collect::<Vec<_>>()).unwrap()
    }

    #[test]
    fn states_that_one_rotation_joins_name_its_axis_and_those_of_one_line_none() {
        let at = |angle: f64| [libm::cos(angle), libm::sin(angle), 0.0];
        let thirds = [0.3, 0.3 + 2.0 * PI / 3.0, 0.3 - 2.0 * PI / 3.0].map(at);
        let a = Spins::from_vectors(&thirds).unwrap();
        // of a reversal in the plane the normal; of the other chirality an axis in the plane
        for axis in [Direction::Z, Direction::new([0.6, 0.8, 0.0]).unwrap()] {
            let found = own_axis(&a, &turned(&thirds, axis, PI)).unwrap();
            assert!(vector::norm(vector::cross(found.vector(), axis.vector())) < 1e-9, "{axis}");
        }
        let found = own_axis(&a, &turned(&thirds, Direction::Y, 1.0)).unwrap();
        assert!(vector::norm(vector::sub(found.vector(), Direction::Y.vector())) < 1e-9);
        assert_eq!(own_axis(&a, &a), None);
        let line = [at(0.4), at(0.4 + PI), at(0.4)];
        let up = Spins::from_vectors(&line).unwrap();
        assert_eq!(own_axis(&up, &turned(&line, Direction::Z, PI)), None);
    }
}
