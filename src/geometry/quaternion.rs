//! Unit quaternions: rotations of a whole configuration, and the interpolation between two of them.
//!
//! ```text
//! q = cos(φ/2) + sin(φ/2) k;      q and −q are the same rotation (double cover)
//! v' = q v q* = v + 2 w u×v + 2 u×(u×v),      q = (w, u)
//! slerp(p, q, t) = [sin((1−t)Ω) p + sin(tΩ) q]/sin Ω,      cos Ω = p·q, with q → −q if p·q < 0 (the short way)
//! ```
//!
//! K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985, DOI 10.1145/325334.325242.

use super::direction::Direction;
use super::midpoint::{is_short, midpoint};
use super::vector::{Vector, add, cross, dot, norm, scale, with_length_of};

/// A unit quaternion w + x i + y j + z k.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    w: f64,
    u: Vector,
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Quaternion = Quaternion { w: 1.0, u: [0.0; 3] };

    /// The rotation by the finite angle φ (rad, right-handed) about k.
    ///
    /// ```
    /// use spinneb::geometry::{Direction, Quaternion};
    /// let q = Quaternion::from_axis_angle(Direction::Z, std::f64::consts::FRAC_PI_2);
    /// let p = q.rotate([1.0, 0.0, 0.0]);
    /// assert!(p[0].abs() < 1e-15 && (p[1] - 1.0).abs() < 1e-15);
    /// ```
    pub fn from_axis_angle(k: Direction, phi: f64) -> Quaternion {
        let (sin, cos) = libm::sincos(0.5 * phi);
        Quaternion { w: cos, u: scale(sin, k.vector()) }.normalised()
    }

    /// The smallest rotation that takes the unit vector a to b; for b = −a, the half turn about the part of `axis`
    /// normal to a, as in slerp. With the middle m of the two it is q = a·m + a×m.
    ///
    /// ```
    /// use spinneb::geometry::{Direction, Quaternion};
    /// let q = Quaternion::from_rotation([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Direction::Z);
    /// assert!((q.rotate([0.0, 1.0, 0.0])[1] + 1.0).abs() < 1e-15);
    /// ```
    pub fn from_rotation(a: Vector, b: Vector, axis: Direction) -> Quaternion {
        let m = midpoint(a, b, axis);
        if !is_short(add(a, b)) {
            return Quaternion::twice(a, m);
        }
        // in two halves, so that b is met also where the middle is blended
        Quaternion::twice(m, midpoint(m, b, axis)).mul(Quaternion::twice(a, midpoint(a, m, axis)))
    }

    /// Twice the rotation from a to m.
    fn twice(a: Vector, m: Vector) -> Quaternion {
        Quaternion { w: dot(a, m), u: cross(a, m) }.normalised()
    }

    /// The four components, w first.
    pub fn components(self) -> [f64; 4] {
        [self.w, self.u[0], self.u[1], self.u[2]]
    }

    /// The product: first `other`, then `self`.
    ///
    /// ```
    /// use spinneb::geometry::{Direction, Quaternion};
    /// let half = Quaternion::from_axis_angle(Direction::X, 0.4);
    /// let whole = Quaternion::from_axis_angle(Direction::X, 0.8);
    /// assert!((half.mul(half).dot(whole) - 1.0).abs() < 1e-15);
    /// ```
    #[allow(clippy::should_implement_trait)] // a.mul(b) reads in the order in which it is written down
    pub fn mul(self, other: Quaternion) -> Quaternion {
        let (p, q) = (self, other);
        let u = add(add(scale(p.w, q.u), scale(q.w, p.u)), cross(p.u, q.u));
        Quaternion { w: p.w * q.w - dot(p.u, q.u), u }.normalised()
    }

    /// The inverse rotation.
    pub fn conjugate(self) -> Quaternion {
        Quaternion { w: self.w, u: scale(-1.0, self.u) }
    }

    /// The other quaternion of the same rotation.
    pub fn negated(self) -> Quaternion {
        Quaternion { w: -self.w, u: scale(-1.0, self.u) }
    }

    /// The scalar product in four dimensions; ±1 for the same rotation.
    pub fn dot(self, other: Quaternion) -> f64 {
        self.w * other.w + dot(self.u, other.u)
    }

    /// v, of any length, rotated; the length is restored to rounding.
    pub fn rotate(self, v: Vector) -> Vector {
        let sideways = scale(2.0, cross(self.u, v));
        with_length_of(add(v, add(scale(self.w, sideways), cross(self.u, sideways))), v)
    }

    /// The angle of the rotation, 0 … π rad.
    pub fn angle(self) -> f64 {
        2.0 * libm::atan2(norm(self.u), self.w.abs())
    }

    /// The axis about which it turns by [`angle`](Self::angle), right-handed; none for no rotation.
    pub fn axis(self) -> Option<Direction> {
        Direction::new(scale(1.0_f64.copysign(self.w), self.u)).ok()
    }

    /// The rotation at fraction t from `self` (exact at 0) to `other` (at 1 exact up to the sign), the short way and
    /// with constant angular velocity.
    ///
    /// ```
    /// use spinneb::geometry::{Direction, Quaternion};
    /// let q = Quaternion::from_axis_angle(Direction::Y, 1.2);
    /// let third = Quaternion::IDENTITY.slerp(q, 1.0 / 3.0);
    /// assert!((third.angle() - 0.4).abs() < 1e-15);
    /// ```
    pub fn slerp(self, other: Quaternion, t: f64) -> Quaternion {
        let other = if self.dot(other) < 0.0 { other.negated() } else { other };
        if t == 0.0 {
            return self;
        }
        if t == 1.0 {
            return other;
        }
        let angle =
            2.0 * libm::atan2(self.combined(1.0, other, -1.0).length(), self.combined(1.0, other, 1.0).length());
        let sin = libm::sin(angle);
        if sin == 0.0 {
            return self.combined(1.0 - t, other, t).normalised();
        }
        self.combined(libm::sin((1.0 - t) * angle) / sin, other, libm::sin(t * angle) / sin).normalised()
    }

    /// p self + q other, not normalised.
    fn combined(self, p: f64, other: Quaternion, q: f64) -> Quaternion {
        Quaternion { w: p * self.w + q * other.w, u: add(scale(p, self.u), scale(q, other.u)) }
    }

    fn length(self) -> f64 {
        self.dot(self).sqrt()
    }

    fn normalised(self) -> Quaternion {
        let n = self.length();
        if !(n > 0.0 && n.is_finite()) {
            return Quaternion::IDENTITY;
        }
        Quaternion { w: self.w / n, u: [self.u[0] / n, self.u[1] / n, self.u[2] / n] }
    }
}

