//! Which states an operation takes to each other, rotations about the axes of symmetry aside.

use super::{Group, Operation};
use crate::field::Components;
use crate::geometry::{Direction, Vector, vector};
use crate::sphere::{rotate_sites, turn_towards};

/// All numbers below n, far apart one after the other: two states differ at a few sites side by side, and are alike everywhere else.
fn scattered(n: usize) -> impl Iterator<Item = usize> {
    // nearest to the golden section; every step that has no divisor in common with n comes by all
    let step = (n * 5 / 8..=n).find(|step| gcd(*step, n) == 1).unwrap_or(1);
    (0..n).map(move |k| k * step % n)
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl Group {
    /// Whether an operation, and then a rotation about an axis of symmetry, takes state a to b: each spin to less than `off` (rad)
    /// beside it. Of an energy that has no axis at all, whether it does without a rotation.
    pub fn takes(&self, o: &Operation, a: &[f64], b: &[f64], off: f64) -> bool {
        let (from, to) = (Components::new(a), Components::new(b));
        let near = |p: Vector, q: Vector| vector::dot(vector::sub(p, q), vector::sub(p, q)) < off * off;
        let [axis] = self.axes() else { return scattered(to.sites()).all(|i| near(o.at(from, i), to.get(i))) };
        // along the axis nothing turns: only where that part agrees is the whole compared
        let along = |m: Vector| vector::dot(m, *axis);
        if !scattered(to.sites()).all(|i| (along(o.at(from, i)) - along(to.get(i))).abs() < off) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scattered_numbers_are_all_numbers_and_meet_each_run_of_them_soon() {
        for n in (0..70).chain([1000, 4096, 16384]) {
            let order: Vec<usize> = scattered(n).collect();
            let mut sorted = order.clone();
            sorted.sort();
            assert_eq!(sorted, (0..n).collect::<Vec<_>>());
            let run = |i: &usize| (n / 2..n / 2 + n / 64).contains(i);
            let first = order.iter().position(run).unwrap_or(0);
            assert!(first <= 200 || n < 64, "{n}: {first}");
        }
    }
}
