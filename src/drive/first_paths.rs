//! The natural first paths: each relaxed a little, the best followed to their saddles.

use super::escape::escapes;
use super::explore::natural_guesses;
use super::first_path::{FirstPath, describe};
use super::relaxation::{Goal, LOOSELY, image_levels};
use super::run::{Run, WORTH};
use super::scales::LEAST_IMAGES;
use super::{Images, Stop};
use crate::band::Band;
use crate::error::Result;
use crate::landscape::{Effort, Peak, Saddle, peaks, promising, zoomed};
use crate::path::guess::{GuessSpec, NoiseSpec, add_noise, moving_sites, smooth};
use crate::path::{COARSE, Path};
use crate::stationary::{ALIKE, FEW, is_very_dear};

/// Evaluations after which first paths are compared.
const TRIAL: usize = 8;
/// On a film, where saddles are found from farther away, if no lower pass is looked for: of 600 films as many are not the lowest after 3
/// as after 4, with 8 % fewer evaluations; after 2, descents in cubes start badly. To the search a first path that is more relaxed is
/// worth its work. And on ways over third states, which the search finds too: of 1350 random chains two are not the lowest at `quick`,
/// after 8 one, and none at `normal`; a wall that leaves its well takes a quarter fewer evaluations.
pub(super) const BRIEF_TRIAL: usize = 3;

/// Rounds of leaving a saddle of higher index.
const ESCAPES: usize = 3;
/// On a film the best path of another kind is followed to its saddle too, unless its top is higher than the lowest saddle times this.
const OF_OTHER_KINDS: f64 = 1.5;

