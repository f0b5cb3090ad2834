//! How long the states of a survey live: rates over every saddle, and the times of the network that they make.

use super::{Label, Survey, SurveyProblem};
use crate::error::{Error, Result};
use crate::landscape::Landscape;
use crate::network::{Network, Parts};
use crate::rates::{LEAST_BARRIER, ORDER, RateSettings, SaddleRate, Symmetry, Theory};
use crate::stationary::ALIKE;
use crate::units::K_B;
use crate::words::counted;
use std::collections::{BTreeMap, BTreeSet};

/// So many of the lowest minima are groups of their own, where none are named.
const LOWEST: usize = 8;

/// The logarithm of the factor that stands for an error of which nothing is known.
const UNKNOWN: f64 = 700.0;
/// The part of all errors by which a time's dependence on them is told.
const STEP: f64 = 1e-4;

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
    /// The time, Langer's where there is one, may be longer or shorter by this factor; nothing where there is no time, or nothing known
    /// of its error.
    pub known_within: Option<f64>,
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
    /// Out of groups of minima and among them, over the passes of these numbers, a kind of saddles each. All saddles are looked for
    /// here: by its symmetry none is counted for another.
    pub(in crate::drive) fn of(
        survey: &Survey,
        groups: Vec<(String, Vec<usize>)>,
        settings: &RateSettings,
        land: &Landscape,
        symmetry: &Symmetry,
        passes: &[usize],
    ) -> Result<Lifetimes> {
        let h = land.evaluator();
        let rates = |(k, pass): (usize, &usize)| {
            let rates = land.passes()[*pass].rates(h, k, symmetry, settings);
            // rates that were stopped on their way look like rates that there are none of
            if h.is_stopped() { Err(Error::Stopped) } else { Ok(rates) }
        };
        let saddles = passes.iter().enumerate().map(rates).collect::<Result<_>>()?;
        let mut found = Lifetimes { settings: settings.clone(), groups, saddles, rows: Vec::new() };
        // most temperatures have the same states and passes as the one before
        let (mut known, mut transitions) = ((Vec::new(), Vec::new()), Vec::new());
        for t in &settings.temperatures_k {
            let places = found.places(survey, *t);
            let networks =
                [0.0, STEP].map(|part| Theory::ALL.map(|theory| found.network(survey, &places, theory, *t, part)));
            let rated = found.rated(*t);
            if known.0 != places.state || known.1 != rated {
                transitions = found.transitions(survey, &places, &found.ascending(survey, &rated));
                known = (places.state, rated);
            }
            let rows: Vec<Lifetime> =
                transitions.iter().map(|transition| found.row(survey, transition, *t, &networks)).collect();
            found.rows.extend(rows);
        }
        Ok(found)
    }

    /// What the user should know of the times.
    pub(super) fn warnings(&self, survey: &Survey, asked: &[(String, Label)]) -> Vec<String> {
        let mut words = self.unrated();
        words.extend(self.apart(survey));
        let (all, own) = (survey.minima.len(), self.groups.len());
        words.extend((asked.is_empty() && own < all).then(|| {
            format!("times are told out of the {own} lowest of {all} minima and among them: \"groups\" of \"landscape\" name others")
        }));
        let is_empty = |name: &String| self.groups.iter().all(|(own, _)| own != name);
        let empty = asked.iter().filter(|(name, _)| is_empty(name));
        words.extend(empty.map(|(name, _)| format!("no minimum that was found is of the group \"{name}\"")));
        let hottest = self.settings.hottest_k();
        let low = |r: &SaddleRate| r.barrier_mev.is_some_and(|e| e < LEAST_BARRIER * K_B * hottest);
        let parts = |[on, back]: &&[SaddleRate; 2]| !on.is_within_one(back, hottest);
        let count = self.saddles.iter().filter(parts).filter(|both| both.iter().any(low)).count();
        let which = if count == 1 { "one kind of saddles is".into() } else { format!("{count} kinds of saddles are") };
        let low = format!(
            "{which} lower than {LEAST_BARRIER} k_BT at {hottest} K above a minimum beside them: such a minimum hardly \
             holds the spins there, and its part in the times is formal"
        );
        words.extend((count > 0).then_some(low));
        let is_vague = |row: &&Lifetime| {
            row.ln_time_s.iter().any(Option::is_some) && row.known_within.is_none_or(|factor| factor > ORDER)
        };
        let vague = self.rows.iter().filter(is_vague).count();
        let vague_words = || {
            let times = if vague == 1 { "one time is".into() } else { format!("{vague} times are") };
            format!(
                "{times} known no better than as an order of magnitude, if at all (\"known_within_factor\"): soft modes of their saddles or \
                 minima are not harmonic at k_BT"
            )
        };
        words.extend((vague > 0).then(vague_words));
        words
    }

    /// How many minima have no part in the times of their groups, because no passes join them with the lowest.
    fn apart(&self, survey: &Survey) -> Option<String> {
        let mut parts = Parts::of(survey.minima.len());
        survey.saddles.iter().for_each(|saddle| parts.join(saddle.minima[0], saddle.minima[1]));
        let mut apart = |states: &[usize]| states.iter().filter(|k| parts.root(**k) != parts.root(states[0])).count();
        let count: usize = self.groups.iter().map(|(_, states)| apart(states)).sum();
        (count > 0).then(|| {
            format!(
                "no passes that were found join {} with the lowest of their group, of whose times they are no part",
                counted(count, "minimum", "minima")
            )
        })
    }

    /// Which kinds of saddles have no part in the times, and why: each reason once.
    fn unrated(&self) -> Vec<String> {
        let asked = Theory::ALL.into_iter().enumerate().filter(|(_, theory)| self.settings.wants(*theory));
        let told = self.settings.first_k();
        let of = |(k, theory): (usize, Theory)| {
            let without: Vec<&[SaddleRate; 2]> =
                self.saddles.iter().filter(|both| !rated(both, theory, told)).collect();
            let refused = without.iter().copied().flatten().flat_map(|r| &r.at(told).refused);
            let reason = refused.into_iter().find(|(by, _)| *by == theory)?.1.clone();
            let timed = self.rows.iter().any(|row| row.ln_time_s[k].is_some());
            let so =
                if timed { "and no part in its times, which are upper bounds" } else { "and there are no times by it" };
            Some(format!(
                "{} of {} kinds of saddles have no rate by {} {so}: {reason}",
                without.len(),
                self.saddles.len(),
                theory.name()
            ))
        };
        asked.filter_map(of).collect()
    }

    /// Which minima are places of one state at a temperature (K).
    fn places(&self, survey: &Survey, temperature_k: f64) -> Places {
        let mut parts = Parts::of(survey.minima.len());
        for saddle in &survey.saddles {
            let [on, back] = &self.saddles[saddle.kind];
            if on.is_within_one(back, temperature_k) {
                parts.join(saddle.minima[0], saddle.minima[1]);
            }
        }
        let state: Vec<usize> = (0..survey.minima.len()).map(|k| parts.root(k)).collect();
        let kind = |k: usize| (state[k], survey.minima[k].kind);
        let mut alike: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        (0..state.len()).for_each(|k| *alike.entry(kind(k)).or_default() += 1);
        let ln_alike = (0..state.len()).map(|k| libm::log(alike[&kind(k)] as f64)).collect();
        Places { state, ln_alike }
    }

    /// The network at a temperature (K), of all saddles that have a rate, each of them slower by this part of the error of its ln;
    /// nothing where none has.
    fn network(
        &self,
        survey: &Survey,
        places: &Places,
        theory: Theory,
        temperature_k: f64,
        slower: f64,
    ) -> Option<Network> {
        let mut network = Network::new(survey.minima.len());
        for saddle in &survey.saddles {
            let [a, b] = saddle.minima;
            let [on, back] = &self.saddles[saddle.kind];
            // those that are equivalent are saddles of their own here, and places share a state's time, each kind of them all of it
            let ln = |r: &SaddleRate, from: usize| {
                let ln_ways = survey.saddle_kinds[saddle.kind].ln_ways(survey.minimum_kind(from));
                let ln = r.ln_rate_of_one_per_s(theory, temperature_k)? + ln_ways - places.ln_alike[from];
                Some(ln - slower * r.ln_known_within(temperature_k).min(UNKNOWN))
            };
            if let (Some(on), Some(back)) = (ln(on, a), ln(back, b)) {
                network.add(places.state[a], places.state[b], on);
                network.add(places.state[b], places.state[a], back);
            }
        }
        self.saddles.iter().any(|both| rated(both, theory, temperature_k)).then_some(network)
    }

    /// Whether each kind of saddle has a rate at a temperature (K), by theory.
    fn rated(&self, temperature_k: f64) -> Vec<[bool; 2]> {
        self.saddles.iter().map(|both| Theory::ALL.map(|theory| rated(both, theory, temperature_k))).collect()
    }

    /// The passes by ascending energy: all of them, and those that have a rate by each theory.
    fn ascending(&self, survey: &Survey, rated: &[[bool; 2]]) -> [Vec<([usize; 2], f64)>; 3] {
        let ascending = |is_in: &dyn Fn(usize) -> bool| {
            let all = survey.saddles.iter().zip(survey.passes()).filter(|(saddle, _)| is_in(saddle.kind));
            let mut passes: Vec<([usize; 2], f64)> = all.map(|(_, pass)| pass).collect();
            passes.sort_by(|p, q| p.1.total_cmp(&q.1));
            passes
        };
        let [htst, langer] = [0, 1].map(|theory| ascending(&|kind| rated[kind][theory]));
        [ascending(&|_| true), htst, langer]
    }

    /// Out of each group with all places of its states, and from it to each other one.
    fn transitions(
        &self,
        survey: &Survey,
        places: &Places,
        [all, htst, langer]: &[Vec<([usize; 2], f64)>; 3],
    ) -> Vec<Transition> {
        let mut found = Vec::new();
        for (from, states) in &self.groups {
            let own = places.all_of(states);
            let outside: Vec<usize> = (0..survey.minima.len()).filter(|k| !own.contains(k)).collect();
            let others = self
                .groups
                .iter()
                .filter(|(name, _)| name != from)
                .map(|(name, goal)| (Some(name.clone()), goal.clone()));
            for (to, goal) in std::iter::once((None, outside)).chain(others) {
                let climb_mev = climb(survey, all, states, &goal);
                let lowest = |passes: &Vec<_>| climb(survey, passes, states, &goal) <= climb_mev * (1.0 + ALIKE);
                let rated = [htst, langer].map(lowest);
                let leads = climb(survey, all, &states[..1], &goal) < f64::INFINITY;
                let [states, goal] = [states, &goal].map(|group| places.states_of(group));
                found.push(Transition { from: from.clone(), to, states, goal, climb_mev, leads, rated });
            }
        }
        found
    }

    fn row(
        &self,
        survey: &Survey,
        transition: &Transition,
        temperature_k: f64,
        [networks, slower]: &[[Option<Network>; 2]; 2],
    ) -> Lifetime {
        let Transition { from, to, states, goal, climb_mev, leads, rated } = transition;
        let climb_mev = *climb_mev;
        let of = |networks: &[Option<Network>; 2], k: usize| {
            let network = networks[k].as_ref().filter(|_| rated[k])?;
            // what no passes join with the lowest of the group is no part of its equilibrium
            let joined = network.joined_with(states[0]);
            let states: Vec<usize> = states.iter().copied().filter(|k| joined.contains(k)).collect();
            network.ln_passage_s(&states, goal)
        };
        let refused = if !survey.is_whole() {
            Some("not all states that symmetry makes are listed".to_string())
        } else if climb_mev == f64::INFINITY {
            Some("no passes lead there".to_string())
        } else if !leads {
            Some("no passes lead there from the lowest of the group".to_string())
        } else if states.iter().any(|k| goal.contains(k)) {
            Some("some of both are places of one state".to_string())
        } else if climb_mev < LEAST_BARRIER * K_B * temperature_k {
            Some(format!("the climb is below {LEAST_BARRIER} k_BT"))
        } else {
            None
        };
        let ln_time_s = if refused.is_some() { [None; 2] } else { [0, 1].map(|k| of(networks, k)) };
        let none = || ln_time_s.iter().all(Option::is_none).then(|| self.refusal(temperature_k));
        let reason = refused.or_else(none);
        // to first order a sum over all saddles, each by its part in the time, as along a path
        let error = |k: usize| Some((of(slower, k)? - ln_time_s[k]?).abs() / STEP);
        let known_within = error(1).or_else(|| error(0)).filter(|ln| *ln < 0.1 * UNKNOWN).map(libm::exp);
        Lifetime { from: from.clone(), to: to.clone(), temperature_k, climb_mev, ln_time_s, known_within, reason }
    }

    /// Why there is no time.
    fn refusal(&self, temperature_k: f64) -> String {
        let reasons = self.saddles.iter().flatten().flat_map(|r| &r.at(temperature_k).refused);
        let words =
            reasons.map(|(theory, reason)| format!("no rate by {} over the lowest way: {reason}", theory.name()));
        words.into_iter().next().unwrap_or("no rates were asked for".into())
    }
}

