//! The rotation gauge: images of a system with a symmetry axis may turn freely about it; each is turned to lie as near to
//! its predecessor as possible.
//!
//! Without it a start with azimuthal noise does not relax, at any length. Where the energy has no axis
//! at all (full rotation symmetry) the three axes are treated in turn, a few times.

use crate::field::{Components, ComponentsMut};
use crate::geometry::Vector;
use crate::path::Path;
use crate::sphere::turn_towards;
use crate::threads::{READ, apiece};
use multiversion::multiversion;
use rayon::prelude::*;

/// Turns every image between the ends, but those that are `fixed`, about the given symmetry axes towards the image before it.
pub(super) fn align_rotations(path: &mut Path, axes: &[Vector], fixed: &[bool]) {
    let rounds = if axes.len() > 1 { 4 } else { 1 };
    let slab = 3 * path.sites();
    let mut known = axes.first().map_or(Vec::new(), |axis| overlaps_as_they_are(path, *axis));
    for k in (1..path.images() - 1).filter(|k| !fixed[*k]) {
        let (before, rest) = path.as_mut_slice().split_at_mut(k * slab);
        let (reference, image) = (&before[(k - 1) * slab..], &mut rest[..slab]);
        let mut turned = false;
        for _ in 0..rounds {
            for &axis in axes {
                // what is known is of the first axis, before any turn
                let turn = known[k - 1]
                    .take()
                    .unwrap_or_else(|| turn_towards(Components::new(image), Components::new(reference), axis));
                turned |= turn_by(image, axis, turn);
            }
        }
        if turned && let Some(next) = known.get_mut(k) {
            *next = None;
        }
    }
}

/// The turns of all images but the last towards the one before, as long as that has not been turned itself.
fn overlaps_as_they_are(path: &Path, axis: Vector) -> Vec<Option<(f64, f64)>> {
    let pairs = (1..path.images() - 1).into_par_iter().with_min_len(apiece(path.image(0).len(), READ));
    pairs
        .map(|k| Some(turn_towards(Components::new(path.image(k)), Components::new(path.image(k - 1)), axis)))
        .collect()
}

/// Turns an image, if it is by more than rounding; says whether it was.
fn turn_by(image: &mut [f64], axis: Vector, (sine, cosine): (f64, f64)) -> bool {
    let size = (sine * sine + cosine * cosine).sqrt();
    if size < 1e-8 * image.len() as f64 / 3.0 || sine.abs() < 1e-15 * size && cosine > 0.0 {
        return false;
    }
    let image = ComponentsMut::new(image);
    turn(image.x, image.y, image.z, axis, (sine / size, cosine / size));
    true
}

/// Turns every vector about a unit axis by an angle of known sine and cosine, and makes it of unit length.
#[multiversion(targets("x86_64+avx512f", "x86_64+avx2"))]
fn turn(mx: &mut [f64], my: &mut [f64], mz: &mut [f64], [x, y, z]: Vector, (sine, cosine): (f64, f64)) {
    let n = mx.len();
    let (my, mz) = (&mut my[..n], &mut mz[..n]);
    for i in 0..n {
        let m = [mx[i], my[i], mz[i]];
        let along = (1.0 - cosine) * (x * m[0] + y * m[1] + z * m[2]);
        let v = [
            cosine * m[0] + sine * (y * m[2] - z * m[1]) + along * x,
            cosine * m[1] + sine * (z * m[0] - x * m[2]) + along * y,
            cosine * m[2] + sine * (x * m[1] - y * m[0]) + along * z,
        ];
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        (mx[i], my[i], mz[i]) = (v[0] / length, v[1] / length, v[2] / length);
    }
}
