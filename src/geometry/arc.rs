//! The great-circle arc from a to b, ready to be evaluated at many points.
//!
//! ```text
//! p(t) = [sin((1−t)θ) a + sin(tθ) b]/sin θ                           (G. Davis, in Shoemake)
//!      = [sin((1−u)h) a + sin(uh) m]/sin h,   u = 2t, h = θ/2        for t ≤ ½, and from b for t ≥ ½
//! ```
//!
//! K. Shoemake, "Animating rotation with quaternion curves", SIGGRAPH 1985, DOI 10.1145/325334.325242.
//! The second line is the first one for the half up to the middle m. It never divides by a small sine of an angle near
//! π, and it needs no special case for opposite ends, since [`midpoint()`] has one. For θ → 0 it is the lerp.
//!
//! Between opposite ends the halves meet at an angle of up to 1e-6 where the middle is blended; the angular velocity is
//! still constant to 1e-13.
//!
//! Equal steps follow the recurrence p_{k+1} = 2 cos δ p_k − p_{k−1}, started afresh every few steps so that rounding
//! does not grow.

use super::angle::angle;
use super::direction::Direction;
use super::midpoint::{midpoint, quarter_turn};
use super::vector::{Vector, add, cross, lerp, norm, scale, sub, unit_or};

/// The recurrence starts afresh after this many points: so it stays within 5e-14 of the formula.
const RESTART: usize = 16;

/// An arc of a great circle between two unit vectors.
///
/// ```
/// use spinneb::geometry::{Arc, Direction};
/// use std::f64::consts::PI;
/// let arc = Arc::new([1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Direction::Z);
/// assert_eq!(arc.angle(), PI);
/// assert_eq!(arc.at(0.5), [0.0, 1.0, 0.0]);
/// assert_eq!(arc.axis(), [0.0, 0.0, 1.0]);
/// assert_eq!(arc.steps(6).len(), 7);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    a: Vector,
    b: Vector,
    middle: Vector,
    half: f64,
    sin_half: f64,
    chosen: Direction,
}

impl Arc {
    /// The shortest arc from a to b; for opposite ends, the right-handed turn about the part of `axis` normal to a.
    pub fn new(a: Vector, b: Vector, axis: Direction) -> Arc {
        let middle = midpoint(a, b, axis);
        let half = angle(a, middle);
        Arc { a, b, middle, half, sin_half: libm::sin(half), chosen: axis }
    }

    /// The point at fraction t of the arc: exactly a at 0, exactly b at 1, always a unit vector.
    /// Beyond the ends it goes on along the great circle; a t that is not finite gives an end.
    pub fn at(&self, t: f64) -> Vector {
        if t == 0.0 {
            self.a
        } else if t == 1.0 {
            self.b
        } else if t <= 0.5 {
            self.on_half(self.a, 2.0 * t)
        } else {
            self.on_half(self.b, 2.0 * (1.0 - t))
        }
    }

    /// The point at fraction u of the half from an end to the middle.
    fn on_half(&self, end: Vector, u: f64) -> Vector {
        if u == 1.0 {
            return self.middle;
        }
        if self.sin_half == 0.0 {
            return unit_or(lerp(end, self.middle, u), end);
        }
        let of_end = libm::sin((1.0 - u) * self.half) / self.sin_half;
        let of_middle = libm::sin(u * self.half) / self.sin_half;
        unit_or(add(scale(of_end, end), scale(of_middle, self.middle)), end)
    }

    /// The angle swept, in rad: that between the ends (beside opposite ends, up to 1e-6 rad more if the axis so wills).
    pub fn angle(&self) -> f64 {
        2.0 * self.half
    }

    /// The middle of the arc.
    pub fn middle(&self) -> Vector {
        self.middle
    }

    /// The unit axis of the right-handed rotation from a to b: a×b/|a×b| except for opposite ends.
    /// For identical ends it is the part of the chosen axis normal to a.
    pub fn axis(&self) -> Vector {
        let chord = super::vector::unit(sub(self.a, self.b)).unwrap_or(self.a);
        let k = cross(chord, self.middle);
        if norm(k) > 0.5 {
            return unit_or(k, k);
        }
        // the ends differ by the rounding of their lengths only
        let k = cross(self.a, quarter_turn(self.a, self.chosen));
        unit_or(k, k)
    }

    /// The n + 1 points at t = 0, 1/n, …, 1, ends exact; for n = 0 the start alone.
    ///
    /// ```
    /// use spinneb::geometry::{Arc, Direction, angle};
    /// let arc = Arc::new([0.0, 0.0, 1.0], [0.0, 0.8, 0.6], Direction::X);
    /// let path: Vec<_> = arc.steps(4).collect();
    /// assert_eq!((path[0], path[4]), ([0.0, 0.0, 1.0], [0.0, 0.8, 0.6]));
    /// assert!((angle(path[1], path[2]) - arc.angle() / 4.0).abs() < 1e-15);
    /// ```
    pub fn steps(&self, n: usize) -> Steps {
        let two_cos = if n == 0 { 2.0 } else { 2.0 * libm::cos(self.angle() / n as f64) };
        Steps { arc: *self, n, next: 0, two_cos, last: [self.a; 2] }
    }
}

