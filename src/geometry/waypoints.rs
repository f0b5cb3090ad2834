//! A piecewise great-circle path of one spin through given directions.
//!
//! Two parameters: the fraction t ∈ [0, 1] of the whole length Σ θ_leg (constant angular velocity throughout), and the leg
//! parameter u ∈ [0, number of legs], in which every leg takes the same time and waypoint i is at u = i.

use super::arc::Arc;
use super::direction::Direction;
use super::vector::Vector;
use crate::error::{Error, Result};

/// A path through waypoints. Legs between opposite waypoints all turn about one axis, as in slerp.
///
/// ```
/// use spinneb::geometry::{Direction, Waypoints};
/// let (x, y) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0]);
/// let path = Waypoints::new(&[x, y, [-1.0, 0.0, 0.0], x], Direction::Z)?; // legs of 90°, 90° and 180°
/// assert_eq!(path.at(0.25), y);
/// assert_eq!(path.at_leg(1.0), y);
/// assert_eq!(path.at_leg(2.5), [0.0, -1.0, 0.0]);
/// # Ok::<(), spinneb::error::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Waypoints {
    legs: Vec<Arc>,
    /// Length from the start to the end of each leg.
    reached: Vec<f64>,
}

impl Waypoints {
    /// The path through the unit vectors `points`; an error for fewer than two.
    pub fn new(points: &[Vector], axis: Direction) -> Result<Waypoints> {
        if points.len() < 2 {
            return Err(Error::invalid("", format!("{} waypoint(s) found: give two or more", points.len())));
        }
        let legs: Vec<Arc> = points.windows(2).map(|ends| Arc::new(ends[0], ends[1], axis)).collect();
        let mut length = 0.0;
        let reached = legs
            .iter()
            .map(|leg| {
                length += leg.angle();
                length
            })
            .collect();
        Ok(Waypoints { legs, reached })
    }

    /// The legs of the path.
    pub fn legs(&self) -> &[Arc] {
        &self.legs
    }

    /// The length of the path in rad.
    pub fn length(&self) -> f64 {
        self.reached.last().copied().unwrap_or(0.0)
    }

    /// The point at fraction t of the length, with t cut to [0, 1].
    pub fn at(&self, t: f64) -> Vector {
        if t >= 1.0 {
            return self.at_leg(self.legs.len() as f64);
        }
        let way = t.max(0.0) * self.length();
        let leg = self.reached.partition_point(|&end| end <= way).min(self.legs.len() - 1);
        let before = if leg == 0 { 0.0 } else { self.reached[leg - 1] };
        let angle = self.legs[leg].angle();
        let fraction = if angle > 0.0 { ((way - before) / angle).min(1.0) } else { 0.0 };
        self.legs[leg].at(fraction)
    }

    /// The point at leg parameter u: waypoint i at u = i, in between the fraction u − i of leg i; u is cut to [0, legs].
    pub fn at_leg(&self, u: f64) -> Vector {
        let last = self.legs.len() - 1;
        let leg = (u.max(0.0) as usize).min(last);
        self.legs[leg].at((u.max(0.0) - leg as f64).min(1.0))
    }
}

#[cfg(test)]
mod tests {
    use super::super::angle::angle;
    use super::super::test_vectors::directions;
    use super::super::vector::norm;
    use super::super::velocity::{angular_velocity, unevenness};
    use super::*;

    const EPS: f64 = f64::EPSILON;

    fn tour() -> Waypoints {
        Waypoints::new(&directions(), Direction::Y).unwrap()
    }

    #[test]
    fn every_waypoint_is_met_exactly_at_its_leg_parameter() {
        for (i, p) in directions().into_iter().enumerate() {
            assert_eq!(tour().at_leg(i as f64), p);
        }
    }

    #[test]
    fn every_waypoint_is_met_at_its_fraction_of_the_length() {
        let path = tour();
        let mut way = 0.0;
        for (leg, p) in path.legs().iter().zip(directions()) {
            let gap = angle(path.at(way / path.length()), p);
            assert!(gap <= 2.0 * EPS * path.length(), "{gap}");
            way += leg.angle();
        }
        assert_eq!((path.at(0.0), path.at(1.0)), (path.at_leg(0.0), path.at_leg(path.legs().len() as f64)));
    }

    #[test]
    fn along_a_path_in_one_plane_the_fraction_of_the_length_is_an_even_parameter() {
        let at = |phi: f64| [libm::cos(phi), libm::sin(phi), 0.0];
        let path = Waypoints::new(&[at(0.0), at(0.1), at(0.1), at(1.5), at(4.0), at(6.0)], Direction::Z).unwrap();
        assert!((path.length() - 6.0).abs() <= 8.0 * EPS);
        let samples: Vec<Vector> = (0..=100).map(|k| path.at(f64::from(k) / 100.0)).collect();
        assert!(unevenness(&angular_velocity(&samples, 0.01)) - 1.0 < 1e-13);
        let samples: Vec<Vector> = (0..=100).map(|k| path.at_leg(f64::from(k) / 20.0)).collect();
        assert_eq!(unevenness(&angular_velocity(&samples, 0.01)), f64::INFINITY);
    }

    #[test]
    fn parameters_beyond_the_path_give_its_ends_and_never_nan() {
        let path = tour();
        let end = path.legs().len() as f64;
        for t in [-1.0, f64::NEG_INFINITY, f64::NAN] {
            assert_eq!((path.at(t), path.at_leg(t)), (path.at(0.0), path.at(0.0)));
        }
        for t in [1e9, f64::INFINITY] {
            assert_eq!((path.at(t), path.at_leg(t)), (path.at_leg(end), path.at_leg(end)));
        }
    }

    #[test]
    fn waypoints_that_are_all_the_same_make_a_path_of_no_length() {
        let p = [0.0, 0.6, 0.8];
        let path = Waypoints::new(&[p, p, p], Direction::X).unwrap();
        for k in 0..=10 {
            let q = path.at(f64::from(k) / 10.0);
            assert!((norm(q) - 1.0).abs() <= EPS && angle(q, p) <= EPS);
        }
        assert!(path.length() <= EPS);
    }

    #[test]
    fn one_waypoint_is_an_error_that_says_what_would_do() {
        let message = Waypoints::new(&[[1.0, 0.0, 0.0]], Direction::X).unwrap_err().to_string();
        assert_eq!(message, "1 waypoint(s) found: give two or more");
    }
}
