//! The force on a path: the geodesic nudged elastic band.
//!
//! ```text
//!      F∥ = spacing along τ            τ  improved tangent, in the product of tangent planes, |τ| = 1
//!   ●───────●───────●───────●          g  Euclidean gradient;  F = −P g  force on the spheres
//!   fixed   │F⊥     │F⊥     fixed      F⊥ = F − (F·τ) τ,  zero on a minimum-energy path
//!           ▼       ▼
//! ```
//! Bessarab, Uzdin, Jónsson, Comput. Phys. Commun. 196, 335 (2015), doi:10.1016/j.cpc.2015.07.001 (distances and
//! projections on spheres); Henkelman, Jónsson, J. Chem. Phys. 113, 9978 (2000), doi:10.1063/1.1323224 (tangent);
//! Henkelman, Uberuaga, Jónsson, J. Chem. Phys. 113, 9901 (2000), doi:10.1063/1.1329672 (climbing image).

mod gauge;
mod iterated;
mod laplacian;
mod linearised;
mod profile;
mod split;
mod springs;
mod sweep;
mod tangent;
mod upwind;

pub use laplacian::Laplacian;
pub use profile::{Extremum, Profile};
pub use sweep::{Sweep, SweepStep};

use crate::energy::{Evaluator, Hamiltonian};
use crate::field::Components;
use crate::geometry::Vector;
use crate::path::Path;
use crate::sphere::angles_between;
use crate::threads::{MADE, READ, apiece};
use rayon::prelude::*;
use split::Split;

/// Numbers of a field of all images that are worth giving back.
const LARGE: usize = 1 << 22;

/// A path with the energies, forces and tangents of its images. The two ends never move.
#[derive(Debug)]
pub struct Band<'h> {
    hamiltonian: Evaluator<'h>,
    path: Path,
    energy: Vec<f64>,
    gradient: Vec<f64>,
    tangent: Vec<f64>,
    perpendicular: Vec<f64>,
    along: Vec<f64>,
    chord: Vec<[f64; 2]>,
    largest: Vec<f64>,
    uphill: Vec<Option<usize>>,
    spacing: Vec<f64>,
    widest: Vec<f64>,
    held: Vec<bool>,
    /// Those of them that symmetry rotations leave as they are, too.
    fixed: Vec<bool>,
    evaluations: usize,
    /// While it rests.
    profile: Option<Profile>,
}

