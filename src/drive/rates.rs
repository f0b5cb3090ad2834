//! From the proven saddles of a path to its rates.

use super::minimum::Link;
use super::outcome::SaddlePoint;
use crate::energy::Hamiltonian;
use crate::rates::{
    Crossing, Equivalents, RateSettings, Rates, SaddleRate, equivalent_saddles, refused, saddle_rates, transitions,
};

/// What is known of a path.
pub struct Known<'a> {
    pub h: &'a Hamiltonian,
    /// Saddles with the minima beside them, in path order; none where nothing was proven.
    pub links: &'a [Link],
    /// The saddles as reported.
    pub saddles: &'a [SaddlePoint],
    /// Final above initial state (meV).
    pub above_final: f64,
    /// What stands against the certificate of the whole.
    pub doubts: &'a [String],
}

/// The rates over every saddle and over the whole path.
pub fn of_path(known: &Known, settings: &RateSettings) -> Rates {
    let doubt = known.doubts.first().map(String::as_str);
    let saddles: Vec<_> = match known.links.is_empty() {
        true => known.saddles.iter().enumerate().flat_map(|(k, s)| unproven(known, k, s, settings)).collect(),
        false => known.links.iter().flat_map(|l| proven(known, l, settings)).collect(),
    };
    let transitions = transitions(&saddles, &paths(known, settings), settings, doubt);
    Rates { settings: settings.clone(), saddles, transitions }
}

/// Paths that symmetry makes of this one, between the same ends: those through other minima, since saddles between the same two
/// minima are counted with each saddle.
fn paths(known: &Known, settings: &RateSettings) -> Equivalents {
    let (Some(first), Some(last)) = (known.links.first(), known.links.last()) else {
        return Equivalents { count: 1, by: "not sought".into() };
    };
    if known.links.len() == 1 {
        return Equivalents { count: 1, by: "counted with the saddle".into() };
    }
    let ends = [first.before.spins.as_slice(), last.after.spins.as_slice()];
    equivalent_saddles(known.h, first.after.spins.as_slice(), ends, &settings.moments_mub, false)
}

fn proven(known: &Known, link: &Link, settings: &RateSettings) -> [SaddleRate; 2] {
    let h = known.h;
    let doubt = link.doubt(h);
    let m = &link.found.refined.state.m;
    let number = known.saddles.iter().position(|s| s.spins.as_slice() == m).unwrap_or(0);
    let crossing = Crossing {
        saddle: &link.found.refined.state,
        valley: &link.found.refined.valley,
        spectrum: &link.spectrum,
        minima: [&link.before.spins, &link.after.spins],
        minima_spectra: [&link.before.spectrum, &link.after.spectrum],
        doubt: doubt.as_deref(),
    };
    saddle_rates(h, number, &crossing, settings)
}

/// Without a proof there is no minimum to leave: the barriers are those above the ends.
fn unproven(known: &Known, number: usize, saddle: &SaddlePoint, settings: &RateSettings) -> [SaddleRate; 2] {
    let barriers = [saddle.above_initial_mev, saddle.above_initial_mev - known.above_final].map(Some);
    let why = known.doubts.first().map_or("certification was not asked for", String::as_str);
    let way_out = "a rate belongs to a proven saddle between two proven minima (\"saddle\": {\"refine\": true, \"certify\": true})";
    let index = match saddle.negative_modes {
        Some(n) if n != 1 => format!(" and has {n} negative modes"),
        _ => String::new(),
    };
    refused(number, settings, barriers, &format!("the saddle is not certified{index}: {why}; {way_out}"))
}

/// What the whole run should say of its rates: each reason for a refusal once, and that some numbers are rough.
pub fn warnings(rates: &Rates) -> Vec<String> {
    let mut said: Vec<String> = Vec::new();
    for (theory, reason) in rates.saddles.iter().flat_map(|r| &r.refused) {
        let line = format!("no rate by {}: {reason}", theory.name());
        if !said.contains(&line) {
            said.push(line);
        }
    }
    if rates.saddles.iter().any(|r| !r.warnings.is_empty()) {
        said.push("some rates are rough: \"warnings\" of \"rates\" in summary.json give their range".into());
    }
    said
}
