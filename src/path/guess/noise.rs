//! Smooth seeded noise on a path, tangent to the spheres.
//!
//! ```text
//! v_i(t) = sin πt Σ_j w_j cos(π j (i + ½)/N),  j = 0 … 4,      m ← Exp_m(v − (v·m) m)
//! ```
//! along a row; in other lattices with the products of cosines along each direction, by cells, j = 0 … 2 for each,
//!
//! with w_j normally distributed: G. E. P. Box, M. E. Muller, Ann. Math. Statist. 29, 610 (1958), doi:10.1214/aoms/1177706645.

use super::clock::fraction;
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, exp, vector};
use crate::lattice::Lattice;
use crate::path::Path;
use crate::units::Angle;
use rand::{RngExt, SeedableRng};
use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

/// Cosines along a row, the constant one counted.
const IN_A_ROW: usize = 5;
/// Those along each direction of another lattice.
const EACH: usize = 3;

/// `{"amplitude": "2 deg", "seed": 1}`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoiseSpec {
    /// Standard deviation of each mode's amplitude, in the middle of the path.
    pub amplitude: Angle,
    /// Seed of the ChaCha8 generator.
    pub seed: u64,
}

/// The path with noise on all images but the ends; frozen spins stay.
pub fn add_noise(path: &Path, noise: &NoiseSpec, lattice: &Lattice) -> Path {
    let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(noise.seed);
    let mut gaussian = || {
        let (u, v): (f64, f64) = (r.random_range(f64::MIN_POSITIVE..1.0), r.random_range(0.0..TAU));
        (-2.0 * libm::log(u)).sqrt() * libm::cos(v)
    };
    let modes = modes(lattice);
    let weights: Vec<Vector> = modes.iter().map(|_| [0; 3].map(|_| noise.amplitude.0 * gaussian())).collect();
    let n = path.sites();
    let frozen = lattice.is_frozen();
    let field: Vec<Vector> = (0..n)
        .into_par_iter()
        .map(|i| {
            let (cell, size) = (lattice.cell(i).1, lattice.grid.size);
            let x = [0, 1, 2].map(|d| (cell[d] as f64 + 0.5) / size[d] as f64);
            let mode = |(j, w): (&[usize; 3], &Vector)| {
                let along = |d: usize| libm::cos(PI * j[d] as f64 * x[d]);
                vector::scale((0..3).filter(|d| j[*d] > 0).map(along).product(), *w)
            };
            if frozen[i] { [0.0; 3] } else { modes.iter().zip(&weights).map(mode).fold([0.0; 3], vector::add) }
        })
        .collect();
    let images = path.images();
    Path::build(images, n, |k, out| {
        out.copy_from_slice(path.image(k));
        if k == 0 || k + 1 == images {
            return;
        }
        let swell = libm::sin(PI * fraction(k, images));
        let m = Components::new(path.image(k));
        let mut out = ComponentsMut::new(out);
        for i in (0..n).filter(|i| field[*i] != [0.0; 3]) {
            let v = vector::scale(swell, field[i]);
            out.set(i, exp(m.get(i), vector::normal_part(v, m.get(i))));
        }
    })
}

/// The cosines of all modes, by direction.
fn modes(lattice: &Lattice) -> Vec<[usize; 3]> {
    let size = lattice.grid.size;
    let many = |d: usize| match size[d] {
        _ if lattice.is_row() => [IN_A_ROW, 1, 1][d],
        1 => 1,
        _ => EACH,
    };
    let all = (0..many(2)).flat_map(|c| (0..many(1)).flat_map(move |b| (0..many(0)).map(move |a| [a, b, c])));
    all.collect()
}
