//! Smooth seeded noise on a path: sin πs along it, a few cosines along the chain, tangent to the spheres.

use crate::field::{Components, ComponentsMut};
use crate::geometry::{exp, vector};
use crate::lattice::Chain;
use crate::path::Path;
use crate::units::Angle;
use rand::{RngExt, SeedableRng};
use serde::Deserialize;
use std::f64::consts::{PI, TAU};

/// Cosines along the chain, the constant one counted.
const MODES: usize = 5;

/// `{"amplitude": "2 deg", "seed": 1}`.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoiseSpec {
    /// Standard deviation of each mode's amplitude, in the middle of the path.
    pub amplitude: Angle,
    /// Seed of the ChaCha8 generator.
    pub seed: u64,
}

/// The path with noise on all images but the ends; frozen spins stay.
pub fn add_noise(path: &Path, noise: &NoiseSpec, chain: &Chain) -> Path {
    let mut r = rand_chacha::ChaCha8Rng::seed_from_u64(noise.seed);
    let mut gaussian = || {
        let (u, v): (f64, f64) = (r.random_range(f64::MIN_POSITIVE..1.0), r.random_range(0.0..TAU));
        (-2.0 * libm::log(u)).sqrt() * libm::cos(v)
    };
    let weights: Vec<[f64; 3]> = (0..MODES).map(|_| [0; 3].map(|_| noise.amplitude.0 * gaussian())).collect();
    let mut frozen = vec![false; path.sites()];
    for f in &chain.frozen {
        for i in f.sites.indices(chain.sites, "site").unwrap_or_default() {
            frozen[i] = true;
        }
    }
    let last = path.images() - 1;
    Path::build(path.images(), path.sites(), |k, out| {
        out.copy_from_slice(path.image(k));
        if k == 0 || k == last {
            return;
        }
        let swell = libm::sin(PI * k as f64 / last as f64);
        let m = Components::new(path.image(k));
        let mut out = ComponentsMut::new(out);
        for i in (0..m.sites()).filter(|&i| !frozen[i]) {
            let x = (i as f64 + 0.5) / m.sites() as f64;
            let modes = weights.iter().enumerate();
            let v = modes
                .fold([0.0; 3], |v, (j, w)| vector::add(v, vector::scale(swell * libm::cos(PI * j as f64 * x), *w)));
            out.set(i, exp(m.get(i), vector::normal_part(v, m.get(i))));
        }
    })
}
