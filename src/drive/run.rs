//! A whole run.

use super::climb::{Found, conclude, escapes, same};
use super::ends::{Relaxed, relax_to_minimum};
use super::explore::{natural_guesses, turning_axis};
use super::outcome::*;
use super::relaxation::{Goal, Relaxation, height, image_levels, needs_laplacian, prominent_maxima, refined};
use super::top::{highest, tops};
use super::{Images, Observer, Problem, Scales, Stop};
use crate::band::{Band, Laplacian, align_rotations};
use crate::error::Result;
use crate::geometry::{Direction, Vector};
use crate::linalg::slab;
use crate::path::guess::{GuessContext, GuessSpec, NoiseSpec, add_noise, smooth};
use crate::path::{Path, distance};
use crate::spins::Spins;
use crate::state::StateContext;
use std::time::Instant;

/// Neighbouring images of an automatic path are at most this far apart, any spin (rad).
const RESOLVED: f64 = 1.0;
/// Neighbours of a band to start from are at most this far apart, any spin (rad).
const COARSEST: f64 = 2.0;
/// Most images of an automatic path.
const MOST_IMAGES: usize = 4001;
/// Evaluations after which first paths are compared.
const TRIAL: usize = 8;
/// Rounds of leaving a saddle of higher index.
const ESCAPES: usize = 3;
/// Maxima within this part of the path's height of the highest are refined.
const WINDOW: f64 = 0.1;
/// An end that turned by more than this left the place where it was put (rad).
const FAR: f64 = 1.0;
/// Force at a relaxed end, in parts of the largest stiffness.
const END_TOLERANCE: f64 = 1e-14;

/// Finds the minimum-energy path of a problem.
pub fn run(problem: &Problem, observer: &mut dyn Observer) -> Result<Outcome> {
    Run::prepare(problem, observer)?.finish()
}

/// A first path on its way.
struct Candidate<'a> {
    name: String,
    band: Band<'a>,
    stop: Stop,
    history: Vec<HistoryRow>,
    found: Option<Found>,
    /// Saddles of higher index that were left: energy above the first image (meV) and index.
    escapes: Vec<(f64, usize)>,
}

impl Candidate<'_> {
    /// Highest image above the first (meV).
    fn top_mev(&self) -> f64 {
        self.band.energies_mev()[self.band.highest()] - self.band.energies_mev()[0]
    }

    /// The refined saddle above the first image (meV), or the highest image.
    fn barrier_mev(&self) -> f64 {
        let refined = self.found.as_ref().map(|f| f.refined.state.energy_mev - self.band.energies_mev()[0]);
        refined.unwrap_or(self.top_mev())
    }

    /// 0: a saddle of index one; 1: nothing refined; 2: a saddle of higher index.
    fn rank(&self) -> u8 {
        match &self.found {
            Some(f) if f.refined.index <= 1 => 0,
            None => 1,
            Some(_) => 2,
        }
    }
}

struct Run<'a, 'o> {
    problem: &'a Problem,
    observer: &'o mut dyn Observer,
    started: Instant,
    ends: [Relaxed; 2],
    scales: Scales,
    axes: Vec<Vector>,
    laplacian: Option<Laplacian>,
    axis: Direction,
    warnings: Vec<String>,
    lowest_top: f64,
}

