//! From a finished run to its outcome: tables, barrier, warnings.

use super::first_path::FirstPath;
use super::judge::{Judgement, Seen};
use super::network::NetworkTimes;
use super::outcome::*;
use super::places::{Place, in_order, nearest};
use super::rates::{self, Known};
use super::relaxation::{height, prominent_maxima};
use super::run::Run;
use super::{Partial, Problem, Verdict};
use crate::band::{Band, Profile};
use crate::energy::Evaluator;
use crate::landscape::{Doubt, Effort, Minimum, Pass, Saddle};
use crate::linalg::slab;
use crate::path::{Path, RESOLVED, is_within};
use crate::rates::Symmetry;
use crate::spins::Spins;
use crate::stationary::{LOWER, RELAXED, Spectrum, relax_to_minimum};
use crate::threads::{MADE, apiece};
use rayon::prelude::*;

/// Points of the profile in every interval.
const PROFILE: usize = 16;

/// What was proven of a path.
pub struct Proof {
    /// The two ends, examined.
    pub ends: [Minimum; 2],
    /// Saddles in path order, with the minima beside them.
    pub links: Vec<Pass>,
    /// What stands against a certificate; nothing if it is given.
    pub doubts: Vec<Doubt>,
}

/// What its rates are made of, beside its saddles.
#[derive(Default)]
pub struct Rated<'a> {
    /// The symmetry of the energy and the moments, where there are saddles.
    pub symmetry: Option<&'a Symmetry>,
    /// The times over all passes that are known, where they were looked for.
    pub network: Option<NetworkTimes>,
}

impl Run<'_, '_> {
    fn work(&self, iterations: usize) -> Work {
        Work {
            iterations,
            force_evaluations: self.evaluated().evaluations,
            seconds: self.problem.made_in_s + self.started.elapsed().as_secs_f64(),
            threads: rayon::current_num_threads(),
        }
    }

    /// The two ends as they are reported.
    fn end_points(&self, ends: &[Minimum; 2]) -> [EndPoint; 2] {
        let moved = |k: usize| self.problem.relax_ends.then_some(self.ends[k].largest_rotation_rad);
        [0, 1].map(|k| EndPoint { moved_rad: moved(k), ..end_of(&ends[k]) })
    }

    /// What is to be said, with this of the path.
    fn told(&self, of_path: impl IntoIterator<Item = String>) -> Vec<String> {
        self.warnings.iter().cloned().chain(of_path).chain(self.problem.warnings.iter().cloned()).collect()
    }
}

