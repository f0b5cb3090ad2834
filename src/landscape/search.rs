//! The search for lower passes: rivals by turns, until they bring no news.
//!
//! T is the highest saddle of the best route known. A rival names a state from which a saddle below T may be reached; from there a
//! climb goes to one, descents from it to its two minima, and both go into the landscape: the route may then have a lower T.
//! News is a lower T, or a saddle of an energy that none had before; the search ends after so many searches in a row without any, or
//! after so much work if the last few brought none and T never became lower.
//! Searches are made in batches, each batch from what is known before it, its searches side by side: what is found does not depend
//! on how many threads there are.
//!
//! Processes that share a search make batches as many times as large, each its part of every batch; what is found depends on how
//! many shares there are, not on who makes them.
//!
//! The number of searches without any grows with the number of saddles found: of n that are found equally often, q searches miss one
//! with a chance of e^(−q/n). Where all passes below an energy are looked for, T is that, and every new saddle is news.

use super::rivals::{Cut, Rival, rivals, scouts, vanguard};
use super::{Landscape, Pass, Saddle, Sides};
use crate::energy::recorded_each;
use crate::error::Result;
use crate::path::guess::GuessContext;
use crate::record::Count;
use crate::stationary::{FEW, Limits, STEPS, STRIDE};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Kinds of minima, at most: of a search for a route, and of a survey for each step of effort.
pub const KINDS: usize = 1000;
/// The seed of everything random in a search.
const SEED: u64 = 0x5ea2c4;
/// Searches in a row without news, in a row of sites, that end a search which found nothing, and joins that bring two minima no nearer to each other.
pub(super) const QUIET: usize = 24;

/// How long lower passes are looked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Effort {
    /// Not at all.
    None,
    /// Until 8 searches in a row brought no news.
    Quick,
    /// Until 24 searches in a row brought no news for each direction in which the lattice extends, and 16 more for each saddle that was
    /// found, up to 100, and to 100 more for each time that the route became lower.
    #[default]
    Normal,
    /// Until 400 searches in a row brought no news, or as many as `normal` waits for: on soft films one in sixty leads lower.
    Thorough,
}

impl Effort {
    /// So many searches in a row without news end a search that found so many saddles, and a lower route so many times, on a lattice of so
    /// many directions: where there are many, more may be missing, and a film's texture goes more ways than a row's.
    fn quiet(self, [found, lowered]: [usize; 2], directions: usize) -> usize {
        match self {
            Effort::None => 0,
            Effort::Quick => 8,
            Effort::Normal => (QUIET * directions + 16 * found).min(100 * (1 + lowered)),
            Effort::Thorough => Effort::Normal.quiet([found, lowered], directions).max(400),
        }
    }

    /// As many times as much work may it do as `normal` as it waits longer for news, or as much.
    pub fn works(self) -> usize {
        (self.quiet([1, 0], 1) / Effort::Normal.quiet([1, 0], 1)).max(1)
    }

    /// And so many for each pass that is known, where all are looked for.
    fn a_pass(self) -> usize {
        match self {
            Effort::None => 0,
            Effort::Quick => 1,
            Effort::Normal => 3,
            Effort::Thorough => 10,
        }
    }
}

/// What is looked for.
#[derive(Clone, Copy, Debug)]
pub enum Aim {
    /// A route between two minima that is lower than what is known; as high as the best path known is (meV above the landscape's
    /// reference), for as long as no route is.
    Route([usize; 2], f64),
    /// All minima and passes no higher than this above the lowest minimum (meV).
    All(f64),
    /// All minima and passes below this height (meV above the landscape's reference).
    Below(f64),
}

impl Aim {
    /// Where T is now (meV above the landscape's reference).
    fn top_mev(self, land: &Landscape) -> f64 {
        match self {
            Aim::Route([from, to], known_mev) => land.top_mev(from, to).unwrap_or(known_mev),
            Aim::All(window_mev) => land.lowest_mev() + window_mev,
            Aim::Below(height_mev) => height_mev,
        }
    }

    /// What passes have to be lower than.
    fn below_mev(self, land: &Landscape, top_mev: f64) -> f64 {
        match self {
            Aim::Route(..) => top_mev - land.tolerance_mev(top_mev),
            Aim::All(_) | Aim::Below(_) => top_mev,
        }
    }

    fn ends(self) -> Option<[usize; 2]> {
        match self {
            Aim::Route(ends, _) => Some(ends),
            Aim::All(_) | Aim::Below(_) => None,
        }
    }

