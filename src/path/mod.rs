//! A path: a row of spin configurations from an initial to a final state.
//!
//! Distances are geodesic in the product of spheres, L(a, b) = √Σ_i θ_i² (Bessarab, Uzdin, Jónsson, Comput. Phys.
//! Commun. 196, 335 (2015), doi:10.1016/j.cpc.2015.07.001); the reaction coordinate is their running sum, in rad.

pub mod guess;
mod resample;
mod turns;

pub use resample::blend;
pub use turns::{turned, turns};

use crate::field::Components;
use crate::geometry::vector;
use crate::sphere::angles_between;
use crate::spins::{Spins, are_unit};
use crate::threads::{READ, apiece};
use ndarray::Array3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize, Serializer};

/// Neighbouring images that are no further apart (rad, any spin) resolve a path.
pub const RESOLVED: f64 = 1.0;

/// Images of a path that is only to be looked at.
pub const COARSE: usize = 9;

/// Images along a path. Inside (image, xyz, site), so that an image is one contiguous slab of 3N numbers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "(usize, Vec<f64>)")]
pub struct Path {
    m: Array3<f64>,
}

impl Path {
    /// From configurations of the same number of sites, at least two where they lead anywhere.
    ///
    /// # Panics
    /// Where there is none, or they are of different numbers of sites.
    pub fn new(images: &[Spins]) -> Path {
        assert!(!images.is_empty(), "a path without images");
        let n = images[0].sites();
        assert!(images.iter().all(|image| image.sites() == n), "images of different numbers of sites");
        let mut m = Array3::zeros((images.len(), 3, n));
        for (k, s) in images.iter().enumerate() {
            m.index_axis_mut(ndarray::Axis(0), k).assign(&s.view());
        }
        Path { m }
    }

    /// Number of images, both ends counted.
    pub fn images(&self) -> usize {
        self.m.dim().0
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.m.dim().2
    }

    /// All numbers, image after image.
    pub fn as_slice(&self) -> &[f64] {
        self.m.as_slice().expect("made in standard layout")
    }

    /// All numbers, image after image, to be moved. The caller keeps the vectors at unit length.
    pub(crate) fn as_mut_slice(&mut self) -> &mut [f64] {
        self.m.as_slice_mut().expect("made in standard layout")
    }

    /// Image `k`, component-major.
    ///
    /// # Panics
    /// Where there is no such image.
    pub fn image(&self, k: usize) -> &[f64] {
        let n = 3 * self.sites();
        &self.as_slice()[k * n..(k + 1) * n]
    }

    /// Image `k` as a configuration.
    ///
    /// # Panics
    /// Where there is no such image.
    pub fn spins(&self, k: usize) -> Spins {
        Spins::from_unit_components(self.image(k))
    }

    /// The spins as (image, site, xyz).
    pub fn to_image_site_xyz(&self) -> Array3<f64> {
        self.m.clone().permuted_axes([0, 2, 1]).as_standard_layout().into_owned()
    }

    /// Distances between neighbouring images (rad), one fewer than images.
    pub fn spacings(&self) -> Vec<f64> {
        self.steps(distance)
    }

    /// The largest rotation of any spin between neighbouring images (rad).
    pub fn largest_rotation(&self) -> f64 {
        self.steps(largest_angle).into_iter().fold(0.0, f64::max)
    }

    /// The longest of the steps between neighbouring images in which any spin turns by more than that (rad); 0 if none does.
    pub fn longest_step(&self, turns: f64) -> f64 {
        let steps = self.steps(|a, b| if largest_angle(a, b) > turns { distance(a, b) } else { 0.0 });
        steps.into_iter().fold(0.0, f64::max)
    }

    /// Whether its images resolve it.
    pub fn is_resolved(&self) -> bool {
        self.largest_rotation() <= RESOLVED
    }

    /// The largest rotations of any spin from image to image, all together (rad).
    pub fn rotation(&self) -> f64 {
        self.steps(largest_angle).into_iter().sum()
    }

    /// How far neighbouring images are apart, by any measure.
    fn steps(&self, measure: impl Fn(&[f64], &[f64]) -> f64 + Sync) -> Vec<f64> {
        let pairs = (1..self.images()).into_par_iter().with_min_len(apiece(3 * self.sites(), READ));
        pairs.map(|k| measure(self.image(k - 1), self.image(k))).collect()
    }

    /// Distances of all images from a configuration (rad).
    pub fn distances_from(&self, m: &[f64]) -> Vec<f64> {
        let images = (0..self.images()).into_par_iter().with_min_len(apiece(m.len(), READ));
        images.map(|k| distance(self.image(k), m)).collect()
    }

    /// Total length (rad).
    pub fn length(&self) -> f64 {
        self.spacings().iter().sum()
    }

    /// Running length at each image (rad), from 0.
    pub fn reaction_coordinate(&self) -> Vec<f64> {
        let mut s = vec![0.0];
        for l in self.spacings() {
            s.push(s[s.len() - 1] + l);
        }
        s
    }
}

/// Geodesic distance √Σθ² of two configurations (rad).
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    angles_between(Components::new(a), Components::new(b)).0.sqrt()
}

/// The largest angle between spins of the same site (rad).
pub fn largest_angle(a: &[f64], b: &[f64]) -> f64 {
    angles_between(Components::new(a), Components::new(b)).1
}

/// Whether no spin's place in one is farther than this from its place in the other (length of the chord); stops at the first that is.
pub fn is_within(a: &[f64], b: &[f64], chord: f64) -> bool {
    let (p, q) = (Components::new(a), Components::new(b));
    (0..a.len() / 3).all(|i| vector::norm(vector::sub(p.get(i), q.get(i))) < chord)
}

impl Serialize for Path {
    /// The number of images, and all numbers, image after image.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        (self.images(), self.as_slice()).serialize(serializer)
    }
}

impl TryFrom<(usize, Vec<f64>)> for Path {
    type Error = &'static str;

    fn try_from((images, m): (usize, Vec<f64>)) -> Result<Path, &'static str> {
        let slab = m.len() / images.max(1);
        let is_path = images >= 2 && slab > 0 && m.len() == images * slab && m.chunks(slab).all(are_unit);
        let m = is_path.then(|| Array3::from_shape_vec((images, 3, slab / 3), m).ok()).flatten();
        m.map(|m| Path { m }).ok_or("a path is two images or more of as many spins")
    }
}