impl<'a, 'o> Run<'a, 'o> {
    fn prepare(problem: &'a Problem, observer: &'o mut dyn Observer) -> Result<Run<'a, 'o>> {
        let started = Instant::now();
        let h = &problem.hamiltonian;
        observer.stage("relaxing the ends");
        let mut warnings = Vec::new();
        let mut end = |spins: &Spins, which: &str| -> Result<Relaxed> {
            if !problem.relax_ends {
                return Ok(kept(problem, spins));
            }
            let relaxed = relax_to_minimum(h, spins, END_TOLERANCE * h.stiffness_mev())?;
            warnings.extend(judge_end(&relaxed, which));
            Ok(relaxed)
        };
        let ends = [end(&problem.initial, "initial")?, end(&problem.final_state, "final")?];
        if !problem.relax_ends {
            warnings.push("the ends were not relaxed (relax_ends is false): they need not be minima".into());
        }
        let (a, b) = (ends[0].spins.as_slice(), ends[1].spins.as_slice());
        let scales = Scales::of_ends(h, a, b);
        let axes = h.symmetry_axes_at(a);
        let laplacian = needs_laplacian(&problem.neb.optimiser).then(|| Laplacian::new(h, scales.stiffness_mev));
        let mut run = Run {
            problem,
            observer,
            started,
            ends,
            scales,
            axes,
            laplacian,
            axis: Direction::X,
            warnings,
            lowest_top: f64::INFINITY,
        };
        run.axis = turning_axis(problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        Ok(run)
    }

    fn context(&self) -> GuessContext<'a> {
        GuessContext {
            states: StateContext { chain: &self.problem.chain, wall_width_sites: self.scales.wall_width_sites },
            default_axis: self.axis,
        }
    }

    fn finish(mut self) -> Result<Outcome> {
        let (a, b) = (self.ends[0].spins.as_slice(), self.ends[1].spins.as_slice());
        if distance(a, b) < 1e-6 * (self.problem.chain.sites as f64).sqrt() {
            return Ok(self.same_minimum());
        }
        let (mut candidate, rejected) = match &self.problem.guess {
            Some(guess) => {
                let mut c = self.start(guess, self.problem.noise.as_ref(), self.problem.smooth, usize::MAX)?;
                self.conclude(&mut c);
                (c, Vec::new())
            }
            None => self.best_natural()?,
        };
        loop {
            self.resolve(&mut candidate);
            let images = candidate.band.images();
            self.relax(&mut candidate, Goal::Tight, usize::MAX);
            let coarse = self.problem.images == Images::Auto && candidate.band.path().largest_rotation() > RESOLVED;
            if !coarse || images >= MOST_IMAGES || !candidate.stop.is_converged() {
                break;
            }
        }
        let found = self.all_saddles(&mut candidate);
        if self.problem.neb.climb {
            seat(&mut candidate.band, &found);
        }
        Ok(self.outcome(candidate, found, rejected))
    }

    /// The lowest of the natural first paths, and what became of the others: a few evaluations each, the best two finished.
    fn best_natural(&mut self) -> Result<(Candidate<'a>, Vec<RejectedPath>)> {
        let mut tried = Vec::new();
        for (guess, noise) in natural_guesses(self.problem, &self.ends[0].spins, &self.ends[1].spins, self.axis) {
            self.observer.stage(&format!("first path: {}", describe(&guess)));
            tried.push(self.start(&guess, noise.as_ref(), None, TRIAL)?);
        }
        tried.sort_by(|p, q| p.top_mev().total_cmp(&q.top_mev()));
        let mut finished = 0;
        for c in &mut tried {
            let lowest = c.top_mev();
            let worth = finished < 2 && self.problem.seeks_saddles();
            if worth && !(finished == 1 && lowest > 1.2 * self.lowest_top) {
                self.conclude(c);
                finished += 1;
                self.lowest_top = self.lowest_top.min(c.barrier_mev());
            }
        }
        tried.sort_by(|p, q| p.rank().cmp(&q.rank()).then(p.barrier_mev().total_cmp(&q.barrier_mev())));
        let mut rest = tried.into_iter();
        let Some(best) = rest.next() else { unreachable!("the geodesic is always among the guesses") };
        let rejected = rest.map(|c| rejection(&c, &best)).collect();
        Ok((best, rejected))
    }