impl<'h> Band<'h> {
    /// The band of a path; the two ends are evaluated, the images between them not yet.
    pub fn new(hamiltonian: impl Into<Evaluator<'h>>, path: Path) -> Band<'h> {
        let hamiltonian = hamiltonian.into();
        let images = path.images();
        let mut band = Band {
            hamiltonian,
            energy: vec![0.0; images],
            gradient: Vec::new(),
            tangent: Vec::new(),
            perpendicular: Vec::new(),
            along: vec![0.0; images],
            chord: vec![[0.0; 2]; images],
            largest: vec![0.0; images],
            uphill: vec![None; images],
            spacing: vec![0.0; images - 1],
            widest: vec![0.0; images - 1],
            held: vec![false; images],
            fixed: vec![false; images],
            evaluations: 0,
            profile: None,
            path,
        };
        band.make_room();
        band
    }

    /// Makes room for the fields, with the gradients of the two ends.
    fn make_room(&mut self) {
        let (slab, last) = (3 * self.path.sites(), self.path.images() - 1);
        for field in [&mut self.gradient, &mut self.tangent, &mut self.perpendicular] {
            *field = vec![0.0; (last + 1) * slab];
        }
        for end in [0, last] {
            let gradient = &mut self.gradient[end * slab..(end + 1) * slab];
            self.energy[end] = self.hamiltonian.energy_gradient(self.path.image(end), gradient);
        }
    }

    /// The band of a path that continues a relaxation of `evaluations` evaluations.
    pub fn continued(hamiltonian: impl Into<Evaluator<'h>>, path: Path, evaluations: usize) -> Band<'h> {
        Band { evaluations, ..Band::new(hamiltonian, path) }
    }

    /// Gives back the memory of all but the images, their energies and the profile, where that is much, until
    /// [`wake`](Self::wake): bands that wait for their turn.
    pub fn rest(&mut self) {
        if self.gradient.len() > LARGE {
            self.give_back();
        }
    }

    fn give_back(&mut self) {
        self.profile = Some(self.profile());
        let fields = [&mut self.gradient, &mut self.tangent, &mut self.perpendicular];
        fields.into_iter().for_each(|field| *field = Vec::new());
    }

    /// Evaluates anew what [`rest`](Self::rest) gave back, if it did.
    pub fn wake(&mut self) {
        if self.gradient.is_empty() {
            self.profile = None;
            self.make_room();
            self.evaluate();
            self.evaluations -= 1;
        }
    }

    /// One evaluation of the whole band where its images now are.
    pub fn evaluate(&mut self) {
        let (slab, last) = (3 * self.path.sites(), self.path.images() - 1);
        let (h, path) = (self.hamiltonian, &self.path);
        let energies: Vec<f64> = self.gradient[slab..last * slab]
            .par_chunks_mut(slab)
            .with_min_len(apiece(slab, READ))
            .enumerate()
            .map(|(k, g)| h.energy_gradient(path.image(k + 1), g))
            .collect();
        self.energy[1..last].copy_from_slice(&energies);
        self.split_forces();
        self.evaluations += 1;
    }

    /// Tangents, distances, and the force split along and across the path.
    fn split_forces(&mut self) {
        let (slab, last) = (3 * self.path.sites(), self.path.images() - 1);
        let (h, path, energy, gradient) = (self.hamiltonian, &self.path, &self.energy, &self.gradient);
        let held = &self.held;
        let inner = slab..last * slab;
        let tangent = self.tangent[inner.clone()].par_chunks_mut(slab);
        let across = self.perpendicular[inner].par_chunks_mut(slab);
        let split: Vec<Split> = tangent
            .zip(across)
            .with_min_len(apiece(slab, MADE))
            .enumerate()
            .map(|(k, (t, f))| {
                let k = k + 1;
                let gradient = &gradient[k * slab..(k + 1) * slab];
                split::image(&h, [k - 1, k, k + 1].map(|k| path.image(k)), tangent::weights(energy, k), gradient, t, f)
            })
            .collect();
        let (squares, widest) = angles_between(Components::new(path.image(0)), Components::new(path.image(1)));
        (self.spacing[0], self.widest[0]) = (squares.sqrt(), widest);
        for (k, s) in split.iter().enumerate() {
            (self.along[k + 1], self.largest[k + 1], self.chord[k + 1]) = (s.along, s.largest, s.chord);
            (self.spacing[k + 1], self.widest[k + 1]) = s.after;
        }
        for k in (1..last).filter(|&k| held[k]) {
            self.perpendicular[k * slab..(k + 1) * slab].fill(0.0);
            self.largest[k] = 0.0;
        }
        self.uphill = tangent::uphill_neighbours(&self.energy);
    }

    /// What the energies come from.
    pub fn hamiltonian(&self) -> &'h Hamiltonian {
        self.hamiltonian.hamiltonian()
    }

    /// The energy, as counted and stopped.
    pub fn evaluator(&self) -> Evaluator<'h> {
        self.hamiltonian
    }

    /// The images.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts all images where they were after `evaluations` evaluations of an earlier band; they are not evaluated.
    pub(crate) fn restore(&mut self, images: &[f64], evaluations: usize) {
        self.path.as_mut_slice().copy_from_slice(images);
        self.evaluations = evaluations;
    }

    /// Puts a saddle in the place of image k, where it stays: the stretches on its two sides relax on their own.
    pub fn hold(&mut self, k: usize, saddle: &[f64]) {
        let n = saddle.len();
        self.path.as_mut_slice()[k * n..(k + 1) * n].copy_from_slice(saddle);
        self.held[k] = true;
    }

    /// Puts a stationary state of a path that is put together in the place of image k: it stays, and is not turned about symmetry axes,
    /// as its neighbours are at hand as they are to be.
    pub fn fix(&mut self, k: usize, state: &[f64]) {
        self.hold(k, state);
        self.fixed[k] = true;
    }

    /// Turns every image between the ends about the given symmetry axes towards a neighbour.
    pub fn align(&mut self, axes: &[Vector]) {
        gauge::align_rotations(&mut self.path, axes, &self.fixed);
    }

    /// Whether image k is a saddle that stays.
    pub fn is_held(&self, k: usize) -> bool {
        self.held[k]
    }

    /// The images, given back.
    pub fn into_path(self) -> Path {
        self.path
    }

    /// The images between the ends, all numbers of them, to be moved by an optimiser.
    pub fn inner_mut(&mut self) -> &mut [f64] {
        let (slab, last) = (3 * self.path.sites(), self.path.images() - 1);
        &mut self.path.as_mut_slice()[slab..last * slab]
    }

