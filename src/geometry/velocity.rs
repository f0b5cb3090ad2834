//! Angular velocity along a sampled path: ω_k = θ(p_k, p_{k+1})/Δt.

use super::angle::angle;
use super::vector::Vector;

/// The angles between consecutive points divided by `dt` (rad per unit of `dt`): one number fewer than points.
///
/// ```
/// use spinneb::geometry::{Arc, Direction, angular_velocity};
/// let path: Vec<_> = Arc::new([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Direction::Z).steps(4).collect();
/// for omega in angular_velocity(&path, 0.25) {
///     assert!((omega - std::f64::consts::FRAC_PI_2).abs() < 1e-14);
/// }
/// ```
pub fn angular_velocity(points: &[Vector], dt: f64) -> Vec<f64> {
    points.windows(2).map(|pair| angle(pair[0], pair[1]) / dt).collect()
}

/// The largest speed divided by the smallest: 1 for an even motion (and for rest), infinite for one that pauses.
///
/// ```
/// use spinneb::geometry::unevenness;
/// assert_eq!(unevenness(&[2.0, 3.0, 2.5]), 1.5);
/// assert_eq!(unevenness(&[0.0, 0.0]), 1.0);
/// ```
pub fn unevenness(speeds: &[f64]) -> f64 {
    let largest = speeds.iter().copied().fold(0.0, f64::max);
    let smallest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    if largest == 0.0 { 1.0 } else { largest / smallest }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_velocity_of_a_known_motion_is_its_velocity() {
        let path = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]];
        let pi = std::f64::consts::PI;
        assert_eq!(angular_velocity(&path, 0.5), [pi, 2.0 * pi]);
        assert_eq!(unevenness(&angular_velocity(&path, 0.5)), 2.0);
    }

    #[test]
    fn fewer_than_two_points_have_no_velocity_and_are_even() {
        assert!(angular_velocity(&[[1.0, 0.0, 0.0]], 1.0).is_empty());
        assert_eq!(unevenness(&[]), 1.0);
    }

    #[test]
    fn a_pause_is_infinitely_uneven() {
        assert_eq!(unevenness(&[1.0, 0.0]), f64::INFINITY);
    }
}
