//! A low-pass filter on the sphere: a noisy path is smoothed without leaving it.
//!
//! ```text
//! y ← slerp(y, x, h(θ)),      h(θ) = 1 − s cos²(θ/2),      θ the angle between y and x
//! ```
//!
//! for s from 0 (nothing changes) to 1. A small deviation, noise, is followed slowly; a large one, a real turn, at
//! once, and h(π) = 1, so that opposite vectors need no axis. This is exponential smoothing, R. G. Brown, "Smoothing,
//! Forecasting and Prediction of Discrete Time Series", 1963, along geodesics, and it lags behind by (1 − h)/h steps; run
//! forwards and then backwards the lags cancel. Both ends are continued by their point reflection
//! x₋ₖ = 2(x₀·xₖ) x₀ − xₖ, hence the transients lie outside and a uniform rotation goes through unchanged.

use super::direction::Direction;
use super::slerp::slerp;
use super::vector::{Vector, add, dot, scale, sub, unit_or};

/// The unit vectors `points` smoothed with a strength from 0 to 1 (cut to it); the first and the last stay as they are.
///
/// ```
/// use spinneb::geometry::low_pass;
/// let path = [[1.0, 0.0, 0.0], [0.8, 0.6, 0.0], [1.0, 0.0, 0.0]];
/// assert_eq!(low_pass(&path, 0.0), path);
/// let smooth = low_pass(&path, 0.5);
/// assert_eq!((smooth[0], smooth[2]), (path[0], path[2]));
/// assert!(smooth[1][1] < 0.6);
/// ```
pub fn low_pass(points: &[Vector], strength: f64) -> Vec<Vector> {
    let n = points.len();
    if n < 3 {
        return points.to_vec();
    }
    let strength = if strength > 0.0 { strength.min(1.0) } else { 0.0 };
    let mut y = continued(points);
    follow(y.iter_mut(), strength);
    follow(y.iter_mut().rev(), strength);
    let mut smooth = y[n - 1..2 * n - 1].to_vec();
    smooth[0] = points[0];
    smooth[n - 1] = points[n - 1];
    smooth
}

/// The sequence between its point reflections in its ends: 3n − 2 points, the first of `points` at n − 1.
fn continued(points: &[Vector]) -> Vec<Vector> {
    let (first, last) = (points[0], points[points.len() - 1]);
    let before = points[1..].iter().rev().map(|&x| reflected(x, first));
    let after = points[..points.len() - 1].iter().rev().map(|&x| reflected(x, last));
    before.chain(points.iter().copied()).chain(after).collect()
}

/// The point as far beyond `centre` as x is before it.
fn reflected(x: Vector, centre: Vector) -> Vector {
    unit_or(sub(scale(2.0 * dot(centre, x), centre), x), centre)
}

/// One pass: each point becomes what a follower of the sequence has reached there.
fn follow<'a>(points: impl Iterator<Item = &'a mut Vector>, strength: f64) {
    let mut reached: Option<Vector> = None;
    for x in points {
        let y = reached.map_or(*x, |y| slerp(y, *x, 1.0 - strength * closeness(y, *x), Direction::Z));
        *x = y;
        reached = Some(y);
    }
}

/// cos²(θ/2) = |a + b|²/4, 0 for opposite and 1 for identical vectors.
fn closeness(a: Vector, b: Vector) -> f64 {
    let sum = add(a, b);
    (0.25 * dot(sum, sum)).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::arc::Arc;
    use super::super::exp_log::exp;
    use super::super::test_vectors::{directions, opposite_pairs};
    use super::super::vector::norm;
    use super::*;

    const EPS: f64 = f64::EPSILON;

    /// A quarter of a great circle in 100 steps, every second point pushed out of its plane and back.
    fn noisy(push: f64) -> (Vec<Vector>, Vec<Vector>) {
        let clean: Vec<Vector> = Arc::new([1.0, 0.0, 0.0], [0.0, 0.6, 0.8], Direction::X).steps(100).collect();
        let k = Arc::new([1.0, 0.0, 0.0], [0.0, 0.6, 0.8], Direction::X).axis();
        let rough = clean.iter().enumerate().map(|(i, &p)| exp(p, scale(if i % 2 == 0 { push } else { -push }, k)));
        (clean.clone(), rough.collect())
    }

    #[test]
    fn strength_zero_changes_nothing_and_the_ends_are_always_kept() {
        let path = directions();
        assert_eq!(low_pass(&path, 0.0), path);
        for strength in [-1.0, 0.3, 1.0, 7.0, f64::NAN] {
            let smooth = low_pass(&path, strength);
            assert_eq!((smooth.len(), smooth[0], smooth.last()), (path.len(), path[0], path.last()));
        }
    }

    #[test]
    fn a_uniform_rotation_goes_through_without_lag() {
        let (clean, _) = noisy(0.0);
        for strength in [0.2, 0.5, 0.8] {
            for (p, q) in low_pass(&clean, strength).into_iter().zip(clean.iter().copied()) {
                let transient = 0.1 * libm::pow(strength, 99.0); // of the first point, of 0.1 rad, a hundred steps away
                assert!(angle(p, q) < transient + 100.0 * EPS, "{strength}");
            }
        }
    }

    #[test]
    fn alternating_noise_is_damped_by_the_square_of_the_known_factor() {
        // of each pass, (1 − s)/(1 + s) remains at the highest frequency
        let (clean, rough) = noisy(1e-6);
        for strength in [0.3, 0.5, 0.7] {
            let left = angle(low_pass(&rough, strength)[50], low_pass(&clean, strength)[50]) / 1e-6;
            let factor: f64 = (1.0 - strength) / (1.0 + strength);
            assert!((left / (factor * factor) - 1.0).abs() < 0.01, "{strength}: {left}");
        }
    }

    #[test]
    fn every_result_is_a_unit_vector_also_between_opposite_points() {
        let path: Vec<Vector> = opposite_pairs().into_iter().flat_map(|(a, b)| [a, b]).collect();
        for strength in [0.1, 0.5, 1.0] {
            for p in low_pass(&path, strength) {
                assert!((norm(p) - 1.0).abs() <= 2.0 * EPS, "{p:?}");
            }
        }
    }

    #[test]
    fn a_jump_to_the_opposite_is_followed_at_once() {
        let x = [1.0, 0.0, 0.0];
        let mut path = [x, x, [-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]];
        follow(path.iter_mut(), 0.9);
        assert_eq!(path[2], [-1.0, 0.0, 0.0]);
    }
}
