//! What a survey found: states by energy, those of a kind (that symmetry makes of one) side by side.

use super::lifetimes::{Lifetimes, groups};
use super::{Effort, SurveyProblem, Unseen};
use crate::error::Result;
use crate::landscape::{Landscape, Searched, Seen};
use crate::rates::Symmetry;
use crate::spins::Spins;
use crate::stationary::Spectrum;
use crate::symmetry::Group;
use rayon::prelude::*;

/// States that symmetry makes of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// The first of them.
    pub first: usize,
    /// How many there are, by the orbit of the first: the order of the group over that of the operations that keep it.
    pub multiplicity: usize,
    /// How many of them are listed.
    pub listed: usize,
    /// For how many each of these stands: its places by translations, where these make too many states.
    pub places: usize,
    /// Energy above the lowest minimum (meV).
    pub above_lowest_mev: f64,
    /// Energy (meV).
    pub energy_mev: f64,
    /// Its modes.
    pub spectrum: Spectrum,
    /// Largest component of the Riemannian gradient (meV).
    pub max_torque_mev: f64,
}

impl Kind {
    /// Whether all of them are listed, or stood for.
    pub fn is_whole(&self) -> bool {
        self.listed * self.places == self.multiplicity
    }

    /// ln of how many saddles of this kind lead from each place of a state of another one, for each saddle beside it that is listed.
    pub fn ln_ways(&self, from: &Kind) -> f64 {
        libm::log(self.places as f64) - libm::log(from.places as f64)
    }
}

/// A minimum.
#[derive(Clone, Debug)]
pub struct FoundMinimum {
    /// Which kind.
    pub kind: usize,
    /// Its spins.
    pub spins: Spins,
}

/// A saddle.
#[derive(Clone, Debug)]
pub struct FoundSaddle {
    /// Which kind.
    pub kind: usize,
    /// The minima that its two descents reach.
    pub minima: [usize; 2],
    /// Its spins.
    pub spins: Spins,
}

/// All that was found.
#[derive(Clone, Debug)]
pub struct Survey {
    /// Kinds of minima, the lowest first.
    pub minimum_kinds: Vec<Kind>,
    /// Kinds of saddles, the lowest first.
    pub saddle_kinds: Vec<Kind>,
    /// All minima, kind by kind.
    pub minima: Vec<FoundMinimum>,
    /// All saddles, kind by kind.
    pub saddles: Vec<FoundSaddle>,
    /// How long was looked.
    pub effort: Effort,
    /// What the search came to.
    pub searched: Searched,
    /// Into how many shares the search was split.
    pub shares: usize,
    /// States that it started from.
    pub seeds: usize,
    /// What the random ones of them say of minima that may be missing.
    pub unseen: Unseen,
    /// Operations of the group that was found, the identity counted.
    pub symmetry_order: usize,
    /// Lifetimes, where they were asked for.
    pub lifetimes: Option<Lifetimes>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// A survey with where it comes from.
pub(in crate::drive) struct Told {
    pub survey: Survey,
    /// The pass of each kind of saddles.
    pub passes: Vec<usize>,
    /// The minimum that each of the landscape is; `usize::MAX` for those that are not in it.
    pub number: Vec<usize>,
}

impl Survey {
    pub(super) fn of(
        asked: &SurveyProblem,
        land: &Landscape,
        group: &Group,
        (seeds, unseen): (usize, Unseen),
        searched: Searched,
    ) -> Result<Survey> {
        let Told { survey, passes, .. } = Survey::up_to(land, group, land.lowest_mev() + asked.window_mev, searched);
        let mut survey = Survey { effort: asked.effort, shares: asked.shares, seeds, unseen, ..survey };
        let spectra = survey.saddle_kinds.par_iter_mut().zip(&passes);
        spectra.for_each(|(kind, pass)| {
            kind.spectrum.lowest_mev = land.passes()[*pass].lowest_eigenvalues_mev(land.evaluator());
        });
        survey.judge(asked.window_mev);
        if let Some(settings) = &asked.rates {
            let groups = groups(&survey, asked);
            let lifetimes = Lifetimes::of(&survey, groups, settings, land, &Symmetry::exactly(group), &passes)?;
            survey.warnings.extend(lifetimes.warnings(&survey, &asked.groups));
            survey.lifetimes = Some(lifetimes);
        }
        Ok(survey)
    }

