//! How long the states of a survey live: rates over every saddle, and the times of the network that they make.

use super::{Survey, SurveyProblem};
use crate::landscape::{Landscape, Pass};
use crate::network::{Network, Parts};
use crate::rates::{LEAST_BARRIER, RateSettings, SaddleRate, Theory, saddle_rates};
use crate::symmetry::Group;
use crate::units::K_B;

/// Climbs that differ by less than this part are alike.
const ALIKE: f64 = 1e-9;
/// So many of the lowest minima are groups of their own, where none are named.
const LOWEST: usize = 8;

/// The mean time from one group of minima to another, or until it is left.
#[derive(Clone, Debug, PartialEq)]
pub struct Lifetime {
    /// From this group, in its own equilibrium.
    pub from: String,
    /// To this one; to any other state if absent.
    pub to: Option<String>,
    /// Temperature (K).
    pub temperature_k: f64,
    /// The highest saddle of the lowest way, above the lowest minimum of the group (meV).
    pub climb_mev: f64,
    /// ln of the mean time (s), by theory: HTST, Langer.
    pub ln_time_s: [Option<f64>; 2],
    /// Why there is none.
    pub reason: Option<String>,
}

/// All times, and what they are made of.
#[derive(Clone, Debug, PartialEq)]
pub struct Lifetimes {
    /// What was asked for.
    pub settings: RateSettings,
    /// Groups by name, each with its minima.
    pub groups: Vec<(String, Vec<usize>)>,
    /// The rates over each kind of saddle: from the first of its two minima to the second, and back.
    pub saddles: Vec<[SaddleRate; 2]>,
    /// One row a pair of groups and temperature.
    pub rows: Vec<Lifetime>,
}

impl Lifetimes {
    pub(super) fn of(
        survey: &Survey,
        asked: &SurveyProblem,
        settings: &RateSettings,
        land: &Landscape,
        group: &Group,
        passes: &[&Pass],
    ) -> Lifetimes {
        let saddles = passes.iter().enumerate().map(|(k, pass)| over(land, group, pass, k, settings)).collect();
        let groups = groups(survey, asked);
        let mut found = Lifetimes { settings: settings.clone(), groups, saddles, rows: Vec::new() };
        let transitions = found.transitions(survey);
        for t in &settings.temperatures_k {
            let networks = Theory::ALL.map(|theory| found.network(survey, theory, *t));
            let rows: Vec<Lifetime> =
                transitions.iter().map(|transition| found.row(survey, transition, *t, &networks)).collect();
            found.rows.extend(rows);
        }
        found
    }

    /// What the user should know of the times.
    pub(super) fn warnings(&self) -> Vec<String> {
        let mut words = self.unrated();
        let hottest = self.settings.temperatures_k.iter().copied().fold(0.0, f64::max);
        let low = |r: &SaddleRate| r.barrier_mev.is_some_and(|e| e < LEAST_BARRIER * K_B * hottest);
        let count = self.saddles.iter().filter(|both| both.iter().any(low)).count();
        let low = format!(
            "{count} kinds of saddles are lower than {LEAST_BARRIER} k_BT at {hottest} K above a minimum beside them: such a minimum hardly \
             holds the spins there, and its part in the times is formal"
        );
        words.extend((count > 0).then_some(low));
        words
    }

    /// Which kinds of saddles have no part in the times, and why: each reason once.
    fn unrated(&self) -> Vec<String> {
        let asked = Theory::ALL.into_iter().filter(|theory| self.settings.wants(*theory));
        let of = |theory: Theory| {
            let without: Vec<&SaddleRate> =
                self.saddles.iter().map(|both| &both[0]).filter(|r| !has_rate(r, theory)).collect();
            let reason = without.iter().flat_map(|r| &r.refused).find(|(by, _)| *by == theory)?.1.clone();
            Some(format!(
                "{} of {} kinds of saddles have no rate by {} and no part in its times, which are upper bounds: {reason}",
                without.len(),
                self.saddles.len(),
                theory.name()
            ))
        };
        asked.filter_map(of).collect()
    }

    /// The network at a temperature (K), of all saddles that have a rate; nothing where none has.
    pub fn network(&self, survey: &Survey, theory: Theory, temperature_k: f64) -> Option<Network> {
        let mut network = Network::new(survey.minima.len());
        for saddle in &survey.saddles {
            let [a, b] = saddle.minima;
            if a == b {
                continue;
            }
            let [on, back] = &self.saddles[saddle.kind];
            // those that are equivalent are saddles of their own here, and places states of their own
            let ln = |r: &SaddleRate| r.ln_rate_of_one_per_s(theory, temperature_k);
            if let (Some(on), Some(back)) = (ln(on), ln(back)) {
                network.add(a, b, on);
                network.add(b, a, back);
            }
        }
        self.saddles.iter().any(|both| has_rate(&both[0], theory)).then_some(network)
    }

