//! The times of a path over all passes that are known: over other saddles between its minima, which add to its rates, and into minima
//! beside it, which hold what comes to them.
//!
//! The landscape that the search for the path left is searched once more, less long, to somewhat above the path's highest saddle, and the rest is
//! as in a survey: the mean first passage from one end to the other through the network of all that was found. (What is higher than
//! the top by n k_BT adds a part of some e⁻ⁿ.)

use super::rate_warnings::{ALONE, FIELD};
use super::run::Run;
use super::survey::{Lifetime, Lifetimes, Survey, Told};
use crate::band::Band;
use crate::energy::Evaluator;
use crate::error::Result;
use crate::landscape::{Aim, Effort, KINDS, Landscape, Minimum, Pass, Searched, Settings, search};
use crate::rates::{
    LEAST_BARRIER, NetworkTime, RateSettings, Rates, Regime, Row, Symmetry, TransitionRate, Way, ZeroModes, digits,
    may_slide_to,
};
use crate::record::Count;
use crate::symmetry::Group;
use crate::units::K_B;
use crate::words::number;

/// Passes are looked for up to so many k_BT above the path's highest saddle.
const ABOVE: f64 = 5.0;
/// With so many times the work that is little, or as much as all before.
const WORTH: f64 = 0.1;
/// The largest group of which every image is a state by itself.
const IMAGES: usize = 64;

/// What a path's network says.
#[derive(Debug)]
pub struct NetworkTimes {
    /// Forward and backward, a temperature each.
    pub times: [Vec<NetworkTime>; 2],
    /// Kinds of saddles, and how high they were looked for (meV above the path's highest).
    pub kinds: usize,
    pub above_mev: f64,
    /// What the search came to.
    pub searched: Searched,
}

impl Run<'_, '_> {
    /// Of a proven path over these passes. None where no rates are asked for, or nothing is looked for, or the two ends are places of one
    /// state.
    pub(super) fn network(
        &mut self,
        links: &[Pass],
        band: &Band,
        symmetry: Option<&Symmetry>,
    ) -> Result<Option<NetworkTimes>> {
        let problem = self.problem;
        let (Some(settings), Some(symmetry), [first, ..]) = (&problem.rates, symmetry, links) else { return Ok(None) };
        let Some(effort) = beside(problem.search) else { return Ok(None) };
        let h = problem.evaluator();
        let Some(kelvin) = hottest(h, settings, links) else { return Ok(None) };
        self.observer.stage("looking for other saddles of the rates");
        let above_mev = ABOVE * K_B * kelvin;
        let group = &symmetry.exact;
        let mut land = Landscape::new(h, self.land.reference());
        land.unfold_all(group, IMAGES);
        let top = |land: &Landscape, pass: &Pass| land.height_mev(pass.saddle.spins());
        let until = links.iter().map(|link| top(&land, link)).fold(f64::NEG_INFINITY, f64::max) + above_mev;
        for pass in links.iter().chain(self.land.passes()).filter(|pass| top(&self.land, pass) <= until) {
            land.add(pass.clone());
        }
        let ends = [&first.before, &links[links.len() - 1].after].map(|end| land.add_minimum(end));
        let Count { evaluations, hessians } = self.worth(WORTH);
        let most = Count { evaluations: evaluations.min(self.left(band)), hessians };
        let wanted = Settings {
            effort,
            shares: 1,
            most,
            most_with_news: most,
            together: most,
            most_kinds: KINDS,
            c: self.tools.scales.stiffness_mev,
            context: self.context(),
        };
        let observer = &mut *self.observer;
        let searched = search(&mut land, Aim::Below(until), &wanted, &mut |standing| observer.searching(standing))?;
        let Told { survey, passes, number } = Survey::up_to(&land, group, until, searched);
        let ends = ends.map(|end| number[land.standing_for(end)]);
        if ends[0] == ends[1] || ends.contains(&usize::MAX) {
            return Ok(None);
        }
        let groups = Way::BOTH.into_iter().zip(ends).map(|(way, end)| (way.name().into(), vec![end])).collect();
        let found = Lifetimes::of(&survey, groups, settings, &land, &Symmetry::exactly(group), &passes)?;
        let kinds = survey.saddle_kinds.len();
        let untold = |kelvin: f64| slides(&found, kelvin) || overlap(&found, &survey, group, kelvin);
        Ok(Some(NetworkTimes { times: Way::BOTH.map(|way| times(&found, way, &untold)), kinds, above_mev, searched }))
    }
}

impl NetworkTimes {
    /// Beside the times of the path's own saddles.
    pub fn put_into(&self, rates: &mut Rates) {
        for (transition, times) in rates.transitions.iter_mut().zip(&self.times) {
            transition.network.clone_from(times);
        }
    }

    /// Where a path's own saddles tell another time, by more than both are known: the temperature at which they differ most, each way.
    pub fn warnings(&self, rates: &Rates) -> Vec<String> {
        rates.transitions.iter().filter_map(|transition| self.warning(transition)).collect()
    }