impl<'a> Run<'a, '_> {
    /// The first paths, the most promising first: the one that was asked for, or the natural ones.
    pub(super) fn first_paths(&mut self) -> Result<Vec<FirstPath<'a>>> {
        let Some(guess) = &self.problem.guess else {
            let is_row = self.problem.hamiltonian.lattice().is_row();
            let is_brief = !is_row && self.problem.search == Effort::None;
            return self.natural(if is_brief { BRIEF_TRIAL } else { TRIAL });
        };
        let name = describe(guess, false);
        self.observer.stage(&format!("first path: {name}"));
        let mut c = self.start(name, guess, self.problem.noise.as_ref(), self.problem.smooth, usize::MAX)?;
        self.conclude(&mut c)?;
        Ok(vec![c])
    }

    /// The natural first paths, the most promising first: so many evaluations each, the best two (on a film the best of each kind) followed
    /// to their saddles.
    pub(super) fn natural(&mut self, trial: usize) -> Result<Vec<FirstPath<'a>>> {
        let mut tried = Vec::new();
        let context = self.context();
        self.problem.control.check()?;
        let is_row = self.problem.hamiltonian.lattice().is_row();
        let guesses = natural_guesses(self.problem, &self.ends[0].spins, &self.ends[1].spins, &context);
        for (guess, noise) in &guesses {
            let namesakes =
                guesses.iter().filter(|(other, _)| describe(other, false) == describe(guess, false)).count();
            let name = describe(guess, namesakes > 1);
            self.observer.stage(&format!("first path: {name}"));
            let mut c = self.start(name, guess, noise.as_ref(), None, trial)?;
            c.band.rest();
            let is_spent = self.is_spent(&c.band);
            tried.push(c);
            if is_spent {
                break;
            }
        }
        tried.sort_by(|p, q| p.peak_mev().total_cmp(&q.peak_mev()));
        let scale = self.tools.scales.stiffness_mev;
        let (mut finished, mut lowest_barrier) = (0, f64::INFINITY);
        let mut kinds: Vec<String> = vec!["geodesic".into()];
        for c in &mut tried {
            // on a film a collapse and an escape over an edge are two answers, and both are told
            let is_other = if is_row { finished < 2 } else { !kinds.iter().any(|k| k == c.kind()) };
            let part = if is_row { WORTH } else { OF_OTHER_KINDS };
            let is_below = |part: f64| c.peak_mev() < part * lowest_barrier;
            // a top that stands below every saddle may be a lower one
            let is_worth = is_below(1.0) || is_other && is_below(part);
            if self.problem.seeks_saddles() && is_worth {
                self.conclude(c)?;
                c.band.rest();
                finished += 1;
                lowest_barrier = lowest_barrier.min(c.barrier_mev(scale));
                kinds.push(c.kind().into());
            }
        }
        tried.sort_by(|p, q| {
            let by_barrier = p.barrier_mev(scale).total_cmp(&q.barrier_mev(scale));
            p.rank(scale).cmp(&q.rank(scale)).then(by_barrier)
        });
        if !is_row && let Some(lowest) = tried.first().map(|c| (c.rank(scale), c.barrier_mev(scale))) {
            // of paths over one saddle, or over images of it by a symmetry, the one that came there soonest
            let alike = tried.partition_point(|c| {
                c.rank(scale) == lowest.0 && c.barrier_mev(scale) < lowest.1 + ALIKE * lowest.1.abs()
            });
            tried[..alike].sort_by_key(|c| c.band.evaluations());
        }
        Ok(tried)
    }

    /// Relaxes a path, where it needs to be, until its top is a refined saddle of index one, leaving saddles of higher index sideways.
    pub(super) fn conclude(&mut self, c: &mut FirstPath<'a>) -> Result<()> {
        let scale = self.tools.scales.stiffness_mev;
        c.band.wake();
        // on a film the saddle is found by its lowest mode, and from farther away than by a valley
        let mut relaxes = self.problem.hamiltonian.lattice().is_row();
        for round in 0..ESCAPES {
            if relaxes && !c.stop.is_converged() {
                self.relax(c, Goal::Loose, c.band.evaluations() + LOOSELY)?;
            }
            if !self.problem.seeks_saddles() || self.is_spent(&c.band) {
                break;
            }
            let h = c.band.evaluator();
            // where factors are very dear a band is relaxed sooner than a search comes back to its valley
            let may_stray = relaxes || !is_very_dear(&h);
            c.found = match self.zoom(c)? {
                Some(top) => Some(Saddle::recorded(h, top, may_stray)?),
                None => None,
            };
            let Some(found) = c.found.as_ref() else { break };
            if found.is_saddle(scale) || round + 1 == ESCAPES {
                break;
            }
            if !std::mem::replace(&mut relaxes, true) && !c.stop.is_converged() && !found.is_stationary(scale) {
                continue;
            }
            let mut best: Option<Band<'a>> = None;
            for path in escapes(&c.band, found, scale) {
                let mut band = Band::continued(self.problem.evaluator(), path, c.band.evaluations());
                band.align(&self.tools.axes);
                band.evaluate();
                let top = |b: &Band| b.energies_mev()[b.highest()];
                if best.as_ref().is_none_or(|b| top(&band) < top(b) - ALIKE * scale) {
                    best = Some(band);
                }
            }
            let Some(band) = best else { break };
            self.observer.stage(&format!("leaving a saddle of index {}", found.refined.index()));
            c.band = band;
            c.stop = Stop::NotFinite;
        }
        Ok(())
    }

    /// The path's top. One inside the first or last interval is not resolved: the part of the path around it becomes finer.
    fn zoom(&mut self, c: &mut FirstPath<'a>) -> Result<Option<Peak>> {
        let scale = self.tools.scales.stiffness_mev;
        let mut tops = peaks(&c.band, scale);
        for _ in 0..FEW {
            let images = self.problem.images.asked_for().unwrap_or(c.band.images() + 8);
            let Some(path) = zoomed(&c.band, tops.first(), images) else { break };
            c.band = Band::continued(self.problem.evaluator(), path, c.band.evaluations());
            self.relax(c, Goal::Loose, c.band.evaluations() + LOOSELY)?;
            tops = peaks(&c.band, scale);
        }
        Ok(promising(&c.band, tops))
    }

    /// A first path, relaxed from few images to as many as asked for (automatic: as few as resolve it).
    fn start(
        &mut self,
        name: String,
        guess: &GuessSpec,
        noise: Option<&NoiseSpec>,
        smoothing: Option<f64>,
        limit: usize,
    ) -> Result<FirstPath<'a>> {
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
            Images::Auto => {
                let lattice = context.states.lattice;
                let images = self.tools.scales.images_between(lattice, moving_sites(a, b, lattice));
                // a film's is looked at, and put together anew
                let is_tried = limit < usize::MAX && !lattice.is_row() && images == LEAST_IMAGES;
                if is_tried { COARSE + 2 } else { images + 2 }
            }
            Images::Count(n) => image_levels(n, |n| make(n).is_ok_and(|p| p.is_resolved()))[0],
        };
        let band = Band::new(self.problem.evaluator(), make(coarsest)?);
        let mut c = FirstPath::new(name, band, Stop::NotFinite);
        self.relax(&mut c, Goal::Loose, limit)?;
        Ok(c)
    }
}
