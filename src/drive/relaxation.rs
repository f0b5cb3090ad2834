//! The loop that relaxes a band: evaluate, judge, move; it counts and says why it stopped.

use super::heights::{height, prominent_maxima};
use super::outcome::HistoryRow;
use super::{NebSettings, Observer, Scales, Silent, Stop};
use crate::band::{Band, Laplacian, Sweep};
use crate::energy::{Evaluator, Stored};
use crate::error::Result;
use crate::geometry::Vector;
use crate::hessian::StandIn;
use crate::landscape::{Bands, are_counts, are_finite};
use crate::linalg::slab;
use crate::optimise::{Follows, Optimiser, OptimiserSpec};
use crate::path::{COARSE, Path};
use crate::record::Fingerprint;
use crate::sphere::rotation_of;
use crate::stationary::LOWER;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::sync::Arc;

/// |F⊥|∞/c that is enough to double the images or to read off which path is lowest.
pub const LOOSE: f64 = 5e-3;
/// Evaluations in which a band is relaxed so, and those in which one is tightly: a band that needs more has minima on its way.
pub const LOOSELY: usize = 24;
pub const TIGHTLY: usize = 60;
/// Evaluations without progress that end a relaxation.
const PATIENCE: usize = 80;
/// Methods that follow forces take so many times as many evaluations as the sweep.
const SLOWER: usize = 50;
/// A top that moves by less than this part of its height in an evaluation stands still, if its force can lower it by no more than
/// that other part.
const STILL: f64 = 1e-3;
const LOWERED: f64 = 1e-2;

/// How far to go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Goal {
    /// |F⊥|∞ < 5e-3 c.
    Loose,
    /// The predicted rotation below the tolerance (rad), maxima climbed if asked for.
    Tight,
}

/// What a relaxation works with.
pub struct Relaxation<'a> {
    /// The same in all relaxations of the run.
    pub tools: &'a Tools<'a>,
    /// Let prominent maxima climb by the reversed force, where the method has springs.
    pub climb: bool,
    /// One row an evaluation is appended.
    pub history: Vec<HistoryRow>,
    /// Who watches.
    pub observer: &'a mut dyn Observer,
}

/// What relaxes bands.
#[derive(Clone)]
pub struct Tools<'a> {
    /// Settings of the run.
    pub settings: &'a NebSettings,
    /// Scales of the problem.
    pub scales: Scales,
    /// Symmetry axes, for the rotation gauge.
    pub axes: Vec<Vector>,
    /// The preconditioner, for methods that follow no sweep.
    pub laplacian: Option<Arc<Laplacian>>,
    /// What stands in for Hessians, for sweeps where factors take long.
    pub stand_in: Option<Arc<StandIn>>,
}

impl Tools<'_> {
    fn relax(&self, band: &mut Band, goal: Goal, evaluations: usize) -> Result<()> {
        let mut relaxation = Relaxation { tools: self, climb: false, history: Vec::new(), observer: &mut Silent };
        let more = match self.settings.optimiser.member().follows() {
            Follows::Sweep => evaluations,
            _ => SLOWER * evaluations,
        };
        relaxation.run(band, goal, more.min(self.settings.max_evaluations)).map(|_| ())
    }
}

impl Bands for Tools<'_> {
    fn loosely(&self, band: &mut Band) -> Result<()> {
        self.relax(band, Goal::Loose, LOOSELY)
    }

    fn tightly(&self, band: &mut Band) -> Result<()> {
        self.relax(band, Goal::Tight, TIGHTLY)
    }
}

/// Watches the predicted rotation: a sweep that runs in circles is damped, and what makes no progress ends.
#[derive(Clone, Serialize, Deserialize)]
struct Progress {
    best: f64,
    since: usize,
    patience: usize,
    damps: bool,
    damping: f64,
}

impl Progress {
    fn new(follows: Follows) -> Progress {
        let patience = match follows {
            Follows::Sweep => PATIENCE,
            Follows::Preconditioned | Follows::Springs => SLOWER * PATIENCE,
        };
        Progress { best: f64::INFINITY, since: 0, patience, damps: follows == Follows::Sweep, damping: 1.0 }
    }

