//! Pins that make a singular Hessian regular, and the border that takes one of them back.
//!
//! ```text
//! H″ = H' + κ e eᵀ         e: direction of the soft mode t on its largest site
//! C = [t, −e],  Z = H″⁻¹C,  S = diag(0, 1/κ) − CᵀZ        [H' t; tᵀ 0] by H″ and one border column
//! ```

use crate::linalg::{Factors, Matrix, slab};

/// A unit vector on one site.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pin {
    site: usize,
    e: [f64; 2],
}

impl Pin {
    /// e · x.
    pub fn dot(&self, x: &[f64]) -> f64 {
        self.e[0] * x[2 * self.site] + self.e[1] * x[2 * self.site + 1]
    }

    /// e as a vector of so many numbers.
    pub fn column(&self, length: usize) -> Vec<f64> {
        let mut column = vec![0.0; length];
        column[2 * self.site..2 * self.site + 2].copy_from_slice(&self.e);
        column
    }
}

/// Adds κ e eᵀ on the site where `mode` is largest and no pin stands yet; returns e.
pub fn pin(matrix: &mut Matrix, mode: &[f64], used: &mut Vec<usize>, kappa: f64) -> Pin {
    let size = |i: usize| mode[2 * i].powi(2) + mode[2 * i + 1].powi(2);
    let mut site = 0;
    let mut largest = -1.0;
    for i in 0..mode.len() / 2 {
        if size(i) > largest && !used.contains(&i) {
            (site, largest) = (i, size(i));
        }
    }
    used.push(site);
    let norm = size(site).sqrt().max(f64::MIN_POSITIVE);
    let e = [mode[2 * site] / norm, mode[2 * site + 1] / norm];
    for a in 0..2 {
        for b in 0..=a {
            matrix.add(2 * site + a, 2 * site + b, kappa * e[a] * e[b]);
        }
    }
    Pin { site, e }
}

/// Pins orthonormal modes; the pins, and their sites.
pub fn pin_all(matrix: &mut Matrix, modes: &[Vec<f64>], kappa: f64) -> (Vec<Pin>, Vec<usize>) {
    let mut used = Vec::new();
    (modes.iter().map(|mode| pin(matrix, mode, &mut used, kappa)).collect(), used)
}

/// The soft mode and its pin.
#[derive(Debug, Default)]
pub struct Border {
    /// t: a unit vector.
    pub soft: Vec<f64>,
    /// e.
    pub pin: Pin,
    /// Z, the two columns side by side.
    solved: Vec<f64>,
    /// S: symmetric.
    pub schur: [[f64; 2]; 2],
}

impl Border {
    /// Of a unit vector, to be factorised.
    pub fn along(soft: Vec<f64>) -> Border {
        Border { soft, ..Border::default() }
    }

    /// Pins `self.soft`; factorises the matrix that is pinned so, and solves for C.
    pub fn factor(&mut self, mut matrix: Matrix, used: &mut Vec<usize>, kappa: f64) -> Factors {
        self.set(&mut matrix, used, kappa);
        let factors = Factors::solving(matrix, &mut self.solved, 2);
        self.close(kappa);
        factors
    }

    /// The same with a step of iterative refinement, and the matrix that is pinned so.
    pub fn factor_refined(&mut self, mut matrix: Matrix, used: &mut Vec<usize>, kappa: f64) -> (Matrix, Factors) {
        self.set(&mut matrix, used, kappa);
        let columns = self.solved.clone();
        let factors = Factors::solving(matrix.clone(), &mut self.solved, 2);
        let (mut x, mut image, mut rest) = (Vec::new(), vec![0.0; self.soft.len()], columns);
        for column in 0..2 {
            slab::one_of(&self.solved, 2, column, &mut x);
            matrix.multiply(&x, &mut image);
            rest[column..].iter_mut().step_by(2).zip(&image).for_each(|(r, a)| *r -= a);
        }
        factors.solve(&mut rest, 2);
        slab::add_scaled(&mut self.solved, 1.0, &rest);
        self.close(kappa);
        (matrix, factors)
    }

    /// The pin, and C where Z is to be.
    fn set(&mut self, matrix: &mut Matrix, used: &mut Vec<usize>, kappa: f64) {
        self.pin = pin(matrix, &self.soft, used, kappa);
        slab::spread(&self.soft, &mut self.solved);
        for a in 0..2 {
            self.solved[2 * (2 * self.pin.site + a) + 1] = -self.pin.e[a];
        }
    }

    /// S, from Z.
    fn close(&mut self, kappa: f64) {
        let [tt, te] = slab::dot_pairs(&self.soft, &self.solved);
        let at_pin = |column: usize| {
            let of = |a: usize| self.pin.e[a] * self.solved[2 * (2 * self.pin.site + a) + column];
            -(of(0) + of(1))
        };
        let off = -0.5 * (te + at_pin(0));
        self.schur = [[-tt, off], [off, 1.0 / kappa - at_pin(1)]];
    }

    /// From x = H″⁻¹b to the solution of [H' t; tᵀ 0] (x, ν) = (b, 0), in place.
    pub fn take_back(&self, x: &mut [f64]) {
        let r = [-slab::dot(&self.soft, x), self.pin.dot(x)];
        let q = self.share(r);
        slab::add_pairs(x, [-q[0], -q[1]], &self.solved);
    }

    /// The solution of [H' t; tᵀ 0] (x, ν) = (0, 1), into the memory of `x`.
    pub fn valley(&self, x: &mut Vec<f64>) {
        let q = self.share([1.0, 0.0]);
        x.clear();
        x.resize(self.soft.len(), 0.0);
        slab::add_pairs(x, [-q[0], -q[1]], &self.solved);
    }

    /// S⁻¹ r.
    fn share(&self, r: [f64; 2]) -> [f64; 2] {
        let [[a, b], [c, d]] = self.schur;
        let determinant = a * d - b * c;
        [(d * r[0] - b * r[1]) / determinant, (a * r[1] - c * r[0]) / determinant]
    }
}
