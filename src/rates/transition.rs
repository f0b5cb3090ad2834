//! The rate of the whole path, over all its saddles.

use super::passage::{TEN_YEARS_S, blocking_temperature, first_passage, first_passage_by_either, passages};
use super::rate::{factor, ruling};
use super::{Equivalents, RateSettings, Refusal, Row, SaddleRate, Siblings, Theory, Way};
use crate::units::K_B;

/// How many of each stationary state symmetry makes of the path's own with both ends kept: from a minimum of a kind of which there
/// are M, S/M of the S saddles of a kind lead on to the next kind, and likewise back. Taken together, the minima of a kind are one
/// state of the network, and what starts at one end is found in any of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Orbits {
    /// So it is above this temperature (K), until the next.
    pub above_k: f64,
    /// Of each saddle, in path order.
    pub saddles: Vec<Kindred>,
    /// Of each minimum, both ends counted.
    pub minima: Vec<Kindred>,
    /// Paths of the same kind, through other minima.
    pub paths: Equivalents,
    /// Whether what makes each end the other makes another path of this one, over the same saddles the other way round, as time reversal
    /// does without a field.
    pub leads_back: bool,
}

impl Orbits {
    /// ln of the number of ways over saddles like saddle k out of the minimum before it (`side` 0) or after it (1) at a k_BT (meV), over
    /// the number that its own rate is over already, of which the ln is given.
    fn ln_more(&self, k: usize, side: usize, ln_counted: f64, thermal_mev: f64) -> f64 {
        let known = self.saddles.get(k).zip(self.minima.get(k + side));
        known.map_or(0.0, |(s, m)| (s.ln_number(thermal_mev) - m.ln_number(thermal_mev) - ln_counted).max(0.0))
    }
}

/// How many states there are like one.
#[derive(Clone, Debug, PartialEq)]
pub struct Kindred {
    /// That symmetry makes of it, itself among them.
    pub alike: usize,
    /// That it nearly makes of it.
    pub siblings: Siblings,
}

impl Kindred {
    /// None but itself.
    pub fn alone() -> Kindred {
        Kindred { alike: 1, siblings: Siblings::default() }
    }

    /// ln of their number at a k_BT (meV).
    fn ln_number(&self, thermal_mev: f64) -> f64 {
        self.siblings.ln_number(self.alike, thermal_mev)[0]
    }
}

/// One temperature of a transition.
#[derive(Clone, Debug, PartialEq)]
pub struct TransitionRow {
    /// To the other end: one over the mean first-passage time.
    pub passage: Row,
    /// Over the first saddle and all that shifts make of it, out of the first minimum, whatever follows; where that slides, out of all of its
    /// places.
    pub escape: Row,
}

/// The mean first passage to the other end over all passes that are known, at one temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct NetworkTime {
    /// Temperature (K).
    pub temperature_k: f64,
    /// ln of the mean time (s), by theory: HTST, Langer.
    pub ln_time_s: [Option<f64>; 2],
    /// It may be longer or shorter by this factor.
    pub known_within: Option<f64>,
}

impl NetworkTime {
    /// ln of the time (s), Langer's where there is one.
    pub fn ln_s(&self) -> Option<f64> {
        self.ln_time_s[1].or(self.ln_time_s[0])
    }
}

/// The whole way from one end to the other, through the minima between.
#[derive(Clone, Debug, PartialEq)]
pub struct TransitionRate {
    /// In which direction.
    pub way: Way,
    /// Saddles on the way.
    pub saddles: usize,
    /// Paths of the same kind, through other minima; the rates are over all of them.
    pub equivalents: Equivalents,
    /// The highest saddle above the first minimum (meV).
    pub barrier_mev: f64,
    /// One row a temperature.
    pub rows: Vec<TransitionRow>,
    /// The times of the network of all passes that are known, a temperature each; empty where none was looked for.
    pub network: Vec<NetworkTime>,
    /// Temperature (K) at which the mean first passage takes 1 s, and at which it takes ten years.
    pub blocking_k: [Option<f64>; 2],
    /// Why there is no rate; nothing if there is one.
    pub refused: Option<Refusal>,
}

/// The rates of the whole path in both directions, from those of its saddles (forward and backward, in path order) and the
/// numbers of their like, by ascending temperature from 0 K on. `doubt` is what stands against a certificate of the path.
pub fn transitions(
    saddles: &[SaddleRate],
    orbits: &[Orbits],
    settings: &RateSettings,
    doubt: Option<&str>,
) -> Vec<TransitionRate> {
    if saddles.is_empty() {
        return Vec::new();
    }
    Way::BOTH.map(|way| transition(saddles, orbits, settings, doubt, way)).into()
}

/// A path in one direction.
struct Along<'a> {
    way: Way,
    /// The rates over each saddle that it meets.
    onward: Vec<&'a SaddleRate>,
    /// Back over each.
    back: Vec<&'a SaddleRate>,
    orbits: &'a [Orbits],
    doubt: Option<&'a str>,
}

