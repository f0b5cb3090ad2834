//! The landscape as a result: all minima and passes below an energy, as far as they are found, and what follows from them.
//!
//! Seeds (the states of the problem, uniform ones along and against x, y and z, random ones) are relaxed to minima. Then climbs from
//! these and from what they lead to, along soft modes, from between neighbours, from local turns and from blocks of random spins, until
//! they bring no news; what is not joined by then is joined by first paths and their bands, and what these meet is searched from in turn.

mod found;
mod lifetimes;
mod unseen;

pub(super) use found::Told;
pub use found::{FoundMinimum, FoundSaddle, Kind, Survey};
pub use lifetimes::{Lifetime, Lifetimes};
pub use unseen::Unseen;

use super::problem::{check_rates, of_so_many_sites};
use super::run::Run;
use super::{Observer, Problem};
use crate::energy::recorded_each;
use crate::error::{Error, Result};
use crate::field::Components;
use crate::geometry::{Direction, vector};
use crate::landscape::{Aim, Effort, KINDS, Minimum, Searched, Settings, search};
use crate::lattice::Triangles;
use crate::rates::RateSettings;
use crate::record::Count;
use crate::spins::Spins;
use crate::stationary::{RELAXED, relax_to_minimum};
use crate::symmetry::Group;
use crate::words::number;
use std::collections::BTreeSet;

/// Searches and joins follow each other so many times at most.
const ROUNDS: usize = 4;
/// Of spins, so many are evaluated at most for each step of effort, and so many times as many of a Hessian's blocks.
const SPINS: usize = 50_000_000;

/// What a survey is asked for.
#[derive(Debug)]
pub struct SurveyProblem {
    /// The energy, a first seed (both its ends), and how bands are relaxed.
    pub problem: Problem,
    /// Further states to start from.
    pub seeds: Vec<Spins>,
    /// States above the lowest minimum by more than this are left out (meV).
    pub window_mev: f64,
    /// How long is looked.
    pub effort: Effort,
    /// Groups of minima, by name.
    pub groups: Vec<(String, Label)>,
    /// Lifetimes; none if absent.
    pub rates: Option<RateSettings>,
    /// Into how many shares the search is split, for as many processes; 1 is not split.
    pub shares: usize,
    /// A larger group is unfolded but for its translations: a state stands for all its places then.
    pub images: usize,
}

/// The largest group, as a rule, of which every image is a state by itself.
pub const IMAGES: usize = 2000;

/// What the states of a group have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Label {
    /// Their mean spin along a direction is from one number to another; vacant sites do not count.
    MeanSpin {
        /// The direction.
        axis: Direction,
        /// At least.
        from: f64,
        /// At most.
        to: f64,
    },
    /// Their topological charge is nearest to this.
    Charge(i32),
}

impl Label {
    /// Whether a state of a lattice with these vacant sites and triangles is one of them.
    pub fn holds(&self, spins: &Spins, vacant: &[bool], triangles: &Triangles) -> bool {
        match *self {
            Label::MeanSpin { axis, from, to } => (from..=to).contains(&vector::dot(axis.vector(), spins.mean(vacant))),
            Label::Charge(charge) => triangles.charge(Components::new(spins.as_slice())).round() == f64::from(charge),
        }
    }
}

/// How many random states are seeds, and how many times as much work as by the least effort may be done.
fn share(effort: Effort) -> [usize; 2] {
    match effort {
        Effort::None => [0, 1],
        Effort::Quick => [8, 1],
        Effort::Normal => [32, 4],
        Effort::Thorough => [128, 20],
    }
}

/// Finds the minima and passes of a problem below an energy. One that its control stops ends with [`Error::Stopped`].
pub fn survey(asked: &SurveyProblem, observer: &mut dyn Observer) -> Result<Survey> {
    searched(asked, observer, |run, group, planted, searched| {
        // how the ends relaxed is no news: they are states to start from, and perhaps not even given
        Survey::of(asked, &run.land, group, planted, searched)
    })
}

