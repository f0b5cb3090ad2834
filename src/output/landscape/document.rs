//! `landscape.json`: one entry for all states that symmetry makes of one, with their number.

use super::LandscapeReport;
use super::json;
use crate::drive::survey::{Kind, Lifetime, Unseen};
use crate::error::Result;
use crate::landscape::Effort;
use crate::output::number::Number;
use crate::rates::{SaddleRate, Theory};
use serde::Serialize;
use std::collections::BTreeMap;

#[derive(Serialize)]
struct Document<'a> {
    name: &'a str,
    version: &'a str,
    config_sha256: &'a str,
    finished: bool,
    stop_reason: String,
    symmetry_order: usize,
    search: Search,
    minima: Vec<Entry>,
    saddles: Vec<SaddleEntry>,
    #[serde(skip_serializing_if = "Option::is_none")]
    lifetimes: Option<Vec<LifetimeEntry<'a>>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    groups: Option<BTreeMap<&'a str, &'a [usize]>>,
    warnings: Vec<String>,
}

#[derive(Serialize)]
struct Search {
    effort: Effort,
    /// Of a search in shares, whose batches are larger, how many there were.
    #[serde(skip_serializing_if = "is_one")]
    shares: usize,
    seeds: usize,
    searches: usize,
    quiet: usize,
    random_starts: RandomStarts,
}

/// See `drive::survey::Unseen`.
#[derive(Serialize)]
struct RandomStarts {
    reached_a_minimum: usize,
    kinds_reached: usize,
    reached_once: usize,
    reached_twice: usize,
    estimated_kinds: Number,
    chance_of_another_kind: Option<Number>,
}

/// What minima and saddles share. `states`: their numbers in the tables, `places`: for how many each of them stands.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct Entry {
    id: usize,
    energy_meV: Number,
    above_lowest_meV: Number,
    multiplicity: usize,
    states: [usize; 2],
    #[serde(skip_serializing_if = "is_one")]
    places: usize,
    max_torque_meV: Number,
    negative_modes: usize,
    zero_modes: usize,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct SaddleEntry {
    #[serde(flatten)]
    entry: Entry,
    /// Kinds of the minima beside it.
    minima: [usize; 2],
    barriers_meV: [Number; 2],
    lowest_eigenvalues_meV: Vec<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rates: Option<[RateEntry; 2]>,
}

/// The rate over one saddle, from one of its minima: at the lowest of the temperatures where it depends on it.
#[derive(Serialize)]
#[allow(non_snake_case)]
struct RateEntry {
    htst_prefactor_Hz: Option<Number>,
    langer_prefactor_Hz: Option<Number>,
    refused: Vec<String>,
}

#[derive(Serialize)]
#[allow(non_snake_case)]
struct LifetimeEntry<'a> {
    from: &'a str,
    to: Option<&'a str>,
    temperature_K: Number,
    climb_meV: Option<Number>,
    htst_time_s: Option<Number>,
    langer_time_s: Option<Number>,
    log10_htst_time_s: Option<Number>,
    log10_langer_time_s: Option<Number>,
    known_within_factor: Option<Number>,
    #[serde(skip_serializing_if = "Option::is_none")]
    reason: Option<&'a str>,
}

fn is_one(count: &usize) -> bool {
    *count == 1
}

pub fn render(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let lifetimes = s.lifetimes.as_ref();
    let document = Document {
        name: report.name,
        version: report.version,
        config_sha256: report.config_sha256,
        finished: s.is_finished(),
        stop_reason: report.stop_reason(),
        symmetry_order: s.symmetry_order,
        search: Search {
            effort: s.effort,
            shares: s.shares,
            seeds: s.seeds,
            searches: s.searched.searches,
            quiet: s.searched.quiet,
            random_starts: random_starts(s.unseen),
        },
        minima: s.minimum_kinds.iter().enumerate().map(|(id, k)| entry(id, k)).collect(),
        saddles: (0..s.saddle_kinds.len()).map(|id| saddle(report, id)).collect(),
        lifetimes: lifetimes.map(|l| l.rows.iter().map(lifetime).collect()),
        groups: lifetimes.map(|l| l.groups.iter().map(|(name, states)| (name.as_str(), &states[..])).collect()),
        warnings: report.warnings(),
    };
    json("landscape.json", &document)
}

fn random_starts(unseen: Unseen) -> RandomStarts {
    RandomStarts {
        reached_a_minimum: unseen.starts,
        kinds_reached: unseen.kinds,
        reached_once: unseen.once,
        reached_twice: unseen.twice,
        estimated_kinds: Number(unseen.estimated_kinds()),
        chance_of_another_kind: unseen.chance().map(Number),
    }
}

fn entry(id: usize, kind: &Kind) -> Entry {
    Entry {
        id,
        energy_meV: Number(kind.energy_mev),
        above_lowest_meV: Number(kind.above_lowest_mev),
        multiplicity: kind.multiplicity,
        states: [kind.first, kind.first + kind.listed - 1],
        places: kind.places,
        max_torque_meV: Number(kind.max_torque_mev),
        negative_modes: kind.spectrum.negative,
        zero_modes: kind.spectrum.zero_and_flat(),
    }
}

fn saddle(report: &LandscapeReport, id: usize) -> SaddleEntry {
    let s = report.survey;
    let kind = &s.saddle_kinds[id];
    let kinds = s.saddles[kind.first].minima.map(|k| s.minima[k].kind);
    let rates = s.lifetimes.as_ref().map(|l| l.saddles[id].each_ref().map(|r| rate(r, l.settings.temperatures_k[0])));
    SaddleEntry {
        entry: entry(id, kind),
        minima: kinds,
        barriers_meV: kinds.map(|k| Number(kind.above_lowest_mev - s.minimum_kinds[k].above_lowest_mev)),
        lowest_eigenvalues_meV: kind.spectrum.lowest_mev.iter().copied().map(Number).collect(),
        rates,
    }
}

fn rate(r: &SaddleRate, temperature_k: f64) -> RateEntry {
    let hz = |p: Option<crate::rates::Prefactor>| p.map(|p| Number(p.hz_at(temperature_k)));
    let words = |(theory, reason): &(Theory, crate::rates::Refusal)| format!("{}: {reason}", theory.name());
    let at = r.at(temperature_k);
    RateEntry {
        htst_prefactor_Hz: hz(at.htst),
        langer_prefactor_Hz: hz(at.langer),
        refused: at.refused.iter().map(words).collect(),
    }
}

fn lifetime(l: &Lifetime) -> LifetimeEntry<'_> {
    let [htst, langer] = l.ln_time_s;
    let time = |ln: Option<f64>| ln.map(libm::exp).filter(|t| t.is_finite() && *t > 0.0).map(Number);
    let digits = |ln: Option<f64>| ln.map(|ln| Number(ln / std::f64::consts::LN_10));
    LifetimeEntry {
        from: &l.from,
        to: l.to.as_deref(),
        temperature_K: Number(l.temperature_k),
        climb_meV: Some(l.climb_mev).filter(|e| e.is_finite()).map(Number),
        htst_time_s: time(htst),
        langer_time_s: time(langer),
        log10_htst_time_s: digits(htst),
        log10_langer_time_s: digits(langer),
        known_within_factor: l.known_within.map(Number),
        reason: l.reason.as_deref(),
    }
}
