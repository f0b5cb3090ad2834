//! The energy between images: a cubic Hermite piece an interval, from the energies and the slopes −F·τ.

use super::Band;
use crate::field::{Components, TILE};
use crate::linalg::slab;
use crate::sphere::write_logs;
use crate::threads::both;

/// Energy along the reaction coordinate.
#[derive(Clone, Debug)]
pub struct Profile {
    /// Reaction coordinate of the images (rad).
    pub s: Vec<f64>,
    /// Energy of the images above the first one (meV).
    pub energy: Vec<f64>,
    /// dE/ds at the images (meV/rad).
    pub slope: Vec<f64>,
}

/// A maximum or minimum of the interpolated energy inside the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extremum {
    /// Reaction coordinate (rad).
    pub s: f64,
    /// Energy above the first image (meV).
    pub energy: f64,
    /// It lies between image `interval` and the next one,
    pub interval: usize,
    /// at this fraction of the way.
    pub fraction: f64,
    /// A maximum (else a minimum).
    pub is_maximum: bool,
}

impl Profile {
    /// Of an evaluated band.
    pub fn of(band: &Band) -> Profile {
        let last = band.images() - 1;
        let mut s = vec![0.0];
        for l in band.spacings() {
            s.push(s[s.len() - 1] + l);
        }
        let e = band.energies_mev();
        let energy = e.iter().map(|x| x - e[0]).collect();
        let mut slope: Vec<f64> = (0..=last).map(|k| -band.along(k)).collect();
        let numbers = band.gradient(0).len();
        let ends = both(numbers, || end_slope(band, 0, 1), || end_slope(band, last, last - 1));
        (slope[0], slope[last]) = (ends.0, -ends.1);
        Profile { s, energy, slope }
    }

    /// Coefficients of E = a + b u + c u² + d u³ on an interval, u from 0 to 1.
    fn cubic(&self, k: usize) -> [f64; 4] {
        let h = self.s[k + 1] - self.s[k];
        let (a, b, p, q) = (self.energy[k], self.energy[k + 1], h * self.slope[k], h * self.slope[k + 1]);
        [a, p, 3.0 * (b - a) - 2.0 * p - q, 2.0 * (a - b) + p + q]
    }

    /// Energy above the first image (meV) at fraction u of interval k.
    pub fn energy_at(&self, k: usize, u: f64) -> f64 {
        let [a, b, c, d] = self.cubic(k);
        a + u * (b + u * (c + u * d))
    }

    /// `count` points in every interval, and the last image: (s in rad, energy above the first image in meV).
    pub fn samples(&self, count: usize) -> Vec<(f64, f64)> {
        let last = self.s.len() - 1;
        let mut points = Vec::with_capacity(count * last + 1);
        for k in 0..last {
            for j in 0..count {
                let u = j as f64 / count as f64;
                points.push((self.s[k] + u * (self.s[k + 1] - self.s[k]), self.energy_at(k, u)));
            }
        }
        points.push((self.s[last], self.energy[last]));
        points
    }

    /// The highest energy above the first image (meV), of the images and between them.
    pub fn highest_mev(&self) -> f64 {
        let between = self.extrema().into_iter().map(|x| x.energy);
        self.energy.iter().copied().chain(between).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Maxima and minima inside the path, in path order.
    pub fn extrema(&self) -> Vec<Extremum> {
        let last = self.s.len() - 1;
        let mut found: Vec<Extremum> = Vec::new();
        for k in 0..last {
            let [_, b, c, d] = self.cubic(k);
            let mut roots = quadratic_roots(3.0 * d, 2.0 * c, b);
            roots.retain(|u| (-1e-9..1.0 + 1e-9).contains(u));
            for u in roots {
                let curvature = 2.0 * c + 6.0 * d * u;
                let s = self.s[k] + u * (self.s[k + 1] - self.s[k]);
                let inside = s > 1e-9 * self.s[last] && s < (1.0 - 1e-9) * self.s[last];
                let new = found
                    .last()
                    .is_none_or(|f| s - f.s > 1e-7 * (self.s[k + 1] - self.s[k]) || f.is_maximum != (curvature < 0.0));
                if curvature != 0.0 && inside && new {
                    let fraction = u.clamp(0.0, 1.0);
                    found.push(Extremum {
                        s,
                        energy: self.energy_at(k, fraction),
                        interval: k,
                        fraction,
                        is_maximum: curvature < 0.0,
                    });
                }
            }
        }
        found
    }

    /// The highest maximum between image k and its neighbours, if there is one.
    pub fn highest_beside(&self, k: usize) -> Option<Extremum> {
        let near = self.extrema().into_iter().filter(|x| x.is_maximum && (x.interval == k || x.interval + 1 == k));
        near.max_by(|a, b| a.energy.total_cmp(&b.energy))
    }
}

/// Slope of the energy from an end towards its neighbour (meV/rad).
fn end_slope(band: &Band, end: usize, towards: usize) -> f64 {
    let (a, b) = (Components::new(band.path().image(end)), Components::new(band.path().image(towards)));
    let g = Components::new(band.gradient(end));
    let mut v = [0.0; 3 * TILE];
    let (mut work, mut squares) = (0.0, 0.0);
    for first in (0..a.sites()).step_by(TILE) {
        let range = first..a.sites().min(first + TILE);
        let v = &mut v[..3 * range.len()];
        write_logs(a.range(range.clone()), b.range(range.clone()), v);
        squares += slab::dot(v, v);
        let (v, g) = (Components::new(v), g.range(range));
        work += slab::dot(g.x, v.x) + slab::dot(g.y, v.y) + slab::dot(g.z, v.z);
    }
    if squares == 0.0 { 0.0 } else { work / squares.sqrt() }
}

/// Real roots of a u² + b u + c, ascending, without cancellation.
fn quadratic_roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let size = a.abs().max(b.abs()).max(c.abs());
    if a.abs() <= 1e-14 * size {
        return if b == 0.0 { vec![] } else { vec![-c / b] };
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return vec![];
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    let mut roots = if q == 0.0 { vec![0.0] } else { vec![q / a, c / q] };
    roots.sort_by(f64::total_cmp);
    roots
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_reproduced_with_its_extrema() {
        // E = s³ − 3 s² + 2 s: maximum at 1 − 1/√3, minimum at 1 + 1/√3
        let e = |s: f64| s * (s - 1.0) * (s - 2.0);
        let d = |s: f64| 3.0 * s * s - 6.0 * s + 2.0;
        let s = vec![0.0, 0.9, 1.1, 2.5];
        let p = Profile { energy: s.iter().map(|x| e(*x)).collect(), slope: s.iter().map(|x| d(*x)).collect(), s };
        let x = p.extrema();
        assert_eq!(x.len(), 2);
        let third = 1.0 / 3.0f64.sqrt();
        assert!(
            (x[0].s - (1.0 - third)).abs() < 1e-12 && x[0].is_maximum && (x[0].energy - e(1.0 - third)).abs() < 1e-14
        );
        assert!((x[1].s - (1.0 + third)).abs() < 1e-12 && !x[1].is_maximum);
        for (s, energy) in p.samples(5) {
            assert!((energy - e(s)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_maximum_on_an_image_is_found_once() {
        let p = Profile { s: vec![0.0, 1.0, 2.0], energy: vec![0.0, 1.0, 0.0], slope: vec![0.0, 0.0, 0.0] };
        assert_eq!(p.extrema().len(), 1);
    }
}
