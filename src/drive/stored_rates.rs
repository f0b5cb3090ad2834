//! Rates of saddles and minima that a run found before, as its files have them.

use super::Problem;
use super::outcome::{Outcome, SaddlePoint};
use super::rate_warnings::{exits_not_told, is_said_of_rates, network_not_told, warnings};
use super::rates::{Known, of_path};
use crate::energy::Evaluator;
use crate::landscape::{Minimum, Pass, Peak, Saddle};
use crate::linalg::slab;
use crate::rates::{RateSettings, Rates, Symmetry};
use crate::spins::Spins;
use crate::stationary::{ALIKE, Refined, Spectrum, State};

impl Outcome {
    /// The same with the rates that the problem asks for, over its own saddles and between these minima, both ends among them; why
    /// there can be none, if so. Of its warnings those in `last` stay the last ones.
    pub fn with_rates(self, problem: &Problem, minima: &[Spins], last: &[String]) -> Result<Outcome, String> {
        if !self.certified {
            return Err("this result is not certified, and rates need saddles and minima that are proven".into());
        }
        let Some(settings) = problem.rates.as_ref().filter(|_| problem.relax_ends) else {
            let why = "the ends of this result were kept as they were given, and rates need minima: let them relax";
            return Err(why.into());
        };
        let rates = stored_rates(problem.evaluator(), &self.saddles, minima, settings)
            .map_err(|why| format!("the states in its files do not prove themselves: {why}"))?;
        let colder = self.search.exits_from_k.and_then(|from_k| exits_not_told(from_k, settings.coldest_k()));
        // in the place that a run gives them
        let own = |w: &&String| is_said_of_rates(w) || last.contains(w);
        let others = self.warnings.iter().filter(|w| !own(w)).cloned();
        let said = others
            .chain(warnings(&rates, &self.search, self.barrier, self.highest_climb))
            .chain(colder)
            .chain(network_not_told(&self.warnings))
            .chain(last.iter().cloned())
            .collect();
        Ok(Outcome { warnings: said, rates: Some(rates), ..self })
    }
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
