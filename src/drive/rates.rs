//! From the proven saddles of a path to its rates.

use super::Verdict;
use super::network::FIELD;
use super::outcome::{Barrier, SaddlePoint, SearchReport};
use crate::energy::Evaluator;
use crate::landscape::{Doubt, Minimum, Pass, Peak, Saddle};
use crate::linalg::slab;
use crate::rates::{
    APART, Equivalents, Family, KEPT, Kindred, OneState, Orbits, RateSettings, Rates, Refusal, SaddleRate, Symmetry,
    Theory, Turn, Unstable, ZeroKind, ZeroModes, equivalent_saddles, leads_back_by, refused, transitions,
    unstable_mode,
};
use crate::sphere::SAME;
use crate::spins::Spins;
use crate::stationary::{ALIKE, Refined, Spectrum, State};
use crate::units::K_B;

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

/// The rates over saddles and minima (both ends among them) that were found earlier, in path order; the reason if they do not
/// prove themselves to be what they were said to be.
pub fn stored_rates(
    h: Evaluator,
    saddles: &[SaddlePoint],
    minima: &[Spins],
    settings: &RateSettings,
) -> Result<Rates, String> {
    if saddles.is_empty() || minima.len() != saddles.len() + 1 {
        return Err(format!("{} saddles do not lie between {} minima", saddles.len(), minima.len()));
    }
    let sites = saddles.iter().map(|s| s.spins.sites()).chain(minima.iter().map(Spins::sites));
    if let Some(found) = sites.into_iter().find(|n| *n != h.sites()) {
        return Err(format!("a state has {found} sites, the chain has {}", h.sites()));
    }
    let examined: Vec<Minimum> = minima.iter().map(|m| Minimum::examine(h, m)).collect();
    let links: Vec<Pass> =
        saddles.iter().zip(examined.windows(2)).map(|(s, beside)| stored_link(h, s, beside)).collect();
    let initial = minima[0].as_slice();
    for (k, (link, saddle)) in links.iter().zip(saddles).enumerate() {
        if let Some(doubt) = link.doubt(h) {
            return Err(format!("saddle {k}: {doubt}"));
        }
        let above = h.difference_mev(saddle.spins.as_slice(), initial);
        if (above - saddle.above_initial_mev).abs() > ALIKE * h.stiffness_mev() {
            return Err(format!(
                "saddle {k} lies {above} meV above the initial state, and summary.json says otherwise"
            ));
        }
    }
    let above_final = h.difference_mev(minima[saddles.len()].as_slice(), initial);
    let symmetry = Symmetry::of(&h, initial, &settings.moments_mub);
    let (doubts, no_barrier, symmetry) = (&[][..], None, Some(&symmetry));
    Ok(of_path(&Known { h, links: &links, saddles, above_final, doubts, no_barrier, symmetry }, settings))
}

/// A stored saddle between two minima, its descending mode found anew.
fn stored_link(h: Evaluator, saddle: &SaddlePoint, beside: &[Minimum]) -> Pass {
    let state = State::at(h, saddle.spins.as_slice().to_vec());
    let spectrum = Spectrum::of(h, &state, 0);
    let lowest = state.lowest_mode(h);
    let valley = lowest.as_ref().map_or_else(|| vec![0.0; state.m.len()], |mode| state.field(&mode.vector));
    let mut tau = valley.clone();
    slab::normalise(&mut tau);
    let (s, image) = (saddle.reaction_coordinate_rad, saddle.image);
    let top = Peak { m: state.m.clone(), tau, energy_mev: state.energy_mev, s, image, floor_mev: f64::NEG_INFINITY };
    let saddle = Saddle::new(top, Refined { state, valley, spectrum: Some(spectrum) });
    Pass { given: false, ..Pass::between(h, saddle, [beside[0].clone(), beside[1].clone()]) }
}

/// That some numbers are rough.
const ROUGH: &str = "some rates are rough: \"warnings\" of \"rates\" in summary.json give their range";
/// That states are left by other ways too.
pub const ALONE: &str = "rates and lifetimes are of the path's saddles alone";
/// How a refusal begins.
const REFUSAL: &str = "no rate by ";

/// Whether a warning is one of [`warnings`].
pub fn is_said_of_rates(warning: &str) -> bool {
    warning == ROUGH || warning.ends_with(ALONE) || warning.starts_with(REFUSAL)
}