/// Whether a saddle has a rate by a theory at a temperature (K) in both directions, as the network takes it.
fn rated(both: &[SaddleRate; 2], theory: Theory, temperature_k: f64) -> bool {
    both.iter().all(|rate| rate.at(temperature_k).prefactor(theory).is_some())
}

/// Named groups with the minima that they hold; where none are named, each of the lowest minima by itself.
pub(super) fn groups(survey: &Survey, asked: &SurveyProblem) -> Vec<(String, Vec<usize>)> {
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

/// The minima as states at a temperature: those between which a sliding state hops freely are one.
struct Places {
    /// The state of each minimum: the least of its places.
    state: Vec<usize>,
    /// ln of how many places of its state are of its kind.
    ln_alike: Vec<f64>,
}

impl Places {
    /// The states of some minima, each once, in the order of the minima.
    fn states_of(&self, minima: &[usize]) -> Vec<usize> {
        let mut seen = BTreeSet::new();
        minima.iter().map(|k| self.state[*k]).filter(|state| seen.insert(*state)).collect()
    }

    /// All places of the states of some minima.
    fn all_of(&self, minima: &[usize]) -> BTreeSet<usize> {
        let states: BTreeSet<usize> = minima.iter().map(|k| self.state[*k]).collect();
        (0..self.state.len()).filter(|k| states.contains(&self.state[*k])).collect()
    }
}

/// From one group of minima to another, or to any other minimum.
struct Transition {
    from: String,
    to: Option<String>,
    /// The states of the group, and those that it goes to.
    states: Vec<usize>,
    goal: Vec<usize>,
    /// The highest saddle of the lowest way, above the lowest minimum of the group (meV).
    climb_mev: f64,
    /// Whether any passes lead there from the lowest minimum of the group.
    leads: bool,
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::survey::{Effort, FoundMinimum, FoundSaddle, Kind, Unseen};
    use crate::geometry::Direction;
    use crate::landscape::Searched;
    use crate::rates::test_rates::{HOP_MEV, both, settings};
    use crate::spins::Spins;
    use crate::stationary::Spectrum;

    /// A uniform state, 0, and a skyrmion's four places: two of one kind, 1 and 2, from which it collapses, and two of another between
    /// them, 3 and 4.
    fn survey() -> Survey {
        let spins = || Spins::uniform(1, Direction::Z);
        let saddle = |kind: usize, minima: [usize; 2]| FoundSaddle { kind, minima, spins: spins() };
        let kind = |multiplicity: usize| Kind {
            first: 0,
            multiplicity,
            listed: multiplicity,
            places: 1,
            above_lowest_mev: 0.0,
            energy_mev: 0.0,
            spectrum: Spectrum {
                negative: 0,
                flat: 0,
                zero: 0,
                floor_mev: 0.0,
                norm_mev: 1.0,
                lowest_mev: Vec::new(),
                bound: None,
            },
            max_torque_mev: 0.0,
        };
        Survey {
            minimum_kinds: [1, 2, 2].map(kind).into(),
            saddle_kinds: [4, 2].map(kind).into(),
            minima: [0, 1, 1, 2, 2].map(|kind| FoundMinimum { kind, spins: spins() }).into(),
            saddles: [(0, [1, 3]), (0, [2, 3]), (0, [2, 4]), (0, [1, 4]), (1, [1, 0]), (1, [2, 0])]
                .map(|(kind, minima)| saddle(kind, minima))
                .into(),
            effort: Effort::Quick,
            searched: Searched::default(),
            shares: 1,
            seeds: 0,
            unseen: Unseen::default(),
            symmetry_order: 1,
            lifetimes: None,
            warnings: Vec::new(),
        }
    }

    #[test]
    fn each_kind_of_places_between_which_nothing_holds_a_sliding_state_has_all_of_its_time() {
        let survey = survey();
        let saddles =
            vec![both(0, 27.0, [HOP_MEV, 0.5 * HOP_MEV], [true; 2]), both(0, 25.0, [20.0, 50.0], [true, false])];
        let found = Lifetimes { settings: settings(&[20.0, 1e-6]), groups: Vec::new(), saddles, rows: Vec::new() };
        let escape = |kelvin: f64, group: &[usize]| {
            let places = found.places(&survey, kelvin);
            let network = found.network(&survey, &places, Theory::Langer, kelvin, 0.0).unwrap();
            let all: Vec<usize> = places.all_of(group).into_iter().collect();
            (all.len(), network.ln_escape_s(&places.states_of(group)).unwrap())
        };
        let collapse = -found.saddles[1][0].ln_rate_per_s(Theory::Langer, 20.0).unwrap();
        for group in [&[1][..], &[4], &[1, 2, 3, 4]] {
            let (places, time) = escape(20.0, group);
            assert!(places == 4 && (time - collapse).abs() < 1e-12 * collapse.abs(), "{group:?}: {time} {collapse}");
        }
        // where hops take long each place is a state, which is left by hops
        let (places, time) = escape(1e-6, &[1]);
        let hop = -found.saddles[0][0].ln_rate_per_s(Theory::Langer, 1e-6).unwrap();
        assert!(places == 1 && (time - hop + libm::log(2.0)).abs() < 1e-12, "{time} {hop}");
    }
}
