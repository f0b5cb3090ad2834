//! Where a relaxed band has its maxima: starting points for their refinement.

use crate::band::{Band, Extremum, Profile};
use crate::field::Components;
use crate::linalg::slab;
use crate::path::blend;
use crate::sphere::write_logs;
use crate::stationary::{ALIKE, ROUGHLY};
use crate::threads::both;
use serde::{Deserialize, Serialize};

/// A maximum of a band, as far as the band tells.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Peak {
    /// Spins, component-major.
    pub m: Vec<f64>,
    /// Unit direction of the path (3N).
    pub tau: Vec<f64>,
    /// Energy above the Hamiltonian's reference (meV).
    pub energy_mev: f64,
    /// Reaction coordinate (rad).
    pub s: f64,
    /// The nearest image.
    pub image: usize,
    /// A stationary state below this (meV above the reference) is not what the peak rises to: a search that falls so far has slid
    /// down the path.
    pub floor_mev: f64,
}

/// Every maximum, highest first; c: stiffness scale (meV).
pub fn peaks(band: &Band, c: f64) -> Vec<Peak> {
    let profile = band.profile();
    let e = band.energies_mev();
    let last = e.len() - 1;
    let mut found: Vec<Peak> = Vec::new();
    for k in 1..last {
        if e[k] >= e[k - 1] && e[k] >= e[k + 1] {
            found.push(beside(band, &profile, k, c));
        }
    }
    for x in profile.extrema().into_iter().filter(|x| x.is_maximum) {
        let at_an_image = |k: usize| k > 0 && k < last && e[k] >= e[k - 1] && e[k] >= e[k + 1];
        if !at_an_image(x.interval) && !at_an_image(x.interval + 1) {
            found.push(between(band, &profile, &x, c));
        }
    }
    found.sort_by(|p, q| q.energy_mev.total_cmp(&p.energy_mev).then(p.image.cmp(&q.image)));
    found
}

/// The highest maximum, if the band rises anywhere above its ends.
pub fn highest(band: &Band, c: f64) -> Option<Peak> {
    peaks(band, c).into_iter().next()
}

/// The highest of a band's maxima from which a saddle is well looked for: not an interpolated one where the great circle between images
/// that are far apart leads over the valley, as on a plateau that few images cross, if the highest image is a maximum too.
pub fn promising(band: &Band, mut tops: Vec<Peak>) -> Option<Peak> {
    let top_mev = band.energies_mev()[band.highest()];
    let leads_over = |top: &Peak| top.energy_mev < top.floor_mev;
    let is_image = |top: &Peak| !leads_over(top) && top.energy_mev >= top_mev;
    let instead = tops.first().filter(|top| leads_over(top)).and_then(|_| tops.iter().position(is_image));
    (!tops.is_empty()).then(|| tops.swap_remove(instead.unwrap_or(0)))
}

/// A maximal image, or the interpolated maximum beside it where that can be trusted: its force is below twice the image's (on coarse
/// plateaus the interpolation overshoots).
fn beside(band: &Band, profile: &Profile, k: usize, c: f64) -> Peak {
    let image = Peak {
        m: band.path().image(k).to_vec(),
        tau: through(band, k),
        energy_mev: band.energies_mev()[k],
        s: profile.s[k],
        image: k,
        floor_mev: floor(band, band.energies_mev()[k], k, c),
    };
    let Some(x) = profile.highest_beside(k) else { return image };
    let top = between(band, profile, &x, c);
    let h = band.evaluator();
    let (mut g, mut f) = (vec![0.0; top.m.len()], vec![0.0; top.m.len()]);
    let energy = h.energy_gradient(&top.m, &mut g);
    h.force(&top.m, &g, &mut f);
    let along = slab::dot(&f, &top.tau);
    slab::add_scaled(&mut f, -along, &top.tau);
    let image_force = slab::max_abs(band.perpendicular(k)) + band.along(k).abs() * slab::max_abs(band.tangent(k));
    let trusted = slab::max_abs(&f) < 2.0 * image_force;
    let floor_mev = image.floor_mev.min(floor(band, energy, k, c));
    if trusted { Peak { energy_mev: energy.max(image.energy_mev), floor_mev, ..top } } else { image }
}

/// What a peak of this height beside an image is told from what lies below it by (meV above the reference).
fn floor(band: &Band, peak_mev: f64, image: usize, c: f64) -> f64 {
    let e = band.energies_mev();
    let rises = (peak_mev - e[0].max(e[e.len() - 1])).max(0.0);
    let f = band.perpendicular(image);
    // a saddle is lower than its peak by no more than a part of what that rises; a band that is not relaxed yet is higher than its valley by about |F⊥|²/2c
    let falls = slab::dot(f, f) / c;
    peak_mev - (ROUGHLY * rises).max(falls)
}

/// The interpolated maximum of an interval: its spins on the great circles between the two images.
fn between(band: &Band, profile: &Profile, x: &Extremum, c: f64) -> Peak {
    let (a, b) = (band.path().image(x.interval), band.path().image(x.interval + 1));
    let mut m = vec![0.0; a.len()];
    blend(a, b, x.fraction, &mut m);
    let tau = if x.fraction < 0.5 { direction(&m, b, 1.0) } else { direction(&m, a, -1.0) };
    let image = if x.fraction < 0.5 { x.interval } else { x.interval + 1 };
    let energy_mev = x.energy + band.energies_mev()[0];
    // of the energy that is there: the interpolation may overshoot
    let floor_mev =
        floor(band, band.evaluator().difference_mev(&m, band.path().image(0)) + band.energies_mev()[0], image, c);
    Peak {
        m,
        tau,
        energy_mev,
        floor_mev,
        s: profile.s[x.interval] + x.fraction * (profile.s[x.interval + 1] - profile.s[x.interval]),
        image,
    }
}

/// Direction of the path through image k: both neighbours, each as a unit vector.
fn through(band: &Band, k: usize) -> Vec<f64> {
    let here = band.path().image(k);
    let (on, back) = (band.path().image(k + 1), band.path().image(k - 1));
    let (mut t, back) = both(here.len(), || direction(here, on, 1.0), || direction(here, back, -1.0));
    slab::add_scaled(&mut t, 1.0, &back);
    let size = slab::norm(&t);
    if size < ALIKE {
        return band.tangent(k).to_vec();
    }
    slab::scale(&mut t, 1.0 / size);
    t
}

/// ± the unit initial velocity of the geodesic from m to `to`.
pub fn direction(m: &[f64], to: &[f64], sign: f64) -> Vec<f64> {
    let mut t = vec![0.0; m.len()];
    write_logs(Components::new(m), Components::new(to), &mut t);
    let size = slab::norm(&t);
    slab::scale(&mut t, sign / size.max(f64::MIN_POSITIVE));
    t
}
