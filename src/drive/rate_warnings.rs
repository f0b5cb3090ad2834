//! What a run says of its rates beside their numbers.

use super::outcome::{Barrier, SearchReport};
use crate::rates::{Rates, SaddleRate, Theory};
use crate::units::K_B;

/// That some numbers are rough.
const ROUGH: &str = "some rates are rough: \"warnings\" of \"rates\" in summary.json give their range";
/// That states are left by other ways too.
pub const ALONE: &str = "rates and lifetimes are of the path's saddles alone";
/// Where results have the times of a path's network.
pub const FIELD: &str = "\"network_first_passage_s\"";
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
