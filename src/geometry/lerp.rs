//! Straight-line interpolation, to compare with slerp.
//!
//! ```text
//! lerp(a, b, t)  = (1−t) a + t b                  sags inside the sphere: length cos(θ/2) in the middle
//! nlerp(a, b, t) = lerp/|lerp|                    the points of slerp, at uneven speed
//! ```
//!
//! The angular velocity of nlerp is θ' = 2 tan h/(1 + (1−2t)² tan² h) with h = θ/2: in the middle it is 1/cos² h times
//! that at the ends (2 at 90°, 15 at 150°, 13131 at 179°).

use super::arc::Arc;
use super::direction::Direction;
use super::midpoint::is_short;
use super::vector::{Vector, add, lerp, scale, unit_or};

/// The normalised lerp for t from 0 to 1: exact at the ends, a unit vector everywhere, on the same arc as slerp.
/// Between opposite ends it rests at a up to the middle, where it is the middle of the slerp about `axis`, then at b.
///
/// ```
/// use spinneb::geometry::{Direction, nlerp};
/// let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
/// let p = nlerp(x, y, 0.25, Direction::Z);
/// assert!((p[1] / p[0] - 1.0 / 3.0).abs() < 1e-15); // slerp: tan(22.5°) = 0.414
/// assert_eq!(nlerp(x, [-1.0, 0.0, 0.0], 0.5, Direction::Z), y);
/// ```
pub fn nlerp(a: Vector, b: Vector, t: f64, axis: Direction) -> Vector {
    if t == 0.0 {
        a
    } else if t == 1.0 {
        b
    } else if is_short(add(a, b)) {
        through_middle(&Arc::new(a, b, axis), a, b, t)
    } else {
        unit_or(lerp(a, b, t), a)
    }
}

/// The normalised lerp in two halves, from an end to the middle cos h m of the chord.
fn through_middle(arc: &Arc, a: Vector, b: Vector, t: f64) -> Vector {
    let sag = libm::cos(0.5 * arc.angle()).max(0.0);
    let (end, u) = if t <= 0.5 { (a, 2.0 * t) } else { (b, 2.0 * (1.0 - t)) };
    if u == 1.0 { arc.middle() } else { unit_or(lerp(end, scale(sag, arc.middle()), u), end) }
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::slerp::slerp;
    use super::super::test_vectors::{axes, pairs};
    use super::super::vector::norm;
    use super::*;

    const EPS: f64 = f64::EPSILON;

    fn at_angle(degrees: f64) -> Vector {
        let theta = degrees.to_radians();
        [libm::cos(theta), libm::sin(theta), 0.0]
    }

    #[test]
    fn lerp_sags_to_the_cosine_of_half_the_angle() {
        for degrees in [30.0_f64, 90.0, 150.0, 179.0] {
            let middle = norm(lerp([1.0, 0.0, 0.0], at_angle(degrees), 0.5));
            assert!((middle - libm::cos(degrees.to_radians() / 2.0)).abs() <= 2.0 * EPS, "{degrees}");
        }
    }

    #[test]
    fn nlerp_is_a_unit_vector_with_exact_ends_for_every_pair() {
        for (a, b) in pairs() {
            for axis in axes() {
                assert_eq!((nlerp(a, b, 0.0, axis), nlerp(a, b, 1.0, axis)), (a, b));
                for t in [1e-17, 0.25, 0.5 - EPS, 0.5, 0.5 + EPS, 0.75, 1.0 - EPS] {
                    let p = nlerp(a, b, t, axis);
                    assert!((norm(p) - 1.0).abs() <= 2.0 * EPS, "{a:?} {b:?} {t} {axis:?}: {p:?}");
                }
            }
        }
    }

    #[test]
    fn nlerp_reaches_the_points_of_slerp_at_the_known_times() {
        for degrees in [1.0_f64, 30.0, 90.0, 150.0, 174.0, 175.0, 179.0, 179.99] {
            let (a, b, h) = ([1.0, 0.0, 0.0], at_angle(degrees), degrees.to_radians() / 2.0);
            for k in 1..20 {
                let t = f64::from(k) / 20.0;
                let fraction = 0.5 - libm::atan((1.0 - 2.0 * t) * libm::tan(h)) / (2.0 * h);
                let gap = angle(nlerp(a, b, t, Direction::Z), slerp(a, b, fraction, Direction::Z));
                assert!(gap < 4.0 * EPS / libm::cos(h), "{degrees}° {t}: {gap}");
            }
        }
    }

    #[test]
    fn the_speed_of_nlerp_in_the_middle_is_the_known_multiple_of_that_at_the_ends() {
        for degrees in [30.0_f64, 90.0, 150.0, 179.0] {
            let (a, b, dt) = ([1.0, 0.0, 0.0], at_angle(degrees), 1e-6);
            let at = |t| nlerp(a, b, t, Direction::Z);
            let ratio = angle(at(0.5 - dt / 2.0), at(0.5 + dt / 2.0)) / angle(at(0.0), at(dt));
            let expected = 1.0 / libm::cos(degrees.to_radians() / 2.0).powi(2);
            assert!((ratio / expected - 1.0).abs() < 1e-5, "{degrees}: {ratio} {expected}");
        }
    }
}
