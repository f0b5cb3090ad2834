//! The rotation gauge: images of a system with a symmetry axis may turn freely about it; each is turned to lie as near to
//! its predecessor as possible.
//!
//! About one axis, φ = atan2(Σ (b_x a_y − b_y a_x), Σ (a_x b_x + a_y b_y)) with x, y across the axis brings b nearest to a.
//! Without it a start with azimuthal noise does not relax, at any length. Where the energy has no axis at all (full rotation
//! symmetry) the three axes are treated in turn, a few times.

use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, Vector, rotate, vector};
use crate::path::Path;

/// Turns every image between the ends about the given symmetry axes towards the image before it.
pub fn align_rotations(path: &mut Path, axes: &[Vector]) {
    let rounds = if axes.len() > 1 { 4 } else { 1 };
    let slab = 3 * path.sites();
    for k in 1..path.images() - 1 {
        let (before, rest) = path.as_mut_slice().split_at_mut(k * slab);
        let (reference, image) = (&before[(k - 1) * slab..], &mut rest[..slab]);
        for _ in 0..rounds {
            for &axis in axes {
                turn_towards(reference, image, axis);
            }
        }
    }
}

fn turn_towards(reference: &[f64], image: &mut [f64], axis: Vector) {
    let a = Components::new(reference);
    let b = Components::new(image);
    let (mut sine, mut cosine) = (0.0, 0.0);
    for i in 0..a.sites() {
        let (p, q) = (a.get(i), b.get(i));
        sine += vector::dot(axis, vector::cross(q, p));
        cosine += vector::dot(p, q) - vector::dot(p, axis) * vector::dot(q, axis);
    }
    let n = a.sites() as f64;
    if sine.hypot(cosine) < 1e-8 * n {
        return;
    }
    let phi = libm::atan2(sine, cosine);
    let Ok(direction) = Direction::new(axis) else { return };
    if phi.abs() > 1e-15 {
        let mut image = ComponentsMut::new(image);
        for i in 0..image.x.len() {
            let v = rotate([image.x[i], image.y[i], image.z[i]], direction, phi);
            image.set(i, vector::unit(v).unwrap_or(v));
        }
    }
}