    /// The evaluations since the last progress, if they are too many.
    fn stalled(&mut self, rotation: f64) -> Option<usize> {
        self.since += 1;
        if rotation < 0.9 * self.best {
            (self.best, self.since) = (rotation, 0);
        }
        if self.damps && self.since > 0 && self.since.is_multiple_of(12) {
            self.damping = (0.6 * self.damping).max(0.1);
        }
        (self.since >= self.patience).then_some(self.since)
    }
}

/// What a relaxation remembers from one iteration to the next.
struct Iterate {
    optimiser: Box<dyn Optimiser>,
    sweep: Sweep,
    progress: Progress,
    /// The highest of the interpolated energy above the first image (meV) when it was last looked at.
    peak_mev: Option<f64>,
}

impl Relaxation<'_> {
    /// Relaxes the band of `path` with at most `limit` evaluations. An error where the run was stopped on the way.
    pub fn run<'h>(&mut self, band: &mut Band<'h>, goal: Goal, limit: usize) -> Result<Stop> {
        let h = band.evaluator();
        let first = self.history.len();
        let call = h.call("relaxation", |print| fingerprint(print, band, goal, limit));
        if let Some(end) = call.answer(|end: End| end.restored(band)) {
            self.history.extend(end.rows.into_owned());
            return Ok(end.stop);
        }
        self.observer.relaxing(goal, self.tools.settings.tolerance);
        let mut now = self.start(h, goal);
        if let Some(stand) = call.underway(|stand: Stand| stand.restored(band)) {
            self.history.extend(now.take_over(stand, band));
        }
        let mut direction = vec![0.0; band.inner_mut().len()];
        let stop = loop {
            call.obey(|| Some(now.stand(band, &self.history[first..])))?;
            call.save_if_due(|| now.stand(band, &self.history[first..]));
            if let Some(stop) = self.step(band, &mut now, &mut direction, goal, limit) {
                break stop;
            }
        };
        call.finish(|| End {
            path: Cow::Borrowed(band.path()),
            evaluations: band.evaluations(),
            stop,
            rows: Cow::Borrowed(&self.history[first..]),
        });
        Ok(stop)
    }

    fn start(&self, h: Evaluator, goal: Goal) -> Iterate {
        let method = self.tools.settings.optimiser.member();
        let sweep = Sweep::new(self.tools.scales.stiffness_mev).sharing(self.tools.stand_in.clone());
        Iterate {
            optimiser: method.start(h.stiffness_mev()),
            sweep: if goal == Goal::Tight { sweep } else { sweep.roughly() },
            progress: Progress::new(method.follows()),
            peak_mev: None,
        }
    }

    /// One iteration: evaluate, judge, move; why it was the last, if it was.
    fn step(
        &mut self,
        band: &mut Band,
        now: &mut Iterate,
        direction: &mut [f64],
        goal: Goal,
        limit: usize,
    ) -> Option<Stop> {
        let size = 3 * band.path().sites();
        let Tools { settings, scales, axes, .. } = self.tools;
        let tolerance = settings.tolerance;
        band.align(axes);
        band.evaluate();
        let force = band.max_perpendicular_mev();
        let enough = LOOSE * scales.stiffness_mev;
        if goal == Goal::Loose && (force < enough || self.top_stands(band, now, enough)) {
            let rotation = force.min(enough) / scales.stiffness_mev;
            self.record(band, rotation, 0);
            return Some(Stop::Converged { rotation, tolerance: LOOSE });
        }
        if goal == Goal::Loose && force.is_finite() && band.evaluations() >= limit {
            // where the images would go next is not asked
            let rotation = force / scales.stiffness_mev;
            self.record(band, rotation, 0);
            return Some(Stop::MaxEvaluations { evaluations: band.evaluations(), rotation, tolerance });
        }
        let climbing = self.climbing(band, goal);
        let (rotation, products) = match settings.optimiser.member().follows() {
            Follows::Sweep => {
                let step = now.sweep.step(band, axes, direction);
                (step.rotation, step.products)
            }
            follows => (self.along_forces(band, follows, &climbing, direction), 0),
        };
        self.record(band, rotation, products);
        if !rotation.is_finite() || !force.is_finite() {
            return Some(Stop::NotFinite);
        }
        if goal == Goal::Tight && (rotation <= tolerance || is_level(band, direction)) {
            return Some(Stop::Converged { rotation, tolerance });
        }
        if band.evaluations() >= limit {
            return Some(Stop::MaxEvaluations { evaluations: band.evaluations(), rotation, tolerance });
        }
        if let Some(evaluations) = now.progress.stalled(rotation) {
            return Some(Stop::Stalled { evaluations, rotation, tolerance });
        }
        if now.progress.damping != 1.0 {
            slab::scale(direction, now.progress.damping);
        }
        now.optimiser.advance(band.inner_mut(), size, direction);
        None
    }

    /// Whether the highest image is relaxed, all but |F⊥|²/c of its energy, and the path's top stays as high as it is: the interpolated
    /// one, as the images may slide down on both sides of a narrow top. In a row all images relax about as quickly; on other lattices
    /// the way down from a nucleus, which no barrier depends on, takes much longer than its top.
    fn top_stands(&self, band: &Band, now: &mut Iterate, enough: f64) -> bool {
        if band.hamiltonian().lattice().is_row() {
            return false;
        }
        let (e, top, peak) = (band.energies_mev(), band.highest(), band.profile().highest_mev());
        let Some(before) = now.peak_mev.replace(peak) else { return false };
        let height = peak - (e[e.len() - 1] - e[0]).max(0.0);
        let perpendicular = band.perpendicular(top);
        let lowered = slab::dot(perpendicular, perpendicular) / self.tools.scales.stiffness_mev;
        let relaxed = band.force(top) < enough || lowered < LOWERED * height;
        height > 0.0 && (peak - before).abs() < STILL * height && relaxed
    }

    /// Writes what the methods that follow forces want to be shown; the rotation that still seems needed (rad).
    fn along_forces(&self, band: &Band, follows: Follows, climbing: &[usize], y: &mut [f64]) -> f64 {
        let slab = 3 * band.path().sites();
        let Some(laplacian) = &self.tools.laplacian else { return f64::NAN };
        laplacian.rotations(band, y);
        let rotation = y.chunks(slab).map(rotation_of).fold(0.0, f64::max);
        let c = self.tools.scales.stiffness_mev;
        if follows == Follows::Preconditioned {
            let shifts = band.equal_shifts();
            for k in 1..band.images() - 1 {
                slab::add_scaled(&mut y[(k - 1) * slab..k * slab], shifts[k], band.tangent(k));
            }
            return rotation;
        }
        for k in (1..band.images() - 1).filter(|&k| !band.is_held(k)) {
            let f = &mut y[(k - 1) * slab..k * slab];
            f.copy_from_slice(band.perpendicular(k));
            let along = if climbing.contains(&k) { -band.along(k) } else { c * band.spring_pull(k) };
            slab::add_scaled(f, along, band.tangent(k));
        }
        rotation
    }

    /// The images that climb: every prominent maximum, once the band is loosely relaxed.
    fn climbing(&self, band: &Band, goal: Goal) -> Vec<usize> {
        if goal == Goal::Loose || !self.climb {
            return Vec::new();
        }
        if band.max_perpendicular_mev() > LOOSE * self.tools.scales.stiffness_mev {
            return Vec::new();
        }
        prominent_maxima(band.energies_mev(), LOWER * height(band))
    }

    fn record(&mut self, band: &Band, rotation: f64, hessian_products: usize) {
        let e = band.energies_mev();
        let row = HistoryRow {
            iteration: self.history.len() + 1,
            images: band.images(),
            max_perpendicular_torque_mev: band.max_perpendicular_mev(),
            largest_predicted_rotation_rad: rotation,
            highest_image_mev: e[band.highest()] - e[0],
            length_rad: band.spacings().iter().sum(),
            hessian_products,
        };
        self.history.push(row);
        self.observer.iteration(&row);
    }
}

