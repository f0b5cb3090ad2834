//! Rotation about an axis.
//!
//! ```text
//! v' = v + sin φ k×v + 2 sin²(φ/2) k×(k×v)
//! ```
//!
//! O. Rodrigues, J. Math. Pures Appl. 5, 380 (1840), with 2 sin²(φ/2) for 1 − cos φ, which would cancel for small φ.

use super::direction::Direction;
use super::vector::{Vector, add, cross, scale, with_length_of};

/// v, of any length, rotated by the finite angle φ (rad, right-handed) about k. The length is restored to rounding, so
/// that it does not drift in many rotations.
///
/// ```
/// use spinneb::geometry::{Direction, rotate};
/// let p = rotate([1.0, 0.0, 5.0], Direction::Z, std::f64::consts::FRAC_PI_2);
/// assert!(p[0].abs() < 1e-15 && (p[1] - 1.0).abs() < 1e-15 && (p[2] - 5.0).abs() < 1e-15);
/// ```
pub fn rotate(v: Vector, k: Direction, phi: f64) -> Vector {
    let k = k.vector();
    let sideways = cross(k, v);
    let half = libm::sin(0.5 * phi);
    let inwards = scale(2.0 * half * half, cross(k, sideways));
    with_length_of(add(v, add(scale(libm::sin(phi), sideways), inwards)), v)
}

#[cfg(test)]
mod tests {
    use super::super::quaternion::Quaternion;
    use super::super::test_vectors::{axes, directions};
    use super::super::vector::{dot, norm, sub};
    use super::*;
    use std::f64::consts::PI;

    const EPS: f64 = f64::EPSILON;
    const ANGLES: [f64; 9] = [0.0, 1e-17, 1e-9, -0.3, 1.0, PI / 2.0, 3.0, PI, -5.0];

    #[test]
    fn lengths_and_the_part_along_the_axis_stay() {
        for v in directions() {
            for k in axes() {
                for phi in ANGLES {
                    let p = rotate(v, k, phi);
                    assert!((norm(p) - norm(v)).abs() <= 2.0 * EPS, "{v:?} {k:?} {phi}");
                    assert!((dot(sub(p, v), k.vector())).abs() <= 4.0 * EPS, "{v:?} {k:?} {phi}");
                }
            }
        }
    }

    #[test]
    fn rodrigues_and_the_quaternion_agree() {
        for v in directions() {
            for k in axes() {
                for phi in ANGLES {
                    let q = Quaternion::from_axis_angle(k, phi).rotate(v);
                    assert!(norm(sub(rotate(v, k, phi), q)) <= 6.0 * EPS, "{v:?} {k:?} {phi}");
                }
            }
        }
    }

    #[test]
    fn a_rotation_by_a_tiny_angle_keeps_its_digits() {
        let p = rotate([1.0, 0.0, 0.0], Direction::Z, 1e-9);
        assert_eq!(p, [1.0, 1e-9, 0.0]);
        let p = rotate([1.0, 0.0, 0.0], Direction::Z, 1e-7);
        assert!((p[0] - (1.0 - 5e-15)).abs() <= EPS);
    }

    #[test]
    fn two_rotations_about_one_axis_add_their_angles() {
        for v in directions() {
            for k in axes() {
                let twice = rotate(rotate(v, k, 0.7), k, 1.9);
                assert!(norm(sub(twice, rotate(v, k, 2.6))) <= 8.0 * EPS);
            }
        }
    }
}
