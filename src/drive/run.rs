//! A whole run.

use super::candidate::{Candidate, describe, rejection};
use super::climb::{ZOOMS, escapes, zoomed};
use super::connect::{Sequence, follow};
use super::ends::{judge_end, kept};
use super::explore::{natural_guesses, turning_axis};
use super::join::{Joined, Tools, joined};
use super::lower::lowered;
use super::outcome::*;
use super::relaxation::{Goal, Relaxation, height, image_levels, needs_laplacian, refined};
use super::report::{self, Prepared, Proof};
use super::{Images, Observer, Problem, Scales, Silent, Stop};
use crate::band::{Band, Laplacian, align_rotations};
use crate::energy::Evaluator;
use crate::energy::recorded;
use crate::error::Result;
use crate::geometry::{Direction, Vector};
use crate::landscape::{Doubt, PathEnd};
use crate::landscape::{Minimum, Pass};
use crate::landscape::{Peak, highest, peaks};
use crate::landscape::{Saddle, same};
use crate::path::guess::{FirstGuess, GuessContext, GuessSpec, NoiseSpec, Rotation, add_noise, moving_sites, smooth};
use crate::path::{Path, distance};
use crate::spins::Spins;
use crate::stationary::{Relaxed, relax_to_minimum};
use crate::threads::both;
use std::sync::Arc;
use std::time::Instant;

/// Neighbouring images of an automatic path are at most this far apart, any spin (rad).
const RESOLVED: f64 = 1.0;
/// Neighbours of a band to start from are at most this far apart, any spin (rad).
const COARSEST: f64 = 2.0;
/// Fewest images of an automatic path in the end.
pub const FEWEST_IMAGES: usize = 17;
/// Most images of an automatic path.
const MOST_IMAGES: usize = 2001;
/// Evaluations after which first paths are compared.
const TRIAL: usize = 8;
/// Evaluations of a band before its minima are looked at.
const FIRST: usize = 60;
/// Further paths that are followed to the end when the best one cannot be proven.
const SECOND_TRIES: usize = 2;
/// They are not if their top is higher than the best one's times this.
const SECOND_BELOW: f64 = 1.2;
/// Another path is tried beside a proven one if its top is lower by more than this part.
const BELOW: f64 = 1e-6;
/// A proven path takes the place of an unproven one unless it is higher by more than this part: images may straddle a top.
const AS_LOW: f64 = 1e-3;
/// Rounds of leaving a saddle of higher index.
const ESCAPES: usize = 3;
/// Maxima within this part of the path's height of the highest are refined.
const WINDOW: f64 = 0.1;
/// Force at a relaxed end, in parts of the largest stiffness.
pub(super) const END_TOLERANCE: f64 = 1e-14;

/// Finds the minimum-energy path of a problem, taking what its [`Control`](crate::control::Control) finds on record from there, and
/// recording what it computes. A run that its control stops ends with [`Error::Stopped`](crate::error::Error::Stopped).
pub fn run(problem: &Problem, observer: &mut dyn Observer) -> Result<Outcome> {
    problem.control.recorder().begin(|| problem.fingerprint());
    // on a thread of the pool, so that it is not left and entered again for every band
    rayon::scope(|_| Run::prepare(problem, observer)?.finish())
}

/// A path with what is known of it.
pub(super) struct Settled<'a> {
    pub(super) candidate: Candidate<'a>,
    found: Vec<Saddle>,
    pub(super) proof: Proof,
}

impl Settled<'_> {
    /// The highest that the path is known to pass above its first image (meV): an image or a saddle.
    pub(super) fn seen_mev(&self) -> f64 {
        let reference = self.candidate.band.energies_mev()[0];
        let saddles = self.proof.links.iter().map(|l| l.saddle.refined.state.energy_mev - reference);
        saddles.fold(self.candidate.top_mev(), f64::max)
    }
}