    /// Out of each group, and from it to each other one.
    fn transitions(&self, survey: &Survey) -> Vec<Transition> {
        let ascending = |is_in: &dyn Fn(usize) -> bool| {
            let all = survey.saddles.iter().zip(survey.passes()).filter(|(saddle, _)| is_in(saddle.kind));
            let mut passes: Vec<([usize; 2], f64)> = all.map(|(_, pass)| pass).collect();
            passes.sort_by(|p, q| p.1.total_cmp(&q.1));
            passes
        };
        let all = ascending(&|_| true);
        let rated = Theory::ALL.map(|theory| ascending(&|kind| has_rate(&self.saddles[kind][0], theory)));
        let mut found = Vec::new();
        for (from, states) in &self.groups {
            let outside: Vec<usize> = (0..survey.minima.len()).filter(|k| !states.contains(k)).collect();
            let others = self
                .groups
                .iter()
                .filter(|(name, _)| name != from)
                .map(|(name, goal)| (Some(name.clone()), goal.clone()));
            for (to, goal) in std::iter::once((None, outside)).chain(others) {
                let climb_mev = climb(survey, &all, states, &goal);
                let lowest = |passes: &Vec<_>| climb(survey, passes, states, &goal) <= climb_mev * (1.0 + ALIKE);
                let rated = rated.each_ref().map(lowest);
                found.push(Transition { from: from.clone(), to, states: states.clone(), goal, climb_mev, rated });
            }
        }
        found
    }

    fn row(
        &self,
        survey: &Survey,
        transition: &Transition,
        temperature_k: f64,
        networks: &[Option<Network>; 2],
    ) -> Lifetime {
        let Transition { from, to, states, goal, climb_mev, rated } = transition;
        let climb_mev = *climb_mev;
        let time = |k: usize| networks[k].as_ref().filter(|_| rated[k])?.ln_passage_s(states, goal);
        let reason = if !survey.is_whole() {
            Some("not all states that symmetry makes are listed".to_string())
        } else if climb_mev == f64::INFINITY {
            Some("no passes lead there".to_string())
        } else if climb_mev < LEAST_BARRIER * K_B * temperature_k {
            Some(format!("the climb is below {LEAST_BARRIER} k_BT"))
        } else if (0..2).all(|k| time(k).is_none()) {
            Some(self.refusal())
        } else {
            None
        };
        let ln_time_s = if reason.is_some() { [None; 2] } else { [time(0), time(1)] };
        Lifetime { from: from.clone(), to: to.clone(), temperature_k, climb_mev, ln_time_s, reason }
    }

    /// Why there is no time.
    fn refusal(&self) -> String {
        let reasons = self.saddles.iter().flatten().flat_map(|r| &r.refused);
        let words =
            reasons.map(|(theory, reason)| format!("no rate by {} over the lowest way: {reason}", theory.name()));
        words.into_iter().next().unwrap_or("no rates were asked for".into())
    }
}

fn has_rate(rate: &SaddleRate, theory: Theory) -> bool {
    match theory {
        Theory::Htst => rate.htst.is_some(),
        Theory::Langer => rate.langer.is_some(),
    }
}

/// Named groups with the minima that they hold; where none are named, each of the lowest minima by itself.
fn groups(survey: &Survey, asked: &SurveyProblem) -> Vec<(String, Vec<usize>)> {
    if asked.groups.is_empty() {
        return (0..survey.minima.len().min(LOWEST)).map(|k| (format!("minimum {k}"), vec![k])).collect();
    }
    let lattice = asked.problem.hamiltonian.lattice();
    let triangles = lattice.triangles();
    let held = asked.groups.iter().map(|(name, label)| {
        let states = (0..survey.minima.len())
            .filter(|k| label.holds(&survey.minima[*k].spins, &lattice.vacant, &triangles))
            .collect();
        (name.clone(), states)
    });
    held.filter(|(_, states): &(String, Vec<usize>)| !states.is_empty()).collect()
}

/// From one group of minima to another, or to any other minimum.
struct Transition {
    from: String,
    to: Option<String>,
    states: Vec<usize>,
    goal: Vec<usize>,
    /// The highest saddle of the lowest way, above the lowest minimum of the group (meV).
    climb_mev: f64,
    /// Whether saddles with a rate by HTST, and by Langer, lead there as low.
    rated: [bool; 2],
}

/// The highest saddle of the lowest way from some minima to others, above the lowest of the first (meV); passes by ascending energy.
fn climb(survey: &Survey, ascending: &[([usize; 2], f64)], from: &[usize], to: &[usize]) -> f64 {
    let lowest = from.iter().map(|k| survey.minimum_kind(*k).above_lowest_mev).fold(f64::INFINITY, f64::min);
    let mut parts = Parts::of(survey.minima.len());
    for &([a, b], height) in ascending {
        parts.join(a, b);
        let reached: Vec<usize> = from.iter().map(|k| parts.root(*k)).collect();
        if to.iter().any(|k| reached.contains(&parts.root(*k))) {
            return height - lowest;
        }
    }
    f64::INFINITY
}

/// The rates over a pass, from the minimum before it and back.
fn over(land: &Landscape, group: &Group, pass: &Pass, number: usize, settings: &RateSettings) -> [SaddleRate; 2] {
    let h = land.evaluator();
    let doubt = pass.doubt(h).map(|doubt| doubt.to_string());
    saddle_rates(h, number, &pass.crossing(group, doubt.as_deref()), settings)
}
