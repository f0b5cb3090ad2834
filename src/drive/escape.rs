//! Away from saddles of higher index.

use crate::band::Band;
use crate::field::project;
use crate::landscape::Saddle;
use crate::linalg::{slab, soft_modes};
use crate::path::Path;
use crate::sphere::{move_points, rotation_of};
use crate::stationary::{ALIKE, FEW};

/// How far a path is pushed off a saddle of higher index (rad).
const PUSH: f64 = 0.8;

/// Two paths pushed off a stationary point of index > 1, along its lowest negative mode other than the path's own, both ways.
pub fn escapes(band: &Band, found: &Saddle, c: f64) -> Vec<Path> {
    let state = &found.refined.state;
    let enough = -ALIKE * c;
    if band.hamiltonian().forgoes_factors() {
        return Vec::new();
    }
    let modes = soft_modes(&state.hessian, FEW, &state.zeros, enough);
    let negative: Vec<_> = modes.into_iter().filter(|m| m.value < enough).collect();
    if negative.len() < 2 {
        return Vec::new();
    }
    let mut along = found.top.tau.clone();
    project(&state.m, &mut along);
    let along = state.basis.coordinates(&along);
    let overlap = |v: &[f64]| slab::dot(v, &along).abs();
    let own =
        (0..negative.len()).max_by(|&i, &j| overlap(&negative[i].vector).total_cmp(&overlap(&negative[j].vector)));
    let Some(other) = (0..negative.len()).find(|i| Some(*i) != own) else { return Vec::new() };
    let mut mode = state.field(&negative[other].vector);
    band.hamiltonian().hold_frozen(&mut mode);
    [PUSH, -PUSH].map(|push| pushed(band.path(), &mode, push)).into()
}

/// The path with every image moved along the mode's tangent part, sin(πs) as far, and resampled.
fn pushed(path: &Path, mode: &[f64], push: f64) -> Path {
    let last = path.images() - 1;
    let mut out = path.clone();
    let slab_size = mode.len();
    for k in 1..last {
        let mut v = mode.to_vec();
        project(path.image(k), &mut v);
        let size = rotation_of(&v);
        if size > 0.0 {
            let far = push * libm::sin(std::f64::consts::PI * k as f64 / last as f64) / size;
            let image = &mut out.as_mut_slice()[k * slab_size..(k + 1) * slab_size];
            move_points(image, &v, slab_size, far);
        }
    }
    out.resampled(path.images())
}
