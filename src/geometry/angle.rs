//! The angle between two vectors: θ = atan2(|a×b|, a·b), in [0, π].
//!
//! acos(a·b) would lose half of the digits near 0 and π (1e-8 rad); the arctangent keeps 1e-16 everywhere.
//! W. Kahan, "How futile are mindless assessments of roundoff in floating-point computation?", 2006, §12.

use super::vector::{Vector, cross, dot, norm};

/// The angle between a and b in rad, 0 … π. They need not be unit vectors.
///
/// ```
/// use spinneb::geometry::angle;
/// use std::f64::consts::PI;
/// assert_eq!(angle([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), PI / 2.0);
/// assert_eq!(angle([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]), PI);
/// assert_eq!(angle([1.0, 0.0, 0.0], [1.0, 1e-12, 0.0]), 1e-12);
/// ```
#[inline]
pub fn angle(a: Vector, b: Vector) -> f64 {
    libm::atan2(norm(cross(a, b)), dot(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn small_angles_keep_all_their_digits_near_zero_and_near_pi() {
        for k in 1..150 {
            let small = libm::exp10(-k as f64);
            let b = [libm::cos(small), 0.0, libm::sin(small)];
            let relative = angle([1.0, 0.0, 0.0], b) / small - 1.0;
            assert!(relative.abs() <= 2.0 * f64::EPSILON, "{small}: {relative}");
            let back = angle([-1.0, 0.0, 0.0], b);
            assert!((back - (PI - small)).abs() <= 2.0 * f64::EPSILON, "{small}: {back}");
        }
    }

    #[test]
    fn the_angle_does_not_depend_on_the_order_or_the_lengths() {
        let (a, b) = ([0.3, -0.2, 0.9], [-1.0, 4.0, 0.5]);
        assert_eq!(angle(a, b), angle(b, a));
        assert_eq!(angle(a, b), angle([0.6, -0.4, 1.8], [-4.0, 16.0, 2.0]));
    }
}