    fn warning(&self, transition: &TransitionRate) -> Option<String> {
        let both = transition.rows.iter().zip(&transition.network);
        let off = both.filter_map(|(row, network)| Some((network, apart(&row.passage, network)?)));
        let (network, ln_times) = off.max_by(|(_, p), (_, q)| p.abs().total_cmp(&q.abs()))?;
        Some(format!(
            "{}, at {} K the first passage takes {} s over all {} kinds of saddles that are known, which were looked for up to {:.6} meV above \
             the path's highest{}: {} times what the path's own say ({FIELD}); {ALONE}",
            transition.way.name(),
            number(network.temperature_k),
            told(network.ln_s()?, digits(network.known_within)),
            self.kinds,
            self.above_mev,
            if self.searched.spent { " until as much work was done as may be" } else { "" },
            told(ln_times, 2),
        ))
    }
}

/// ln of the time of a network over that of a path, where they differ by more than both are known.
fn apart(path: &Row, network: &NetworkTime) -> Option<f64> {
    let ln_times = network.ln_s()? - path.ln_lifetime_s()?;
    let [own, all] = [path.known_within, network.known_within].map(|known| known.map_or(f64::INFINITY, libm::log));
    (ln_times.abs() > libm::hypot(own, all)).then_some(ln_times)
}

/// How long is looked, after a search for the path itself.
fn beside(search: Effort) -> Option<Effort> {
    match search {
        Effort::None => None,
        Effort::Quick | Effort::Normal => Some(Effort::Quick),
        Effort::Thorough => Some(Effort::Normal),
    }
}

/// A number of which the ln is given, with so many digits.
fn told(ln: f64, digits: usize) -> String {
    match libm::exp(ln) {
        x if x.is_normal() => format!("{x:.*e}", digits - 1),
        _ => format!("10^{:.1}", ln / std::f64::consts::LN_10),
    }
}

/// The hottest temperature (K) at which the path has a rate over a saddle.
fn hottest(h: Evaluator, settings: &RateSettings, links: &[Pass]) -> Option<f64> {
    let barrier = |link: &Pass, beside: &Minimum| h.difference_mev(link.saddle.spins(), beside.spins.as_slice());
    let most = links.iter().flat_map(|link| [&link.before, &link.after].map(|beside| barrier(link, beside)));
    let most = most.fold(0.0, f64::max);
    let held = settings.temperatures_k.iter().copied().filter(|kelvin| most >= LEAST_BARRIER * K_B * kelvin);
    held.max_by(f64::total_cmp)
}

/// From one end to the other, but for the temperatures (K) at which they are `untold`.
fn times(found: &Lifetimes, way: Way, untold: &dyn Fn(f64) -> bool) -> Vec<NetworkTime> {
    let rows = found.rows.iter().filter(|row| row.from == way.name() && row.to.is_some());
    let time = |row: &Lifetime| {
        let (kelvin, is_told) = (row.temperature_k, !untold(row.temperature_k));
        NetworkTime {
            temperature_k: kelvin,
            ln_time_s: row.ln_time_s.map(|ln| ln.filter(|_| is_told)),
            known_within: row.known_within.filter(|_| is_told),
        }
    };
    rows.map(time).collect()
}

/// Whether a minimum slides at a temperature (K): its places are minima, of which the network need not have what joins them.
fn slides(found: &Lifetimes, kelvin: f64) -> bool {
    found.saddles.iter().flatten().flat_map(|rate| &rate.at(kelvin).minimum_zeros).any(ZeroModes::slides)
}

/// Whether a saddle may slide at a temperature (K) to where one of another kind does: each has the volume of all places, and they
/// would be counted twice.
fn overlap(found: &Lifetimes, survey: &Survey, group: &Group, kelvin: f64) -> bool {
    let regimes: Vec<&Regime> = found.saddles.iter().map(|[on, _]| on.at(kelvin)).collect();
    let sliding: Vec<usize> =
        (0..regimes.len()).filter(|k| regimes[*k].saddle_zeros.iter().any(ZeroModes::slides)).collect();
    let turn = regimes.iter().find_map(|regime| regime.turn);
    let along = turn.map(|turn| group.with_axis(turn.axis));
    let group = along.as_ref().unwrap_or(group);
    let of = |kind: usize| survey.saddles.iter().filter(move |s| s.kind == kind).map(|s| s.spins.as_slice());
    let meet = |a: usize, b: usize| of(a).next().is_some_and(|m| of(b).any(|other| may_slide_to(group, other, m)));
    sliding.iter().enumerate().any(|(n, a)| sliding[n + 1..].iter().any(|b| meet(*a, *b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_of_a_path_and_of_a_network_differ_where_neither_is_known_so_roughly() {
        let ln_times = |path: Option<f64>, network: Option<f64>| {
            let path = Row { ln_langer_per_s: Some(-2.0), known_within: path, ..Row::default() };
            let network = NetworkTime { temperature_k: 1.0, ln_time_s: [None, Some(4.0)], known_within: network };
            apart(&path, &network)
        };
        assert_eq!(ln_times(Some(2.0), Some(5.0)), Some(2.0));
        // 2 > ln 5, 2 > ln 4, and 2 < √(ln² 5 + ln² 4)
        let known = [[Some(2.0), Some(679.0)], [Some(679.0), Some(2.0)], [Some(5.0), Some(4.0)], [Some(2.0), None]];
        assert!(known.iter().all(|[path, network]| ln_times(*path, *network).is_none()));
    }
}
