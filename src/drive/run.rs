//! A whole run: the ends, first paths, a route that connects them, a search below its top, and what all this came to.

use super::ends::{judge_end, kept, torque_mev};
use super::explore::turning_axis;
use super::first_path::{FirstPath, rejection};
use super::outcome::*;
use super::relaxation::{Goal, Relaxation, Tools, height, needs_laplacian};
use super::report::{self, Proof, Rated};
use super::settled::Settled;
use super::{Observer, Problem, Scales, Stop};
use crate::band::{Band, Laplacian, Sweep};
use crate::energy::{Evaluator, recorded};
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::landscape::{Doubt, Edge, Landscape, Minimum, Pass};
use crate::path::guess::{FirstGuess, GuessContext, Rotation};
use crate::path::is_within;
use crate::rates::{Kin, LEAST_BARRIER, RateSettings, Symmetry};
use crate::record::Count;
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::{ALIKE, LOWER, RELAXED, Relaxed, both_by_factors, relax_end};
use crate::units::K_B;
use std::sync::Arc;
use std::time::Instant;

/// Fewest images of an automatic path in the end.
pub const FEWEST_IMAGES: usize = 17;
/// Further paths that are followed to the end.
const SECOND_TRIES: usize = 2;
/// A path is not followed further if its top is higher than that of the best one times this.
pub(super) const WORTH: f64 = 1.2;

/// Finds the minimum-energy path of a problem, taking what its [`Control`](crate::control::Control) finds on record from there, and
/// recording what it computes. A run that its control stops ends with [`Error::Stopped`](crate::error::Error::Stopped), one that meets an
/// energy that is no finite number with [`Error::Numerical`](crate::error::Error::Numerical). A problem may be run as often as one
/// likes; runs of one problem at the same time share what it may evaluate, so that each is better given a problem of its own.
///
/// ```
/// use spinneb::drive::{Problem, Silent, run};
/// use spinneb::energy::{Anisotropy, Exchange, Hamiltonian};
/// use spinneb::{geometry::Direction, lattice::Chain, spins::Spins};
///
/// let chain = Chain::open(9).resolve()?;
/// let exchange = Exchange::uniform(&chain, &[10.0]); // meV
/// let easy_axis = Anisotropy::uniform(9, 0.5, Direction::Z); // meV
/// let hamiltonian = Hamiltonian::new(&chain, vec![Box::new(exchange), Box::new(easy_axis)])?;
/// let [up, down] = [Direction::Z, Direction::Z.reversed()].map(|d| Spins::uniform(9, d));
/// let outcome = run(&Problem::new(hamiltonian, up, down), &mut Silent)?;
/// assert!(outcome.certified);
/// assert!((outcome.barrier.unwrap().forward_mev - 9.0 * 0.5).abs() < 1e-9); // too short for a wall: N K
/// # Ok::<(), spinneb::error::Error>(())
/// ```
pub fn run(problem: &Problem, observer: &mut dyn Observer) -> Result<Outcome> {
    problem.check()?;
    problem.control.recorder().begin(|| problem.fingerprint());
    // on a thread of the pool, so that it is not left and entered again for every band
    problem.control.relied_on(rayon::scope(|_| Run::prepare(problem, observer)?.finish()))
}

pub(super) struct Run<'a, 'o> {
    pub(super) problem: &'a Problem,
    pub(super) observer: &'o mut dyn Observer,
    pub(super) started: Instant,
    /// What was evaluated before it.
    pub(super) before: Count,
    pub(super) ends: [Relaxed; 2],
    pub(super) tools: Tools<'a>,
    pub(super) axis: Direction,
    pub(super) warnings: Vec<String>,
    /// All that was found.
    pub(super) land: Landscape<'a>,
    /// The two ends in it.
    pub(super) minima: [usize; 2],
    /// Most evaluations of single states, where a path is proven and others are followed beside it.
    pub(super) most_evaluations: usize,
}

impl<'a, 'o> Run<'a, 'o> {
    pub(super) fn prepare(problem: &'a Problem, observer: &'o mut dyn Observer) -> Result<Run<'a, 'o>> {
        let started = Instant::now();
        let h = problem.evaluator();
        let before = h.evaluated();
        observer.stage("relaxing the ends");
        let mut warnings = Vec::new();
        let given = [&problem.initial, &problem.final_state];
        let ends = if problem.relax_ends {
            recorded(h, "ends", &given.map(|spins| spins.as_slice()), || relaxed_ends(h, given))?
        } else {
            given.map(|spins| kept(spins, torque_mev(h, spins), None))
        };
        if problem.relax_ends {
            warnings.extend(ends.iter().zip(["initial", "final"]).flat_map(|(end, which)| judge_end(h, end, which)));
        } else {
            warnings.push(
                "the ends were not relaxed (relax_ends is false): they need not be minima, and a certificate speaks of the saddle alone"
                    .into(),
            );
        }
        let (a, b) = (ends[0].spins.as_slice(), ends[1].spins.as_slice());
        let scales = recorded(h, "scales", &[a, b], || Ok(Scales::of_ends(h, &ends)))?;
        let axes = h.symmetry_axes_at(a);
        let laplacian =
            needs_laplacian(&problem.neb.optimiser).then(|| Arc::new(Laplacian::new(&h, scales.stiffness_mev)));
        let stand_in = if laplacian.is_none() { Sweep::stand_in(&h, [a, b], scales.stiffness_mev) } else { None };
        let mut land = Landscape::new(h, a);
        let examined = Minimum::of_both(h, &ends);
        problem.control.check()?;
        let minima = examined.each_ref().map(|minimum| land.add_minimum(minimum));
        let mut run = Run {
            problem,
            observer,
            started,
            before,
            ends,
            tools: Tools { settings: &problem.neb, scales, axes, laplacian, stand_in },
            axis: Direction::X,
            warnings,
            land,
            minima,
            most_evaluations: usize::MAX,
        };
        run.axis = turning_axis(problem, &run.ends[0].spins, &run.ends[1].spins, &run.context());
        Ok(run)
    }

