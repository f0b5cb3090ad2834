//! What a survey found: states by energy, those of a kind (that symmetry makes of one) side by side.

use super::lifetimes::Lifetimes;
use super::{Effort, SurveyProblem};
use crate::error::Result;
use crate::landscape::{Landscape, Searched, is_same_state};
use crate::spins::Spins;
use crate::stationary::Spectrum;
use crate::symmetry::Group;

/// States that symmetry makes of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kind {
    /// The first of them.
    pub first: usize,
    /// How many there are, by the orbit of the first: the order of the group over that of the operations that keep it.
    pub multiplicity: usize,
    /// How many of them are listed.
    pub listed: usize,
    /// Energy above the lowest minimum (meV).
    pub above_lowest_mev: f64,
    /// Energy (meV).
    pub energy_mev: f64,
    /// Its modes.
    pub spectrum: Spectrum,
    /// Largest component of the Riemannian gradient (meV).
    pub max_torque_mev: f64,
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
    /// States that it started from.
    pub seeds: usize,
    /// Operations of the group that was found, the identity counted.
    pub symmetry_order: usize,
    /// Lifetimes, where they were asked for.
    pub lifetimes: Option<Lifetimes>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Survey {
    pub(super) fn of(
        asked: &SurveyProblem,
        land: &Landscape,
        group: &Group,
        seeds: usize,
        searched: Searched,
        warnings: Vec<String>,
    ) -> Result<Survey> {
        let heights = land.heights_mev();
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let top = lowest + asked.window_mev;
        // kinds by energy, then in the order in which they were found
        let is_in = |k: &usize| land.standing_for(*k) == *k && heights[*k] <= top;
        let mut nodes: Vec<usize> = (0..heights.len()).filter(is_in).collect();
        let height_of = |k: usize| heights[land.orbit(k)];
        nodes.sort_by(|p, q| {
            height_of(*p).total_cmp(&height_of(*q)).then(land.orbit(*p).cmp(&land.orbit(*q))).then(p.cmp(q))
        });
        let mut number = vec![usize::MAX; heights.len()];
        let (mut minimum_kinds, mut minima): (Vec<Kind>, Vec<FoundMinimum>) = (Vec::new(), Vec::new());
        for (id, &k) in nodes.iter().enumerate() {
            number[k] = id;
            let minimum = &land.minima()[k];
            let new = id == 0 || land.orbit(nodes[id - 1]) != land.orbit(k);
            if new {
                minimum_kinds.push(Kind {
                    first: id,
                    multiplicity: multiplicity(land, group, minimum.spins.as_slice()),
                    listed: 0,
                    above_lowest_mev: heights[k] - lowest,
                    energy_mev: minimum.energy_mev,
                    spectrum: minimum.spectrum.clone(),
                    max_torque_mev: minimum.max_torque_mev,
                });
            }
            let kind = minimum_kinds.len() - 1;
            minimum_kinds[kind].listed += 1;
            minima.push(FoundMinimum { kind, spins: minimum.spins.clone() });
        }
        let is_joined = |e: &usize| {
            let edge = &land.edges()[*e];
            edge.height_mev <= top && edge.ends.iter().all(|k| number[*k] != usize::MAX)
        };
        let mut edges: Vec<usize> = (0..land.edges().len()).filter(is_joined).collect();
        let own = |e: usize| land.edges()[e].pass;
        let first_height = |e: usize| land.height_mev(land.passes()[own(e)].saddle.spins());
        edges.sort_by(|p, q| first_height(*p).total_cmp(&first_height(*q)).then(own(*p).cmp(&own(*q))).then(p.cmp(q)));
        let (mut saddle_kinds, mut saddles): (Vec<Kind>, Vec<FoundSaddle>) = (Vec::new(), Vec::new());
        let mut passes = Vec::new();
        for &e in &edges {
            let (edge, pass) = (&land.edges()[e], &land.passes()[own(e)]);
            if passes.last() != Some(&own(e)) {
                passes.push(own(e));
                let state = &pass.saddle.refined.state;
                saddle_kinds.push(Kind {
                    first: saddles.len(),
                    multiplicity: multiplicity(land, group, &state.m),
                    listed: 0,
                    above_lowest_mev: land.height_mev(&state.m) - lowest,
                    energy_mev: land.evaluator().energy_mev(&state.m),
                    spectrum: pass.spectrum.clone(),
                    max_torque_mev: state.max_torque_mev(),
                });
            }
            let kind = saddle_kinds.len() - 1;
            saddle_kinds[kind].listed += 1;
            let minima = edge.ends.map(|k| number[k]);
            saddles.push(FoundSaddle { kind, minima, spins: Spins::from_unit_components(&edge.saddle) });
        }
        let mut survey = Survey {
            minimum_kinds,
            saddle_kinds,
            minima,
            saddles,
            effort: asked.effort,
            searched,
            seeds,
            symmetry_order: group.order(),
            lifetimes: None,
            warnings,
        };
        survey.judge();
        if let Some(settings) = &asked.rates {
            let passes: Vec<_> = passes.into_iter().map(|k| &land.passes()[k]).collect();
            let lifetimes = Lifetimes::of(&survey, asked, settings, land, group, &passes);
            survey.warnings.extend(lifetimes.warnings());
            survey.lifetimes = Some(lifetimes);
        }
        Ok(survey)
    }

    /// Whether every state that symmetry makes of the kinds is listed.
    pub fn is_whole(&self) -> bool {
        self.minimum_kinds.iter().chain(&self.saddle_kinds).all(|kind| kind.listed == kind.multiplicity)
    }

    /// Whether the search came to its stop: nothing new for as long as was asked for.
    pub fn is_finished(&self) -> bool {
        !self.searched.spent
    }

    fn judge(&mut self) {
        if !self.is_whole() {
            let count = |kinds: &[Kind]| kinds.iter().filter(|kind| kind.listed != kind.multiplicity).count();
            self.warnings.push(format!(
                "symmetry makes more states than are listed of {} kinds of minima and {} of saddles: tables and graphs are of those \
                 that are",
                count(&self.minimum_kinds),
                count(&self.saddle_kinds)
            ));
        }
        if self.searched.spent {
            self.warnings.push(
                "the search ended because it had done as much work as it may: more may be found with more effort"
                    .into(),
            );
        }
        let reached: Vec<usize> = self.saddles.iter().flat_map(|s| s.minima).collect();
        let alone = (0..self.minima.len()).filter(|k| !reached.contains(k)).count();
        if alone > 0 && self.minima.len() > 1 {
            self.warnings.push(format!("no saddle was found beside {alone} of the minima"));
        }
    }
}

/// How many states the group makes of one.
fn multiplicity(land: &Landscape, group: &Group, m: &[f64]) -> usize {
    let h = land.evaluator();
    let keeps = 1 + group.operations().filter(|operation| is_same_state(h, &operation.apply(m), m)).count();
    group.order() / keeps
}
