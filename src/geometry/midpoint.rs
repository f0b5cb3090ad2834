//! The middle of the arc from a to b, and the rule for opposite ends.
//!
//! ```text
//! m = (a + b)/|a + b|                          for all but opposite ends
//! m = k×a, k the unit part of the axis normal to a,   for b = −a
//! ```
//!
//! The two are blended where |a + b| < 1e-6, because the plane of a and b is known to eps/|a + b| only. An axis along
//! a has no part normal to a; its place is then taken by the Cartesian axis that follows (x → y → z → x) the
//! largest component of the axis, with that component's sign. It is at least 45° away from the axis, so two suffice
//! for every a. The same blend joins the two.
//!
//! A blend without any jump does not exist: the true m turns once about a as b goes once about −a, and the chosen one
//! does not. The jump is one point, where the two are opposite with equal weights; the axis decides there.
//!
//! With reversed axis and exchanged ends m is the same.

use super::direction::Direction;
use super::vector::{Vector, add, cross, dot, norm, normal_part, scale, sub, unit_or};

/// Below this |a + b| (or sine between the axis and a) the direction is blended with the next choice.
const BLEND: f64 = 1e-6;

/// The middle of the arc from a to b: the normalised a + b, or for opposite ends a quarter of a right-handed turn
/// from a about `axis`. Always of unit length, at equal angles from both ends.
///
/// ```
/// use spinneb::geometry::{Direction, midpoint};
/// let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
/// let half = 0.5_f64.sqrt();
/// assert!((midpoint(x, y, Direction::Z)[0] - half).abs() < 1e-15);
/// assert_eq!(midpoint(x, [-1.0, 0.0, 0.0], Direction::Z), y);
/// ```
pub fn midpoint(a: Vector, b: Vector, axis: Direction) -> Vector {
    let sum = add(a, b);
    if !is_short(sum) {
        return unit_or(sum, a);
    }
    let line = unit_or(sub(a, b), a);
    let m = blend(normal_part(sum, line), || quarter_turn(line, axis));
    unit_or(normal_part(m, line), m)
}

/// Whether a + b is so short (ends more than 120° apart) that rounding in the lengths of a and b shows in it.
pub(super) fn is_short(sum: Vector) -> bool {
    dot(sum, sum) < 1.0
}

/// The unit vector a quarter of a turn from a, about the part of the axis normal to a.
pub(super) fn quarter_turn(a: Vector, axis: Direction) -> Vector {
    let turned = blend(cross(axis.vector(), a), || cross(next_axis(axis), a));
    unit_or(normal_part(turned, a), turned)
}

/// The Cartesian axis after the one the given axis is nearest to.
fn next_axis(axis: Direction) -> Vector {
    let d = axis.vector();
    let mut nearest = 0;
    for c in 1..3 {
        if d[c].abs() > d[nearest].abs() {
            nearest = c;
        }
    }
    let mut next = [0.0; 3];
    next[(nearest + 1) % 3] = 1.0_f64.copysign(d[nearest]);
    next
}

/// v/|v| if v is long enough, and a smooth change to `otherwise` as it shrinks to nothing.
fn blend(v: Vector, otherwise: impl FnOnce() -> Vector) -> Vector {
    let length = norm(v);
    if length >= BLEND {
        return scale(1.0 / length, v);
    }
    let other = otherwise();
    let other = unit_or(other, other);
    if length == 0.0 {
        return other;
    }
    let x = length / BLEND;
    let w = x * x * (3.0 - 2.0 * x);
    let sum = add(scale(w / length, v), scale(1.0 - w, other));
    if norm(sum) < BLEND { other } else { unit_or(sum, other) }
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::test_vectors::{axes, directions, opposite_pairs};
    use super::*;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn for_opposite_ends_the_middle_is_normal_to_both_and_the_turn_is_right_handed() {
        for a in directions() {
            for axis in axes() {
                let m = midpoint(a, scale(-1.0, a), axis);
                assert!((norm(m) - 1.0).abs() <= 2.0 * EPS && dot(m, a).abs() <= 2.0 * EPS, "{a:?} {axis:?} {m:?}");
                let along = dot(cross(a, m), axis.vector());
                let sine = norm(cross(a, axis.vector()));
                assert!(sine < BLEND || (along - sine).abs() <= 4.0 * EPS, "{a:?} {axis:?}: {along} {sine}");
            }
        }
    }

    #[test]
    fn an_axis_along_the_spin_gives_its_place_to_the_next_axis() {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        assert_eq!(midpoint(z, [0.0, 0.0, -1.0], Direction::Z), scale(-1.0, y)); // about x
        assert_eq!(midpoint(x, [-1.0, 0.0, 0.0], Direction::X), scale(-1.0, z)); // about y
        assert_eq!(midpoint(y, [0.0, -1.0, 0.0], Direction::Y), scale(-1.0, x)); // about z
    }

    #[test]
    fn the_middle_is_equally_far_from_both_ends_also_where_it_is_blended() {
        for (a, b) in opposite_pairs() {
            for axis in axes() {
                let m = midpoint(a, b, axis);
                assert!((norm(m) - 1.0).abs() <= 2.0 * EPS);
                assert!((angle(a, m) - angle(m, b)).abs() <= 4.0 * EPS, "{a:?} {b:?} {axis:?}");
            }
        }
    }

    #[test]
    fn exchanged_ends_with_reversed_axis_have_the_same_middle() {
        for (a, b) in opposite_pairs() {
            for axis in axes() {
                assert_eq!(midpoint(a, b, axis), midpoint(b, a, axis.reversed()), "{a:?} {b:?} {axis:?}");
            }
        }
    }

    #[test]
    fn the_blend_is_continuous_but_at_its_one_singular_point() {
        // b goes away from −a at an angle φ to the direction the axis chooses; the middle turns from it by at most φ
        for degrees in [0, 30, 90, 150, 170] {
            let phi = f64::from(degrees).to_radians();
            let mut before = [0.0, 1.0, 0.0];
            for k in 0..=2000 {
                let s = 1e-9 * f64::from(k);
                let b = [-1.0, s * libm::cos(phi), s * libm::sin(phi)];
                let m = midpoint([1.0, 0.0, 0.0], unit_or(b, b), Direction::Z);
                let turn = angle(before, m);
                assert!(turn <= 0.02 * phi + 1e-9, "{degrees}° at {s}: {turn}");
                before = m;
            }
            assert!((angle(before, [0.0, 1.0, 0.0]) - phi).abs() < 2e-6); // half the step, out of the plane of y and z
        }
    }

    #[test]
    fn at_the_singular_point_of_the_blend_the_axis_decides() {
        for s in [4.9999999e-7, 5e-7, 5.0000001e-7] {
            let m = midpoint([1.0, 0.0, 0.0], [-1.0, -s, 0.0], Direction::Z);
            assert!((norm(m) - 1.0).abs() <= 2.0 * EPS && m[0].abs() < 1e-6 && m[1].abs() > 0.999999, "{s}: {m:?}");
        }
    }
}