    pub(super) fn context(&self) -> GuessContext<'a> {
        GuessContext { states: self.problem.states(&self.tools.scales), default_axis: self.axis }
    }

    fn finish(mut self) -> Result<Outcome> {
        let (a, b) = (self.ends[0].spins.as_slice(), self.ends[1].spins.as_slice());
        if is_within(a, b, SAME) {
            return Ok(report::same_minimum(&self));
        }
        if let Some(flat) = self.turned_minimum()? {
            return Ok(flat);
        }
        let firsts = self.first_paths()?;
        let (mut best, others) = self.best_of(firsts)?;
        let scale = self.tools.scales.stiffness_mev;
        let mut rejected: Vec<RejectedPath> =
            others.iter().map(|c| rejection(c, &best.first, best.seen_mev(), scale)).collect();
        let mut search = self.search(&mut best, &mut rejected)?;
        let (links, rates) = (&best.proof.links, self.problem.rates.as_ref());
        let symmetry = links.first().zip(rates).map(|(first, rates)| {
            Symmetry::of(&self.problem.hamiltonian, first.before.spins.as_slice(), &rates.moments_mub)
        });
        search.lowest_exits_mev = self.lowest_exits(links, symmetry.as_ref());
        search.exits_from_k = self.coldest_k();
        let network = match best.proof.doubts.is_empty() {
            true => self.network(links, &best.first.band, symmetry.as_ref())?,
            false => None,
        };
        if self.problem.rates.is_some() {
            self.observer.stage("computing the rates");
        }
        let rated = Rated { symmetry: symmetry.as_ref(), network };
        Ok(report::outcome(&self, best.first, &best.found, best.proof, search, rejected, rated))
    }

    /// The lowest temperature (K) that rates are asked for at.
    fn coldest_k(&self) -> Option<f64> {
        self.problem.rates.as_ref().map(RateSettings::coldest_k)
    }

    /// Beside the path over these saddles, of the initial and of the final state (meV above it).
    fn lowest_exits(&mut self, links: &[Pass], symmetry: Option<&Symmetry>) -> [Option<f64>; 2] {
        let Some(first) = links.first() else { return [None; 2] };
        let beside = std::iter::once(&first.before).chain(links.iter().map(|link| &link.after));
        let mut minima: Vec<usize> = beside.map(|minimum| self.land.add_minimum(minimum)).collect();
        let mut saddles: Vec<f64> = links.iter().map(|link| self.land.height_mev(link.saddle.spins())).collect();
        // what the coldest temperature does not hold apart is one state of all rates; what a hotter one does not has more ways out
        let within_mev = self.coldest_k().map_or(0.0, |coldest_k| LEAST_BARRIER * K_B * coldest_k);
        // rates are over the kin of the path's saddles too
        let ends = [&first.before, &links[links.len() - 1].after].map(|minimum| minimum.spins.as_slice());
        let tops: Vec<&[f64]> = links.iter().map(|link| link.saddle.spins()).collect();
        let kin = symmetry.map(|symmetry| Kin::of(symmetry, ends));
        let exit = |minima: &[usize], saddles: &[f64], last: usize| {
            let is_told = |edge: &Edge| kin.as_ref().is_some_and(|kin| kin.holds(last, &tops, &edge.saddle));
            self.land.lowest_exit_mev(minima, saddles, within_mev, &is_told)
        };
        let forward = exit(&minima, &saddles, 1);
        minima.reverse();
        saddles.reverse();
        [forward, exit(&minima, &saddles, 0)]
    }

    /// The first of the paths in full, or another one that could be proven where it could not or that is lower; and all others.
    fn best_of(&mut self, firsts: Vec<FirstPath<'a>>) -> Result<(Settled<'a>, Vec<FirstPath<'a>>)> {
        let scale = self.tools.scales.stiffness_mev;
        let mut firsts = firsts.into_iter();
        let Some(first) = firsts.next() else { return Err(Error::Numerical("no first path could be made".into())) };
        let mut best = self.settle(first, f64::INFINITY)?;
        let mut others = Vec::new();
        let tries = if self.problem.certify && self.problem.seeks_saddles() { SECOND_TRIES } else { 0 };
        for mut next in firsts.by_ref().take(tries) {
            // a proven path is the one, unless what is known of another lies below its highest saddle
            let proven = best.proof.doubts.is_empty();
            let below = if proven { (1.0 - LOWER) * best.seen_mev() } else { f64::INFINITY };
            // and what may be lower takes no more work than all that led to it
            if proven && self.most_evaluations == usize::MAX {
                let now = self.problem.evaluator().evaluated();
                self.most_evaluations = (now + self.evaluated()).evaluations;
            }
            if next.barrier_mev(scale) > below.min(WORTH * best.seen_mev()) {
                others.push(next);
                continue;
            }
            if next.found.is_none() {
                self.conclude(&mut next)?;
                if next.barrier_mev(scale) > below {
                    others.push(next);
                    continue;
                }
            }
            let next = self.settle(next, below)?;
            // the images of an unproven path are an upper bound all the same
            let better = next.proof.doubts.is_empty() && next.seen_mev() < (1.0 + LOWER) * best.seen_mev();
            let mut left = if better { std::mem::replace(&mut best, next) } else { next };
            left.first.followed_mev = Some(left.seen_mev());
            left.first.band.rest();
            others.push(left.first);
        }
        self.most_evaluations = usize::MAX;
        others.extend(firsts);
        Ok((best, others))
    }

    pub(super) fn relax(&mut self, c: &mut FirstPath<'a>, goal: Goal, limit: usize) -> Result<()> {
        let left = self.left(&c.band) / c.band.images();
        let limit = limit.min(self.problem.neb.max_evaluations).min(c.band.evaluations() + left);
        let mut relaxation = Relaxation {
            tools: &self.tools,
            climb: self.problem.neb.climb && !self.problem.refine,
            history: std::mem::take(&mut c.history),
            observer: &mut *self.observer,
        };
        let stop = relaxation.run(&mut c.band, goal, limit);
        c.history = relaxation.history;
        self.observer.relaxed(c.band.path(), &c.history);
        c.stop = stop?;
        Ok(())
    }

    /// How many evaluations of single states a band may take with all that is done for it, all that were made before counted.
    pub(super) fn allowed(&self, band: &Band) -> usize {
        let own = self.problem.neb.max_evaluations.saturating_mul(band.images());
        self.before.evaluations.saturating_add(own).min(self.most_evaluations)
    }

    /// What it has evaluated so far.
    pub(super) fn evaluated(&self) -> Count {
        self.problem.evaluator().evaluated().since(self.before)
    }

    /// How many are left of them.
    pub(super) fn left(&self, band: &Band) -> usize {
        self.allowed(band).saturating_sub(self.problem.evaluator().evaluated().evaluations)
    }

    /// Whether none are.
    pub(super) fn is_spent(&self, band: &Band) -> bool {
        self.left(band) == 0
    }

    /// Ends that are one minimum turned about a symmetry axis: the rigid turn between them costs nothing.
    fn turned_minimum(&mut self) -> Result<Option<Outcome>> {
        let h = self.problem.evaluator();
        if self.tools.axes.is_empty() || !self.problem.relax_ends {
            return Ok(None);
        }
        let [a, b] = self.ends.each_ref().map(|end| &end.spins);
        let [from, to] = self.minima.map(|k| &self.land.minima()[k]);
        if !from.is_turned(h, to) {
            return Ok(None);
        }
        // the landscape keeps one of them for both
        let ends = Minimum::of_both(h, &self.ends);
        let images = self.problem.images.asked_for().unwrap_or(FEWEST_IMAGES);
        // about an axis of symmetry the way is as long as it is; the shortest way between two states of a cone leads across it
        let axis = match self.tools.axes[..] {
            [axis] => Direction::new(axis).ok(),
            _ => None,
        };
        let path = Rotation { axis }.path(a, b, images, &self.context())?;
        let mut band = Band::new(h, path);
        band.evaluate();
        if height(&band) > ALIKE * h.stiffness_mev() {
            return Ok(None);
        }
        let stop = Stop::Converged { rotation: 0.0, tolerance: self.problem.neb.tolerance };
        let c = FirstPath::new("rotation".into(), band, stop);
        let proof = Proof { ends, links: Vec::new(), doubts: vec![Doubt::CostlyTurn] };
        Ok(Some(report::outcome(self, c, &[], proof, SearchReport::default(), Vec::new(), Rated::default())))
    }
}

/// The minima that two states relax to.
fn relaxed_ends(h: Evaluator, given: [&Spins; 2]) -> Result<[Relaxed; 2]> {
    let relax = |spins: &Spins| relax_end(h, spins, RELAXED * h.stiffness_mev());
    let (a, b) = both_by_factors(&h, || relax(given[0]), || relax(given[1]));
    Ok([a?, b?])
}
