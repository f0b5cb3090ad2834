//! Newton's steps by the factors of a Hessian some steps back, where these are dear.
//!
//! ```text
//! M⁻¹ H s = −M⁻¹ g    M: the Hessian that was factorised, H: the one here, both in the tangent coordinates there
//! ```
//! As long as the spins have turned little since, M⁻¹H is all but the identity, and a few solutions by the factors tell what new ones
//! would. Where they do not, new factors are due.

use super::point::Point;
use super::tolerances::{FEW, STEP};
use crate::energy::Evaluator;
use crate::field::project;
use crate::hessian::TangentBasis;
use crate::linalg::{Factors, Matrix, gmres, remove, slab};
use crate::sphere::rotation_of;

/// What is left of the residual, in parts of M⁻¹g.
const LEFT: f64 = 0.01;

/// How much shorter a step is than the one before: else the directions that fall may be others.
const SHORTER: f64 = 2.0;

/// The factors of a step that was theirs alone.
#[derive(Debug)]
pub(super) struct Kept {
    factors: Factors,
    /// Where they are of.
    basis: TangentBasis,
    zeros: Vec<Vec<f64>>,
    /// Largest rotation of a spin in the last step by them (rad).
    pub rotation: f64,
}

impl Kept {
    /// Factors of the Hessian at a point, zero modes pinned, before the step that they were made for.
    pub fn of(factors: Factors, here: &Point) -> Kept {
        Kept { factors, basis: here.basis.clone(), zeros: here.zeros.clone(), rotation: f64::INFINITY }
    }

    /// Negative directions where they are of, zero modes apart.
    pub fn negatives(&self) -> usize {
        self.factors.negatives()
    }

    /// Their memory, to be filled anew.
    pub fn into_memory(self) -> Matrix {
        self.factors.into_memory()
    }

    /// Writes Newton's step from a point to `v` (3N), if these factors tell it soon and it is so much shorter than the one before; its
    /// largest rotation of a spin (rad).
    pub fn step(&mut self, h: Evaluator, here: &Point, v: &mut Vec<f64>) -> Option<f64> {
        if self.rotation > STEP {
            return None;
        }
        let mut right = self.solved(&here.field(&here.slope));
        slab::scale(&mut right, -1.0);
        let product = |x: &[f64]| {
            let along = self.field(here, x);
            let mut image = vec![0.0; along.len()];
            h.hessian_product(&here.m, &here.gradient, &along, &mut image);
            (!h.is_stopped()).then(|| self.solved(&image))
        };
        let x = gmres(product, &right, LEFT, FEW)?;
        *v = self.field(here, &x);
        h.hold_frozen(v);
        let rotation = rotation_of(v);
        let serves = SHORTER * rotation < self.rotation;
        self.rotation = rotation;
        serves.then_some(rotation)
    }

    /// M⁻¹ of a field, zero modes apart, in coordinates.
    fn solved(&self, field: &[f64]) -> Vec<f64> {
        let mut x = self.basis.coordinates(field);
        self.factors.solve(&mut x, 1);
        remove(&mut x, &self.zeros);
        x
    }

    /// The field of coordinates, tangent at a point beside the one that they are of.
    fn field(&self, here: &Point, x: &[f64]) -> Vec<f64> {
        let mut v = vec![0.0; here.m.len()];
        self.basis.field(x, &mut v);
        project(&here.m, &mut v);
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::spins::Spins;

    #[test]
    fn factors_of_a_state_beside_tell_the_step_that_new_ones_do() {
        let film = lattice(r#"{"square": {"cells": [9, 7]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0.03, 0.06, 1]}}"#;
        let h = hamiltonian(&film, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let h = Evaluator::from(&h);
        let mut matrix = Matrix::default();
        let mut factors_at = |at: &Point| {
            at.write_hessian(h, 0.0, &mut matrix);
            std::mem::take(&mut matrix).factor()
        };
        let from = Point::at(h, Spins::uniform(h.sites(), Direction::Z).as_slice().to_vec());
        let mut kept = Kept::of(factors_at(&from), &from);
        let mut v = Vec::new();
        assert!(kept.step(h, &from, &mut v).is_none(), "no step was made by them");
        let mut here = from.clone();
        let uneven: Vec<f64> = (0..from.slope.len()).map(|k| 0.05 * libm::sin(k as f64)).collect();
        here.move_by(h, &from.field(&uneven));
        kept.rotation = STEP;
        assert!(kept.step(h, &here, &mut v).is_some_and(|rotation| rotation > 0.05));
        let mut exact = here.downhill();
        factors_at(&here).solve(&mut exact, 1);
        let mut difference = here.field(&exact);
        slab::add_scaled(&mut difference, -1.0, &v);
        let wrong = slab::norm(&difference) / slab::norm(&v);
        assert!((1e-9..2.0 * LEFT).contains(&wrong), "{wrong:e}");
        assert!(kept.step(h, &here, &mut v).is_none(), "the step is no shorter than the one before");
    }
}
