//! Newton's equations on the way down from a saddle without factors, where these are dear: by conjugate gradients. What is
//! left of the residual has the noise of what stands in for the Hessian, which knows how sites are numbered: a wall that leaves a film may
//! tilt to either side, and what tells the sides apart grows on the way.

use super::point::Point;
use super::tolerances::INDEPENDENT;
use crate::energy::Hamiltonian;
use crate::field::project;
use crate::hessian::{Complement, Place, StandIn};
use crate::linalg::{orthonormal, slab};

/// The part of the residual that is left: small enough that what grows of it on the way is small beside the 0.01 rad by which a step of
/// the flow may be wrong.
pub const LEFT: f64 = 1e-6;

/// The equations at one point after the other.
pub struct Unfactored {
    stand_in: StandIn,
    equations: Complement,
}

impl Unfactored {
    /// For points like one, with spins held by the stiffness scale c (meV) at least.
    pub fn about(h: &Hamiltonian, from: &Point, c: f64) -> Unfactored {
        Unfactored { stand_in: StandIn::about(h, &from.m, &from.gradient, c), equations: Complement::default() }
    }

    /// Solves P (H + shift) P x = P b for tangent fields (3N), P without zero modes and, across valleys, the directions `along` them; |b|
    /// may be of any size. None where a direction of negative curvature is met.
    pub fn solve(&mut self, h: &Hamiltonian, at: &Point, shift: f64, along: &[&[f64]], b: &[f64]) -> Option<&[f64]> {
        self.solve_until(LEFT, h, at, shift, along, b)
    }

    /// The same, until a part `left` of the residual is left.
    pub fn solve_until(
        &mut self,
        left: f64,
        h: &Hamiltonian,
        at: &Point,
        shift: f64,
        along: &[&[f64]],
        b: &[f64],
    ) -> Option<&[f64]> {
        let zeros = at.zeros.iter().map(|z| at.field(z));
        let border = zeros.chain(along.iter().map(|t| t.to_vec())).collect();
        self.equations.border = orthonormal(border, INDEPENDENT);
        self.equations.right.clear();
        self.equations.right.extend_from_slice(b);
        let place = Place { h, m: &at.m, g: &at.gradient, shift, pull: 0.0 };
        self.equations.solve(place, &self.stand_in, left).ok()?;
        Some(&self.equations.x)
    }

    /// q ← P M⁻¹ q of a tangent field: roughly the step that a force q asks for.
    pub fn step(&mut self, h: &Hamiltonian, at: &Point, q: &mut [f64]) {
        self.equations.apply_stand_in(&self.stand_in, q);
        project(&at.m, q);
        h.hold_frozen(q);
    }

    /// The direction of the valley at a point near it, t the one so far (unit, tangent, 3N): t + y, P H (t + y) = 0. None where it has
    /// none, or another one.
    pub fn valley(&mut self, h: &Hamiltonian, at: &Point, shift: f64, t: &[f64]) -> Option<Vec<f64>> {
        let mut image = vec![0.0; t.len()];
        h.hessian_product(&at.m, &at.gradient, t, &mut image);
        slab::scale(&mut image, -1.0);
        let mut valley = self.solve(h, at, shift, &[t], &image)?.to_vec();
        slab::add_scaled(&mut valley, 1.0, t);
        Some(valley)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::geometry::Direction;
    use crate::linalg::Matrix;
    use crate::sphere::move_points;
    use crate::spins::Spins;
    use crate::stationary::Pinned;

    const C: f64 = 0.2;

    /// A film with an easy axis along z, its spins along `mean` and a little disordered.
    fn disordered(mean: Direction) -> (Hamiltonian, Vec<f64>) {
        let lattice = lattice(r#"{"square": {"cells": [14, 9]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.1 meV", "axis": [0, 0, 1]}}"#;
        let canted = r#"{"dmi": {"D": "0.1 meV", "kind": "interfacial"}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy, canted]);
        let mut m = Spins::uniform(h.sites(), mean).as_slice().to_vec();
        let mut v = Spins::random(h.sites(), 5).as_slice().to_vec();
        project(&m, &mut v);
        let length = v.len();
        move_points(&mut m, &v, length, 0.1);
        (h, m)
    }

    #[test]
    fn it_finds_what_factors_find() {
        let (h, m) = disordered(Direction::Z);
        let at = Point::at((&h).into(), m);
        let mut t = at.m.iter().enumerate().map(|(k, _)| (k as f64 * 0.07).sin()).collect::<Vec<f64>>();
        project(&at.m, &mut t);
        slab::normalise(&mut t);

        let (mut pinned, mut matrix) = (Pinned::default(), Matrix::default());
        at.write_hessian((&h).into(), 0.0, &mut matrix);
        let along = at.basis.coordinates(&t);
        pinned.factor(matrix, &at.zeros, &along, Pinned::strength_mev((&h).into(), C));
        let mut valley = Vec::new();
        pinned.write_valley(&mut valley);
        let mut across = at.downhill();
        pinned.solve_in_place(&mut across);

        let mut without = Unfactored::about(&h, &at, C);
        let found = without.valley(&h, &at, 0.0, &t).expect("no direction is negative");
        let off = |found: &[f64], exact: &[f64]| {
            let mut difference = at.field(exact);
            slab::add_scaled(&mut difference, -1.0, found);
            slab::norm(&difference) / slab::norm(exact)
        };
        assert!(off(&found, &valley) < 1e-6, "{:e}", off(&found, &valley));
        let step = without.solve(&h, &at, 0.0, &[&t], &at.field(&at.downhill())).expect("no direction is negative");
        assert!(off(step, &across) < 1e-6, "{:e}", off(step, &across));
        assert!(slab::dot(step, &t).abs() < 1e-9);
    }

    #[test]
    fn where_another_direction_is_negative_there_is_no_valley() {
        let (h, m) = disordered(Direction::X);
        let at = Point::at((&h).into(), m);
        let mut without = Unfactored::about(&h, &at, C);
        let mut t = vec![0.0; at.m.len()];
        t[h.sites() + 3] = 1.0;
        project(&at.m, &mut t);
        assert!(without.valley(&h, &at, 0.0, &t).is_none());
    }
}