/// The outcome of a path.
pub fn outcome(
    run: &Run,
    c: FirstPath,
    found: &[Saddle],
    proof: Proof,
    search: SearchReport,
    rejected_paths: Vec<RejectedPath>,
    rated: Rated,
) -> Outcome {
    let h = run.problem.evaluator();
    let band = &c.band;
    let initial = band.path().image(0);
    let above_final = h.difference_mev(band.path().image(band.images() - 1), initial);
    let places = places_of(band.path(), &proof.links);
    let mut saddles = saddles(run.problem, band, found, &proof.links, &places);
    let seen = Seen { problem: run.problem, saddles: &saddles, above_final, ends: &proof.ends };
    let Judgement { verdict, barrier, doubts } = seen.judge(&c, proof.doubts);
    // nothing is crossed in a flat valley
    let (saddles, links) = match verdict {
        Verdict::FlatValley { .. } | Verdict::BelowRounding { .. } => (Vec::new(), &[][..]),
        _ => {
            tell_eigenvalues(h, &mut saddles, &proof.links);
            (saddles, &proof.links[..])
        }
    };
    let rates = run.problem.rates.as_ref().map(|settings| {
        let no_barrier = barrier.is_none().then_some(&verdict);
        let symmetry = rated.symmetry.filter(|_| !links.is_empty());
        let known = Known { h, links, saddles: &saddles, above_final, doubts: &doubts, no_barrier, symmetry };
        let mut rates = rates::of_path(&known, settings);
        if let Some(network) = &rated.network {
            network.put_into(&mut rates);
        }
        rates
    });
    let behind = proof.links.iter().zip(places.iter().skip(1).step_by(2));
    let intermediate_minima: Vec<IntermediateMinimum> = match proof.links.len() {
        0 | 1 => band_minima(band).into_iter().map(|image| at_rest(run.problem, band, image)).collect(),
        _ => behind.map(|(link, place)| minimum_of(link, *place)).collect(),
    };
    let highest_climb = barrier.map(|b| {
        let above = |m: &IntermediateMinimum| m.state.energy_mev - h.energy_mev(initial);
        let minima = intermediate_minima.iter().map(|m| (m.reaction_coordinate_rad, above(m)));
        let tops = saddles.iter().map(|s| (s.reaction_coordinate_rad, s.above_initial_mev));
        highest_climb(b, tops, minima, above_final)
    });
    let flat = flat_warnings(&proof.ends, &proof.links);
    let of_rates = rates.iter().flat_map(|rates| rates::warnings(rates, &search, barrier, highest_climb));
    let of_network = rates.iter().zip(&rated.network).flat_map(|(rates, network)| network.warnings(rates));
    let of_rates = of_rates.chain(of_network);
    let images: Vec<usize> = saddles.iter().map(|saddle| saddle.image).collect();
    let lower = lower_maxima(band.energies_mev(), LOWER * height(band), &images);
    let more = run.problem.images.asked_for().and_then(|asked| more_images(asked, band.images(), saddles.len()));
    let hidden = matches!(verdict, Verdict::BelowRounding { .. }).then(|| format!("not certified: {verdict}"));
    let doubtful = doubts.iter().map(Doubt::warning).chain(hidden);
    let warnings = run.told(more.into_iter().chain(doubtful).chain(flat).chain(lower).chain(of_rates));
    let (certified, iterations) = (doubts.is_empty() && barrier.is_some(), band.evaluations());
    let beside = links.iter().flat_map(|link| [&link.before, &link.after]).chain(&proof.ends);
    let spectra = links.iter().map(|link| &link.spectrum).chain(beside.map(|minimum| &minimum.spectrum));
    let certificate = certified.then(|| Certificate::of(spectra));
    let ends = run.end_points(&proof.ends);
    Outcome {
        certified,
        certificate,
        warnings,
        barrier,
        highest_climb,
        saddles,
        intermediate_minima,
        rates,
        search,
        rejected_paths,
        ..of_band(c.band, c.history, &verdict, ends, run.work(iterations))
    }
}

