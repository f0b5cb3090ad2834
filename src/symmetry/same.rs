//! Which states an operation takes to each other, rotations about the axes of symmetry aside.

use super::{Group, Operation};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::sphere::{rotate_sites, turn_towards};

impl Group {
    /// Whether an operation, and then a rotation about an axis of symmetry, takes state a to b: each spin to less than `off` (rad)
    /// beside it. Of an energy that has no axis at all, whether it does without a rotation.
    pub fn takes(&self, o: &Operation, a: &[f64], b: &[f64], off: f64) -> bool {
        let (from, to) = (Components::new(a), Components::new(b));
        let near = |p: Vector, q: Vector| vector::dot(vector::sub(p, q), vector::sub(p, q)) < off * off;
        let [axis] = self.axes() else { return (0..to.sites()).all(|i| near(o.at(from, i), to.get(i))) };
        // along the axis nothing turns: only where that part agrees is the whole compared
        let along = |m: Vector| vector::dot(m, *axis);
        if !(0..to.sites()).all(|i| (along(o.at(from, i)) - along(to.get(i))).abs() < off) {
            return false;
        }
        let mut image = o.apply(a);
        if let Ok(direction) = Direction::new(*axis) {
            let (sine, cosine) = turn_towards(Components::new(&image), to, *axis);
            rotate_sites(&mut image, 0..to.sites(), direction, libm::atan2(sine, cosine));
        }
        (0..to.sites()).all(|i| near(Components::new(&image).get(i), to.get(i)))
    }

    /// Of the multiples of `least` of each shortest shift the first that keeps all the states.
    pub fn periods(&self, states: &[&[f64]], least: &[usize], off: f64) -> Vec<usize> {
        let of = |(s, least): (&super::Shift, &usize)| {
            let divides = |k: &usize| s.order.is_multiple_of(*k);
            let keeps =
                |k: &usize| *k == s.order || s.order > 1 && states.iter().all(|m| self.takes(&s.times(*k), m, m, off));
            (*least..=s.order).step_by(*least).filter(divides).find(keeps).unwrap_or(s.order)
        };
        self.shifts().iter().zip(least).map(of).collect()
    }
}
