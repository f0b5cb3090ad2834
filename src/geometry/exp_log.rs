//! The exponential map of the sphere and its inverse.
//!
//! ```text
//! Exp_s(v) = cos|v| s + sinc|v| v,        sinc r = sin r/r
//! Log_a(b) = θ w/|w|,                     w = (I − aaᵀ)(b − a),  θ = atan2(|w|, a·b)
//! ```
//!
//! P.-A. Absil, R. Mahony, R. Sepulchre, "Optimization Algorithms on Matrix Manifolds", Princeton 2008, §5.4,
//! DOI 10.1515/9781400830244. b − a is exact for near vectors, so the logarithm keeps its digits down to 1e-150;
//! for an obtuse angle w = (I − aaᵀ)(b + a), the same vector, is exact near −a.
//!
//! For |v| ≤ ½ cos and sinc are Taylor polynomials in x = |v|², to x⁷. The next terms, x⁸/16! < 8e-19 and
//! x⁸/17! < 5e-20, are far below the rounding, 1.1e-16.

use super::direction::Direction;
use super::midpoint::quarter_turn;
use super::vector::{Vector, add, dot, norm, normal_part, scale, sub, unit_or};

/// Below this sine, b is −a to the rounding of the two.
const OPPOSITE: f64 = 1e-15;

/// Taylor coefficients of cos √x: (−1)ᵏ/(2k)!.
const COS: [f64; 8] = [
    1.0,
    -1.0 / 2.0,
    1.0 / 24.0,
    -1.0 / 720.0,
    1.0 / 40_320.0,
    -1.0 / 3_628_800.0,
    1.0 / 479_001_600.0,
    -1.0 / 87_178_291_200.0,
];

/// Taylor coefficients of sinc √x: (−1)ᵏ/(2k+1)!.
const SINC: [f64; 8] = [
    1.0,
    -1.0 / 6.0,
    1.0 / 120.0,
    -1.0 / 5_040.0,
    1.0 / 362_880.0,
    -1.0 / 39_916_800.0,
    1.0 / 6_227_020_800.0,
    -1.0 / 1_307_674_368_000.0,
];

/// Where the great circle from s leads with initial velocity v, a tangent vector in rad, after unit time.
/// v may be of any length and is used as it is (not projected); the result is normalised.
///
/// ```
/// use spinneb::geometry::exp;
/// use std::f64::consts::PI;
/// let p = exp([1.0, 0.0, 0.0], [0.0, PI / 6.0, 0.0]);
/// assert!((p[0] - 0.75_f64.sqrt()).abs() < 1e-15 && (p[1] - 0.5).abs() < 1e-15);
/// assert_eq!(exp([1.0, 0.0, 0.0], [0.0; 3]), [1.0, 0.0, 0.0]);
/// ```
#[inline]
pub fn exp(s: Vector, v: Vector) -> Vector {
    let (cos, sinc) = cos_sinc(dot(v, v));
    unit_or(add(scale(cos, s), scale(sinc, v)), s)
}

/// [`exp`] for |v| ≤ ½, to the same bits, without a branch: loops over it vectorise.
#[inline(always)]
pub(crate) fn exp_short(s: Vector, v: Vector) -> Vector {
    let x = dot(v, v);
    unit_or(add(scale(polynomial(&COS, x), s), scale(polynomial(&SINC, x), v)), s)
}

/// cos √x and sinc √x.
#[inline]
fn cos_sinc(x: f64) -> (f64, f64) {
    if x <= 0.25 {
        return (polynomial(&COS, x), polynomial(&SINC, x));
    }
    let r = x.sqrt();
    let (sin, cos) = libm::sincos(r);
    (cos, sin / r)
}

/// Σ cₖ xᵏ by Horner's rule.
#[inline]
fn polynomial(c: &[f64; 8], x: f64) -> f64 {
    c.iter().rev().fold(0.0, |sum, &c| sum * x + c)
}

/// The tangent vector at a that [`exp`] takes to b: of length θ, in rad. Zero for b = a; for b = −a of length π
/// about z (see [`log_about`]).
///
/// ```
/// use spinneb::geometry::log;
/// use std::f64::consts::FRAC_PI_2;
/// assert_eq!(log([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, FRAC_PI_2, 0.0]);
/// assert_eq!(log([0.6, 0.8, 0.0], [0.6, 0.8, 0.0]), [0.0; 3]);
/// ```
pub fn log(a: Vector, b: Vector) -> Vector {
    log_about(a, b, Direction::Z)
}

