//! Ends, saddles and minima of a path as they are reported.

use super::Problem;
use super::heights::{height, prominent_maxima};
use super::outcome::{Barrier, EndPoint, IntermediateMinimum, SaddlePoint};
use super::places::{Place, in_order, nearest};
use crate::band::Band;
use crate::energy::Evaluator;
use crate::landscape::{Minimum, Pass, Saddle};
use crate::linalg::slab;
use crate::path::{Path, RESOLVED, is_within};
use crate::spins::Spins;
use crate::stationary::{LOWER, RELAXED, relax_to_minimum};
use rayon::prelude::*;

pub fn end_of(m: &Minimum) -> EndPoint {
    EndPoint {
        energy_mev: m.energy_mev,
        max_torque_mev: m.max_torque_mev,
        negative_modes: Some(m.spectrum.negative),
        zero_modes: Some(m.spectrum.zero_and_flat()),
        moved_rad: None,
    }
}

/// The saddles in path order: proven, refined, or else as the band shows them.
pub fn saddles(problem: &Problem, band: &Band, found: &[Saddle], links: &[Pass], places: &[Place]) -> Vec<SaddlePoint> {
    let h = problem.evaluator();
    let of_link = |(l, place): (&Pass, &Place)| saddle_of_link(h, band, l, *place);
    match (links, found) {
        ([], []) => band_saddles(problem, band),
        ([], found) => {
            // where the path only rises to an end, a search may come to that
            let found = found.iter().filter(|f| f.refined.index() > 0);
            let at = |f: &Saddle| saddle_of(h, band, f, nearest(band.path(), &f.refined.state.m));
            let mut saddles: Vec<SaddlePoint> = found.map(at).collect();
            saddles.sort_by(|p, q| p.reaction_coordinate_rad.total_cmp(&q.reaction_coordinate_rad));
            saddles
        }
        (links, _) => {
            let places: Vec<&Place> = places.iter().step_by(2).collect();
            links.par_iter().zip(places).map(of_link).collect()
        }
    }
}

fn saddle_of(h: Evaluator, band: &Band, f: &Saddle, place: Place) -> SaddlePoint {
    let first = band.path().image(0);
    let above = h.difference_mev(&f.refined.state.m, first);
    SaddlePoint {
        energy_mev: h.energy_mev(first) + above,
        above_initial_mev: above,
        reaction_coordinate_rad: place.s,
        image: place.image,
        spins: Spins::from_unit_components(&f.refined.state.m),
        max_torque_mev: Some(f.refined.state.max_torque_mev()),
        negative_modes: Some(f.refined.index()),
        zero_modes: Some(f.refined.state.zeros.len()),
        lowest_eigenvalues_mev: Vec::new(),
    }
}

fn saddle_of_link(h: Evaluator, band: &Band, link: &Pass, place: Place) -> SaddlePoint {
    SaddlePoint {
        negative_modes: Some(link.spectrum.negative),
        zero_modes: Some(link.spectrum.zero_and_flat()),
        ..saddle_of(h, band, &link.saddle, place)
    }
}

/// The lowest eigenvalues of the saddles of proven passes: what takes longest to find of all that is told of them.
pub fn tell_eigenvalues(h: Evaluator, saddles: &mut [SaddlePoint], links: &[Pass]) {
    let told = saddles.par_iter_mut().zip(links);
    told.for_each(|(saddle, link)| saddle.lowest_eigenvalues_mev = link.lowest_eigenvalues_mev(h));
}

/// The prominent maxima as the band shows them: the interpolated ones beside the highest images.
fn band_saddles(problem: &Problem, band: &Band) -> Vec<SaddlePoint> {
    let h = problem.evaluator();
    let first = band.path().image(0);
    let profile = band.profile();
    let peak = |k: usize| {
        let image = h.difference_mev(band.path().image(k), first);
        profile.highest_beside(k).map_or((profile.s[k], image), |x| (x.s, x.energy.max(image)))
    };
    let reference = h.energy_mev(first);
    let point = |k: usize| {
        let (s, above) = peak(k);
        SaddlePoint {
            energy_mev: reference + above,
            above_initial_mev: above,
            reaction_coordinate_rad: s,
            image: k,
            spins: band.path().spins(k),
            max_torque_mev: None,
            negative_modes: None,
            zero_modes: None,
            lowest_eigenvalues_mev: Vec::new(),
        }
    };
    prominent_maxima(band.energies_mev(), LOWER * height(band)).into_iter().map(point).collect()
}

/// Where a path passes the saddles of its links, and the minima between them.
pub fn places_of(path: &Path, links: &[Pass]) -> Vec<Place> {
    let states = links.iter().flat_map(|l| [&l.saddle.refined.state.m[..], l.after.spins.as_slice()]);
    in_order(path, &states.take((2 * links.len()).saturating_sub(1)).collect::<Vec<_>>())
}

/// The minima between the ends in path order: those behind proven saddles, or as the band shows them.
pub fn minima_between(problem: &Problem, band: &Band, links: &[Pass], places: &[Place]) -> Vec<IntermediateMinimum> {
    let behind = links.iter().zip(places.iter().skip(1).step_by(2));
    match links.len() {
        0 | 1 => band_minima(band).into_iter().map(|image| at_rest(problem, band, image)).collect(),
        _ => behind.map(|(link, place)| minimum_of(link, *place)).collect(),
    }
}

/// The minimum behind a link.
fn minimum_of(link: &Pass, place: Place) -> IntermediateMinimum {
    IntermediateMinimum {
        image: place.image,
        reaction_coordinate_rad: place.s,
        spins: link.after.spins.clone(),
        state: end_of(&link.after),
    }
}