impl<'a> Along<'a> {
    fn new(saddles: &'a [SaddleRate], orbits: &'a [Orbits], doubt: Option<&'a str>, way: Way) -> Along<'a> {
        let mut onward: Vec<&SaddleRate> = saddles.iter().filter(|r| r.way == way).collect();
        let mut back: Vec<&SaddleRate> = saddles.iter().filter(|r| r.way != way).collect();
        if way == Way::Backward {
            onward.reverse();
            back.reverse();
        }
        Along { way, onward, back, orbits, doubt }
    }

    /// The saddles that part states.
    fn parting(&self, t: f64) -> Vec<usize> {
        (0..self.onward.len()).filter(|i| !self.onward[*i].is_within_one(self.back[*i], t)).collect()
    }

    /// Over saddle i, onward or back.
    fn ln_rate(&self, onward: bool, i: usize, theory: Theory, t: f64) -> Option<f64> {
        let rate = if onward { self.onward[i] } else { self.back[i] };
        Some(rate.ln_rate_per_s(theory, t)? + self.ln_more(onward, i, t))
    }

    /// ln of the ways over saddles like it over those that its own rate is over.
    fn ln_more(&self, onward: bool, i: usize, t: f64) -> f64 {
        // saddles count along the path: backward, the minimum that a step on leaves is the one after its saddle
        let side = usize::from(onward != (self.way == Way::Forward));
        let number = if self.way == Way::Forward { i } else { self.onward.len() - 1 - i };
        let rate = if onward { self.onward[i] } else { self.back[i] };
        let [counted, _] = rate.at(t).ln_saddles(t);
        at(self.orbits, t).ln_more(number, side, counted, K_B * t)
    }

    /// Of all saddles onward, and back over all but the last: what the passage hangs on.
    fn both(&self, theory: Theory, t: f64) -> Option<[Vec<f64>; 2]> {
        let parted = self.parting(t);
        let (_, but_last) = parted.split_last().filter(|_| self.doubt.is_none())?;
        let ln_rates = |onward: bool, saddles: &[usize]| -> Option<Vec<f64>> {
            saddles.iter().map(|i| self.ln_rate(onward, *i, theory, t)).collect()
        };
        Some([ln_rates(true, &parted)?, ln_rates(false, but_last)?])
    }

    fn escape(&self, theory: Theory, t: f64) -> Option<f64> {
        let first = *self.parting(t).first().filter(|_| self.doubt.is_none())?;
        let more = self.ln_more(true, first, t).max(self.onward[first].at(t).ln_beyond);
        Some(self.onward[first].ln_rate_per_s(theory, t)? + more)
    }

    /// ln of the factor within which a passage is known: each saddle's error counts as far as the time hangs on it.
    fn ln_known(&self, t: f64) -> f64 {
        let Some([on, back]) = self.both(Theory::Langer, t).or_else(|| self.both(Theory::Htst, t)) else {
            return f64::INFINITY;
        };
        let total = first_passage(&on, &back);
        let parts = passages(&on, &back).into_iter().zip(self.parting(t));
        parts.map(|(time, i)| libm::exp(time - total) * self.onward[i].ln_known_within(t)).sum()
    }
}

/// A path in one direction, and over the same saddles the other way round: what leads back along the path, made to lead on.
struct Passage<'a> {
    path: Along<'a>,
    other: Along<'a>,
    barrier_mev: f64,
}

impl<'a> Passage<'a> {
    fn of(path: Along<'a>, other: Along<'a>) -> Passage<'a> {
        let barrier_mev = highest(&path.onward, &path.back);
        Passage { path, other, barrier_mev }
    }

    fn leads_back(&self, t: f64) -> bool {
        at(self.path.orbits, t).leads_back
    }

    /// ln of one over the mean time to the other end (1/s).
    fn ln_rate(&self, theory: Theory, t: f64) -> Option<f64> {
        let [on, back] = self.path.both(theory, t)?;
        if !self.leads_back(t) {
            return Some(-first_passage(&on, &back));
        }
        let [other_on, other_back] = self.other.both(theory, t)?;
        Some(-first_passage_by_either([[&on, &back], [&other_on, &other_back]]))
    }

    fn row(&self, t: f64) -> TransitionRow {
        let path = &self.path;
        let whole = Row {
            temperature_k: t,
            barrier_over_kt: self.barrier_mev / (K_B * t),
            ln_htst_per_s: self.ln_rate(Theory::Htst, t),
            ln_langer_per_s: self.ln_rate(Theory::Langer, t),
            ..Row::default()
        };
        let out = path.onward[path.parting(t).first().copied().unwrap_or(0)];
        let first = Row {
            temperature_k: t,
            barrier_over_kt: out.barrier_mev.unwrap_or(0.0) / (K_B * t),
            ln_htst_per_s: path.escape(Theory::Htst, t),
            ln_langer_per_s: path.escape(Theory::Langer, t),
            ..Row::default()
        };
        let known_within = first.ln_lifetime_s().and_then(|_| factor(out.ln_known_within(t)));
        let first = Row { known_within, ..first };
        let ln_known = path.ln_known(t);
        let ln_known = if self.leads_back(t) { ln_known.max(self.other.ln_known(t)) } else { ln_known };
        TransitionRow { passage: Row { known_within: factor(ln_known), ..whole }.held(), escape: first.held() }
    }

    /// Why it has no rate at any of these temperatures.
    fn refused(&self, settings: &RateSettings) -> Option<Refusal> {
        let has_a_rate = |t: &f64| Theory::ALL.iter().any(|theory| self.ln_rate(*theory, *t).is_some());
        if settings.temperatures_k.iter().any(has_a_rate) {
            return None;
        }
        let Along { onward, back, doubt, .. } = &self.path;
        let mut refusals = onward.iter().chain(back).flat_map(|r| &r.at(settings.first_k()).refused);
        doubt.map(|doubt| Refusal::Path(doubt.into())).or_else(|| refusals.next().map(|(_, reason)| reason.clone()))
    }
}