    /// So many searches in a row without news end the search, which brought news so often, and a lower route.
    fn quiet(self, effort: Effort, counts: [usize; 2], land: &Landscape) -> usize {
        match self {
            Aim::Route(..) => effort.quiet(counts, land.evaluator().lattice().directions()),
            Aim::All(_) | Aim::Below(_) => {
                effort.quiet([1, 0], 1).max(effort.a_pass() * land.passes_below(self.top_mev(land)))
            }
        }
    }
}

/// What a search is given.
#[derive(Clone, Copy, Debug)]
pub struct Settings<'a> {
    /// How long.
    pub effort: Effort,
    /// Batches are so many times as large.
    pub shares: usize,
    /// Most gradients and Hessians of single states.
    pub most: Count,
    /// And as long as one of the last few searches brought news, or once T became lower: what is still found may be worth more.
    pub most_with_news: Count,
    /// And of the climbs that are made before their work is looked at.
    pub together: Count,
    /// Most kinds of minima: with their number grows what each further climb costs beside what it evaluates.
    pub most_kinds: usize,
    /// Stiffness scale c (meV).
    pub c: f64,
    /// What first paths need to know.
    pub context: GuessContext<'a>,
}

impl Settings<'_> {
    /// What a search may evaluate, of which so many, the last ones, brought no news, and which made the route lower so many times.
    fn allowed(&self, quiet: usize, lowered: usize) -> Count {
        if brings_news(quiet) || lowered > 0 { self.most_with_news } else { self.most }
    }
}

/// Whether one of the last few searches brought news, of which so many, the last ones, brought none.
pub fn brings_news(quiet: usize) -> bool {
    quiet < FEW
}

/// What a search came to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Searched {
    /// How many climbs.
    pub searches: usize,
    /// How many of them, the last ones, brought no news.
    pub quiet: usize,
    /// Its work ended it before they did.
    pub spent: bool,
}

/// How a search gets on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Standing {
    /// What it came to so far.
    pub done: Searched,
    /// So many searches in a row without news end it.
    pub wanted: usize,
    /// Part of the work that it may do.
    pub spent: f64,
    /// Minima and passes known, images counted.
    pub known: [usize; 2],
}

/// Looks for passes below the top of the route between two minima, or for all below an energy; after each batch tells how it gets on.
pub fn search(
    land: &mut Landscape,
    aim: Aim,
    settings: &Settings,
    tell: &mut dyn FnMut(&Standing),
) -> Result<Searched> {
    let h = land.evaluator();
    land.unfold();
    let mut done = Searched::default();
    let mut turns = match aim {
        Aim::Route(..) => Turns::of(vanguard(false), rivals(h.lattice())),
        Aim::All(_) | Aim::Below(_) => Turns::of(vanguard(true), scouts()),
    };
    let (mut lowest, mut found, mut lowered) = (aim.top_mev(land), 0, 0);
    let before = h.evaluated();
    loop {
        let top_mev = aim.top_mev(land);
        if top_mev < lowest - land.tolerance_mev(top_mev) {
            (lowest, lowered, done.quiet) = (top_mev, lowered + 1, 0);
        }
        let wanted = aim.quiet(settings.effort, [found, lowered], land);
        let worked = h.evaluated().since(before);
        let spent =
            worked.part_of(settings.allowed(done.quiet, lowered)).max(land.kinds() as f64 / settings.most_kinds as f64);
        // what comes to its own stop has not missed the work that it has used up
        done.spent = spent >= 1.0 && done.quiet < wanted;
        tell(&Standing { done, wanted, spent, known: [land.minima().len(), land.edges().len()] });
        if done.quiet >= wanted || done.spent {
            break;
        }
        let cut = Cut::of(land, aim.ends(), aim.below_mev(land, top_mev), settings.context);
        let a_climb = match done.searches {
            // as many as one may take
            0 => Count { evaluations: STEPS, hessians: STEPS }.part_of(settings.together),
            climbs => worked.part_of(settings.together) / climbs as f64,
        };
        let side_by_side = FEW.min((1.0 / a_climb) as usize).max(1);
        let count = (side_by_side * settings.shares).min(wanted - done.quiet);
        let (starts, count_as_quiet): (Vec<Vec<f64>>, Vec<bool>) = (0..count).map_while(|_| turns.next(&cut)).unzip();
        if starts.is_empty() {
            break;
        }
        let input: Vec<&[f64]> = starts.iter().map(Vec::as_slice).collect();
        let below = cut.top_mev;
        let most = (settings.together.hessians / side_by_side).max(STEPS);
        let sides = Sides { c: settings.c, level_mev: 0.0, beside: &[], most };
        let caught: Vec<Option<Pass>> =
            recorded_each(h, "searches", &input, |k| climb(land, &starts[k], below, sides))?;
        for (pass, counts) in caught.into_iter().zip(count_as_quiet) {
            let news = pass.is_some_and(|pass| bring(land, pass, below, aim));
            done.searches += 1;
            found += usize::from(news);
            done.quiet = if news { 0 } else { done.quiet + usize::from(counts) };
        }
    }
    Ok(done)
}