/// The search of [`survey`] alone, as one of the processes that share it makes it, and what it came to.
pub fn take_part(asked: &SurveyProblem, observer: &mut dyn Observer) -> Result<Searched> {
    searched(asked, observer, |_, _, _, searched| Ok(searched))
}

/// Searches, and tells what it came to.
fn searched<T: Send>(
    asked: &SurveyProblem,
    observer: &mut dyn Observer,
    tell: impl FnOnce(Run, &Group, (usize, Unseen), Searched) -> Result<T> + Send,
) -> Result<T> {
    asked.check()?;
    asked.problem.control.recorder().begin(|| asked.fingerprint());
    asked.problem.control.relied_on(rayon::scope(|_| {
        let mut run = Run::prepare(&asked.problem, observer)?;
        let alike = asked.rates.as_ref().map_or(&[][..], |rates| &rates.moments_mub);
        let group = Group::of(&asked.problem.hamiltonian, run.ends[0].spins.as_slice(), alike);
        run.land.unfold_all(&group, asked.images);
        let planted = run.plant(asked)?;
        let searched = run.explore(asked)?;
        tell(run, &group, planted, searched)
    }))
}

impl SurveyProblem {
    /// An error where a state, the window, the number of shares or what is asked of rates is none that a survey can have.
    fn check(&self) -> Result<()> {
        self.problem.check().map_err(|e| e.within("problem"))?;
        let sites = self.problem.hamiltonian.sites();
        for (k, seed) in self.seeds.iter().enumerate() {
            of_so_many_sites(sites, &format!("seeds[{k}]"), seed)?;
        }
        if self.window_mev.is_nan() || self.window_mev < 0.0 {
            let message = format!("found {}, but a window of energies is 0 or greater", number(self.window_mev));
            return Err(Error::invalid("window_mev", message));
        }
        if self.shares == 0 {
            return Err(Error::invalid("shares", "found 0, but a search that is not split has 1 share"));
        }
        if self.problem.rates.is_some() {
            let message = "these are rates of a single path: those of a landscape are the survey's own \"rates\"";
            return Err(Error::invalid("problem.rates", message));
        }
        check_rates(self.rates.as_ref(), sites)
    }

    fn fingerprint(&self) -> crate::record::Fingerprint {
        let SurveyProblem { problem, seeds, window_mev, effort, groups, rates, shares, images } = self;
        let print =
            problem.fingerprint().text(&format!("{window_mev:?} {effort:?} {groups:?} {rates:?} {shares} {images}"));
        seeds.iter().fold(print, |print, seed| print.row(seed.as_slice()))
    }

    /// States to start from: those that are given, uniform ones and random ones; frozen spins as they are.
    fn starts(&self) -> Vec<Spins> {
        let (h, given) = (&self.problem.hamiltonian, &self.problem.initial);
        let sites = h.sites();
        let axes = [Direction::X, Direction::Y, Direction::Z];
        let uniform = axes.into_iter().flat_map(|d| [d, d.reversed()]).map(|d| Spins::uniform(sites, d));
        let [random, _] = share(self.effort);
        let random = (0..random as u64).map(|seed| Spins::random(sites, seed));
        let free = |state: Spins| {
            let mut m = state.as_slice().to_vec();
            for i in (0..sites).filter(|i| h.is_frozen(*i)) {
                (0..3).for_each(|c| m[c * sites + i] = given.as_slice()[c * sites + i]);
            }
            Spins::from_unit_components(&m)
        };
        self.seeds.iter().cloned().chain(uniform.chain(random).map(free)).collect()
    }
}

