//! From the proven saddles of a path to its rates.

use super::Verdict;
use super::outcome::SaddlePoint;
use crate::energy::Evaluator;
use crate::landscape::{Doubt, Pass};
use crate::rates::{
    APART, Equivalents, Family, KEPT, Kindred, OneState, Orbits, RateSettings, Rates, Refusal, SaddleRate, Symmetry,
    Turn, Unstable, ZeroKind, ZeroModes, equivalent_saddles, leads_back_by, refused, transitions, unstable_mode,
};
use crate::sphere::SAME;
use crate::stationary::{Refined, State};

/// What is known of a path.
pub struct Known<'a> {
    pub h: Evaluator<'a>,
    /// Saddles with the minima beside them, in path order; none where nothing was proven.
    pub links: &'a [Pass],
    /// The saddles as reported.
    pub saddles: &'a [SaddlePoint],
    /// Final above initial state (meV).
    pub above_final: f64,
    /// What stands against the certificate of the whole.
    pub doubts: &'a [Doubt],
    /// What the run came to, if there is no barrier.
    pub no_barrier: Option<&'a Verdict>,
    /// The symmetry of the energy and the moments, where there are links.
    pub symmetry: Option<&'a Symmetry>,
}

impl Known<'_> {
    /// What stands against rates of the whole.
    fn doubt(&self) -> Option<String> {
        self.no_barrier.map(Verdict::to_string).or_else(|| self.doubts.first().map(Doubt::to_string))
    }
}

/// The rates over every saddle and over the whole path.
pub fn of_path(known: &Known, settings: &RateSettings) -> Rates {
    let doubt = known.doubt();
    let saddles: Vec<_> = match known.symmetry.filter(|_| known.no_barrier.is_none()) {
        None => known.saddles.iter().enumerate().flat_map(|(k, s)| unproven(known, k, s, settings)).collect(),
        Some(symmetry) => known.links.iter().flat_map(|l| proven(known, symmetry, l, settings)).collect(),
    };
    let orbits = orbits(known, &saddles);
    let transitions = transitions(&saddles, &orbits, settings, doubt.as_deref());
    Rates { settings: settings.clone(), saddles, transitions }
}

/// How many of its saddles and minima symmetry makes, both ends kept, at all temperatures. A path over one saddle needs no count: the
/// saddles between the same two minima are counted with it.
fn orbits(known: &Known, rates: &[SaddleRate]) -> Vec<Orbits> {
    let alone = |by: &str| {
        let paths = Equivalents { count: 1, by: by.into() };
        vec![Orbits { above_k: 0.0, saddles: Vec::new(), minima: Vec::new(), paths, leads_back: false }]
    };
    let Some(symmetry) = known.symmetry.filter(|_| !known.links.is_empty()) else { return alone("not sought") };
    if known.links.len() == 1 || known.doubt().is_some() {
        return alone("counted with the saddle");
    }
    let mut above: Vec<f64> = rates.iter().flat_map(|r| r.regimes.iter().map(|regime| regime.above_k)).collect();
    above.sort_by(f64::total_cmp);
    above.dedup();
    let mut counted: Vec<(Slides, Orbits)> = Vec::new();
    for (k, above_k) in above.iter().enumerate() {
        // the end of a range is still in it
        let slides = Slides::at(rates, above.get(k + 1).copied().unwrap_or(f64::INFINITY));
        if counted.last().is_none_or(|(last, _)| *last != slides) {
            let orbits = slides.orbits(known, symmetry, *above_k);
            counted.push((slides, orbits));
        }
    }
    counted.into_iter().map(|(_, orbits)| orbits).collect()
}

/// What of a path slides at a temperature.
#[derive(PartialEq)]
struct Slides {
    /// Over the lattice, each minimum, both ends among them.
    minima: Vec<bool>,
    /// Each saddle.
    saddles: Vec<bool>,
    turn: Option<Turn>,
}

impl Slides {
    /// From the rates over each saddle forward and backward, in path order.
    fn at(rates: &[SaddleRate], kelvin: f64) -> Slides {
        let slides = |zeros: &[ZeroModes]| zeros.iter().any(|z| z.kind == ZeroKind::Translation);
        let before = rates.iter().take(1).chain(rates.iter().skip(1).step_by(2));
        Slides {
            minima: before.map(|r| slides(&r.at(kelvin).minimum_zeros)).collect(),
            saddles: rates.iter().step_by(2).map(|r| slides(&r.at(kelvin).saddle_zeros)).collect(),
            turn: rates.iter().find_map(|r| r.at(kelvin).turn),
        }
    }

