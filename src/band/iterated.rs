//! One image of the linearised band without its factors, by conjugate gradients in the complement of C, the tangent and the zero
//! modes:
//!
//! ```text
//! P A P x = P (F⊥ + σ y_u − A d τ),   P = 1 − C Cᵀ,   A = H + σ m·m_u + μ,   y = d τ + x
//! ```
//! (see `upwind` and [`Complement`]), until 3 % of the residual are left, or a tenth where the band is only to be looked at: the next
//! evaluation changes the right-hand side by more. A direction of negative curvature on the way makes μ grow, as a negative pivot does
//! where there are factors.
//! (T. Steihaug, SIAM J. Numer. Anal. 20, 626 (1983), doi:10.1137/0720042, for conjugate gradients that end so; R. S. Dembo, S. C.
//! Eisenstat, T. Steihaug, SIAM J. Numer. Anal. 19, 400 (1982), doi:10.1137/0719025, for how far they are to go.)

use super::Band;
use super::linearised::{LEAST, Move, SHIFT_TRIES, first_shift};
use super::upwind::{pulled, upwind_rate};
use crate::energy::Hamiltonian;
use crate::energy::magnetostatics::DENSE;
use crate::field::Components;
use crate::geometry::{Vector, vector};
use crate::hessian::{Complement, Place, StandIn};
use crate::linalg::{orthonormal, slab};
use std::mem::take;
use std::sync::Arc;

/// The residual that is left, and where a band is only to be looked at.
pub(super) const TOLERANCE: f64 = 3e-2;
pub(super) const ROUGH: f64 = 0.1;

/// An image with room for its linear algebra.
#[derive(Debug)]
pub struct Iterated {
    /// M.
    stand_in: Arc<StandIn>,
    tolerance: f64,
    equations: Complement,
    sigma: f64,
    shift: f64,
    /// g − σ m_u.
    pulled: Vec<f64>,
    image: Vec<f64>,
}

impl Iterated {
    /// Nothing yet, but for M, and for the residual that is to be left.
    pub fn by(stand_in: Arc<StandIn>, tolerance: f64) -> Iterated {
        let (equations, pulled, image) = (Complement::default(), Vec::new(), Vec::new());
        Iterated { stand_in, tolerance, equations, sigma: 0.0, shift: 0.0, pulled, image }
    }

    /// M for images between two states, where factors of their Hessians take long: of blocks whose fronts are large, and of all pairs of
    /// more than a few sites. (Of fewer sites too they take half as long; but conjugate gradients do not see that a symmetric path is a
    /// ridge, and of 102 random chains and rings two lost their lowest barriers so.)
    pub fn stand_in(h: &Hamiltonian, ends: [&[f64]; 2], c: f64) -> Option<StandIn> {
        let is_far = h.coupling().pairs().is_some() && h.sites() > DENSE;
        (h.has_dear_factors() || is_far).then(|| {
            let gradients = ends.map(|m| {
                let mut gradient = vec![0.0; m.len()];
                h.energy_gradient(m, &mut gradient);
                gradient
            });
            StandIn::between(h, &[0, 1].map(|k| (ends[k], &gradients[k][..])), c)
        })
    }

    /// For image k, with symmetry axes `axes` and the shift μ of its last visit (meV).
    pub fn prepare(&mut self, band: &Band, k: usize, axes: &[Vector], old: f64) {
        self.sigma = upwind_rate(band, k);
        self.shift = first_shift(band, k, self.stand_in.c, old);
        let m = Components::new(band.path().image(k));
        let mut columns = vec![band.tangent(k).to_vec()];
        for axis in axes {
            let turned: Vec<Vector> = (0..m.sites()).map(|i| vector::cross(*axis, m.get(i))).collect();
            let mut z: Vec<f64> = (0..3).flat_map(|c| turned.iter().map(move |v| v[c])).collect();
            let size = slab::norm(&z);
            slab::scale(&mut z, 1.0 / size.max(LEAST));
            columns.push(z);
        }
        self.equations.border = orthonormal(columns, LEAST);
    }