/// Equally spaced points of an [`Arc`], from [`Arc::steps`].
#[derive(Clone, Debug)]
pub struct Steps {
    arc: Arc,
    n: usize,
    next: usize,
    two_cos: f64,
    /// The last two points, not normalised.
    last: [Vector; 2],
}

impl Steps {
    /// Point k by the recurrence, or directly at the ends, at a restart, and where the last three points lie on both
    /// sides of the middle (the halves of a blended arc meet at an angle of up to 1e-6).
    fn point(&self, k: usize) -> Vector {
        let across_middle = 2 * k > self.n && 2 * k < self.n + 4;
        if k == 0 || k == self.n || k % RESTART < 2 || across_middle {
            return if k == 0 { self.arc.a } else { self.arc.at(k as f64 / self.n as f64) };
        }
        let [before, now] = self.last;
        sub(scale(self.two_cos, now), before)
    }
}

impl Iterator for Steps {
    type Item = Vector;

    fn next(&mut self) -> Option<Vector> {
        if self.next > self.n {
            return None;
        }
        let p = self.point(self.next);
        self.last = [self.last[1], p];
        self.next += 1;
        Some(if self.next == 1 || self.next > self.n { p } else { unit_or(p, p) })
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = (self.n + 1).saturating_sub(self.next);
        (left, Some(left))
    }
}

impl ExactSizeIterator for Steps {}

#[cfg(test)]
mod tests {
    use super::super::test_vectors::{axes, directions, opposite_pairs, pairs};
    use super::super::vector::dot;
    use super::*;
    use std::f64::consts::PI;

    const EPS: f64 = f64::EPSILON;

    #[test]
    fn the_axis_is_that_of_the_rotation_from_a_to_b() {
        for a in directions() {
            for b in directions() {
                let turn = angle(a, b);
                if (0.1..PI - 0.1).contains(&turn) {
                    let k = Arc::new(a, b, Direction::X).axis();
                    let expected = scale(1.0 / libm::sin(turn), cross(a, b));
                    assert!(norm(sub(k, expected)) < 40.0 * EPS, "{a:?} {b:?}: {k:?} {expected:?}");
                }
            }
        }
    }

    #[test]
    fn the_axis_of_opposite_and_of_identical_ends_is_the_part_of_the_chosen_one_normal_to_them() {
        let a = [0.6, 0.0, 0.8];
        let expected = [-0.8, 0.0, 0.6];
        for b in [a, scale(-1.0, a)] {
            let k = Arc::new(a, b, Direction::Z).axis();
            assert!(norm(sub(k, expected)) <= 2.0 * EPS, "{k:?}");
        }
    }

    #[test]
    fn the_axis_is_always_a_unit_vector_normal_to_the_start() {
        for (a, b) in pairs() {
            for axis in axes() {
                let k = Arc::new(a, b, axis).axis();
                assert!((norm(k) - 1.0).abs() <= 2.0 * EPS, "{a:?} {b:?} {axis:?}: {k:?}");
                assert!(dot(k, a).abs() <= 1.1e-6, "{a:?} {b:?} {axis:?}: {k:?}");
            }
        }
    }

    #[test]
    fn the_recurrence_gives_the_same_points_as_the_formula() {
        let mut worst = 0.0_f64;
        for (a, b) in directions().into_iter().zip(directions().into_iter().rev()).chain(opposite_pairs()) {
            let arc = Arc::new(a, b, Direction::Y);
            for n in [1, 2, 3, 4, 7, 16, 33] {
                for (k, p) in arc.steps(n).enumerate() {
                    worst = worst.max(norm(sub(p, arc.at(k as f64 / n as f64))));
                }
            }
        }
        assert!(worst < 128.0 * EPS, "{worst}");
    }

    #[test]
    fn a_thousand_steps_are_equal_and_end_at_the_end() {
        let (a, b) = ([0.0, 0.6, 0.8], [0.0, -0.8, -0.6]);
        let arc = Arc::new(a, b, Direction::X);
        let path: Vec<Vector> = arc.steps(1000).collect();
        assert_eq!((path.len(), path[0], path[1000]), (1001, a, b));
        for k in 0..1000 {
            assert!((angle(path[k], path[k + 1]) - arc.angle() / 1000.0).abs() < 60.0 * EPS, "{k}");
        }
    }

    #[test]
    fn no_step_is_the_start_alone() {
        let arc = Arc::new([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Direction::Z);
        assert_eq!(arc.steps(0).collect::<Vec<_>>(), [[1.0, 0.0, 0.0]]);
        assert_eq!(arc.steps(1).collect::<Vec<_>>(), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    }

    #[test]
    fn beyond_its_ends_the_arc_goes_on_along_the_circle() {
        let arc = Arc::new([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], Direction::Z);
        assert!(norm(sub(arc.at(2.0), [-1.0, 0.0, 0.0])) <= 4.0 * EPS);
        assert!(norm(sub(arc.at(-1.0), [0.0, -1.0, 0.0])) <= 4.0 * EPS);
        assert_eq!(arc.at(f64::NAN), [0.0, 1.0, 0.0]);
    }
}
