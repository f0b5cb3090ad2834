//! The inverse of a Hessian, as far as the last steps and the changes of the gradient along them tell it: limited-memory BFGS.
//!
//! Nocedal, Math. Comp. 35, 773 (1980), doi:10.1090/S0025-5718-1980-0572855-7 (two-loop recursion).

use super::slab;
use std::collections::VecDeque;

/// The last pairs of a step and the change of the gradient along it, so many at most.
#[derive(Clone, Debug)]
pub struct Secants {
    most: usize,
    pairs: VecDeque<(Vec<f64>, Vec<f64>)>,
}

impl Secants {
    /// None yet.
    pub fn of(most: usize) -> Secants {
        Secants { most, pairs: VecDeque::new() }
    }

    /// Remembers a step and the change of the gradient along it. One without positive curvature makes it forget all.
    pub fn learn(&mut self, step: Vec<f64>, change: Vec<f64>) {
        if slab::dot(&step, &change) <= 1e-12 * slab::norm(&step) * slab::norm(&change) {
            self.pairs.clear();
            return;
        }
        self.pairs.push_back((step, change));
        if self.pairs.len() > self.most {
            self.pairs.pop_front();
        }
    }

    /// q ← H⁻¹ q; whether anything is remembered that tells of H. Where nothing is, q stays.
    pub fn apply(&self, q: &mut [f64]) -> bool {
        let Some((last, change)) = self.pairs.back() else { return false };
        let scale = slab::dot(last, change) / slab::dot(change, change);
        self.apply_beside(q, |q| slab::scale(q, scale))
    }

    /// The same, where `nearly` makes H⁻¹q of q for all that is not remembered.
    pub fn apply_beside(&self, q: &mut [f64], nearly: impl FnOnce(&mut [f64])) -> bool {
        let mut weights = Vec::new();
        for (s, y) in self.pairs.iter().rev() {
            let a = slab::dot(s, q) / slab::dot(s, y);
            slab::add_scaled(q, -a, y);
            weights.push(a);
        }
        nearly(q);
        for ((s, y), a) in self.pairs.iter().zip(weights.iter().rev()) {
            let b = slab::dot(y, q) / slab::dot(s, y);
            slab::add_scaled(q, a - b, s);
        }
        !self.pairs.is_empty()
    }

    /// What is remembered, oldest first.
    pub fn pairs(&self) -> impl Iterator<Item = &(Vec<f64>, Vec<f64>)> {
        self.pairs.iter()
    }

    /// Forgets all, and remembers these.
    pub fn remember(&mut self, pairs: impl Iterator<Item = (Vec<f64>, Vec<f64>)>) {
        self.pairs = pairs.collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_and_changes_of_a_quadratic_give_its_inverse_in_the_space_they_span() {
        // H = diag(1, 4, 9); conjugate steps
        let diagonal = [1.0, 4.0, 9.0];
        let mut secants = Secants::of(3);
        for (k, stiffness) in diagonal.iter().enumerate() {
            let (mut step, mut change) = (vec![0.0; 3], vec![0.0; 3]);
            (step[k], change[k]) = (0.5, 0.5 * stiffness);
            secants.learn(step, change);
        }
        let mut q = vec![2.0, 2.0, 2.0];
        assert!(secants.apply(&mut q));
        for (x, stiffness) in q.iter().zip(diagonal) {
            assert!((x - 2.0 / stiffness).abs() < 1e-15, "{q:?}");
        }
        // of two of the three directions the rest is told by what is nearly the inverse
        let mut two = Secants::of(2);
        two.remember(secants.pairs().skip(1).cloned());
        let mut q = vec![2.0, 2.0, 2.0];
        assert!(two.apply_beside(&mut q, |q| slab::scale(q, 0.9)));
        assert!((q[0] - 1.8).abs() < 1e-15 && (q[1] - 0.5).abs() < 1e-15 && (q[2] - 2.0 / 9.0).abs() < 1e-15, "{q:?}");
        assert!(!Secants::of(2).apply_beside(&mut q, |q| q.fill(1.0)) && q == [1.0; 3]);
        secants.learn(vec![1.0, 0.0, 0.0], vec![-1.0, 0.0, 0.0]);
        let mut q = vec![1.0, 0.0, 0.0];
        assert!(!secants.apply(&mut q) && q == [1.0, 0.0, 0.0], "a negative curvature is forgotten with all else");
    }
}