    /// Relaxes a path until its top is a refined saddle of index one, leaving saddles of higher index sideways.
    fn conclude(&mut self, c: &mut Candidate<'a>) {
        let scale = self.scales.stiffness_mev;
        for round in 0..ESCAPES {
            if !c.stop.is_converged() {
                self.relax(c, Goal::Loose, c.band.evaluations() + 24);
            }
            if !self.problem.seeks_saddles() {
                return;
            }
            self.zoom(c);
            c.found = conclude(&c.band, scale);
            let Some(found) = c.found.as_ref() else { return };
            if found.is_saddle(scale) || round + 1 == ESCAPES {
                return;
            }
            let mut best: Option<Band<'a>> = None;
            for path in escapes(&c.band, found, scale) {
                let mut band = Band::continued(&self.problem.hamiltonian, path, c.band.evaluations());
                align_rotations(band.path_mut(), &self.axes);
                band.evaluate();
                let top = |b: &Band| b.energies_mev()[b.highest()];
                if best.as_ref().is_none_or(|b| top(&band) < top(b) - 1e-9 * scale) {
                    best = Some(band);
                }
            }
            let Some(band) = best else { return };
            self.observer.stage(&format!("leaving a saddle of index {}", found.refined.index));
            c.escapes.push((found.refined.state.energy_mev - c.band.energies_mev()[0], found.refined.index));
            c.band = band;
            c.stop = Stop::NotFinite;
        }
    }

    /// A top inside the first or last interval is not resolved: the part of the path around it becomes finer.
    fn zoom(&mut self, c: &mut Candidate<'a>) {
        for _ in 0..4 {
            let last = c.band.images() - 1;
            let Some(top) = highest(&c.band) else { return };
            let s = c.band.path().reaction_coordinate();
            let (left, right) = (s[1], s[last - 1]);
            if top.s > left && top.s < right {
                return;
            }
            let images = match self.problem.images {
                Images::Count(n) => n,
                Images::Auto => c.band.images() + 8,
            };
            let places = condensed(&s, if top.s <= left { 0 } else { last }, images);
            let path = c.band.path().at_places(&s, &places);
            c.band = Band::continued(&self.problem.hamiltonian, path, c.band.evaluations());
            self.relax(c, Goal::Loose, c.band.evaluations() + 24);
        }
    }

    /// Every maximum within a tenth of the highest, refined; saddles found twice count once.
    fn all_saddles(&mut self, c: &mut Candidate<'a>) -> Vec<Found> {
        let scale = self.scales.stiffness_mev;
        if !self.problem.seeks_saddles() {
            return Vec::new();
        }
        let h = &self.problem.hamiltonian;
        let mut found: Vec<Found> = Vec::new();
        for top in tops(&c.band, WINDOW * height(&c.band)) {
            let f = Found::at(h, top, scale);
            if f.is_saddle(scale) && !found.iter().any(|g| same(&g.refined.state.m, &f.refined.state.m)) {
                found.push(f);
            }
        }
        found
    }