    /// What a landscape holds up to a height (meV above its reference), with as much of it as symmetry makes.
    pub(in crate::drive) fn up_to(land: &Landscape, group: &Group, top: f64, searched: Searched) -> Told {
        let view = View { land, group, lowest: land.lowest_mev(), top };
        let (minimum_kinds, minima, number) = view.minima();
        let (saddle_kinds, saddles, passes) = view.saddles(&number);
        let survey = Survey {
            minimum_kinds,
            saddle_kinds,
            minima,
            saddles,
            effort: Effort::default(),
            searched,
            shares: 1,
            seeds: 0,
            unseen: Unseen::default(),
            symmetry_order: group.order(),
            lifetimes: None,
            warnings: Vec::new(),
        };
        Told { survey, passes, number }
    }

    /// The kind of a minimum.
    pub fn minimum_kind(&self, k: usize) -> &Kind {
        &self.minimum_kinds[self.minima[k].kind]
    }

    /// The kind of a saddle.
    pub fn saddle_kind(&self, k: usize) -> &Kind {
        &self.saddle_kinds[self.saddles[k].kind]
    }

    /// The two minima beside each saddle, and its energy above the lowest minimum (meV).
    pub fn passes(&self) -> impl Iterator<Item = ([usize; 2], f64)> {
        self.saddles.iter().map(|saddle| (saddle.minima, self.saddle_kinds[saddle.kind].above_lowest_mev))
    }

    /// Whether states stand for all their places by translations.
    pub fn has_places(&self) -> bool {
        self.minimum_kinds.iter().chain(&self.saddle_kinds).any(|kind| kind.places > 1)
    }

    /// Whether every state that symmetry makes of the kinds is listed, or stood for.
    pub fn is_whole(&self) -> bool {
        self.minimum_kinds.iter().chain(&self.saddle_kinds).all(Kind::is_whole)
    }

    /// Whether the search came to its stop: nothing new for as long as was asked for.
    pub fn is_finished(&self) -> bool {
        !self.searched.spent
    }

    fn judge(&mut self, window_mev: f64) {
        if !self.is_whole() {
            let count = |kinds: &[Kind]| kinds.iter().filter(|kind| !kind.is_whole()).count();
            self.warnings.push(format!(
                "symmetry makes more states than are listed of {} kinds of minima and {} of saddles: tables and graphs are of those \
                 that are",
                count(&self.minimum_kinds),
                count(&self.saddle_kinds)
            ));
        }
        if self.searched.spent {
            let more = match window_mev.is_finite() {
                true => "with more effort",
                false => "with more effort; no energy_window bounds what is looked for, and one would",
            };
            let words = "the search ended because it had done as much work, or found as many states, as it may: more may be found";
            self.warnings.push(format!("{words} {more}"));
        }
        let estimated = self.unseen.estimated_kinds();
        if estimated >= self.minimum_kinds.len() as f64 + 1.0 {
            self.warnings.push(format!(
                "{} kinds of minima were found, and from how often random states led to each there are about {estimated:.0} at least \
                 (Chao's estimate)",
                self.minimum_kinds.len()
            ));
        }
        let reached: Vec<usize> = self.saddles.iter().flat_map(|s| s.minima).collect();
        let alone = (0..self.minima.len()).filter(|k| !reached.contains(k)).count();
        if alone > 0 && self.minima.len() > 1 {
            self.warnings.push(format!("no saddle was found beside {alone} of the minima"));
        }
    }
}

/// A landscape up to a height.
struct View<'l> {
    land: &'l Landscape<'l>,
    group: &'l Group,
    /// The lowest minimum, and how high it reaches (meV above the landscape's reference).
    lowest: f64,
    top: f64,
}