/// What no image of a path over these saddles exceeds (meV above the first image): the highest of them or an end, and rounding.
fn over(c: &Candidate, links: &[Pass]) -> f64 {
    let e = c.band.energies_mev();
    let saddles = links.iter().map(|l| l.saddle.refined.state.energy_mev - e[0]);
    saddles.fold((e[e.len() - 1] - e[0]).max(0.0), f64::max) + 1e-6 * height(&c.band)
}

pub(super) struct Run<'a, 'o> {
    pub(super) problem: &'a Problem,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) started: Instant,
    pub(super) ends: [Relaxed; 2],
    pub(super) scales: Scales,
    pub(super) axes: Vec<Vector>,
    pub(super) laplacian: Option<Arc<Laplacian>>,
    pub(super) axis: Direction,
    pub(super) warnings: Vec<String>,
    pub(super) lowest_top: f64,
    /// Every certified pass that was met.
    pub(super) met: Vec<Pass>,
    pub(super) silent: Silent,
}

impl<'a, 'o> Run<'a, 'o> {
    fn prepare(problem: &'a Problem, observer: &'o mut dyn Observer) -> Result<Run<'a, 'o>> {
        let started = Instant::now();
        let h = problem.evaluator();
        observer.stage("relaxing the ends");
        let mut warnings = Vec::new();
        let given = [&problem.initial, &problem.final_state];
        let ends = if problem.relax_ends {
            recorded(h, "ends", &given.map(|spins| spins.as_slice()), || relaxed_ends(h, given))?
        } else {
            given.map(|spins| kept(h, spins))
        };
        if problem.relax_ends {
            warnings.extend(ends.iter().zip(["initial", "final"]).flat_map(|(end, which)| judge_end(end, which)));
        } else {
            warnings.push(
                "the ends were not relaxed (relax_ends is false): they need not be minima, and a certificate speaks of the saddle alone"
                    .into(),
            );
        }
        let (a, b) = (ends[0].spins.as_slice(), ends[1].spins.as_slice());
        let scales = recorded(h, "scales", &[a, b], || Ok(Scales::of_ends(h, a, b)))?;
        let axes = h.symmetry_axes_at(a);
        let laplacian =
            needs_laplacian(&problem.neb.optimiser).then(|| Arc::new(Laplacian::new(&h, scales.stiffness_mev)));
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
            met: Vec::new(),
            silent: Silent,
        };
        run.axis = turning_axis(problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        Ok(run)
    }