    /// Writes the move `y` (3N, rad) of image k, pushed across the path, shifted along it, and dragged by σ times the move of its
    /// uphill neighbour, if that moves.
    pub fn relax(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>, y: &mut [f64]) -> Move {
        self.equations.products = 0;
        let mut room = take(&mut self.pulled);
        let g = pulled(band, k, self.sigma, &mut room);
        self.set_right_side(band, k, g, uphill);
        for _ in 1..SHIFT_TRIES {
            let (h, m) = (band.hamiltonian(), band.path().image(k));
            let place = Place { h, m, g, shift: self.shift, pull: self.sigma };
            let Err(negative) = self.equations.solve(place, &self.stand_in, self.tolerance) else { break };
            // as much as it takes and as the force asks for: a mode that is all but free is left soon where it is not held
            let enough = (2.0 * negative).max(band.force(k).min(self.stand_in.c));
            self.shift = (4.0 * self.shift).max(self.shift + enough);
        }
        let x = &self.equations.x;
        y.copy_from_slice(x);
        slab::add_scaled(y, band.resolving_shift(k), band.tangent(k));
        let rotation = longest(x);
        self.pulled = room;
        Move { rotation, shift: self.shift, factorisations: 0, products: self.equations.products }
    }

    /// F⊥ + σ y_u − A d τ.
    fn set_right_side(&mut self, band: &Band, k: usize, g: &[f64], uphill: Option<&[f64]>) {
        let right = &mut self.equations.right;
        right.clear();
        right.extend_from_slice(band.perpendicular(k));
        if let Some(uphill) = uphill {
            slab::add_scaled(right, self.sigma, uphill);
        }
        let along = band.resolving_shift(k);
        if along != 0.0 {
            // what A adds to H d τ is along τ
            self.image.resize(right.len(), 0.0);
            band.hamiltonian().hessian_product(band.path().image(k), g, band.tangent(k), &mut self.image);
            slab::add_scaled(right, -along, &self.image);
        }
    }
}