impl View<'_> {
    /// Kinds of minima, by energy and then in the order in which they were found; all of them; and the number of each node.
    fn minima(&self) -> (Vec<Kind>, Vec<FoundMinimum>, Vec<usize>) {
        let (land, heights) = (self.land, self.land.heights_mev());
        let is_in = |k: &usize| land.standing_for(*k) == *k && heights[*k] <= self.top;
        let mut nodes: Vec<usize> = (0..heights.len()).filter(is_in).collect();
        let order = |p: &usize, q: &usize| {
            let [a, b] = [*p, *q].map(|k| land.orbit(k));
            heights[a].total_cmp(&heights[b]).then(a.cmp(&b)).then(p.cmp(q))
        };
        nodes.sort_by(order);
        let mut number = vec![usize::MAX; heights.len()];
        let (mut kinds, mut minima): (Vec<Kind>, Vec<FoundMinimum>) = (Vec::new(), Vec::new());
        for (id, &k) in nodes.iter().enumerate() {
            number[k] = id;
            let minimum = &land.minima()[k];
            if id == 0 || land.orbit(nodes[id - 1]) != land.orbit(k) {
                kinds.push(Kind {
                    first: id,
                    multiplicity: self.multiplicity(minimum.spins.as_slice()),
                    listed: 0,
                    places: land.places().count(land.evaluator(), minimum.spins.as_slice()),
                    above_lowest_mev: heights[k] - self.lowest,
                    energy_mev: minimum.energy_mev,
                    spectrum: minimum.spectrum.clone(),
                    max_torque_mev: minimum.max_torque_mev,
                });
            }
            let kind = kinds.len() - 1;
            kinds[kind].listed += 1;
            minima.push(FoundMinimum { kind, spins: minimum.spins.clone() });
        }
        (kinds, minima, number)
    }

    /// Kinds of saddles between these minima, likewise; all of them; and the pass of each kind.
    fn saddles(&self, number: &[usize]) -> (Vec<Kind>, Vec<FoundSaddle>, Vec<usize>) {
        let (land, edges) = (self.land, self.land.edges());
        let is_listed = |k: &usize| number[*k] != usize::MAX;
        let is_in =
            |e: &usize| edges[*e].height_mev <= self.top && !edges[*e].is_twin && edges[*e].ends.iter().all(is_listed);
        let mut order: Vec<usize> = (0..edges.len()).filter(is_in).collect();
        // images are as high as the pass itself
        let place = |e: &usize| (edges[*e].height_mev, edges[*e].pass);
        order.sort_by(|p, q| place(p).0.total_cmp(&place(q).0).then(place(p).1.cmp(&place(q).1)).then(p.cmp(q)));
        let (mut kinds, mut saddles): (Vec<Kind>, Vec<FoundSaddle>) = (Vec::new(), Vec::new());
        let mut passes = Vec::new();
        for edge in order.into_iter().map(|e| &edges[e]) {
            let pass = &land.passes()[edge.pass];
            if passes.last() != Some(&edge.pass) {
                passes.push(edge.pass);
                let state = &pass.saddle.refined.state;
                kinds.push(Kind {
                    first: saddles.len(),
                    multiplicity: self.multiplicity(&state.m),
                    listed: 0,
                    places: land.places().count(land.evaluator(), &state.m),
                    above_lowest_mev: edge.height_mev - self.lowest,
                    energy_mev: land.evaluator().energy_mev(&state.m),
                    spectrum: pass.spectrum.clone(),
                    max_torque_mev: state.max_torque_mev(),
                });
            }
            let kind = kinds.len() - 1;
            kinds[kind].listed += 1;
            let minima = edge.ends.map(|k| number[k]);
            saddles.push(FoundSaddle { kind, minima, spins: Spins::from_unit_components(&edge.saddle) });
        }
        (kinds, saddles, passes)
    }

    /// How many states the group makes of one.
    fn multiplicity(&self, m: &[f64]) -> usize {
        let (h, group) = (self.land.evaluator(), self.group);
        let seen = Seen::of(h, m);
        let keeps = 1 + group.operations().filter(|by| seen.is_made(by, m)).count();
        group.order() / keeps
    }
}