    /// A first path, relaxed from few images to as many as asked for (automatic: as few as resolve it).
    fn start(
        &mut self,
        guess: &GuessSpec,
        noise: Option<&NoiseSpec>,
        smoothing: Option<f64>,
        limit: usize,
    ) -> Result<Candidate<'a>> {
        let context = self.context();
        let (a, b) = (&self.ends[0].spins, &self.ends[1].spins);
        let make = |images: usize| -> Result<Path> {
            let mut path = guess.member().path(a, b, images, &context)?;
            if let Some(noise) = noise {
                path = add_noise(&path, noise, context.states.chain);
            }
            Ok(match smoothing {
                Some(strength) => smooth(&path, strength),
                None => path,
            })
        };
        let coarsest = match self.problem.images {
            Images::Auto => self.scales.images_between(self.problem.chain.sites) + 2,
            Images::Count(n) => image_levels(n, |n| make(n).is_ok_and(|p| p.largest_rotation() <= COARSEST))[0],
        };
        let band = Band::new(&self.problem.hamiltonian, make(coarsest)?);
        let mut c = Candidate {
            name: describe(guess),
            band,
            stop: Stop::NotFinite,
            history: Vec::new(),
            found: None,
            escapes: Vec::new(),
        };
        self.relax(&mut c, Goal::Loose, limit);
        Ok(c)
    }

    /// More images, each time relaxed loosely: to the number asked for, or until neighbours are within 1 rad a spin.
    fn resolve(&mut self, c: &mut Candidate<'a>) {
        if !c.stop.is_converged() {
            self.relax(c, Goal::Loose, c.band.evaluations() + 24);
        }
        loop {
            let now = c.band.images();
            let next = match self.problem.images {
                Images::Count(n) if now < n => image_levels(n, |_| true).into_iter().find(|l| *l > now).unwrap_or(n),
                Images::Auto if c.band.path().largest_rotation() > RESOLVED && now < MOST_IMAGES => 2 * now - 1,
                _ => return,
            };
            self.observer.stage(&format!("{next} images"));
            let evaluations = c.band.evaluations();
            c.band = Band::continued(&self.problem.hamiltonian, refined(c.band.path(), next), evaluations);
            self.relax(c, Goal::Loose, evaluations + 40);
        }
    }

    fn relax(&mut self, c: &mut Candidate<'a>, goal: Goal, limit: usize) {
        let mut relaxation = Relaxation {
            settings: &self.problem.neb,
            climb: self.problem.neb.climb && !self.problem.refine,
            scales: self.scales,
            axes: &self.axes,
            laplacian: self.laplacian.as_ref(),
            history: std::mem::take(&mut c.history),
            observer: self.observer,
        };
        c.stop = relaxation.run(&mut c.band, goal, limit.min(self.problem.neb.max_evaluations));
        c.history = relaxation.history;
    }

    fn outcome(self, c: Candidate<'a>, found: Vec<Found>, rejected_paths: Vec<RejectedPath>) -> Outcome {
        let h = &self.problem.hamiltonian;
        let band = &c.band;
        let path = band.path().clone();
        let profile = band.profile();
        let (first, last) = (path.image(0), path.image(path.images() - 1));
        let saddles = if found.is_empty() { self.saddles(band) } else { refined_saddles(h, band, &found) };
        let above_final = h.difference_mev(last, first);
        let mut warnings = self.warnings;
        let top = saddles.iter().map(|s| s.above_initial_mev).fold(f64::NEG_INFINITY, f64::max);
        let seen = band.energies_mev()[band.highest()] - band.energies_mev()[0];
        let missed = seen > top + 1e-6 * height(band) && seen > above_final.max(0.0) + 1e-9 * height(band);
        if missed && !found.is_empty() {
            warnings.push(
                "an image of the path lies above every refined saddle: the barrier is that image's energy".into(),
            );
        }
        let top = if missed { seen } else { top };
        let mut stop_reason = c.stop.to_string();
        let top = if top > above_final.max(0.0) {
            top
        } else {
            stop_reason
                .push_str("; the path rises to no maximum between its ends: there is no barrier beyond the higher end");
            above_final.max(0.0)
        };
        let barrier = Barrier { forward_mev: top, backward_mev: top - above_final };
        warnings.push("the barrier is the band's; its saddle is not refined yet and not certified".into());
        let rotation = c.history.last().map_or(0.0, |r| r.largest_predicted_rotation_rad);
        Outcome {
            converged: c.stop.is_converged(),
            certified: false,
            stop_reason,
            warnings,
            barrier: Some(barrier),
            initial: end_point(h, &self.ends[0]),
            final_state: end_point(h, &self.ends[1]),
            intermediate_minima: minima(h, band),
            rejected_paths,
            images: image_table(h, band),
            profile: profile
                .samples(16)
                .into_iter()
                .map(|(s, e)| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: e })
                .collect(),
            work: Work {
                iterations: band.evaluations(),
                force_evaluations: h.evaluations(),
                seconds: self.started.elapsed().as_secs_f64(),
                threads: rayon::current_num_threads(),
            },
            max_perpendicular_torque_mev: band.max_perpendicular_mev(),
            largest_predicted_rotation_rad: rotation,
            history: c.history,
            saddles,
            path,
        }
    }

    /// The prominent maxima: the climbing images, or without them the maxima of the interpolated energy.
    fn saddles(&self, band: &Band) -> Vec<SaddlePoint> {
        let h = &self.problem.hamiltonian;
        let first = band.path().image(0);
        let profile = band.profile();
        let peak = |k: usize| {
            let near = |x: &&crate::band::Extremum| x.is_maximum && (x.interval == k || x.interval + 1 == k);
            let between = profile.extrema().iter().filter(near).copied().max_by(|p, q| p.energy.total_cmp(&q.energy));
            let image = h.difference_mev(band.path().image(k), first);
            match between.filter(|_| !self.problem.neb.climb) {
                Some(x) => (x.s, x.energy.max(image), None),
                None => (profile.s[k], image, Some(torque(band, k))),
            }
        };
        let reference = h.energy_mev(first);
        prominent_maxima(band.energies_mev(), 1e-6 * height(band))
            .into_iter()
            .map(|k| {
                let (s, above, max_torque_mev) = peak(k);
                SaddlePoint {
                    energy_mev: reference + above,
                    above_initial_mev: above,
                    reaction_coordinate_rad: s,
                    image: k,
                    max_torque_mev,
                    negative_modes: None,
                    zero_modes: None,
                    lowest_eigenvalues_mev: Vec::new(),
                }
            })
            .collect()
    }

    /// Both ends relaxed to one minimum: a result without a path.
    fn same_minimum(self) -> Outcome {
        let h = &self.problem.hamiltonian;
        let path = Path::new(&[self.ends[0].spins.clone(), self.ends[1].spins.clone()]);
        let band = Band::new(h, path.clone());
        let mut warnings = self.warnings;
        warnings.push("there is no path between a minimum and itself".into());
        Outcome {
            converged: false,
            certified: false,
            stop_reason: "the initial and the final state relaxed to the same minimum".into(),
            warnings,
            barrier: None,
            saddles: Vec::new(),
            initial: end_point(h, &self.ends[0]),
            final_state: end_point(h, &self.ends[1]),
            intermediate_minima: Vec::new(),
            rejected_paths: Vec::new(),
            images: image_table(h, &band),
            profile: Vec::new(),
            history: Vec::new(),
            work: Work {
                iterations: 0,
                force_evaluations: h.evaluations(),
                seconds: self.started.elapsed().as_secs_f64(),
                threads: rayon::current_num_threads(),
            },
            max_perpendicular_torque_mev: 0.0,
            largest_predicted_rotation_rad: 0.0,
            path,
        }
    }
}