/// All that the next iteration depends on, with the iterations so far: where a relaxation stands.
#[derive(Serialize, Deserialize)]
struct Stand {
    path: Path,
    evaluations: usize,
    shifts: Vec<f64>,
    /// What the optimiser remembers.
    memory: Vec<Vec<f64>>,
    progress: Progress,
    peak_mev: Option<f64>,
    rows: Vec<HistoryRow>,
}

/// The end of a relaxation.
#[derive(Serialize, Deserialize)]
struct End<'a> {
    path: Cow<'a, Path>,
    evaluations: usize,
    stop: Stop,
    rows: Cow<'a, [HistoryRow]>,
}

impl Iterate {
    fn stand(&self, band: &Band, rows: &[HistoryRow]) -> Stand {
        Stand {
            path: band.path().clone(),
            evaluations: band.evaluations(),
            shifts: self.sweep.shifts().to_vec(),
            memory: self.optimiser.memory(),
            progress: self.progress.clone(),
            peak_mev: self.peak_mev,
            rows: rows.to_vec(),
        }
    }

    /// Goes on from where another one stood; the iterations up to there.
    fn take_over(&mut self, stand: Stand, band: &mut Band) -> Vec<HistoryRow> {
        band.restore(stand.path.as_slice(), stand.evaluations);
        self.sweep.set_shifts(stand.shifts);
        self.optimiser.remember(stand.memory);
        self.peak_mev = stand.peak_mev;
        let Progress { best, since, damping, .. } = stand.progress;
        (self.progress.best, self.progress.since, self.progress.damping) = (best, since, damping);
        stand.rows
    }
}