/// Largest component of the whole force on image k (meV).
fn torque(band: &Band, k: usize) -> f64 {
    let mut f = band.perpendicular(k).to_vec();
    slab::add_scaled(&mut f, band.along(k), band.tangent(k));
    slab::max_abs(&f)
}

/// An image as it is, its modes not counted.
pub fn image_state(band: &Band, k: usize) -> EndPoint {
    EndPoint {
        energy_mev: band.hamiltonian().energy_mev(band.path().image(k)),
        max_torque_mev: torque(band, k),
        negative_modes: None,
        zero_modes: None,
        moved_rad: None,
    }
}

/// Interior images that are prominent minima of the path.
fn band_minima(band: &Band) -> Vec<IntermediateMinimum> {
    let upside_down: Vec<f64> = band.energies_mev().iter().map(|e| -e).collect();
    let s = band.path().reaction_coordinate();
    prominent_maxima(&upside_down, LOWER * height(band))
        .into_iter()
        .map(|k| IntermediateMinimum {
            image: k,
            reaction_coordinate_rad: s[k],
            spins: band.path().spins(k),
            state: image_state(band, k),
        })
        .collect()
}

/// The minimum that an image of a path between relaxed ends all but is; the image as it is where none is beside it.
fn at_rest(problem: &Problem, band: &Band, image: IntermediateMinimum) -> IntermediateMinimum {
    let h = problem.evaluator();
    let asked = problem.certify && problem.relax_ends;
    let relaxed = asked.then(|| relax_to_minimum(h, &image.spins, RELAXED * h.stiffness_mev()).ok()).flatten();
    let beside = |m: &Minimum| is_within(m.spins.as_slice(), image.spins.as_slice(), RESOLVED);
    let found =
        relaxed.map(|relaxed| Minimum::of(h, &relaxed)).filter(|minimum| minimum.is_proven() && beside(minimum));
    let Some(minimum) = found else { return image };
    let place = nearest(band.path(), minimum.spins.as_slice());
    IntermediateMinimum {
        image: place.image,
        reaction_coordinate_rad: place.s,
        state: end_of(&minimum),
        spins: minimum.spins,
    }
}

/// The highest climb on a path over these saddles and minima between its ends, each way; with the energy of the initial state, and of the
/// final one above it (meV).
pub fn highest_climb(
    barrier: Barrier,
    saddles: &[SaddlePoint],
    minima: &[IntermediateMinimum],
    [initial_mev, above_final]: [f64; 2],
) -> Barrier {
    let tops = saddles.iter().map(|s| (s.reaction_coordinate_rad, s.above_initial_mev));
    let minima = minima.iter().map(|m| (m.reaction_coordinate_rad, m.state.energy_mev - initial_mev));
    highest_of(barrier, tops, minima, above_final)
}

/// The same of places and heights above the initial state.
fn highest_of(
    barrier: Barrier,
    saddles: impl Iterator<Item = (f64, f64)>,
    minima: impl Iterator<Item = (f64, f64)>,
    above_final: f64,
) -> Barrier {
    // where a path is coarse a saddle and the minimum behind it may be at one place
    let tops = saddles.enumerate().map(|(k, s)| (s.0, s.1, 2 * k));
    let mut levels: Vec<(f64, f64, usize)> =
        minima.enumerate().map(|(k, m)| (m.0, m.1, 2 * k + 1)).chain(tops).collect();
    levels.sort_by(|p, q| p.0.total_cmp(&q.0).then(p.2.cmp(&q.2)));
    let climb = |levels: &mut dyn Iterator<Item = &(f64, f64, usize)>, from: f64, least: f64| {
        let step = |(deepest, most): (f64, f64), &(_, height, k): &(f64, f64, usize)| match k % 2 == 0 {
            true => (deepest, f64::max(most, height - deepest)),
            false => (f64::min(deepest, height), most),
        };
        levels.fold((from, least), step).1
    };
    Barrier {
        forward_mev: climb(&mut levels.iter(), 0.0, barrier.forward_mev),
        backward_mev: climb(&mut levels.iter().rev(), above_final, barrier.backward_mev),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_climb_starts_from_the_deepest_minimum_before_a_saddle() {
        let climb = |saddles: &[f64], minima: &[f64], end: f64| {
            let top = saddles.iter().fold(f64::MIN, |t, s| t.max(*s));
            let barrier = Barrier { forward_mev: top, backward_mev: top - end };
            let at = |odd: f64| move |(k, height): (usize, &f64)| (2.0 * k as f64 + odd, *height);
            let (tops, deeps) = (saddles.iter().enumerate().map(at(0.0)), minima.iter().enumerate().map(at(1.0)));
            let found = highest_of(barrier, tops, deeps, end);
            [found.forward_mev, found.backward_mev]
        };
        // one saddle: the barrier
        assert_eq!(climb(&[2.0], &[], 0.5), [2.0, 1.5]);
        // a shallow minimum on the way changes nothing
        assert_eq!(climb(&[2.0, 1.0], &[0.5], 0.0), [2.0, 2.0]);
        // a deep one is climbed out of: forward over the second saddle, backward over the first
        assert_eq!(climb(&[0.5, 0.25], &[-0.5], 0.25), [0.75, 1.0]);
        // two of them: the deeper one before the higher saddle
        assert_eq!(climb(&[1.0, 2.0, 1.5], &[-1.0, -2.0], -3.0), [3.5, 5.0]);
        // a minimum at the place of the saddle before it comes after that
        let barrier = Barrier { forward_mev: 2.0, backward_mev: 2.0 };
        let found = highest_of(barrier, [(1.0, 2.0), (2.0, 1.5)].into_iter(), [(1.0, -1.0)].into_iter(), 0.0);
        assert_eq!([found.forward_mev, found.backward_mev], [2.5, 3.0]);
    }
}