/// Puts refined saddles in the place of the images nearest to them, where they fit between the neighbours.
fn seat(band: &mut Band, found: &[Found]) {
    let slab_size = 3 * band.path().sites();
    let last = band.images() - 1;
    for f in found {
        let k = f.top.image.clamp(1, last - 1);
        let saddle = &f.refined.state.m;
        let gap = distance(band.path().image(k - 1), band.path().image(k + 1));
        let fits = [k - 1, k + 1].iter().all(|&j| distance(band.path().image(j), saddle) < gap);
        if fits {
            band.path_mut().as_mut_slice()[k * slab_size..(k + 1) * slab_size].copy_from_slice(saddle);
        }
    }
    if !found.is_empty() {
        band.evaluate();
    }
}

/// Why a path was not the one.
fn rejection(c: &Candidate, best: &Candidate) -> RejectedPath {
    let (barrier_mev, negative_modes) = (Some(c.barrier_mev()), c.found.as_ref().map(|f| f.refined.index));
    let reason = match &c.found {
        Some(f) if f.refined.index > 1 => "its top is a saddle of higher index".to_string(),
        Some(_) => format!("its saddle is not below that of \"{}\"", best.name),
        None => format!(
            "its highest image lies above the path \"{}\" after {} evaluations",
            best.name,
            c.band.evaluations()
        ),
    };
    RejectedPath { guess: c.name.clone(), barrier_mev, negative_modes, reason }
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

/// Refined saddles in path order.
fn refined_saddles(h: &crate::energy::Hamiltonian, band: &Band, found: &[Found]) -> Vec<SaddlePoint> {
    let first = band.path().image(0);
    let reference = h.energy_mev(first);
    let mut saddles: Vec<SaddlePoint> = found
        .iter()
        .map(|f| {
            let above = h.difference_mev(&f.refined.state.m, first);
            SaddlePoint {
                energy_mev: reference + above,
                above_initial_mev: above,
                reaction_coordinate_rad: f.top.s,
                image: f.top.image,
                max_torque_mev: Some(f.refined.state.max_torque_mev()),
                negative_modes: Some(f.refined.index),
                zero_modes: Some(f.refined.state.zeros.len()),
                lowest_eigenvalues_mev: Vec::new(),
            }
        })
        .collect();
    saddles.sort_by(|p, q| p.reaction_coordinate_rad.total_cmp(&q.reaction_coordinate_rad));
    saddles
}

/// The config fragment of a guess, for people.
fn describe(guess: &GuessSpec) -> String {
    match guess {
        GuessSpec::Sweep(s) => format!("sweep from {}", s.from),
        other => other.name().to_string(),
    }
}

/// An end that stays as given.
fn kept(problem: &Problem, spins: &Spins) -> Relaxed {
    let h = &problem.hamiltonian;
    let m = spins.as_slice();
    let (mut g, mut f) = (vec![0.0; m.len()], vec![0.0; m.len()]);
    h.energy_gradient(m, &mut g);
    h.force(m, &g, &mut f);
    let max_torque_mev = slab::max_abs(&f);
    Relaxed {
        spins: spins.clone(),
        max_torque_mev,
        steps: 0,
        largest_rotation_rad: 0.0,
        left_saddle: false,
        converged: true,
    }
}

fn judge_end(r: &Relaxed, which: &str) -> Vec<String> {
    let mut warnings = Vec::new();
    let degrees = r.largest_rotation_rad.to_degrees();
    if r.left_saddle {
        warnings.push(format!("the {which} state was stationary but no minimum; it was left along its lowest mode"));
    }
    if r.largest_rotation_rad > FAR {
        warnings.push(format!("the {which} state relaxed far from where it was put: a spin turned by {degrees:.0} degrees, so it may be another state than meant"));
    }
    if !r.converged {
        warnings
            .push(format!("the {which} state did not relax fully: a torque of {:.1e} meV remains", r.max_torque_mev));
    }
    warnings
}

fn end_point(h: &crate::energy::Hamiltonian, r: &Relaxed) -> EndPoint {
    EndPoint {
        energy_mev: h.energy_mev(r.spins.as_slice()),
        max_torque_mev: r.max_torque_mev,
        negative_modes: None,
        zero_modes: None,
    }
}

/// Largest component of the whole force on image k (meV).
fn torque(band: &Band, k: usize) -> f64 {
    let mut f = band.perpendicular(k).to_vec();
    slab::add_scaled(&mut f, band.along(k), band.tangent(k));
    slab::max_abs(&f)
}

/// Interior images that are prominent minima of the path.
fn minima(h: &crate::energy::Hamiltonian, band: &Band) -> Vec<IntermediateMinimum> {
    let upside_down: Vec<f64> = band.energies_mev().iter().map(|e| -e).collect();
    let s = band.path().reaction_coordinate();
    let state = |k: usize| EndPoint {
        energy_mev: h.energy_mev(band.path().image(k)),
        max_torque_mev: torque(band, k),
        negative_modes: None,
        zero_modes: None,
    };
    prominent_maxima(&upside_down, 1e-3 * height(band))
        .into_iter()
        .map(|k| IntermediateMinimum { image: k, reaction_coordinate_rad: s[k], state: state(k) })
        .collect()
}

fn image_table(h: &crate::energy::Hamiltonian, band: &Band) -> ImageTable {
    let path = band.path();
    let images = path.images();
    let mut terms_mev: Vec<(String, Vec<f64>)> = Vec::new();
    for k in 0..images {
        for (j, (name, e)) in h.energies_mev(path.image(k)).into_iter().enumerate() {
            if k == 0 {
                terms_mev.push((name.to_string(), Vec::with_capacity(images)));
            }
            terms_mev[j].1.push(e);
        }
    }
    ImageTable {
        reaction_coordinate_rad: path.reaction_coordinate(),
        energy_mev: (0..images).map(|k| h.energy_mev(path.image(k))).collect(),
        above_initial_mev: (0..images).map(|k| h.difference_mev(path.image(k), path.image(0))).collect(),
        terms_mev,
        max_perpendicular_torque_mev: (0..images).map(|k| slab::max_abs(band.perpendicular(k))).collect(),
    }
}
