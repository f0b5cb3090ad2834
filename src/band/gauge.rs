//! The rotation gauge: images of a system with a symmetry axis may turn freely about it; each is turned to lie as near to
//! a neighbour as possible.
//!
//! Without it a start with azimuthal noise does not relax, at any length. Where the energy has no axis
//! at all (full rotation symmetry) the three axes are treated in turn, a few times.
//!
//! A turn is as well known as its two images are off the axis: one beside a minimum along the axis has next to none. So images
//! between two that stay follow the one of these that is farther off it: the other way about, what is arbitrary beside the minimum
//! would turn them all against the saddle.

use crate::field::{Components, ComponentsMut};
use crate::geometry::Vector;
use crate::path::Path;
use crate::sphere::turn_towards;
use crate::threads::{READ, apiece};
use multiversion::multiversion;
use rayon::prelude::*;

/// Overlaps of less than this a spin tell no turn.
const ALONG_AXIS: f64 = 1e-8;

/// An image that is turned, and its neighbour towards which it is.
type Pair = (usize, usize);

/// Turns every image between the ends, but those that are `fixed`, about the given symmetry axes towards a neighbour.
pub(super) fn align_rotations(path: &mut Path, axes: &[Vector], fixed: &[bool]) {
    let Some(&first) = axes.first() else { return };
    let rounds = if axes.len() > 1 { 4 } else { 1 };
    let pairs = pairs(path, axes, fixed);
    let known = overlaps_as_they_are(path, &pairs, first);
    let mut turned = vec![false; path.images()];
    for ((k, towards), known) in pairs.into_iter().zip(known) {
        let (image, reference) = two(path, k, towards);
        // what is known is of the first axis, before any turn
        let mut known = Some(known).filter(|_| !turned[towards]);
        for &axis in std::iter::repeat_n(axes, rounds).flatten() {
            let turn =
                known.take().unwrap_or_else(|| turn_towards(Components::new(image), Components::new(reference), axis));
            turned[k] |= turn_by(image, axis, turn);
        }
    }
}

/// The images that are turned, in this order.
fn pairs(path: &Path, axes: &[Vector], fixed: &[bool]) -> Vec<Pair> {
    let last = path.images() - 1;
    let stay: Vec<usize> = (0..=last).filter(|&k| k == 0 || k == last || fixed[k]).collect();
    let off: Vec<f64> = stay.iter().map(|&k| off_axes(path.image(k), axes)).collect();
    let stretches = stay.windows(2).zip(off.windows(2));
    let pairs = stretches.flat_map(|(ends, off)| {
        let between = ends[0] + 1..ends[1];
        // plainly, so that rounding does not decide
        if off[1] > 2.0 * off[0] + ALONG_AXIS * path.sites() as f64 {
            between.rev().map(|k| (k, k + 1)).collect::<Vec<_>>()
        } else {
            between.map(|k| (k, k - 1)).collect()
        }
    });
    pairs.collect()
}

/// Σ sin² of the angles between the spins and the axes.
fn off_axes(image: &[f64], axes: &[Vector]) -> f64 {
    let m = Components::new(image);
    axes.iter().map(|axis| turn_towards(m, m, *axis).1).sum()
}

/// The turns of images as they are.
fn overlaps_as_they_are(path: &Path, pairs: &[Pair], axis: Vector) -> Vec<(f64, f64)> {
    let image = |k: usize| Components::new(path.image(k));
    let pairs = pairs.par_iter().with_min_len(apiece(path.image(0).len(), READ));
    pairs.map(|(k, towards)| turn_towards(image(*k), image(*towards), axis)).collect()
}

/// An image, to be turned, and a neighbour.
fn two(path: &mut Path, k: usize, neighbour: usize) -> (&mut [f64], &[f64]) {
    let slab = 3 * path.sites();
    let (before, rest) = path.as_mut_slice().split_at_mut(k.max(neighbour) * slab);
    let (low, high) = (&mut before[k.min(neighbour) * slab..], &mut rest[..slab]);
    if k < neighbour { (low, high) } else { (high, low) }
}

/// Turns an image, if it is by more than rounding; says whether it was.
fn turn_by(image: &mut [f64], axis: Vector, (sine, cosine): (f64, f64)) -> bool {
    let size = (sine * sine + cosine * cosine).sqrt();
    if size < ALONG_AXIS * image.len() as f64 / 3.0 || sine.abs() < 1e-15 * size && cosine > 0.0 {
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

#[cfg(test)]
mod tests {
    use super::align_rotations;
    use crate::path::{Path, largest_angle};
    use crate::spins::Spins;

    /// Four spins that are tilted by an angle from the axis, at an azimuth.
    fn tilted(angle: f64, azimuth: f64) -> Spins {
        let (across, along) = angle.sin_cos();
        Spins::from_vectors(&[[across * azimuth.cos(), across * azimuth.sin(), along]; 4]).unwrap()
    }

    #[test]
    fn an_image_beside_a_minimum_along_the_axis_turns_no_other() {
        let tilts = [0.0, 1e-3, 0.4, 0.8, 1.2];
        // the second one's azimuth is noise
        let mut states: Vec<Spins> = tilts.iter().map(|angle| tilted(*angle, 0.5)).collect();
        states[1] = tilted(tilts[1], 2.5);
        let mut back = states.clone();
        back.reverse();
        for states in [states, back] {
            let mut path = Path::new(&states);
            align_rotations(&mut path, &[[0.0, 0.0, 1.0]], &[false; 5]);
            for k in 1..5 {
                let turn = largest_angle(path.image(k - 1), path.image(k));
                assert!(turn < 0.4 + 1e-9, "{turn}");
            }
        }
    }
}