/// [`log`] with a choice for b = −a (to rounding, 1e-15): the right-handed half turn about the part of `axis` normal
/// to a. It is not blended as slerp is, so that exp(a, log(a, b)) = b to 3e-15 for every pair.
///
/// ```
/// use spinneb::geometry::{Direction, log_about};
/// use std::f64::consts::PI;
/// assert_eq!(log_about([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Direction::Z), [0.0, PI, 0.0]);
/// ```
pub fn log_about(a: Vector, b: Vector, axis: Direction) -> Vector {
    let cos = dot(a, b);
    let w = normal_part(if cos < 0.0 { add(b, a) } else { sub(b, a) }, a);
    let sin = norm(w);
    if cos < 0.0 && sin < OPPOSITE {
        return scale(libm::atan2(sin, cos), quarter_turn(a, axis));
    }
    if sin == 0.0 {
        return [0.0; 3];
    }
    // once more: where w is short, rounding left a part of it along a, or nothing but that
    let tangent = normal_part([w[0] / sin, w[1] / sin, w[2] / sin], a);
    if norm(tangent) < 0.5 {
        return [0.0; 3];
    }
    scale(libm::atan2(sin, cos), unit_or(tangent, [0.0; 3]))
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::slerp::slerp;
    use super::super::test_vectors::{axes, directions, pairs};
    use super::*;
    use std::f64::consts::PI;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn the_polynomials_agree_with_libm_to_an_ulp() {
        for k in 1..=100_000 {
            let r = 0.5 * f64::from(k) / 100_000.0;
            let (cos, sinc) = (polynomial(&COS, r * r), polynomial(&SINC, r * r));
            assert!((cos - libm::cos(r)).abs() <= EPS, "{r}");
            assert!((sinc - libm::sin(r) / r).abs() <= EPS, "{r}");
        }
    }

    #[test]
    fn the_two_ways_to_cos_and_sinc_meet_at_one_half() {
        let (below, above) = (cos_sinc(0.25), cos_sinc(0.25 * (1.0 + EPS)));
        assert!((below.0 - above.0).abs() <= EPS && (below.1 - above.1).abs() <= EPS);
    }

    #[test]
    fn exp_undoes_log_for_every_pair() {
        for (a, b) in pairs() {
            for axis in axes() {
                let gap = norm(sub(exp(a, log_about(a, b, axis)), b));
                assert!(gap <= 2.0 * OPPOSITE + 3.0 * EPS, "{a:?} {b:?} {axis:?}: {gap}");
            }
        }
    }

    #[test]
    fn exp_undoes_log_where_the_sine_is_of_the_size_of_rounding() {
        for i in 0..100_000 {
            let (x, y) = (libm::sin(f64::from(i)), libm::cos(1.7 * f64::from(i)));
            let a = unit_or([x, y, 0.3], [0.0, 0.0, 1.0]);
            let off = scale(f64::from(i % 100) * 1e-16, quarter_turn(a, Direction::X));
            let b = unit_or(sub(off, a), a);
            let gap = norm(sub(exp(a, log(a, b)), b));
            assert!(gap <= 2.0 * OPPOSITE + 3.0 * EPS, "{a:?} {b:?}: {gap}");
        }
    }

    #[test]
    fn log_undoes_exp_for_tangent_vectors_shorter_than_pi() {
        for a in directions() {
            let along = quarter_turn(a, Direction::Y);
            for length in [0.0, 1e-140, 1e-20, 1e-9, 1e-3, 0.4999, 0.5, 0.5001, 1.0, 2.0, 3.0] {
                let v = scale(length, along);
                let back = log(a, exp(a, v));
                // rounding of the point turns v by EPS/sin θ
                let magnified = if length > 0.5 { length / libm::sin(length) } else { 1.2 };
                assert!(norm(sub(back, v)) <= 3.0 * EPS * magnified, "{a:?} {length}: {back:?}");
            }
        }
    }

    #[test]
    fn log_is_tangent_and_as_long_as_the_angle() {
        for (a, b) in pairs() {
            let v = log(a, b);
            assert!(dot(v, a).abs() <= 4.0 * EPS * norm(v), "{a:?} {b:?}: {v:?}");
            assert!((norm(v) - angle(a, b)).abs() <= 2.0 * PI * EPS, "{a:?} {b:?}: {v:?}");
        }
    }

    #[test]
    fn log_keeps_the_digits_of_small_angles() {
        for k in 1..150 {
            let small = libm::exp10(-k as f64);
            let v = log([1.0, 0.0, 0.0], [libm::cos(small), 0.0, libm::sin(small)]);
            assert!((v[2] / small - 1.0).abs() <= 3.0 * EPS, "{small}: {v:?}");
        }
    }

    #[test]
    fn the_log_of_opposite_vectors_starts_the_slerp_about_the_same_axis() {
        for a in directions() {
            for axis in axes() {
                let b = scale(-1.0, a);
                let v = log_about(a, b, axis);
                assert!((norm(v) - PI).abs() <= 2.0 * EPS * PI);
                let quarter = exp(a, scale(0.25, v));
                assert!(norm(sub(quarter, slerp(a, b, 0.25, axis))) <= 4.0 * EPS, "{a:?} {axis:?}");
            }
        }
    }

    #[test]
    fn exp_is_a_unit_vector_for_long_and_for_useless_velocities() {
        for v in [[0.0, 1e3, 0.0], [0.0, 0.0, 1e8], [0.0, 1e200, 0.0], [0.0, f64::INFINITY, 0.0], [f64::NAN; 3]] {
            assert!((norm(exp([1.0, 0.0, 0.0], v)) - 1.0).abs() <= EPS, "{v:?}");
        }
    }
}
