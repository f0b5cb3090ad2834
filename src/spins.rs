//! A spin configuration: one unit vector a site.
//!
//! Inside, the components are contiguous, (xyz, site): x of every site, then y, then z, so that loops over
//! sites vectorise. At the border the usual (site, xyz) is spoken.

use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::geometry::vector::{Vector, unit};
use ndarray::{Array2, ArrayView2};
use rand::{RngExt, SeedableRng};
use serde::{Deserialize, Serialize, Serializer};
use std::f64::consts::TAU;

/// Unit vectors, one a site. Nothing here makes a vector that is not of unit length to rounding.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub struct Spins {
    m: Array2<f64>,
}

impl Spins {
    /// All sites along one direction.
    pub fn uniform(sites: usize, direction: Direction) -> Spins {
        let d = direction.vector();
        Spins { m: Array2::from_shape_fn((3, sites), |(c, _)| d[c]) }
    }

    /// Directions spread evenly over the sphere, from a seed of the ChaCha8 generator: z even on [−1, 1], azimuth even
    /// (Archimedes).
    pub fn random(sites: usize, seed: u64) -> Spins {
        let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
        let mut one = |_| {
            let z: f64 = r.random_range(-1.0..1.0);
            let (sin, cos) = libm::sincos(r.random_range(0.0..TAU));
            let across = (1.0 - z * z).sqrt();
            [across * cos, across * sin, z]
        };
        Spins::from_unit_vectors(&(0..sites).map(&mut one).collect::<Vec<_>>())
    }

    /// From one vector a site; each is normalised. An error where one has no direction.
    pub fn from_vectors(vectors: &[Vector]) -> Result<Spins> {
        let mut m = Array2::zeros((3, vectors.len()));
        for (i, &v) in vectors.iter().enumerate() {
            let u = unit(v).ok_or_else(|| {
                Error::invalid(format!("[{i}]"), format!("{v:?} has no direction: give three numbers, not all zero"))
            })?;
            for c in 0..3 {
                m[[c, i]] = u[c];
            }
        }
        Ok(Spins { m })
    }

    /// From component-major numbers x₀…, y₀…, z₀…; each vector is normalised.
    pub fn from_components(xyz: &[f64]) -> Result<Spins> {
        let n = xyz.len() / 3;
        if xyz.len() != 3 * n {
            return Err(Error::invalid("", format!("found {} numbers, but a spin has three components", xyz.len())));
        }
        let vectors: Vec<Vector> = (0..n).map(|i| [xyz[i], xyz[n + i], xyz[2 * n + i]]).collect();
        Spins::from_vectors(&vectors)
    }

    /// From component-major numbers that are unit vectors already.
    pub(crate) fn from_unit_components(xyz: &[f64]) -> Spins {
        let n = xyz.len() / 3;
        Spins { m: Array2::from_shape_fn((3, n), |(c, i)| xyz[c * n + i]) }
    }

    /// From one vector a site that is of unit length already.
    pub(crate) fn from_unit_vectors(vectors: &[Vector]) -> Spins {
        Spins { m: Array2::from_shape_fn((3, vectors.len()), |(c, i)| vectors[i][c]) }
    }

    /// Number of sites.
    pub fn sites(&self) -> usize {
        self.m.ncols()
    }

    /// The vector on site `i`.
    ///
    /// # Panics
    /// Where there is no such site.
    pub fn get(&self, i: usize) -> Vector {
        [self.m[[0, i]], self.m[[1, i]], self.m[[2, i]]]
    }

    /// The vectors, site by site.
    pub fn vectors(&self) -> Vec<Vector> {
        (0..self.sites()).map(|i| self.get(i)).collect()
    }

    /// Their mean, vacant sites left out.
    ///
    /// # Panics
    /// Where `vacant` is of fewer sites.
    pub fn mean(&self, vacant: &[bool]) -> Vector {
        let there = || (0..self.sites()).filter(|i| !vacant[*i]);
        let count = there().count().max(1) as f64;
        [0, 1, 2].map(|c| there().map(|i| self.m[[c, i]]).sum::<f64>() / count)
    }

    /// View of shape (xyz, site).
    pub fn view(&self) -> ArrayView2<'_, f64> {
        self.m.view()
    }

    /// Component-major numbers: x of all sites, then y, then z.
    pub fn as_slice(&self) -> &[f64] {
        self.m.as_slice().expect("standard layout")
    }
}

impl Serialize for Spins {
    /// Component-major.
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        self.as_slice().serialize(serializer)
    }
}

impl TryFrom<Vec<f64>> for Spins {
    type Error = &'static str;

    /// From component-major numbers that are unit vectors already, to the bit.
    fn try_from(m: Vec<f64>) -> std::result::Result<Spins, &'static str> {
        if are_unit(&m) { Ok(Spins::from_unit_components(&m)) } else { Err("spins are unit vectors") }
    }
}

/// Whether component-major numbers are unit vectors.
pub(crate) fn are_unit(m: &[f64]) -> bool {
    let n = m.len() / 3;
    m.len() == 3 * n && (0..n).all(|i| ((0..3).map(|c| m[c * n + i].powi(2)).sum::<f64>() - 1.0).abs() < 1e-9)
}