fn transition(
    saddles: &[SaddleRate],
    orbits: &[Orbits],
    settings: &RateSettings,
    doubt: Option<&str>,
    way: Way,
) -> TransitionRate {
    let other_way = if way == Way::Forward { Way::Backward } else { Way::Forward };
    let [path, other] = [way, other_way].map(|way| Along::new(saddles, orbits, doubt, way));
    let passage = Passage::of(path, other);
    let lifetime = |t: f64| passage.row(t).passage.ln_lifetime_s();
    let Equivalents { count, by } = at(orbits, settings.first_k()).paths.clone();
    let equivalents = match passage.leads_back(settings.first_k()) {
        false => Equivalents { count, by },
        true => Equivalents { count: 2 * count, by: format!("{by}, and the way back along each") },
    };
    TransitionRate {
        way,
        saddles: passage.path.onward.len(),
        equivalents,
        barrier_mev: passage.barrier_mev,
        rows: settings.temperatures_k.iter().map(|t| passage.row(*t)).collect(),
        network: Vec::new(),
        blocking_k: [1.0, TEN_YEARS_S].map(|s| blocking_temperature(lifetime, passage.barrier_mev, s)),
        refused: passage.refused(settings),
    }
}

/// The numbers at a temperature (K).
fn at(orbits: &[Orbits], temperature_k: f64) -> &Orbits {
    ruling(orbits, |o| o.above_k, temperature_k)
}

/// The highest saddle above the first minimum (meV): up over each, down to the next.
fn highest(onward: &[&SaddleRate], back: &[&SaddleRate]) -> f64 {
    let (mut level, mut top) = (0.0, f64::NEG_INFINITY);
    for (up, down) in onward.iter().zip(back) {
        level += up.barrier_mev.unwrap_or(0.0);
        top = f64::max(top, level);
        level -= down.barrier_mev.unwrap_or(0.0);
    }
    top
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rates::test_rates::{HOP_MEV, both, settings};

    /// A skyrmion's hop from place to place, then its collapse; whether it slides.
    fn hop_and_collapse(slides: bool) -> Vec<SaddleRate> {
        let hop = both(0, 25.0, [HOP_MEV, 0.5 * HOP_MEV], [slides; 2]);
        [hop, both(1, 26.0, [20.0, 50.0], [slides, false])].concat()
    }

    fn row(saddles: &[SaddleRate], way: usize, temperature_k: f64) -> TransitionRow {
        let orbits = Orbits {
            leads_back: false,
            above_k: 0.0,
            saddles: vec![Kindred::alone(); saddles.len() / 2],
            minima: vec![Kindred::alone(); saddles.len() / 2 + 1],
            paths: Equivalents { count: 1, by: String::new() },
        };
        let settings = settings(&[temperature_k]);
        transitions(saddles, &[orbits], &settings, None)[way].rows[0].clone()
    }

    #[test]
    fn places_between_which_nothing_holds_a_sliding_state_are_one_state() {
        let collapse = [0, 1].map(|way| row(&hop_and_collapse(true)[2..], way, 20.0));
        for (way, alone) in collapse.iter().enumerate() {
            let found = row(&hop_and_collapse(true), way, 20.0);
            assert_eq!(found.passage.ln_langer_per_s, alone.passage.ln_langer_per_s);
            assert_eq!(found.escape.ln_langer_per_s, alone.escape.ln_langer_per_s);
            assert!(found.escape.ln_langer_per_s.is_some());
        }
        // two that do not slide are two states, and the first holds nothing back
        let parted = row(&hop_and_collapse(false), 0, 20.0);
        assert!(parted.escape.ln_langer_per_s.is_none());
        assert!(parted.passage.ln_langer_per_s < collapse[0].passage.ln_langer_per_s);
        // and so are two where the hop takes long
        let cold = row(&hop_and_collapse(true), 0, 1e-6);
        assert!(cold.escape.ln_langer_per_s.is_some_and(|ln| ln < 25.0));
    }

    #[test]
    fn a_path_all_of_whose_saddles_lie_within_one_state_has_no_rate() {
        let hops = &hop_and_collapse(true)[..2];
        let found = row(hops, 0, 20.0);
        assert!(found.passage.ln_langer_per_s.is_none() && found.escape.ln_langer_per_s.is_none());
    }
}