#[cfg(test)]
mod tests {
    use super::super::arc::Arc;
    use super::super::test_vectors::{axes, directions, pairs};
    use super::super::vector::sub;
    use super::*;
    use std::f64::consts::PI;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn a_quaternion_and_its_negative_are_the_same_rotation() {
        for k in axes() {
            for phi in [0.0, 0.4, 2.0, PI, 5.0] {
                let q = Quaternion::from_axis_angle(k, phi);
                for v in directions() {
                    assert_eq!(q.rotate(v), q.negated().rotate(v));
                }
                assert_eq!(q.angle(), q.negated().angle());
            }
        }
    }

    #[test]
    fn a_full_turn_changes_the_sign_and_two_do_not() {
        let turn = Quaternion::from_axis_angle(Direction::Y, 2.0 * PI);
        assert!((turn.dot(Quaternion::IDENTITY) + 1.0).abs() <= EPS);
        assert!((turn.mul(turn).dot(Quaternion::IDENTITY) - 1.0).abs() <= EPS);
    }

    #[test]
    fn the_rotation_between_two_vectors_takes_one_to_the_other_for_every_pair() {
        for (a, b) in pairs() {
            for axis in axes() {
                let q = Quaternion::from_rotation(a, b, axis);
                assert!((q.length() - 1.0).abs() <= 2.0 * EPS);
                let gap = norm(sub(q.rotate(a), b));
                assert!(gap <= 8.0 * EPS, "{a:?} {b:?} {axis:?}: {gap}");
                let gap = q.angle() - Arc::new(a, b, axis).angle().min(PI);
                assert!(gap.abs() <= 1e-6, "{a:?} {b:?} {axis:?}: {gap}");
            }
        }
    }

    #[test]
    fn angle_and_axis_give_the_rotation_back() {
        for k in axes() {
            for phi in [1e-9, 0.4, 2.0, 3.1] {
                let q = Quaternion::from_axis_angle(k, phi);
                assert!((q.angle() - phi).abs() <= 2.0 * EPS * phi);
                let axis = q.axis().unwrap();
                assert!(norm(sub(axis.vector(), k.vector())) <= 3.0 * EPS, "{k:?} {phi} {axis:?}");
                assert_eq!(q.negated().axis(), Some(axis));
            }
        }
        assert_eq!(Quaternion::IDENTITY.axis(), None);
    }

    #[test]
    fn the_product_is_one_rotation_after_the_other() {
        let p = Quaternion::from_axis_angle(Direction::X, 0.7);
        let q = Quaternion::from_axis_angle(Direction::Z, -1.9);
        for v in directions() {
            assert!(norm(sub(p.mul(q).rotate(v), p.rotate(q.rotate(v)))) <= 6.0 * EPS);
            assert!(norm(sub(p.conjugate().rotate(p.rotate(v)), v)) <= 6.0 * EPS);
        }
    }

    #[test]
    fn slerp_takes_the_short_way_at_constant_angular_velocity() {
        let p = Quaternion::from_axis_angle(Direction::X, 0.3);
        for k in axes() {
            for phi in [1e-12, 0.5, 2.0, 3.0, 4.0, 6.0] {
                let turn = Quaternion::from_axis_angle(k, phi);
                let q = turn.mul(p);
                let whole = turn.angle();
                assert!(whole <= PI);
                for other in [q, q.negated()] {
                    assert_eq!(p.slerp(other, 0.0), p);
                    assert!((p.slerp(other, 1.0).dot(q).abs() - 1.0).abs() <= 2.0 * EPS);
                    for j in 0..8 {
                        let now = p.slerp(other, f64::from(j) / 8.0);
                        let step = p.slerp(other, f64::from(j + 1) / 8.0).mul(now.conjugate()).angle();
                        assert!((step - whole / 8.0).abs() <= 8.0 * EPS, "{k:?} {phi} {j}: {step} {whole}");
                    }
                }
            }
        }
    }
}
