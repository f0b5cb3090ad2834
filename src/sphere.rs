//! Products of spheres: moving many unit vectors along tangent vectors, by the exponential map.

use crate::field::{Components, ComponentsMut};
use crate::geometry::{exp, vector};
use rayon::prelude::*;

/// Each spin m ← Exp_m(s v), image by image (slabs of 3N numbers).
pub fn move_points(points: &mut [f64], v: &[f64], slab: usize, s: f64) {
    points.par_chunks_mut(slab).zip(v.par_chunks(slab)).for_each(|(m, v)| {
        let v = Components::new(v);
        let mut m = ComponentsMut::new(m);
        for i in 0..v.sites() {
            let step = vector::scale(s, v.get(i));
            if step != [0.0; 3] {
                m.set(i, exp([m.x[i], m.y[i], m.z[i]], step));
            }
        }
    });
}

/// The largest |v_i| of any spin (rad); NaN if any entry is NaN.
pub fn rotation_of(v: &[f64]) -> f64 {
    let v = Components::new(v);
    let squares = (0..v.sites()).map(|i| vector::dot(v.get(i), v.get(i)));
    squares.fold(0.0, |m: f64, x| if m.is_nan() || x.is_nan() { f64::NAN } else { m.max(x) }).sqrt()
}
