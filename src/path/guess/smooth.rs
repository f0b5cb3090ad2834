//! Low-pass filtering of a path, each spin's way on its sphere.

use crate::field::{Components, ComponentsMut};
use crate::geometry::low_pass;
use crate::path::Path;
use rayon::prelude::*;

/// The path with every spin's way filtered by `strength` (0: as it is, 1: strongest); the ends stay.
pub fn smooth(path: &Path, strength: f64) -> Path {
    let images = path.images();
    let ways: Vec<_> = (0..path.sites())
        .into_par_iter()
        .map(|i| low_pass(&(0..images).map(|k| Components::new(path.image(k)).get(i)).collect::<Vec<_>>(), strength))
        .collect();
    Path::build(images, path.sites(), |k, out| {
        if k == 0 || k + 1 == images {
            return out.copy_from_slice(path.image(k));
        }
        let mut out = ComponentsMut::new(out);
        for (i, way) in ways.iter().enumerate() {
            out.set(i, way[k]);
        }
    })
}