/// The longest vector of a field; NaN if any entry is NaN or infinite.
fn longest(v: &[f64]) -> f64 {
    let v = Components::new(v);
    let (mut largest, mut poison) = (0.0, 0.0);
    for i in 0..v.sites() {
        let square = vector::dot(v.get(i), v.get(i));
        largest = if square > largest { square } else { largest };
        poison += 0.0 * square;
    }
    f64::sqrt(largest) + poison
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::lattice::Lattice;
    use crate::linalg::remove;
    use crate::path::Path;
    use crate::spins::Spins;
    use rand::{RngExt, SeedableRng};

    /// Walls at several places, each with so much noise.
    fn walls(lattice: &Lattice, noise: f64) -> Path {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(6);
        let mut image = |k: usize| {
            let field = |i: usize| {
                let x = 0.4 * (lattice.position(i)[0] - 9.0 * k as f64 - 2.0);
                [1.0 / x.cosh(), 0.0, x.tanh()].map(|c| c + r.random_range(-noise..noise))
            };
            let vectors: Vec<Vector> = (0..lattice.sites).map(field).collect();
            let flat: Vec<f64> = (0..3).flat_map(|c| vectors.iter().map(move |v| v[c])).collect();
            Spins::from_components(&flat).unwrap()
        };
        Path::new(&(0..5).map(&mut image).collect::<Vec<_>>())
    }

    #[test]
    fn what_is_left_of_a_force_by_rounding_moves_no_spin_by_more() {
        let spec = r#"{"square": {"cells": [40, 40], "periodic": true}}"#;
        let lattice = lattice(spec);
        let easy = r#"{"anisotropy": {"K": "0.08 meV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        // the last has radial forces alone, of rounding: towards the poles all images are uniform
        let images = [0.0, 0.3, 0.6, 1e-9, 1e-13, 0.0].map(|angle: f64| {
            let m = vec![[angle.sin(), 0.0, angle.cos()]; lattice.sites];
            let flat: Vec<f64> = (0..3).flat_map(|c| m.iter().map(move |v| v[c])).collect();
            Spins::from_components(&flat).unwrap()
        });
        let mut band = Band::new(&h, Path::new(&images));
        band.evaluate();
        let mut room =
            Iterated::by(Arc::new(Iterated::stand_in(&h, band.ends(), 0.16).expect("factors are dear")), TOLERANCE);
        let mut y = vec![0.0; 3 * h.sites()];
        for k in 1..5 {
            room.prepare(&band, k, h.symmetry_axes(), 0.0);
            let uphill = vec![if k == 4 { 1e-15 } else { 0.0 }; y.len()];
            let done = room.relax(&band, k, Some(&uphill), &mut y);
            assert!(done.rotation < 1e-8, "{k}: {}", done.rotation);
        }
    }

    #[test]
    fn a_move_solves_the_bordered_equations_of_its_image_nearly() {
        let exchange = r#"{"exchange": {"J": ["1 meV", "-0.1 meV"]}}"#;
        let easy = r#"{"anisotropy": {"K": "0.08 meV", "axis": [0, 0, 1]}}"#;
        let dmi = r#"{"dmi": {"D": "0.2 meV", "kind": "interfacial"}}"#;
        let (mut tried, mut shifted) = (0, 0);
        for kind in [
            r#"{"square": {"cells": [40, 40], "periodic": [false, true]}}"#,
            r#"{"triangular": {"cells": [40, 40], "shape": {"disc": {"radius": 19}}}}"#,
            r#"{"honeycomb": {"cells": [30, 30]}}"#,
        ] {
            let lattice = lattice(kind);
            for (terms, noise) in
                [(&[exchange, easy][..], 0.01), (&[exchange, easy, dmi], 0.01), (&[exchange, easy], 0.6)]
            {
                let h = hamiltonian(&lattice, terms);
                let mut band = Band::new(&h, walls(&lattice, noise));
                band.evaluate();
                let mut room = Iterated::by(
                    Arc::new(Iterated::stand_in(&h, band.ends(), 0.16).expect("factors are dear")),
                    TOLERANCE,
                );
                let mut y = vec![0.0; 3 * h.sites()];
                for k in 1..4 {
                    let uphill = y.clone();
                    room.prepare(&band, k, h.symmetry_axes(), 0.0);
                    let done = room.relax(&band, k, Some(&uphill), &mut y);
                    (tried, shifted) = (tried + 1, shifted + usize::from(done.shift > 0.1));
                    let (m, mut pull) = (band.path().image(k), Vec::new());
                    let g = pulled(&band, k, room.sigma, &mut pull);
                    assert!((slab::dot(&y, band.tangent(k)) - band.resolving_shift(k)).abs() < 1e-12);
                    assert!(room.equations.border[1..].iter().all(|z| slab::dot(z, &y).abs() < 1e-12));
                    let mut x = y.clone();
                    slab::add_scaled(&mut x, -band.resolving_shift(k), band.tangent(k));
                    assert!((longest(&x) - done.rotation).abs() < 1e-12);
                    let mut rest = vec![0.0; x.len()];
                    h.hessian_product(m, g, &x, &mut rest);
                    slab::add_scaled(&mut rest, done.shift, &x);
                    slab::add_scaled(&mut rest, -1.0, &room.equations.right);
                    remove(&mut rest, &room.equations.border);
                    let part = slab::norm(&rest) / slab::norm(&room.equations.right);
                    assert!(part < 1.001 * TOLERANCE, "{kind} {k}: {part:e}");
                }
            }
        }
        assert!(tried == 27 && (3..20).contains(&shifted), "{shifted} of {tried}");
    }
}
