//! One image of the linearised band without its factors, by conjugate gradients in the complement of C, the tangent and the zero
//! modes:
//!
//! ```text
//! P A P x = P (F⊥ + σ y_u − A d τ),   P = 1 − C Cᵀ,   A = H + (σ + μ)·1,   y = d τ + x
//! ```
//! preconditioned by P M⁻¹ P (see `stand_in`), until a hundredth of the residual is left: the next evaluation changes the right-hand
//! side by more. A direction of negative curvature on the way makes μ grow, as a negative pivot does where there are factors. (T.
//! Steihaug, SIAM J. Numer. Anal. 20, 626 (1983), doi:10.1137/0720042, for conjugate gradients that end so; R. S. Dembo, S. C.
//! Eisenstat, T. Steihaug, SIAM J. Numer. Anal. 19, 400 (1982), doi:10.1137/0719025, for how far they are to go.)

use super::Band;
use super::linearised::{LEAST, Move, SHIFT_TRIES, first_shift, upwind_rate};
use super::stand_in::StandIn;
use crate::field::{Components, project};
use crate::geometry::{Vector, vector};
use crate::linalg::{orthonormal, remove, slab};
use std::sync::Arc;

/// The residual that is left.
const TOLERANCE: f64 = 1e-2;
/// Most products with A.
const PRODUCTS: usize = 100;

/// An image with room for its linear algebra: fields of 3N numbers.
#[derive(Debug)]
pub struct Iterated {
    /// M.
    stand_in: Arc<StandIn>,
    /// C.
    border: Vec<Vec<f64>>,
    sigma: f64,
    shift: f64,
    right: Vec<f64>,
    x: Vec<f64>,
    residual: Vec<f64>,
    /// P M⁻¹ P of the residual.
    towards: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    room: Vec<f64>,
}

impl Iterated {
    /// Nothing yet, but for M.
    pub fn by(stand_in: Arc<StandIn>) -> Iterated {
        let [right, x, residual, towards, direction, image, room] = [(); 7].map(|()| Vec::new());
        let (border, sigma, shift) = (Vec::new(), 0.0, 0.0);
        Iterated { stand_in, border, sigma, shift, right, x, residual, towards, direction, image, room }
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
        self.border = orthonormal(columns, LEAST);
        for field in [&mut self.x, &mut self.towards, &mut self.direction, &mut self.image] {
            field.resize(3 * m.sites(), 0.0);
        }
    }

    /// Writes the move `y` (3N, rad) of image k, pushed across the path, shifted along it, and dragged by σ times the move of its
    /// uphill neighbour, if that moves.
    pub fn relax(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>, y: &mut [f64]) -> Move {
        self.set_right_side(band, k, uphill);
        for _ in 1..SHIFT_TRIES {
            if self.solve(band, k) {
                break;
            }
            self.shift = (4.0 * self.shift).max(self.stand_in.c);
        }
        let rotation = longest(&self.x);
        y.copy_from_slice(&self.x);
        slab::add_scaled(y, band.local_shift(k), band.tangent(k));
        Move { rotation, shift: self.shift, factorisations: 0 }
    }

    /// P (F⊥ + σ y_u − A d τ).
    fn set_right_side(&mut self, band: &Band, k: usize, uphill: Option<&[f64]>) {
        let m = band.path().image(k);
        self.right.clear();
        self.right.extend_from_slice(band.perpendicular(k));
        if let Some(uphill) = uphill {
            slab::add_scaled(&mut self.right, self.sigma, uphill);
        }
        let along = band.local_shift(k);
        if along != 0.0 {
            // what A adds to H d τ is along τ
            band.hamiltonian().hessian_product(m, band.gradient(k), band.tangent(k), &mut self.image);
            slab::add_scaled(&mut self.right, -along, &self.image);
        }
        project(m, &mut self.right);
        band.hamiltonian().hold_frozen(&mut self.right);
        remove(&mut self.right, &self.border);
    }

    /// Solves for x; whether no direction of negative curvature was met.
    fn solve(&mut self, band: &Band, k: usize) -> bool {
        let (h, m, g) = (band.hamiltonian(), band.path().image(k), band.gradient(k));
        self.x.fill(0.0);
        self.residual.clone_from(&self.right);
        self.precondition(m);
        self.direction.copy_from_slice(&self.towards);
        let mut fall = slab::dot(&self.residual, &self.towards);
        let enough = TOLERANCE * slab::norm(&self.residual);
        for _ in 0..PRODUCTS {
            if fall <= 0.0 {
                // what is left turns no spin; what is no number goes on, to be seen by who asked
                break;
            }
            h.hessian_product(m, g, &self.direction, &mut self.image);
            slab::add_scaled(&mut self.image, self.sigma + self.shift, &self.direction);
            remove(&mut self.image, &self.border);
            let curvature = slab::dot(&self.direction, &self.image);
            if curvature <= 0.0 {
                return false;
            }
            let step = fall / curvature;
            slab::add_scaled(&mut self.x, step, &self.direction);
            slab::add_scaled(&mut self.residual, -step, &self.image);
            let left = slab::norm(&self.residual);
            if left <= enough || left.is_nan() {
                break;
            }
            self.precondition(m);
            let before = std::mem::replace(&mut fall, slab::dot(&self.residual, &self.towards));
            slab::scale(&mut self.direction, fall / before);
            slab::add_scaled(&mut self.direction, 1.0, &self.towards);
        }
        true
    }