    pub(super) fn context(&self) -> GuessContext<'a> {
        GuessContext { states: self.problem.states(&self.scales), default_axis: self.axis }
    }

    fn finish(mut self) -> Result<Outcome> {
        let (a, b) = (self.ends[0].spins.as_slice(), self.ends[1].spins.as_slice());
        if distance(a, b) < 1e-6 * (self.problem.hamiltonian.sites() as f64).sqrt() {
            return Ok(report::same_minimum(self.prepared()));
        }
        if let Some(flat) = self.turned_minimum()? {
            return Ok(flat);
        }
        let mut candidates = match &self.problem.guess {
            Some(guess) => {
                let (noise, smoothing) = (self.problem.noise.as_ref(), self.problem.smooth);
                let name = describe(guess, false);
                self.observer.stage(&format!("first path: {name}"));
                let mut c = self.start(name, guess, noise, smoothing, usize::MAX)?;
                self.conclude(&mut c)?;
                vec![c]
            }
            None => self.natural()?,
        };
        let mut best = self.settle(candidates.remove(0))?;
        let mut others = Vec::new();
        let scale = self.scales.stiffness_mev;
        for _ in 0..SECOND_TRIES.min(candidates.len()) {
            if !self.problem.certify || !self.problem.seeks_saddles() {
                break;
            }
            let mut next = candidates.remove(0);
            // a proven path is the one, unless what is known of another lies below its highest saddle
            let part = if best.proof.doubts.is_empty() { 1.0 - BELOW } else { SECOND_BELOW };
            if next.barrier_mev(scale) > part * best.seen_mev() {
                others.push(next);
                continue;
            }
            if next.found.is_none() {
                self.conclude(&mut next)?;
            }
            let next = self.settle(next)?;
            // the images of an unproven path are an upper bound all the same
            let allowed = if best.proof.doubts.is_empty() { 0.0 } else { AS_LOW * best.seen_mev().abs() };
            let better = next.proof.doubts.is_empty() && next.seen_mev() < best.seen_mev() + allowed;
            let mut left = if better { std::mem::replace(&mut best, next) } else { next };
            left.candidate.followed_mev = Some(left.seen_mev());
            others.push(left.candidate);
        }
        others.append(&mut candidates);
        let mut rejected: Vec<RejectedPath> = others.iter().map(|c| rejection(c, &best.candidate, scale)).collect();
        let search = self.search(&mut best, &mut rejected)?;
        Ok(report::outcome(self.prepared(), best.candidate, &best.found, best.proof, search, rejected))
    }

    /// A path in full: as many images as it needs, its saddles, and what could be proven of them.
    pub(super) fn settle(&mut self, mut c: Candidate<'a>) -> Result<Settled<'a>> {
        self.relax_resolved(&mut c, FIRST)?;
        let found = self.all_saddles(&c)?;
        if self.problem.certify && self.problem.seeks_saddles() {
            let proof = self.prove(&c, &found)?;
            let (proof, joined) = self.put_together(&mut c, proof)?;
            if joined {
                return Ok(Settled { candidate: c, found, proof });
            }
            if c.stop.is_converged() && !self.is_coarse(&c) {
                return self.seated(c, found, Some(proof));
            }
        }
        self.relax_resolved(&mut c, usize::MAX)?;
        let found = self.all_saddles(&c)?;
        let Settled { candidate: mut c, found, proof } = self.seated(c, found, None)?;
        let (proof, _) = self.put_together(&mut c, proof)?;
        Ok(Settled { candidate: c, found, proof })
    }

    /// The path from proven stretch to stretch in the place of the band, over a lower saddle if there is one beside its highest,
    /// where the band needs it; the proof of the path that there is then, and whether the band was replaced.
    fn put_together(&mut self, c: &mut Candidate<'a>, proof: Proof) -> Result<(Proof, bool)> {
        if let Some(lower) = self.lowered(c, &proof)? {
            return Ok((lower, true));
        }
        let joined = self.needs_joining(c, &proof) && self.join(c, &proof)?;
        Ok((proof, joined))
    }

    /// The proof of a path over a lower saddle beside the highest, if there is one and the path could be led over it.
    fn lowered(&mut self, c: &mut Candidate<'a>, proof: &Proof) -> Result<Option<Proof>> {
        if !proof.doubts.is_empty() || !self.problem.relax_ends {
            return Ok(None);
        }
        let scale = self.scales.stiffness_mev;
        let Some(links) = lowered(self.problem.evaluator(), &proof.links, scale)? else {
            return Ok(None);
        };
        let lower = Proof { ends: proof.ends.clone(), links, doubts: Vec::new() };
        Ok(self.join(c, &lower)?.then_some(lower))
    }

    /// Relaxes tightly with as many images as it takes, each time with at most `more` evaluations.
    fn relax_resolved(&mut self, c: &mut Candidate<'a>, more: usize) -> Result<()> {
        loop {
            let before = c.band.images();
            self.resolve(c, more)?;
            let images = c.band.images();
            self.seat_top(c);
            self.relax(c, Goal::Tight, c.band.evaluations().saturating_add(more))?;
            let finer = self.is_coarse(c) && images > before && images < MOST_IMAGES;
            if !finer || !c.stop.is_converged() || more < usize::MAX {
                return Ok(());
            }
        }
    }

    /// Puts the refined top in the place of its image: then the rest of the path need not be relaxed around it once more.
    fn seat_top(&self, c: &mut Candidate<'a>) {
        let scale = self.scales.stiffness_mev;
        if self.problem.neb.climb
            && let Some(top) = c.found.as_ref().filter(|f| f.is_saddle(scale))
        {
            seat(&mut c.band, std::slice::from_ref(top));
        }
    }

    /// With its saddles as images, and proven.
    fn seated(&mut self, mut c: Candidate<'a>, found: Vec<Saddle>, proof: Option<Proof>) -> Result<Settled<'a>> {
        if self.problem.neb.climb && seat(&mut c.band, &found) {
            self.relax(&mut c, Goal::Tight, usize::MAX)?;
        }
        let proof = match proof {
            Some(proof) => proof,
            None => self.prove(&c, &found)?,
        };
        Ok(Settled { candidate: c, found, proof })
    }

    /// Whether an automatic path needs more images.
    fn is_coarse(&self, c: &Candidate<'a>) -> bool {
        self.problem.images == Images::Auto && c.band.path().largest_rotation() > RESOLVED
    }

    /// Whether a path is better put together from its proven stretches: it has minima between its ends, or the band is not
    /// where the saddles are.
    fn needs_joining(&self, c: &Candidate<'a>, proof: &Proof) -> bool {
        self.is_coarse(c) || !c.stop.is_converged() || proof.links.len() > 1 || c.top_mev() > over(c, &proof.links)
    }

    /// The path from stretch to stretch in the place of the band, if all of it is proven; says whether it took the place.
    pub(super) fn join(&mut self, c: &mut Candidate<'a>, proof: &Proof) -> Result<bool> {
        let h = self.problem.evaluator();
        if !proof.doubts.is_empty() || !self.problem.relax_ends {
            return Ok(false);
        }
        self.observer.stage("putting the path together");
        let tools = Tools {
            settings: &self.problem.neb,
            scales: self.scales,
            axes: &self.axes,
            laplacian: self.laplacian.as_deref(),
        };
        let ends = [&self.ends[0].spins, &self.ends[1].spins];
        let joined = joined(h, &proof.links, ends, self.problem.images, 0.9 * RESOLVED, &tools)?;
        let Some(Joined { path, stops }) = joined else { return Ok(false) };
        let mut band = Band::continued(h, path, c.band.evaluations());
        for k in stops {
            let m = band.path().image(k).to_vec();
            band.hold(k, &m);
        }
        let before = std::mem::replace(&mut c.band, band);
        let stop = c.stop;
        self.relax(c, Goal::Tight, c.band.evaluations() + FIRST)?;
        let fits = c.top_mev() <= over(c, &proof.links);
        if fits && !c.stop.is_converged() {
            self.relax(c, Goal::Tight, usize::MAX)?;
        }
        let good = fits && (c.stop.is_converged() || !stop.is_converged());
        if !good {
            (c.band, c.stop) = (before, stop);
        }
        Ok(good)
    }

    /// Follows the path from its highest saddle down to both ends, and says what was proven on the way.
    fn prove(&mut self, c: &Candidate<'a>, found: &[Saddle]) -> Result<Proof> {
        let h = self.problem.evaluator();
        let ends = Minimum::examine_both(h, self.ends.each_ref().map(|end| &end.spins));
        let highest = found.iter().max_by(|p, q| p.refined.state.energy_mev.total_cmp(&q.refined.state.energy_mev));
        let Some(highest) = highest.filter(|_| self.problem.certify) else {
            let doubt = match (self.problem.certify, self.problem.seeks_saddles()) {
                (false, _) => Doubt::NotAskedFor,
                (_, false) => Doubt::NotRefined,
                _ => Doubt::NoSaddle,
            };
            return Ok(Proof { ends, links: Vec::new(), doubts: vec![doubt] });
        };
        self.observer.stage("proving the saddles");
        let scale = self.scales.stiffness_mev;
        let mut sequence = Sequence::default();
        if self.problem.relax_ends {
            let context = self.context();
            let mut relaxation = self.relaxation(Vec::new(), true);
            sequence = follow(&mut relaxation, &c.band, ends[0].clone(), ends[1].clone(), highest.clone(), &context)?;
        } else {
            let alone = match self.problem.rates {
                None => Pass::between(h, highest.clone(), ends.clone()),
                Some(_) => None,
            };
            sequence.links.push(alone.map_or_else(|| Pass::recorded(h, highest.clone(), scale), Ok)?);
        }
        let mut doubts: Vec<Doubt> = sequence.links.iter().filter_map(|l| l.doubt(h)).collect();
        doubts.extend(sequence.gap);
        if self.problem.relax_ends {
            let unproven = ends.iter().zip(PathEnd::BOTH).filter(|(end, _)| !end.is_proven());
            doubts.extend(unproven.map(|(_, which)| Doubt::NoMinimum(which)));
        }
        doubts.dedup_by_key(|doubt| doubt.to_string());
        self.met.extend(sequence.links.iter().filter(|pass| pass.doubt(h).is_none()).cloned());
        Ok(Proof { ends, links: sequence.links, doubts })
    }

    fn relaxation(&mut self, history: Vec<HistoryRow>, quiet: bool) -> Relaxation<'_> {
        Relaxation {
            settings: &self.problem.neb,
            climb: self.problem.neb.climb && !self.problem.refine,
            scales: self.scales,
            axes: &self.axes,
            laplacian: self.laplacian.as_deref(),
            history,
            observer: if quiet { &mut self.silent } else { &mut *self.observer },
        }
    }

    fn prepared(&self) -> Prepared<'_> {
        Prepared { problem: self.problem, started: self.started, ends: &self.ends, warnings: &self.warnings }
    }

    /// Ends that are one minimum turned about a symmetry axis: the rigid turn between them costs nothing.
    fn turned_minimum(&mut self) -> Result<Option<Outcome>> {
        let h = self.problem.evaluator();
        if self.axes.is_empty() || !self.problem.relax_ends {
            return Ok(None);
        }
        let ends = Minimum::examine_both(h, self.ends.each_ref().map(|end| &end.spins));
        if !ends[0].is_turned(h, &ends[1]) {
            return Ok(None);
        }
        let images = match self.problem.images {
            Images::Count(n) => n,
            Images::Auto => FEWEST_IMAGES,
        };
        // about an axis of symmetry the way is as long as it is; the shortest way between two states of a cone leads across it
        let axis = match self.axes[..] {
            [axis] => Direction::new(axis).ok(),
            _ => None,
        };
        let path = Rotation { axis }.path(&self.ends[0].spins, &self.ends[1].spins, images, &self.context())?;
        let mut band = Band::new(h, path);
        band.evaluate();
        if height(&band) > 1e-9 * h.stiffness_mev() {
            return Ok(None);
        }
        let stop = Stop::Converged { rotation: 0.0, tolerance: self.problem.neb.tolerance };
        let c = Candidate::new("rotation".into(), band, stop);
        let proof = Proof { ends, links: Vec::new(), doubts: vec![Doubt::CostlyTurn] };
        Ok(Some(report::outcome(self.prepared(), c, &[], proof, SearchReport::default(), Vec::new())))
    }

    /// The natural first paths, the most promising first: a few evaluations each, the best two followed to their saddles.
    pub(super) fn natural(&mut self) -> Result<Vec<Candidate<'a>>> {
        let mut tried = Vec::new();
        let context = self.context();
        let guesses = natural_guesses(self.problem, &self.ends[0].spins, &self.ends[1].spins, &context);
        for (guess, noise) in &guesses {
            let namesakes =
                guesses.iter().filter(|(other, _)| describe(other, false) == describe(guess, false)).count();
            let name = describe(guess, namesakes > 1);
            self.observer.stage(&format!("first path: {name}"));
            tried.push(self.start(name, guess, noise.as_ref(), None, TRIAL)?);
        }
        tried.sort_by(|p, q| p.top_mev().total_cmp(&q.top_mev()));
        let scale = self.scales.stiffness_mev;
        let mut finished = 0;
        for c in &mut tried {
            let lowest = c.top_mev();
            let worth = finished < 2 && self.problem.seeks_saddles();
            if worth && !(finished == 1 && lowest > 1.2 * self.lowest_top) {
                self.conclude(c)?;
                finished += 1;
                self.lowest_top = self.lowest_top.min(c.barrier_mev(scale));
            }
        }
        tried.sort_by(|p, q| {
            p.rank(scale).cmp(&q.rank(scale)).then(p.barrier_mev(scale).total_cmp(&q.barrier_mev(scale)))
        });
        Ok(tried)
    }

    /// Relaxes a path until its top is a refined saddle of index one, leaving saddles of higher index sideways.
    fn conclude(&mut self, c: &mut Candidate<'a>) -> Result<()> {
        let scale = self.scales.stiffness_mev;
        for round in 0..ESCAPES {
            if !c.stop.is_converged() {
                self.relax(c, Goal::Loose, c.band.evaluations() + 24)?;
            }
            if !self.problem.seeks_saddles() {
                break;
            }
            let h = c.band.evaluator();
            c.found = match self.zoom(c)? {
                Some(top) => Some(Saddle::recorded(h, top, scale, self.scales.half_site_rad())?),
                None => None,
            };
            let Some(found) = c.found.as_ref() else { break };
            if found.is_saddle(scale) || round + 1 == ESCAPES {
                break;
            }
            let mut best: Option<Band<'a>> = None;
            for path in escapes(&c.band, found, scale) {
                let mut band = Band::continued(self.problem.evaluator(), path, c.band.evaluations());
                align_rotations(band.path_mut(), &self.axes);
                band.evaluate();
                let top = |b: &Band| b.energies_mev()[b.highest()];
                if best.as_ref().is_none_or(|b| top(&band) < top(b) - 1e-9 * scale) {
                    best = Some(band);
                }
            }
            let Some(band) = best else { break };
            self.observer.stage(&format!("leaving a saddle of index {}", found.refined.index));
            c.escapes.push((found.refined.state.energy_mev - c.band.energies_mev()[0], found.refined.index));
            c.band = band;
            c.stop = Stop::NotFinite;
        }
        Ok(())
    }

    /// The path's top. One inside the first or last interval is not resolved: the part of the path around it becomes finer.
    fn zoom(&mut self, c: &mut Candidate<'a>) -> Result<Option<Peak>> {
        let mut top = highest(&c.band);
        for _ in 0..ZOOMS {
            let images = match self.problem.images {
                Images::Count(n) => n,
                Images::Auto => c.band.images() + 8,
            };
            let Some(path) = zoomed(&c.band, top.as_ref(), images) else { break };
            c.band = Band::continued(self.problem.evaluator(), path, c.band.evaluations());
            self.relax(c, Goal::Loose, c.band.evaluations() + 24)?;
            top = highest(&c.band);
        }
        Ok(top)
    }

    /// Every maximum within a tenth of the highest, refined; saddles found twice count once.
    fn all_saddles(&mut self, c: &Candidate<'a>) -> Result<Vec<Saddle>> {
        let scale = self.scales.stiffness_mev;
        if !self.problem.seeks_saddles() {
            return Ok(Vec::new());
        }
        let h = self.problem.evaluator();
        let mut found: Vec<Saddle> = Vec::new();
        for top in peaks(&c.band, WINDOW * height(&c.band)) {
            let f = match c.found.as_ref().filter(|f| is_seated(&c.band, top.image, f)) {
                Some(f) => Saddle { top, refined: f.refined.clone() },
                None => Saddle::recorded(h, top, scale, self.scales.half_site_rad())?,
            };
            if f.is_saddle(scale) && !found.iter().any(|g| same(&g.refined.state.m, &f.refined.state.m)) {
                found.push(f);
            }
        }
        Ok(found)
    }

    /// A first path, relaxed from few images to as many as asked for (automatic: as few as resolve it).
    fn start(
        &mut self,
        name: String,
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
                path = add_noise(&path, noise, context.states.lattice);
            }
            Ok(match smoothing {
                Some(strength) => smooth(&path, strength),
                None => path,
            })
        };
        let coarsest = match self.problem.images {
            Images::Auto => self.scales.images_between(self.problem.hamiltonian.sites(), moving_sites(a, b)) + 2,
            Images::Count(n) => image_levels(n, |n| make(n).is_ok_and(|p| p.largest_rotation() <= COARSEST))[0],
        };
        let band = Band::new(self.problem.evaluator(), make(coarsest)?);
        let mut c = Candidate::new(name, band, Stop::NotFinite);
        self.relax(&mut c, Goal::Loose, limit)?;
        Ok(c)
    }

    /// More images, each time relaxed loosely: to the number asked for, or until neighbours are within 1 rad a spin.
    fn resolve(&mut self, c: &mut Candidate<'a>, more: usize) -> Result<()> {
        if !c.stop.is_converged() {
            self.relax(c, Goal::Loose, c.band.evaluations() + 24)?;
        }
        let mut apart = f64::INFINITY;
        loop {
            let now = c.band.images();
            // steps over minima stay as long as they are, however many images there are
            let before = std::mem::replace(&mut apart, c.band.path().largest_rotation());
            let many = now >= FEWEST_IMAGES && (more < usize::MAX || now > 257);
            if many && self.problem.images == Images::Auto && apart > 0.8 * before {
                return Ok(());
            }
            let next = match self.problem.images {
                Images::Count(n) if now < n => image_levels(n, |_| true).into_iter().find(|l| *l > now).unwrap_or(n),
                Images::Auto if now < FEWEST_IMAGES || self.is_coarse(c) && now < MOST_IMAGES => 2 * now - 1,
                _ => return Ok(()),
            };
            self.observer.stage(&format!("{next} images"));
            let evaluations = c.band.evaluations();
            c.band = Band::continued(self.problem.evaluator(), refined(c.band.path(), next), evaluations);
            self.relax(c, Goal::Loose, evaluations + 40)?;
        }
    }

    fn relax(&mut self, c: &mut Candidate<'a>, goal: Goal, limit: usize) -> Result<()> {
        let limit = limit.min(self.problem.neb.max_evaluations);
        let mut relaxation = self.relaxation(std::mem::take(&mut c.history), false);
        let stop = relaxation.run(&mut c.band, goal, limit);
        c.history = relaxation.history;
        self.observer.relaxed(c.band.path(), &c.history);
        c.stop = stop?;
        Ok(())
    }
}

