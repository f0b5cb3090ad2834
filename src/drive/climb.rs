//! From a band's top to a refined saddle, and away from saddles of higher index.

use super::recorded::recorded;
use super::top::Top;
use super::turns::{turned, turns};
use crate::band::Band;
use crate::energy::Evaluator;
use crate::error::Result;
use crate::field::project;
use crate::linalg::{Matrix, lowest_modes, slab};
use crate::path::{Path, largest_angle};
use crate::sphere::{move_points, rotation_of};
use crate::spins::Spins;
use crate::stationary::{Refined, Spectrum, Verdict, follow_modes, refine};
use serde::{Deserialize, Serialize};

/// A mode of less than this part of c is shallow.
const SHALLOW: f64 = 1e-3;
/// How often a part of the path is made finer.
pub const ZOOMS: usize = 4;
/// How far a path is pushed off a saddle of higher index (rad).
const PUSH: f64 = 0.8;
/// A saddle this far from the place where its search began (rad, any spin) is another one.
const SAME_PLACE: f64 = 2.5;

/// Where a refined saddle was looked for, and what was found.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Found {
    /// The start.
    pub top: Top,
    /// The end.
    pub refined: Refined,
}

impl Found {
    /// Refines a top. A saddle that is also a maximum of a shallow mode (a wall halfway between two sites) is left along that
    /// mode by `hop` (rad), for the one beside it.
    pub fn at(h: Evaluator, top: Top, c: f64, hop: f64) -> Found {
        let mut found = Found::near(h, top, c, hop);
        found.sharpen(h, c);
        if found.refined.index > 1 {
            // a mode within the rounding error has no sign to count
            found.refined.index = Spectrum::negatives(h, &found.refined.state, &mut Matrix::default());
        }
        found
    }

    /// Follows the modes of a saddle that the valley's search left where sliding over the lattice still has a torque.
    fn sharpen(&mut self, h: Evaluator, c: f64) {
        let rest = |r: &Refined| r.state.max_torque_mev() / (1e-12 * r.state.hessian.norm1());
        if !self.is_stationary(c) || rest(&self.refined) <= 1.0 {
            return;
        }
        for start in [self.refined.state.m.clone(), self.top.m.clone()] {
            if let Some(refined) = follow_modes(h, &start, c).filter(|r| rest(r) <= 1.0) {
                let found = Found { top: self.top.clone(), refined };
                if found.is_stationary(c) {
                    *self = found;
                    return;
                }
            }
        }
    }

    fn near(h: Evaluator, top: Top, c: f64, hop: f64) -> Found {
        let refined = refine(h, &top.m, &top.tau, c);
        let mut found = Found { top, refined };
        if !found.is_stationary(c) {
            if let Some(refined) = follow_modes(h, &found.top.m, c) {
                found.refined = refined;
            }
            return found;
        }
        let state = &found.refined.state;
        let shallow = |l: &f64| l.abs() < SHALLOW * c;
        if Spectrum::of(h, state, 0).negative != 2 || !Spectrum::of(h, state, 2).lowest_mev.get(1).is_some_and(shallow)
        {
            return found;
        }
        // two walls, one on a site and one between two, have a period of half a site
        [hop, -hop, 0.5 * hop, -0.5 * hop].into_iter().find_map(|far| found.beside(h, c, far)).unwrap_or(found)
    }

    /// The same, as far as it is not on record.
    pub fn recorded(h: Evaluator, top: Top, c: f64, hop: f64) -> Result<Found> {
        let [m, tau] = [&top.m, &top.tau].map(Vec::clone);
        recorded(h, "saddle", &[&m, &tau], || Ok(Found::at(h, top, c, hop)))
    }

    /// The saddle of index one a little along the second-lowest mode.
    fn beside(&self, h: Evaluator, c: f64, far: f64) -> Option<Found> {
        let state = &self.refined.state;
        let along = state.basis.coordinates(&self.refined.valley);
        let modes = lowest_modes(&state.hessian, 2, &state.zeros);
        let other = modes
            .iter()
            .min_by(|p, q| slab::dot(&p.vector, &along).abs().total_cmp(&slab::dot(&q.vector, &along).abs()))?;
        let mut v = state.field(&other.vector);
        let size = rotation_of(&v);
        slab::scale(&mut v, far / size);
        let start = state.moved(&v);
        let better = |refined: Refined| {
            let found = Found { top: self.top.clone(), refined };
            let better = found.is_stationary(c) && Spectrum::of(h, &found.refined.state, 0).negative <= 1;
            better.then_some(found)
        };
        better(refine(h, &start, &self.refined.valley, c)).or_else(|| better(follow_modes(h, &start, c)?))
    }