/// The highest climb on a path over these saddles and intermediate minima (place and height above the initial state), each way.
fn highest_climb(
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

/// Both ends relaxed to one minimum: a result without a path.
pub fn same_minimum(run: &Run) -> Outcome {
    let h = run.problem.evaluator();
    let path = Path::new(&[run.ends[0].spins.clone(), run.ends[1].spins.clone()]);
    let ends = Minimum::of_both(h, &run.ends);
    let images = image_table(h, &Band::new(h, path.clone()));
    Outcome {
        warnings: run.told(["there is no path between a minimum and itself".into()]),
        ..bare(path, images, &Verdict::SameMinimum, run.end_points(&ends), run.work(0))
    }
}

/// What is known of a run that was stopped: the band as it stood, without a barrier. `why` says that it is not the end.
pub fn partial(problem: &Problem, partial: &Partial, why: &str) -> Outcome {
    let mut band = Band::new(problem.evaluator(), partial.path.clone());
    band.evaluate();
    let ends = [0, band.images() - 1].map(|k| image_state(&band, k));
    let work = Work { iterations: partial.history.len(), threads: rayon::current_num_threads(), ..Work::default() };
    of_band(band, partial.history.clone(), &Verdict::Interrupted(why.into()), ends, work)
}

/// What a run came to whose band was evaluated, with nothing else said of its path.
fn of_band(band: Band, history: Vec<HistoryRow>, verdict: &Verdict, ends: [EndPoint; 2], work: Work) -> Outcome {
    let images = image_table(band.evaluator(), &band);
    Outcome {
        profile: profile(&band),
        profile_terms_mev: profile_terms(&band.profile(), &images),
        max_perpendicular_torque_mev: band.max_perpendicular_mev(),
        largest_predicted_rotation_rad: history.last().map_or(0.0, |r| r.largest_predicted_rotation_rad),
        history,
        ..bare(band.into_path(), images, verdict, ends, work)
    }
}

/// The same of a path that is not relaxed.
fn bare(path: Path, images: ImageTable, verdict: &Verdict, ends: [EndPoint; 2], work: Work) -> Outcome {
    let [initial, final_state] = ends;
    Outcome {
        converged: verdict.is_converged(),
        certified: false,
        certificate: None,
        stop_code: verdict.code(),
        stop_reason: verdict.to_string(),
        warnings: Vec::new(),
        barrier: None,
        highest_climb: None,
        saddles: Vec::new(),
        initial,
        final_state,
        intermediate_minima: Vec::new(),
        rates: None,
        search: SearchReport { effort: Effort::None, ..SearchReport::default() },
        rejected_paths: Vec::new(),
        path,
        images,
        profile: Vec::new(),
        profile_terms_mev: Vec::new(),
        history: Vec::new(),
        work,
        max_perpendicular_torque_mev: 0.0,
        largest_predicted_rotation_rad: 0.0,
    }
}

/// Modes under the noise floor are said, not guessed: of many saddles at once.
fn flat_warnings(ends: &[Minimum; 2], links: &[Pass]) -> Vec<String> {
    let say = |what: &str, s: &Spectrum| {
        format!("{what}: {} mode(s) flat to {:.1e} meV, counted with the zero modes", s.flat, s.floor_mev)
    };
    let of_ends = ends.iter().zip(["initial state", "final state"]).filter(|(end, _)| end.spectrum.flat > 0);
    let mut warnings: Vec<String> = of_ends.map(|(end, which)| say(which, &end.spectrum)).collect();
    let flat: Vec<usize> = (0..links.len()).filter(|k| links[*k].spectrum.flat > 0).collect();
    for alike in flat.chunk_by(|a, b| say("", &links[*a].spectrum) == say("", &links[*b].spectrum)) {
        let rows: Vec<String> = alike.chunk_by(|a, b| a + 1 == *b).map(row).collect();
        let saddles = if alike.len() == 1 { "saddle" } else { "saddles" };
        warnings.push(say(&format!("{saddles} {}", rows.join(", ")), &links[alike[0]].spectrum));
    }
    warnings
}

/// A row of numbers without a gap.
fn row(numbers: &[usize]) -> String {
    match numbers {
        [first, .., last] => format!("{first}–{last}"),
        _ => numbers.iter().map(usize::to_string).collect(),
    }
}

fn end_of(m: &Minimum) -> EndPoint {
    EndPoint {
        energy_mev: m.energy_mev,
        max_torque_mev: m.max_torque_mev,
        negative_modes: Some(m.spectrum.negative),
        zero_modes: Some(m.spectrum.zero_and_flat()),
        moved_rad: None,
    }
}

/// The saddles in path order: proven, refined, or else as the band shows them.
fn saddles(problem: &Problem, band: &Band, found: &[Saddle], links: &[Pass], places: &[Place]) -> Vec<SaddlePoint> {
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
fn tell_eigenvalues(h: Evaluator, saddles: &mut [SaddlePoint], links: &[Pass]) {
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
fn places_of(path: &Path, links: &[Pass]) -> Vec<Place> {
    let states = links.iter().flat_map(|l| [&l.saddle.refined.state.m[..], l.after.spins.as_slice()]);
    in_order(path, &states.take((2 * links.len()).saturating_sub(1)).collect::<Vec<_>>())
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
fn image_state(band: &Band, k: usize) -> EndPoint {
    EndPoint {
        energy_mev: band.hamiltonian().energy_mev(band.path().image(k)),
        max_torque_mev: torque(band, k),
        negative_modes: None,
        zero_modes: None,
        moved_rad: None,
    }
}

/// Says that a path over proven saddles has other maxima than at their images, higher than both sides by this much (meV): where a slope
/// forks, a relaxed path may leave the descent for another valley.
fn lower_maxima(e: &[f64], prominence: f64, saddles: &[usize]) -> Option<String> {
    let on_a_level = |k: usize, image: usize| e[k.min(image)..=k.max(image)].iter().all(|x| *x >= e[k] - prominence);
    let is_other = |k: &usize| saddles.iter().all(|image| image.abs_diff(*k) > 1 && !on_a_level(*k, *image));
    let others = prominent_maxima(e, prominence).into_iter().filter(is_other);
    let (count, highest) = others.fold((0, f64::NEG_INFINITY), |(n, high), k| (n + 1, f64::max(high, e[k] - e[0])));
    (count > 0 && !saddles.is_empty()).then(|| {
        format!(
            "the path has {count} more maxima than the saddles that are told, the highest {highest:.6} meV above the initial \
             state: below the barrier, and not refined"
        )
    })
}

/// That a path has more images than were asked for.
fn more_images(asked: usize, has: usize, saddles: usize) -> Option<String> {
    (has > asked).then(|| {
        format!(
            "path.images is {asked}: the lowest route that is known, over {saddles} saddles, needs more, and its path has {has}"
        )
    })
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

fn image_table(h: Evaluator, band: &Band) -> ImageTable {
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

fn profile(band: &Band) -> Vec<ProfilePoint> {
    let point = |(s, e)| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: e };
    band.profile().samples(PROFILE).into_iter().map(point).collect()
}

/// The interpolated energy of each term: cubic pieces as the total's, which they add up to. A term's slope is that of the polynomial
/// through an image and two neighbours on each side; what then lacks to the total's is shared out by how far off each may be. (A term's
/// own gradient along the tangent would not do: only the total is stationary across the path, so only its slope forgives a tangent that
/// is a chord.)
fn profile_terms(total: &Profile, images: &ImageTable) -> Vec<(String, Vec<f64>)> {
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
    fn maxima_of_a_path_that_are_no_saddles_are_told_with_the_highest() {
        let e = [1.0, 2.0, 9.0, 4.0, 4.5, 3.0, 3.000001, 0.0, 2.5, 0.0];
        let told = lower_maxima(&e, 1e-3, &[2]).unwrap();
        assert!(
            told.starts_with(
                "the path has 2 more maxima than the saddles that are told, the highest 3.500000 meV above"
            ),
            "{told}"
        );
        // images beside a saddle's are its own
        assert_eq!(lower_maxima(&e, 1.0, &[2]).map(|told| told.contains("has 1 more")), Some(true));
        assert_eq!(lower_maxima(&e, 1e-3, &[1, 4, 8]), None);
        assert_eq!(lower_maxima(&e, 1e-3, &[]), None);
        // nor is what is level with it one more
        let level = [0.0, 5.0, 5.000_1, 5.0, 5.0, 5.000_2, 5.0, 0.0];
        assert_eq!(lower_maxima(&level, 1e-3, &[2]), None);
    }

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

    #[test]
    fn the_highest_climb_starts_from_the_deepest_minimum_before_a_saddle() {
        let climb = |saddles: &[f64], minima: &[f64], end: f64| {
            let top = saddles.iter().fold(f64::MIN, |t, s| t.max(*s));
            let barrier = Barrier { forward_mev: top, backward_mev: top - end };
            let at = |odd: f64| move |(k, height): (usize, &f64)| (2.0 * k as f64 + odd, *height);
            let (tops, deeps) = (saddles.iter().enumerate().map(at(0.0)), minima.iter().enumerate().map(at(1.0)));
            let found = highest_climb(barrier, tops, deeps, end);
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
        let found = highest_climb(barrier, [(1.0, 2.0), (2.0, 1.5)].into_iter(), [(1.0, -1.0)].into_iter(), 0.0);
        assert_eq!([found.forward_mev, found.backward_mev], [2.5, 3.0]);
    }
}