impl Stand {
    /// Nothing where it cannot be of this band.
    fn restored(self, band: &Band) -> Option<Stand> {
        // an optimiser remembers vectors of the inner images, and single numbers
        let inner = band.path().as_slice().len() - 6 * band.path().sites();
        let is_memory = |row: &Vec<f64>| are_finite(row) && (row.len() == inner || row.len() < 2);
        let is_sound = fits(&self.path, band)
            && are_counts(&[self.evaluations, self.progress.since])
            && are_finite(&self.shifts)
            && (self.shifts.is_empty() || self.shifts.len() == band.images())
            && self.memory.iter().all(is_memory)
            && are_finite(&[self.progress.damping, self.peak_mev.unwrap_or(0.0)]);
        let rows = self.rows.restored(band.evaluator())?;
        is_sound.then_some(Stand { rows, ..self })
    }
}

impl End<'_> {
    /// Puts the band where its relaxation ended; nothing where that was another band.
    fn restored(self, band: &mut Band) -> Option<Self> {
        let is_sound = fits(&self.path, band) && are_counts(&[self.evaluations]) && self.evaluations > 0;
        is_sound.then_some(())?;
        let (h, evaluations) = (band.evaluator(), self.evaluations - 1);
        let end = End { stop: self.stop.restored(h)?, rows: self.rows.into_owned().restored(h)?.into(), ..self };
        band.restore(end.path.as_slice(), evaluations);
        band.evaluate();
        Some(end)
    }
}

/// Whether a path has the size of a band.
fn fits(path: &Path, band: &Band) -> bool {
    (path.images(), path.sites()) == (band.images(), band.path().sites())
}

fn fingerprint(print: Fingerprint, band: &Band, goal: Goal, limit: usize) -> Fingerprint {
    let held = (0..band.images()).filter(|&k| band.is_held(k)).fold(print, Fingerprint::whole);
    let print = held.whole(usize::from(goal == Goal::Tight)).whole(limit);
    print.whole(band.evaluations()).row(band.path().as_slice())
}

/// Whether no image's energy is to change by more than rounding, to first order, however far a mode that is all but free still
/// moves it: never in a row, which has no such mode but the path's own.
fn is_level(band: &Band, moves: &[f64]) -> bool {
    if band.hamiltonian().lattice().is_row() {
        return false;
    }
    let rounding = band.hamiltonian().rounding_mev();
    let images = moves.chunks(3 * band.path().sites()).enumerate();
    images.map(|(k, y)| slab::dot(band.perpendicular(k + 1), y)).all(|fall| fall.abs() <= rounding)
}

/// Whether an optimiser needs the preconditioner.
pub fn needs_laplacian(optimiser: &OptimiserSpec) -> bool {
    optimiser.member().follows() != Follows::Sweep
}

/// The images to start from: fewer than `images`, halved as long as that resolves the path; coarsest first.
pub fn image_levels(images: usize, fits: impl Fn(usize) -> bool) -> Vec<usize> {
    let mut levels = vec![images];
    loop {
        let coarser = levels[0].div_ceil(2);
        if coarser < COARSE || !fits(coarser) {
            return levels;
        }
        levels.insert(0, coarser.max(levels[0] / 2 + 1));
    }
}

/// The same curve with `images` images: midpoints where that doubles the intervals, equal distances else.
pub fn refined(path: &Path, images: usize) -> Path {
    if images == 2 * path.images() - 1 { path.doubled() } else { path.resampled(images) }
}
