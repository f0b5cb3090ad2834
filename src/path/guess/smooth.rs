//! Low-pass filtering of a path, each spin's way on its sphere.

use crate::field::{Components, ComponentsMut};
use crate::geometry::{Vector, low_pass};
use crate::path::Path;
use rayon::prelude::*;

/// The path with every spin's way filtered by `strength` (0: as it is, 1: strongest); the ends, and spins at rest, stay.
pub fn smooth(path: &Path, strength: f64) -> Path {
    let images = path.images();
    let filtered = |i: usize| {
        let way: Vec<Vector> = (0..images).map(|k| Components::new(path.image(k)).get(i)).collect();
        let rests = way.iter().all(|m| *m == way[0]);
        if rests { way } else { low_pass(&way, strength) }
    };
    let ways: Vec<Vec<Vector>> = (0..path.sites()).into_par_iter().map(filtered).collect();
    Path::build(images, path.sites(), |k, out| {
        let mut out = ComponentsMut::new(out);
        for (i, way) in ways.iter().enumerate() {
            out.set(i, way[k]);
        }
    })
}