/// Each reason why a rate is lacking, with the theories and, where other directions over saddles have rates, with those that it holds for.
fn refusals(rates: &Rates) -> Vec<String> {
    let refused = rates.saddles.iter().flat_map(|r| rates.told(r).refused.iter().map(move |(by, why)| (r, *by, why)));
    let mut reasons: Vec<(String, Vec<Theory>, Vec<&SaddleRate>)> = Vec::new();
    for (rate, theory, reason) in refused {
        let reason = reason.to_string();
        let known = reasons.iter().position(|(known, ..)| *known == reason);
        let k = known.unwrap_or_else(|| {
            reasons.push((reason, Vec::new(), Vec::new()));
            reasons.len() - 1
        });
        let (_, theories, over) = &mut reasons[k];
        theories.extend(Some(theory).filter(|t| !theories.contains(t)));
        over.extend(Some(rate).filter(|r| over.last().is_none_or(|last| !std::ptr::eq(*last, *r))));
    }
    let line = |(reason, theories, over): (String, Vec<Theory>, Vec<&SaddleRate>)| {
        let theories: Vec<&str> = theories.iter().map(|theory| theory.name()).collect();
        let ways: Vec<String> = over.iter().map(|r| format!("{} over saddle {}", r.way.name(), r.saddle)).collect();
        let ways = if over.len() == rates.saddles.len() { String::new() } else { format!(" {}", ways.join(" and ")) };
        format!("{REFUSAL}{}{ways}: {reason}", theories.join(" and "))
    };
    reasons.into_iter().map(line).collect()
}

/// What is to be said where the lowest exits were told from a temperature (K) on, and rates are asked for at a lower one.
pub fn exits_not_told(from_k: f64, coldest_k: f64) -> Option<String> {
    (coldest_k < from_k).then(|| {
        format!(
            "other ways out of the two states were looked for at {from_k} K and above, not at {coldest_k} K, where what is one state there \
             may be several; a run at these temperatures tells them: {ALONE}"
        )
    })
}

/// What is to be said where a run found that a path's own saddles do not tell the times, and rates are asked for anew.
pub fn network_not_told(before: &[String]) -> Option<String> {
    let is_told = before.iter().any(|warning| warning.contains(FIELD));
    is_told.then(|| format!("over other saddles that the run found times are others ({FIELD}), which a run at these temperatures tells: {ALONE}"))
}

/// What the whole run should say of its rates: each reason for a refusal once, that some numbers are rough, which of its ends are left
/// beside the path, over saddles that are no higher than its own or by k_BT alone, and that a minimum on the way holds what comes to it
/// longer than the first one, by more than k_BT.
pub fn warnings(
    rates: &Rates,
    search: &SearchReport,
    barrier: Option<Barrier>,
    highest_climb: Option<Barrier>,
) -> Vec<String> {
    let mut said = refusals(rates);
    if rates.saddles.iter().any(|r| !r.warnings.is_empty()) {
        said.push(ROUGH.into());
    }
    let climbs = barrier.map(|b| [("initial", b.forward_mev), ("final", b.backward_mev)]);
    for ((which, climb), exit) in climbs.into_iter().flatten().zip(search.lowest_exits_mev) {
        let Some(exit) = exit.filter(|exit| *exit < climb + K_B * rates.settings.hottest_k()) else { continue };
        said.push(format!(
            "the {which} state is left over other saddles too, the lowest known {exit:.6} meV above it ({climb:.6} meV along the path), \
             of which \"spinneb landscape\" tells the times: {ALONE}"
        ));
    }
    let both = barrier.zip(highest_climb);
    let climbs =
        both.map(|(b, c)| [("forward", b.forward_mev, c.forward_mev), ("backward", b.backward_mev, c.backward_mev)]);
    for (way, barrier, climb) in climbs.into_iter().flatten() {
        if climb > barrier + K_B * rates.settings.hottest_k() {
            said.push(format!(
                "{way}, the path leads through a minimum from which it climbs {climb:.6} meV, more than its barrier of {barrier:.6} meV: \
                 that is what the time to the other end hangs on, and other ways may lead around it, of which \"spinneb landscape\" \
                 tells the times: {ALONE}"
            ));
        }
    }
    said
}
