//! The course of a run: the ends, first paths, a route that connects them, a search below its top, and what all this came to.

use super::first_path::{FirstPath, rejection};
use super::heights::height;
use super::outcome::*;
use super::report::{self, Rated};
use super::run::{FEWEST_IMAGES, Run, WORTH};
use super::settled::{Proof, Settled};
use super::{Observer, Problem, Stop};
use crate::band::Band;
use crate::error::{Error, Result};
use crate::geometry::Direction;
use crate::landscape::{Doubt, Edge, Minimum, Pass};
use crate::path::guess::{FirstGuess, Rotation};
use crate::path::is_within;
use crate::rates::{Kin, LEAST_BARRIER, RateSettings, Symmetry};
use crate::sphere::SAME;
use crate::stationary::{ALIKE, LOWER};
use crate::units::K_B;

/// Further paths that are followed to the end.
const SECOND_TRIES: usize = 2;

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

impl<'a> Run<'a, '_> {
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
        Ok(report::outcome(&self, best, search, rejected, rated))
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
        let kin = symmetry.map(|symmetry| {
            // a state that slides from place to place
            let loose = [0, links.len()].map(|k| {
                let mut others = self.land.one_with(minima[k], within_mev);
                let own = self.land.minima()[minima[k]].spins.as_slice();
                others.any(|other| symmetry.shifts(own, other.spins.as_slice()))
            });
            Kin::of(symmetry, ends, loose)
        });
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
        let settled = Settled {
            first: FirstPath::new("rotation".into(), band, stop),
            found: Vec::new(),
            proof: Proof { ends, links: Vec::new(), doubts: vec![Doubt::CostlyTurn] },
        };
        Ok(Some(report::outcome(self, settled, SearchReport::default(), Vec::new(), Rated::default())))
    }
}