/// Whose turn it is to name a start.
struct Turns {
    first: Vec<Box<dyn Rival>>,
    rivals: Vec<Box<dyn Rival>>,
    turn: usize,
    random: ChaCha8Rng,
}

impl Turns {
    fn of(first: Vec<Box<dyn Rival>>, rivals: Vec<Box<dyn Rival>>) -> Turns {
        Turns { first, rivals, turn: 0, random: ChaCha8Rng::seed_from_u64(SEED) }
    }

    /// The next start, and whether a search from there that brings no news counts as quiet.
    fn next(&mut self, cut: &Cut) -> Option<(Vec<f64>, bool)> {
        if let Some(start) = self.first.iter_mut().find_map(|first| first.start(cut, &mut self.random)) {
            return Some((start, false));
        }
        let count = self.rivals.len();
        let mut by_turns = (self.turn..self.turn + count).map(|k| k % count);
        let (by, start) = by_turns.find_map(|k| Some((k, self.rivals[k].start(cut, &mut self.random)?)))?;
        self.turn = by + 1;
        Some((start, true))
    }
}

/// Puts a pass in; whether that is news. For a route, one as high as another is most likely of no more use than that.
fn bring(land: &mut Landscape, pass: Pass, below: f64, aim: Aim) -> bool {
    let height = land.height_mev(pass.saddle.spins());
    if height >= below || pass.doubt(land.evaluator()).is_some() {
        return false;
    }
    let new = aim.ends().is_none() || !land.has_height(height);
    land.add(pass) && new
}

/// The pass that a climb from a state leads to, if that is a new one below a height (meV).
fn climb(land: &Landscape, start: &[f64], below: f64, sides: Sides) -> Result<Option<Pass>> {
    let h = land.evaluator();
    let limits = Limits {
        steps: STEPS,
        without_mode: FEW,
        radius: STRIDE,
        ceiling_mev: land.reference_mev() + below,
        known: &|m, energy_mev| land.is_beside_a_saddle(m, energy_mev - land.reference_mev()),
    };
    let Some(saddle) = Saddle::climbed(h, start, &limits) else { return Ok(None) };
    if land.height_mev(saddle.spins()) >= below || land.knows(&saddle) {
        return Ok(None);
    }
    match land.image_over(&saddle) {
        Some(image) => Ok(Some(image)),
        None => Pass::of(h, saddle, sides).map(Some),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Direction;
    use crate::lattice::Chain;
    use crate::state::StateContext;

    #[test]
    fn a_search_waits_longer_the_more_ways_there_are_and_the_more_it_found() {
        let normal = |counts: [usize; 2], directions: usize| Effort::Normal.quiet(counts, directions);
        assert_eq!([1, 2, 3].map(|directions| normal([0, 0], directions)), [24, 48, 72]);
        assert_eq!([normal([2, 0], 2), normal([9, 0], 2), normal([9, 1], 2)], [80, 100, 192]);
        assert_eq!(Effort::Thorough.quiet([0, 0], 3), 400);
        assert_eq!([Effort::Quick, Effort::Normal, Effort::Thorough].map(Effort::works), [1, 1, 10]);
    }

    #[test]
    fn a_search_may_do_more_as_long_as_there_is_news_and_once_the_route_is_lower() {
        let lattice = Chain::open(2).resolve().unwrap();
        let [most, most_with_news] = [1, 8].map(|n| Count { evaluations: n, hessians: n });
        let context = GuessContext { states: StateContext::new(&lattice, 1.0), default_axis: Direction::X };
        let (effort, shares, most_kinds, c) = (Effort::Normal, 1, KINDS, 1.0);
        let settings = Settings { effort, shares, most, most_with_news, together: most, most_kinds, c, context };
        assert_eq!(settings.allowed(FEW, 0), most);
        assert_eq!([settings.allowed(FEW - 1, 0), settings.allowed(FEW, 1)], [most_with_news; 2]);
    }
}
