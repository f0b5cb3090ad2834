//! Spherical linear interpolation: along the great circle from a to b with constant angular velocity.
//!
//! ```text
//! slerp(a, b, t) = [sin((1−t)θ) a + sin(tθ) b]/sin θ
//! ```
//!
//! K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985, DOI 10.1145/325334.325242; the form is due to
//! G. Davis. The computation and its limits θ → 0 and θ → π are in [`Arc`], which serves for many points of one arc.

use super::arc::Arc;
use super::direction::Direction;
use super::vector::Vector;

/// The point at fraction t of the arc from a to b: bit for bit a at 0 and b at 1, the normalised a + b at ½.
/// Opposite ends turn right-handed about the part of `axis` normal to a; elsewhere `axis` has no influence.
///
/// ```
/// use spinneb::geometry::{Direction, slerp};
/// let p = slerp([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 1.0 / 3.0, Direction::Z);
/// assert!((p[0] - 0.75_f64.sqrt()).abs() < 1e-15 && (p[1] - 0.5).abs() < 1e-15);
/// // from +y to −y about x goes through +z
/// let p = slerp([0.0, 1.0, 0.0], [0.0, -1.0, 0.0], 0.5, Direction::X);
/// assert_eq!(p, [0.0, 0.0, 1.0]);
/// ```
pub fn slerp(a: Vector, b: Vector, t: f64, axis: Direction) -> Vector {
    Arc::new(a, b, axis).at(t)
}

/// The unit axis of the right-handed rotation that takes a to b along [`slerp`].
///
/// ```
/// use spinneb::geometry::{Direction, rotation_axis};
/// assert_eq!(rotation_axis([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Direction::X), [0.0, 0.0, 1.0]);
/// assert_eq!(rotation_axis([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Direction::Y), [0.0, 1.0, 0.0]);
/// ```
pub fn rotation_axis(a: Vector, b: Vector, axis: Direction) -> Vector {
    Arc::new(a, b, axis).axis()
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::rotate::rotate;
    use super::super::test_vectors::{axes, directions, identical_pairs, pairs};
    use super::super::vector::{add, norm, scale, sub, unit};
    use super::*;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn the_ends_are_exact_and_every_point_is_a_unit_vector() {
        for (a, b) in pairs() {
            for axis in axes() {
                assert_eq!((slerp(a, b, 0.0, axis), slerp(a, b, 1.0, axis)), (a, b));
                for t in [1e-300, 1e-17, 0.1, 0.3, 0.5, 0.7, 0.9999999999999999] {
                    let p = slerp(a, b, t, axis);
                    assert!((norm(p) - 1.0).abs() <= 2.0 * EPS, "{a:?} {b:?} {t} {axis:?}: {p:?}");
                }
            }
        }
    }

    #[test]
    fn just_beside_an_end_there_is_no_jump() {
        for (a, b) in pairs() {
            for axis in [Direction::X, Direction::Z] {
                assert!(norm(sub(slerp(a, b, 1e-17, axis), a)) <= 2.0 * EPS);
                assert!(norm(sub(slerp(a, b, 1.0 - EPS / 2.0, axis), b)) <= 4.0 * EPS);
            }
        }
    }

    #[test]
    fn the_middle_is_the_normalised_sum() {
        for a in directions() {
            for b in directions() {
                let sum = add(a, b);
                if norm(sum) >= 1e-3 {
                    let lengths = EPS / norm(sum); // of a and b, which are unit vectors to rounding
                    let m = unit(sum).unwrap_or(a);
                    assert!(norm(sub(slerp(a, b, 0.5, Direction::X), m)) <= 2.0 * EPS + lengths, "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn exchanged_ends_give_the_same_points_in_opposite_order() {
        for (a, b) in pairs() {
            for axis in axes() {
                for t in [0.125, 0.25, 0.4375, 0.625, 0.875] {
                    let there = slerp(a, b, t, axis);
                    let back = slerp(b, a, 1.0 - t, axis.reversed());
                    assert!(norm(sub(there, back)) <= 4.0 * EPS, "{a:?} {b:?} {t} {axis:?}: {there:?} {back:?}");
                }
            }
        }
    }

    #[test]
    fn the_angular_velocity_is_constant() {
        for (a, b) in pairs() {
            for axis in [Direction::X, Direction::Y, Direction::Z] {
                let arc = Arc::new(a, b, axis);
                for k in 0..8 {
                    let (t, next) = (f64::from(k) / 8.0, f64::from(k + 1) / 8.0);
                    let step = angle(arc.at(t), arc.at(next));
                    assert!((step - arc.angle() / 8.0).abs() <= 5.0 * EPS, "{a:?} {b:?} {t} {axis:?}: {step}");
                }
            }
        }
    }

    #[test]
    fn slerp_between_opposite_ends_is_the_rotation_about_the_axis() {
        for a in directions() {
            for axis in axes() {
                let b = scale(-1.0, a);
                let k = Direction::new(rotation_axis(a, b, axis)).unwrap();
                for t in [0.1, 0.5, 0.8] {
                    let expected = rotate(a, k, t * std::f64::consts::PI);
                    assert!(norm(sub(slerp(a, b, t, axis), expected)) <= 8.0 * EPS, "{a:?} {axis:?}");
                }
            }
        }
    }

    #[test]
    fn for_near_ends_slerp_is_lerp() {
        for (a, b) in identical_pairs() {
            let gap = norm(sub(b, a));
            for t in [0.2, 0.6] {
                let straight = add(scale(1.0 - t, a), scale(t, b));
                let p = slerp(a, b, t, Direction::X);
                assert!(norm(sub(p, straight)) <= gap * gap / 8.0 + 2.0 * EPS, "{a:?} {b:?}");
            }
        }
    }
}
