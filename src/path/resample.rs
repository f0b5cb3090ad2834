//! More, fewer or other images on the same curve: neighbours are joined by each spin's great circle.

use super::{Path, largest_angle};
use crate::field::{Components, ComponentsMut};
use crate::geometry::{Direction, slerp};
use crate::threads::{MADE, apiece};
use ndarray::Array3;
use rayon::prelude::*;

impl Path {
    /// `images` images at equal distances along the curve; the ends stay.
    pub fn resampled(&self, images: usize) -> Path {
        let s = self.reaction_coordinate();
        let length = s[s.len() - 1];
        let places: Vec<f64> = (0..images).map(|k| length * k as f64 / (images - 1) as f64).collect();
        self.at_places(&s, &places)
    }

    /// A new image in the middle of every interval.
    pub fn doubled(&self) -> Path {
        self.with_middles(|_| true)
    }

    /// A new image in the middle of every interval in which any spin turns by more than that (rad).
    pub fn halved(&self, turns: f64) -> Path {
        self.with_middles(|k| largest_angle(self.image(k), self.image(k + 1)) > turns)
    }

    /// A new image in the middle of such intervals.
    fn with_middles(&self, of: impl Fn(usize) -> bool) -> Path {
        let mut halves = Vec::new();
        for k in 0..self.images() {
            halves.push(2 * k);
            if k + 1 < self.images() && of(k) {
                halves.push(2 * k + 1);
            }
        }
        Path::build(halves.len(), self.sites(), |k, out| match (halves[k] / 2, halves[k] % 2) {
            (k, 0) => out.copy_from_slice(self.image(k)),
            (k, _) => blend(self.image(k), self.image(k + 1), 0.5, out),
        })
    }

    /// Images at the given places of the running length `s`.
    pub fn at_places(&self, s: &[f64], places: &[f64]) -> Path {
        let last = self.images() - 1;
        Path::build(places.len(), self.sites(), |k, out| {
            if k == 0 || k + 1 == places.len() {
                let end = if k == 0 { 0 } else { last };
                return out.copy_from_slice(self.image(end));
            }
            let i = s.partition_point(|x| *x <= places[k]).clamp(1, last) - 1;
            let width = s[i + 1] - s[i];
            let t = if width > 0.0 { ((places[k] - s[i]) / width).clamp(0.0, 1.0) } else { 0.0 };
            blend(self.image(i), self.image(i + 1), t, out);
        })
    }

    /// A path whose images are written one by one, each a slab of 3N numbers.
    pub(crate) fn build(images: usize, sites: usize, fill: impl Fn(usize, &mut [f64]) + Sync) -> Path {
        let mut path = Path { m: Array3::zeros((images, 3, sites)) };
        let images = path.as_mut_slice().par_chunks_mut(3 * sites).with_min_len(apiece(3 * sites, MADE));
        images.enumerate().for_each(|(k, out)| fill(k, out));
        path
    }
}

/// Every spin at fraction t of the great circle from a to b.
pub fn blend(a: &[f64], b: &[f64], t: f64, out: &mut [f64]) {
    let (a, b) = (Components::new(a), Components::new(b));
    let mut out = ComponentsMut::new(out);
    for i in 0..a.sites() {
        out.set(i, slerp(a.get(i), b.get(i), t, Direction::X));
    }
}

#[cfg(test)]
mod tests {
    use crate::path::Path;
    use crate::spins::Spins;

    /// One spin at such angles in the xz plane.
    fn path(angles: &[f64]) -> Path {
        let at = |a: &f64| Spins::from_vectors(&[[libm::sin(*a), 0.0, libm::cos(*a)]]).unwrap();
        Path::new(&angles.iter().map(at).collect::<Vec<_>>())
    }

    fn angles(path: &Path) -> Vec<f64> {
        (0..path.images()).map(|k| libm::atan2(path.image(k)[0], path.image(k)[2])).collect()
    }

    #[test]
    fn images_are_added_in_the_middle_of_all_intervals_or_of_the_wide_ones() {
        let close = |path: &Path, wanted: &[f64]| {
            let found = angles(path);
            found.len() == wanted.len() && found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-14)
        };
        let uneven = path(&[0.0, 0.2, 1.2, 2.0]);
        assert!(close(&uneven.doubled(), &[0.0, 0.1, 0.2, 0.7, 1.2, 1.6, 2.0]));
        assert!(close(&uneven.halved(0.5), &[0.0, 0.2, 0.7, 1.2, 1.6, 2.0]));
        assert!(close(&uneven.halved(0.9), &[0.0, 0.2, 0.7, 1.2, 2.0]));
        assert_eq!(uneven.halved(1.1), uneven);
    }
}