    fn precondition(&mut self, m: &[f64]) {
        self.stand_in.solve(self.sigma + self.shift, &self.residual, &mut self.towards, &mut self.room);
        project(m, &mut self.towards);
        remove(&mut self.towards, &self.border);
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
    use crate::energy::{Hamiltonian, Medium, TermSpec};
    use crate::lattice::{Lattice, LatticeSpec};
    use crate::path::Path;
    use crate::spins::Spins;
    use rand::{RngExt, SeedableRng};

    fn film(lattice: &Lattice, terms: &[&str]) -> Hamiltonian {
        let medium = Medium::new(lattice, None, None);
        let term = |text: &&str| serde_json::from_str::<TermSpec>(text).unwrap().member().build(&medium).unwrap();
        Hamiltonian::new(lattice, terms.iter().map(term).collect()).unwrap()
    }

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
        let lattice = serde_json::from_str::<LatticeSpec>(spec).unwrap().resolve().unwrap();
        let easy = r#"{"anisotropy": {"K": "0.08 meV", "axis": [0, 0, 1]}}"#;
        let h = film(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        // the last has radial forces alone, of rounding: towards the poles all images are uniform
        let images = [0.0, 0.3, 0.6, 1e-9, 1e-13, 0.0].map(|angle: f64| {
            let m = vec![[angle.sin(), 0.0, angle.cos()]; lattice.sites];
            let flat: Vec<f64> = (0..3).flat_map(|c| m.iter().map(move |v| v[c])).collect();
            Spins::from_components(&flat).unwrap()
        });
        let mut band = Band::new(&h, Path::new(&images));
        band.evaluate();
        let mut room = Iterated::by(Arc::new(StandIn::of(&band, 0.16).expect("factors are dear")));
        let mut y = vec![0.0; 3 * h.sites()];
        for k in 1..5 {
            room.prepare(&band, k, h.symmetry_axes(), 0.0);
            let uphill = vec![if k == 4 { 1e-15 } else { 0.0 }; y.len()];
            let done = room.relax(&band, k, Some(&uphill), &mut y);
            assert!(done.rotation < 1e-8, "{k}: {}", done.rotation);
        }
    }

    #[test]
    fn a_move_solves_the_bordered_equations_of_its_image_to_a_hundredth() {
        let exchange = r#"{"exchange": {"J": ["1 meV", "-0.1 meV"]}}"#;
        let easy = r#"{"anisotropy": {"K": "0.08 meV", "axis": [0, 0, 1]}}"#;
        let dmi = r#"{"dmi": {"D": "0.2 meV", "kind": "interfacial"}}"#;
        let (mut tried, mut shifted) = (0, 0);
        for kind in [
            r#"{"square": {"cells": [40, 40], "periodic": [false, true]}}"#,
            r#"{"triangular": {"cells": [40, 40], "shape": {"disc": {"radius": 19}}}}"#,
            r#"{"honeycomb": {"cells": [30, 30]}}"#,
        ] {
            let lattice = serde_json::from_str::<LatticeSpec>(kind).unwrap().resolve().unwrap();
            for (terms, noise) in
                [(&[exchange, easy][..], 0.01), (&[exchange, easy, dmi], 0.01), (&[exchange, easy], 0.6)]
            {
                let h = film(&lattice, terms);
                let mut band = Band::new(&h, walls(&lattice, noise));
                band.evaluate();
                let mut room = Iterated::by(Arc::new(StandIn::of(&band, 0.16).expect("factors are dear")));
                let mut y = vec![0.0; 3 * h.sites()];
                for k in 1..4 {
                    let uphill = y.clone();
                    room.prepare(&band, k, h.symmetry_axes(), 0.0);
                    let done = room.relax(&band, k, Some(&uphill), &mut y);
                    (tried, shifted) = (tried + 1, shifted + usize::from(done.shift > 0.1));
                    let (m, g) = (band.path().image(k), band.gradient(k));
                    assert!((slab::dot(&y, band.tangent(k)) - band.local_shift(k)).abs() < 1e-12);
                    assert!(room.border[1..].iter().all(|z| slab::dot(z, &y).abs() < 1e-12));
                    let mut x = y.clone();
                    slab::add_scaled(&mut x, -band.local_shift(k), band.tangent(k));
                    assert!((longest(&x) - done.rotation).abs() < 1e-12);
                    let mut rest = vec![0.0; x.len()];
                    h.hessian_product(m, g, &x, &mut rest);
                    slab::add_scaled(&mut rest, room.sigma + done.shift, &x);
                    slab::add_scaled(&mut rest, -1.0, &room.right);
                    remove(&mut rest, &room.border);
                    let part = slab::norm(&rest) / slab::norm(&room.right);
                    assert!(part < 1.001 * TOLERANCE, "{kind} {k}: {part:e}");
                }
            }
        }
        assert!(tried == 27 && (3..20).contains(&shifted), "{shifted} of {tried}");
    }
}
