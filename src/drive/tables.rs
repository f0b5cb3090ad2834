//! The images of a band in numbers, and the energy between them.

use super::outcome::{ImageTable, ProfilePoint};
use crate::band::{Band, Profile};
use crate::energy::Evaluator;
use crate::linalg::slab;
use crate::threads::{MADE, apiece};
use rayon::prelude::*;

/// Points of the profile in every interval.
const PROFILE: usize = 16;

pub fn image_table(h: Evaluator, band: &Band) -> ImageTable {
    let path = band.path();
    let first = h.density(path.image(0));
    let row = |k: usize| {
        let m = path.image(k);
        let mut above = h.density(m);
        let energy = h.reference_mev() + slab::sum(&above);
        slab::add_scaled(&mut above, -1.0, &first);
        (energy, slab::sum(&above), h.energies_mev(m), slab::max_abs(band.perpendicular(k)))
    };
    let rows = (0..path.images()).into_par_iter().with_min_len(apiece(path.image(0).len(), MADE)).map(row);
    let rows: Vec<_> = rows.collect();
    let terms = rows.first().map(|row| row.2.iter().map(|term| term.0)).into_iter().flatten();
    let terms_mev = terms.enumerate().map(|(j, name)| (name.to_string(), rows.iter().map(|row| row.2[j].1).collect()));
    ImageTable {
        reaction_coordinate_rad: path.reaction_coordinate(),
        energy_mev: rows.iter().map(|row| row.0).collect(),
        above_initial_mev: rows.iter().map(|row| row.1).collect(),
        terms_mev: terms_mev.collect(),
        max_perpendicular_torque_mev: rows.iter().map(|row| row.3).collect(),
    }
}

pub fn profile(band: &Band) -> Vec<ProfilePoint> {
    let point = |(s, e)| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: e };
    band.profile().samples(PROFILE).into_iter().map(point).collect()
}

/// The interpolated energy of each term: cubic pieces as the total's, which they add up to. A term's slope is that of the polynomial
/// through an image and two neighbours on each side; what then lacks to the total's is shared out by how far off each may be. (A term's
/// own gradient along the tangent would not do: only the total is stationary across the path, so only its slope forgives a tangent that
/// is a chord.)
pub fn profile_terms(total: &Profile, images: &ImageTable) -> Vec<(String, Vec<f64>)> {
    let terms = &images.terms_mev;
    let (s, count) = (&total.s, terms.len() as f64);
    let slopes = |k: usize| -> Vec<f64> {
        let told: Vec<f64> = terms.iter().map(|(_, energy)| slope_through(s, energy, k, 2)).collect();
        let off = |(told, (_, energy)): (&f64, &(String, Vec<f64>))| (told - slope_through(s, energy, k, 1)).abs();
        let off: Vec<f64> = told.iter().zip(terms).map(off).collect();
        let (lacks, all) = (total.slope[k] - slab::sum(&told), slab::sum(&off));
        let share = |off: f64| if all > 0.0 { off / all } else { 1.0 / count };
        told.iter().zip(off).map(|(told, off)| told + share(off) * lacks).collect()
    };
    let slopes: Vec<Vec<f64>> = (0..s.len()).map(slopes).collect();
    let term = |(j, (name, energy)): (usize, &(String, Vec<f64>))| {
        let above = energy.iter().map(|e| e - energy[0]).collect();
        let pieces = Profile { s: s.clone(), energy: above, slope: slopes.iter().map(|terms| terms[j]).collect() };
        (name.clone(), pieces.samples(PROFILE).into_iter().map(|(_, e)| e).collect())
    };
    terms.iter().enumerate().map(term).collect()
}

/// The slope at a point of the polynomial through it and so many neighbours on either side, at an end the nearest on the other; 0
/// where points coincide.
fn slope_through(s: &[f64], energy: &[f64], k: usize, neighbours: usize) -> f64 {
    let width = (2 * neighbours + 1).min(s.len());
    let first = k.saturating_sub(neighbours).min(s.len() - width);
    let points = first..first + width;
    let weight = |j: usize| points.clone().filter(|i| *i != j).map(|i| s[j] - s[i]).product::<f64>();
    let here = weight(k);
    let part = |j: usize| here / weight(j) / (s[k] - s[j]) * (energy[j] - energy[k]);
    let slope: f64 = points.clone().filter(|j| *j != k).map(part).sum();
    if slope.is_finite() { slope } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn few_images_of_a_coherent_rotation_tell_how_each_of_its_terms_goes() {
        let s: Vec<f64> = (0..5).map(|k| f64::from(k) * PI / 4.0).collect();
        let terms: [fn(f64) -> f64; 2] = [|x| x.sin().powi(2), |x| x.cos() - 1.0];
        let table = |term: fn(f64) -> f64| s.iter().map(|x| term(*x)).collect::<Vec<f64>>();
        let images = ImageTable {
            terms_mev: terms.iter().map(|term| (String::new(), table(*term))).collect(),
            reaction_coordinate_rad: s.clone(),
            ..ImageTable::default()
        };
        let energy = s.iter().map(|x| terms[0](*x) + terms[1](*x)).collect();
        let slope = s.iter().map(|x| (2.0 * x).sin() - x.sin()).collect();
        let total = Profile { s: s.clone(), energy, slope };
        for ((_, told), term) in profile_terms(&total, &images).iter().zip(terms) {
            for (k, told) in told.iter().enumerate() {
                let exact = term(PI * k as f64 / (told_points(&s) - 1.0));
                assert!((told - exact).abs() < 0.06, "{k}: {told} {exact}");
            }
        }
    }

    /// How many points a profile has.
    fn told_points(s: &[f64]) -> f64 {
        ((s.len() - 1) * PROFILE + 1) as f64
    }
}
