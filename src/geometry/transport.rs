//! Parallel transport of a tangent vector along the great circle from a to b.
//!
//! ```text
//! v' = v − (b·v)/(1 + a·b) (a + b) = v − 2 (m·v) m,       m = (a + b)/|a + b|
//! ```
//!
//! The second form holds because a·v = 0 and |a + b|² = 2(1 + a·b): transport is the reflection in the plane normal to
//! the middle m. It keeps lengths by construction and has no cancellation in 1 + a·b. Beyond 120° it is done in
//! two halves, a → m → b, with the m of [`midpoint()`].
//! N. Boumal, "An Introduction to Optimization on Smooth Manifolds", Cambridge 2023, §10.3, DOI 10.1017/9781009166164.

use super::direction::Direction;
use super::midpoint::{is_short, midpoint};
use super::vector::{Vector, add, dot, scale, sub};

/// The tangent vector v at a, carried to b. For b = −a along the half turn about z (see [`transport_about`]).
///
/// ```
/// use spinneb::geometry::transport;
/// let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
/// assert_eq!(transport(x, y, [0.0, 2.0, 3.0]), [-2.0, 0.0, 3.0]);
/// ```
#[inline]
pub fn transport(a: Vector, b: Vector, v: Vector) -> Vector {
    transport_about(a, b, v, Direction::Z)
}

/// [`transport`] with a choice for opposite ends: along the right-handed half turn about the part of `axis` normal
/// to a, the same path as slerp.
///
/// ```
/// use spinneb::geometry::{Direction, transport_about};
/// let (x, minus_x) = ([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]);
/// let v = transport_about(x, minus_x, [0.0, 2.0, 3.0], Direction::Z);
/// assert!((v[1] + 2.0).abs() < 1e-15 && (v[2] - 3.0).abs() < 1e-15);
/// ```
pub fn transport_about(a: Vector, b: Vector, v: Vector, axis: Direction) -> Vector {
    let sum = add(a, b);
    if !is_short(sum) {
        return reflected(v, sum);
    }
    let m = midpoint(a, b, axis);
    reflected(reflected(v, add(a, m)), add(m, b))
}

/// v reflected in the plane normal to n.
#[inline]
fn reflected(v: Vector, n: Vector) -> Vector {
    sub(v, scale(2.0 * dot(n, v) / dot(n, n), n))
}

#[cfg(test)]
mod tests {
    use super::super::basis::tangent_basis;
    use super::super::exp_log::log_about;
    use super::super::test_vectors::{axes, directions, pairs};
    use super::super::vector::norm;
    use super::*;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn transport_keeps_length_and_tangency_for_every_pair() {
        for (a, b) in pairs() {
            for axis in axes() {
                let (u, v) = tangent_basis(a);
                let (p, q) = (transport_about(a, b, u, axis), transport_about(a, b, v, axis));
                for (name, wrong) in [
                    ("length", norm(p) - 1.0),
                    ("tangency", dot(p, b)),
                    ("angle", dot(p, q)),
                    ("length", norm(q) - 1.0),
                    ("tangency", dot(q, b)),
                ] {
                    assert!(wrong.abs() <= 5.0 * EPS, "{name} {wrong}: {a:?} {b:?} {axis:?}");
                }
            }
        }
    }

    #[test]
    fn the_velocity_of_a_great_circle_stays_its_velocity() {
        for a in directions() {
            for b in directions() {
                let gap = norm(add(a, b));
                if (1e-15..1e-6).contains(&gap) {
                    continue; // here the path of transport is blended and the logarithm is not
                }
                for axis in [Direction::X, Direction::Y, Direction::Z] {
                    let there = transport_about(a, b, log_about(a, b, axis), axis);
                    let back = scale(-1.0, log_about(b, a, axis.reversed()));
                    assert!(norm(sub(there, back)) <= 1e-9, "{a:?} {b:?} {axis:?}: {there:?} {back:?}");
                }
            }
        }
    }

    #[test]
    fn the_second_form_is_the_textbook_one() {
        for a in directions() {
            for b in directions() {
                let c = dot(a, b);
                if c > -0.9 {
                    let (v, _) = tangent_basis(a);
                    let textbook = sub(v, scale(dot(b, v) / (1.0 + c), add(a, b)));
                    assert!(norm(sub(transport(a, b, v), textbook)) <= 20.0 * EPS, "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn around_an_octant_a_vector_turns_by_the_enclosed_area() {
        let (x, y, z) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
        let v = transport(z, x, transport(y, z, transport(x, y, y)));
        assert!(norm(sub(v, z)) <= EPS, "{v:?}"); // from y to z: 90°, the area of an octant is π/2
    }
}