    fn orbits(&self, known: &Known, symmetry: &Symmetry, above_k: f64) -> Orbits {
        let (links, h, last) = (known.links, known.h, known.links.len());
        let symmetry = symmetry.along(self.turn);
        let along = &symmetry.exact;
        let ends = [links[0].before.spins.as_slice(), links[last - 1].after.spins.as_slice()];
        let slide = [self.minima[0], self.minima[last]];
        let family = Family::of(h, &symmetry, ends, slide, KEPT);
        let tops: Vec<&[f64]> = links.iter().map(|l| l.saddle.spins()).collect();
        let inside: Vec<&[f64]> = links[..last - 1].iter().map(|l| l.after.spins.as_slice()).collect();
        // of a state, but for what the way back along the path has too
        let kindred = |state: &State, unstable: Option<&Unstable>, own: bool, back: &[&[f64]]| {
            let like = equivalent_saddles(h.lattice(), along, &state.m, ends, OneState::of(own, slide), KEPT);
            let siblings = family.as_ref().map(|family| family.siblings((state, unstable, 0), own, back));
            (Kindred { alike: like.count, siblings: siblings.unwrap_or_default() }, like)
        };
        let count = |leads_back: bool| -> (Vec<Kindred>, Vec<(Kindred, Equivalents)>) {
            let [of_tops, of_inside] = if leads_back { [&tops[..], &inside[..]] } else { [&[][..]; 2] };
            let saddles = links.iter().zip(&self.saddles).map(|(l, own)| {
                let Refined { state, valley, .. } = &*l.saddle.refined;
                kindred(state, unstable_mode(state, valley, &state.zeros).as_ref(), *own, of_tops).0
            });
            let minima = inside.iter().zip(&self.minima[1..]);
            let minima = minima.map(|(m, own)| kindred(&State::at(h, m.to_vec()), None, *own, of_inside));
            (saddles.collect(), minima.collect())
        };
        let inner = [inside[0], inside[last - 2]];
        // of what slides the ends' own volumes hold all places
        let slides = self.minima.iter().chain(&self.saddles).any(|slides| *slides);
        let mut leads_back = !slides && leads_back_by(along, inner, ends, SAME);
        let (mut saddles, mut between) = count(leads_back);
        let has_siblings = saddles.iter().chain(between.iter().map(|b| &b.0)).any(|kin| !kin.siblings.0.is_empty());
        if let Some(near) = symmetry.near.as_ref().filter(|_| leads_back && has_siblings) {
            // the way back may be a sibling too
            leads_back = leads_back_by(near, inner, ends, APART);
            (saddles, between) = count(leads_back);
        }
        let paths = between[0].1.clone();
        let between = between.into_iter().map(|(kin, _)| kin);
        let minima = std::iter::once(Kindred::alone()).chain(between).chain([Kindred::alone()]).collect();
        Orbits { above_k, saddles, minima, paths, leads_back }
    }
}

fn proven(known: &Known, symmetry: &Symmetry, link: &Pass, settings: &RateSettings) -> [SaddleRate; 2] {
    let number = known.saddles.iter().position(|s| s.spins.as_slice() == link.saddle.spins()).unwrap_or(0);
    link.rates(known.h, number, symmetry, settings)
}

/// Without a proof there is no minimum to leave: the barriers are those above the ends.
fn unproven(known: &Known, number: usize, saddle: &SaddlePoint, settings: &RateSettings) -> [SaddleRate; 2] {
    let barriers = [saddle.above_initial_mev, saddle.above_initial_mev - known.above_final].map(Some);
    if let Some(why) = known.no_barrier {
        return refused(number, settings, barriers, &Refusal::NoBarrier(why.to_string()));
    }
    let doubt = known.doubt().unwrap_or_else(|| Doubt::NotAskedFor.to_string());
    refused(number, settings, barriers, &Refusal::Unproven { negative_modes: saddle.negative_modes, doubt })
}