    /// Stationary to machine precision, and still the start's saddle.
    pub fn is_stationary(&self, c: f64) -> bool {
        let done = matches!(self.refined.verdict, Verdict::Saddle | Verdict::Flat | Verdict::HigherIndex);
        let zero = (1e-9 * c).max(1e-12 * self.refined.state.hessian.norm1());
        done && self.refined.state.max_torque_mev() < zero && self.refined.rotation_rad < SAME_PLACE
    }

    /// Whether `other` ended in this saddle too, symmetry turns apart.
    pub fn is_same(&self, h: Evaluator, other: &Found) -> bool {
        let (a, b) = (&self.refined.state, &other.refined.state);
        if (a.energy_mev - b.energy_mev).abs() > 1e-9 * h.stiffness_mev() {
            return false;
        }
        let [p, q] = [a, b].map(|s| Spins::from_unit_components(&s.m));
        same(&a.m, turned(&q, &turns(h, &q, &p)).as_slice())
    }

    /// A stationary state with at most one negative direction.
    pub fn is_saddle(&self, c: f64) -> bool {
        self.is_stationary(c) && self.refined.index <= 1
    }
}

/// The path with more of its images in the first or last interval, if its top is there: or, if none shows, at its higher end
/// (between two minima there is one).
pub fn zoomed(band: &Band, top: Option<&Top>, images: usize) -> Option<Path> {
    let s = band.path().reaction_coordinate();
    let last = band.images() - 1;
    let e = band.energies_mev();
    let end = match top {
        Some(top) if top.s > s[1] && top.s < s[last - 1] => return None,
        Some(top) if top.s <= s[1] => 0,
        Some(_) => last,
        None if e[0] > e[last] => 0,
        None => last,
    };
    Some(band.path().at_places(&s, &condensed(&s, end, images)))
}

/// Places of `images` images, four times as dense within two intervals of image k as elsewhere.
fn condensed(s: &[f64], k: usize, images: usize) -> Vec<f64> {
    let weight = |i: usize| if i + 1 >= k.saturating_sub(1) && i < k + 2 { 4.0 } else { 1.0 };
    let mut warped = vec![0.0];
    for i in 0..s.len() - 1 {
        warped.push(warped[i] + weight(i) * (s[i + 1] - s[i]));
    }
    let total = warped[s.len() - 1];
    let place = |j: usize| {
        let x = total * j as f64 / (images - 1) as f64;
        let i = warped.partition_point(|w| *w <= x).clamp(1, s.len() - 1) - 1;
        s[i] + (x - warped[i]) / weight(i)
    };
    (0..images).map(place).collect()
}

/// Two paths pushed off a stationary point of index > 1, along its lowest negative mode other than the path's own, both ways.
pub fn escapes(band: &Band, found: &Found, c: f64) -> Vec<Path> {
    let state = &found.refined.state;
    let modes = lowest_modes(&state.hessian, 8, &state.zeros);
    let negative: Vec<_> = modes.into_iter().filter(|m| m.value < -1e-6 * c).collect();
    if negative.len() < 2 {
        return Vec::new();
    }
    let mut along = found.top.tau.clone();
    project(&state.m, &mut along);
    let along = state.basis.coordinates(&along);
    let overlap = |v: &[f64]| slab::dot(v, &along).abs();
    let own =
        (0..negative.len()).max_by(|&i, &j| overlap(&negative[i].vector).total_cmp(&overlap(&negative[j].vector)));
    let Some(other) = (0..negative.len()).find(|i| Some(*i) != own) else { return Vec::new() };
    let mode = state.field(&negative[other].vector);
    [PUSH, -PUSH].map(|push| pushed(band.path(), &mode, push)).into()
}

/// The path with every image moved along the mode's tangent part, sin(πs) as far, and resampled.
fn pushed(path: &Path, mode: &[f64], push: f64) -> Path {
    let last = path.images() - 1;
    let mut out = path.clone();
    let slab_size = mode.len();
    for k in 1..last {
        let mut v = mode.to_vec();
        project(path.image(k), &mut v);
        let size = rotation_of(&v);
        if size > 1e-12 {
            let far = push * libm::sin(std::f64::consts::PI * k as f64 / last as f64) / size;
            let image = &mut out.as_mut_slice()[k * slab_size..(k + 1) * slab_size];
            move_points(image, &v, slab_size, far);
        }
    }
    out.resampled(path.images())
}

/// Whether two configurations are the same but for a rotation of no spin by more than 1e-4 rad.
pub fn same(a: &[f64], b: &[f64]) -> bool {
    largest_angle(a, b) < 1e-4
}