impl Run<'_, '_> {
    /// Relaxes all starts and puts the minima in; how many starts there were, and what the random ones say.
    fn plant(&mut self, asked: &SurveyProblem) -> Result<(usize, Unseen)> {
        self.observer.stage("relaxing the seeds");
        let h = self.problem.evaluator();
        let starts = asked.starts();
        let input: Vec<&[f64]> = starts.iter().map(Spins::as_slice).collect();
        let relaxed = |k: usize| -> Result<Minimum> {
            let relaxed = relax_to_minimum(h, &starts[k], RELAXED * h.stiffness_mev())?;
            Ok(Minimum::of(h, &relaxed))
        };
        let minima: Vec<Minimum> = recorded_each(h, "seeds", &input, relaxed)?;
        let heights: Vec<f64> = minima.iter().map(|m| self.land.height_mev(m.spins.as_slice())).collect();
        let top = heights.iter().copied().fold(self.land.lowest_mev(), f64::min) + asked.window_mev;
        let [random, _] = share(asked.effort);
        let mut reached = Vec::new();
        for (k, minimum) in minima.iter().enumerate().filter(|(k, m)| m.is_proven() && heights[*k] <= top) {
            let node = self.land.add_minimum(minimum);
            if k + random >= starts.len() {
                reached.push(self.land.orbit(self.land.standing_for(node)));
            }
        }
        Ok((starts.len() + 1, Unseen::of(&reached)))
    }

    /// Searches, and joins what is not joined, by turns until neither brings news.
    fn explore(&mut self, asked: &SurveyProblem) -> Result<Searched> {
        let mut all = Searched::default();
        let before = self.problem.evaluator().evaluated();
        let mut tried = BTreeSet::new();
        for _ in 0..ROUNDS {
            self.observer.stage(match asked.window_mev.is_finite() {
                true => "looking for minima and passes",
                false => "looking for minima and passes of any energy (landscape.energy_window is not given)",
            });
            let most = self.left_of_budget(asked, before);
            let (c, context) = (self.tools.scales.stiffness_mev, self.context());
            let settings = Settings {
                effort: asked.effort,
                shares: asked.shares,
                most,
                most_with_news: most,
                together: Count { evaluations: usize::MAX, hessians: usize::MAX },
                most_kinds: KINDS * share(asked.effort)[1],
                c,
                context,
            };
            let aim = Aim::All(asked.window_mev);
            let round = search(&mut self.land, aim, &settings, &mut |standing| self.observer.searching(standing))?;
            all = Searched { searches: all.searches + round.searches, ..round };
            let known = [self.land.minima().len(), self.land.edges().len()];
            if round.spent || asked.effort == Effort::None {
                break;
            }
            self.observer.stage("joining minima");
            self.join(asked, before, &mut tried)?;
            if [self.land.minima().len(), self.land.edges().len()] == known {
                break;
            }
        }
        Ok(all)
    }

    /// Joins pairs of minima that no pass joins below the window's top, the nearest first, each kind with its nearest neighbour once.
    fn join(&mut self, asked: &SurveyProblem, before: Count, tried: &mut BTreeSet<usize>) -> Result<()> {
        loop {
            let top = self.land.lowest_mev() + asked.window_mev;
            let part = self.land.parts_below(top);
            let is_in = |k: usize| self.land.standing_for(k) == k && self.land.heights_mev()[k] <= top;
            let nodes: Vec<usize> = (0..part.len()).filter(|k| is_in(*k)).collect();
            let Some(&a) = nodes.iter().find(|k| {
                self.land.orbit(**k) == **k && !tried.contains(*k) && nodes.iter().any(|b| part[*b] != part[**k])
            }) else {
                return Ok(());
            };
            tried.insert(a);
            let near = |b: &&usize| self.land.squared_distance([a, **b]);
            let others = nodes.iter().filter(|b| part[**b] != part[a]);
            let Some(&b) = others.min_by(|p, q| near(p).total_cmp(&near(q))) else { return Ok(()) };
            if self.left_of_budget(asked, before).evaluations == 0 {
                return Ok(());
            }
            self.connect_by_first_path([a, b], top)?;
        }
    }

    fn left_of_budget(&self, asked: &SurveyProblem, before: Count) -> Count {
        let (h, [_, parts]) = (self.problem.evaluator(), share(asked.effort));
        let allowed = parts * SPINS / h.sites();
        h.evaluated().since(before).left_of(Count { evaluations: allowed, hessians: allowed })
    }
}