    /// Number of images, both ends counted.
    pub fn images(&self) -> usize {
        self.path.images()
    }

    /// Energy of every image above the Hamiltonian's reference (meV).
    pub fn energies_mev(&self) -> &[f64] {
        &self.energy
    }

    /// Euclidean gradient of image k (meV).
    pub fn gradient(&self, k: usize) -> &[f64] {
        self.slab(&self.gradient, k)
    }

    /// The two ends.
    fn ends(&self) -> [&[f64]; 2] {
        [0, self.images() - 1].map(|k| self.path.image(k))
    }

    /// Tangent of image k, of unit length over all 3N components.
    pub fn tangent(&self, k: usize) -> &[f64] {
        self.slab(&self.tangent, k)
    }

    /// Force across the path at image k (meV).
    pub fn perpendicular(&self, k: usize) -> &[f64] {
        self.slab(&self.perpendicular, k)
    }

    /// Force along the tangent at image k (meV/rad).
    pub fn along(&self, k: usize) -> f64 {
        self.along[k]
    }

    /// |m_u − m| and |P (m_u − m)| of image k on a slope and its neighbour uphill: the straight distance, and √Σ sin² of the angles.
    pub fn chord(&self, k: usize) -> [f64; 2] {
        self.chord[k]
    }

    /// The neighbour uphill of image k on a monotone slope; none at an extremum.
    pub fn uphill(&self, k: usize) -> Option<usize> {
        self.uphill[k]
    }

    /// Distances between neighbours (rad).
    pub fn spacings(&self) -> &[f64] {
        &self.spacing
    }

    /// The largest rotation of a spin from image k to the next (rad).
    pub fn widest(&self, k: usize) -> f64 {
        self.widest[k]
    }

    /// Evaluations of the whole band so far.
    pub fn evaluations(&self) -> usize {
        self.evaluations
    }

    /// Largest component of the force across the path at image k (meV).
    pub fn force(&self, k: usize) -> f64 {
        self.largest[k]
    }

    /// Largest component of the force across the path (meV).
    pub fn max_perpendicular_mev(&self) -> f64 {
        self.largest.iter().fold(0.0, |m, x| if x.is_nan() { f64::NAN } else { x.max(m) })
    }

    /// The highest image between the ends.
    pub fn highest(&self) -> usize {
        let inner = 1..self.images() - 1;
        inner.fold(1, |top, k| if self.energy[k] > self.energy[top] { k } else { top })
    }

    /// The energy between images, by cubic Hermite pieces with the slopes −F·τ.
    pub fn profile(&self) -> Profile {
        self.profile.clone().unwrap_or_else(|| Profile::of(self))
    }

    fn slab<'a>(&self, data: &'a [f64], k: usize) -> &'a [f64] {
        let n = 3 * self.path.sites();
        &data[k * n..(k + 1) * n]
    }
}

#[cfg(test)]
mod tests {
    use super::Band;
    use crate::energy::test_terms::{hamiltonian, lattice};
    use crate::path::Path;
    use crate::spins::Spins;

    #[test]
    fn a_band_that_rested_is_what_it_was() {
        let lattice = lattice(r#"{"square": {"cells": [4, 3]}}"#);
        let easy = r#"{"anisotropy": {"K": "0.3 meV", "axis": [0, 0, 1]}}"#;
        let h = hamiltonian(&lattice, &[r#"{"exchange": {"J": ["1 meV"]}}"#, easy]);
        let images: Vec<Spins> = (0..5).map(|k| Spins::random(lattice.sites, k)).collect();
        let mut band = Band::new(&h, Path::new(&images));
        band.hold(2, images[2].as_slice());
        band.evaluate();
        let told = |band: &Band| {
            let fields = (0..5).flat_map(|k| [band.gradient(k), band.tangent(k), band.perpendicular(k)].concat());
            let bits: Vec<u64> = fields.chain(band.energies_mev().iter().copied()).map(f64::to_bits).collect();
            (bits, band.evaluations(), band.is_held(2), band.force(2).to_bits(), band.profile().highest_mev().to_bits())
        };
        let before = told(&band);
        band.give_back();
        assert!(band.gradient.is_empty() && band.profile().highest_mev().to_bits() == before.4);
        band.wake();
        assert_eq!(told(&band), before);
        band.rest();
        assert!(!band.gradient.is_empty(), "so few numbers are not worth it");
    }
}