/// The minima that two states relax to.
fn relaxed_ends(h: Evaluator, given: [&Spins; 2]) -> Result<[Relaxed; 2]> {
    let relax = |spins: &Spins| relax_to_minimum(h, spins, END_TOLERANCE * h.stiffness_mev());
    let (a, b) = both(3 * h.sites(), || relax(given[0]), || relax(given[1]));
    Ok([a?, b?])
}

/// Whether a saddle is image k of a band, and higher than its neighbours.
fn is_seated(band: &Band, k: usize, saddle: &Saddle) -> bool {
    let e = band.energies_mev();
    let between_ends = k > 0 && k + 1 < e.len();
    between_ends
        && e[k] >= e[k - 1]
        && e[k] >= e[k + 1]
        && band.is_held(k)
        && band.path().image(k) == saddle.refined.state.m
}

/// Puts refined saddles in the place of the images nearest to them, where they fit between the neighbours; says whether any did.
fn seat(band: &mut Band, found: &[Saddle]) -> bool {
    let last = band.images() - 1;
    let mut seated = false;
    for f in found {
        let saddle = &f.refined.state.m;
        let far = band.path().distances_from(saddle);
        let k = (1..last).min_by(|&i, &j| far[i].total_cmp(&far[j])).unwrap_or(1);
        let gap = distance(band.path().image(k - 1), band.path().image(k + 1));
        let fits = far[k - 1] < gap && far[k + 1] < gap;
        if fits && !band.is_held(k) {
            band.hold(k, saddle);
            seated = true;
        }
    }
    seated
}
