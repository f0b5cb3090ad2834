//! The entries of `rates` and `transition_rates` in `summary.json`.
//!
//! A rate too small for a double is 0 and its lifetime null; `log10_lifetime_s` is there for all. Where the barrier is below k_BT
//! all of them are null, and `reason` says so. `known_within_factor`: a rate or time may be larger or smaller by that. Of a
//! translation `volume_rad` is by the derivative, which the rates are made of, and `hop_volume_rad` by the finite hop. What a
//! prefactor is made of is told as it is at `prefactor_temperature_K`, and in `soft_modes_change_at_K` where the soft modes are others,
//! and prefactors with them. `network_first_passage_s` is over all passes that the search found, other saddles between the path's minima
//! and minima beside it among them; absent where none were looked for.

use super::number::Number;
use crate::rates::{
    NetworkTime, Prefactor, Rates, Refusal, Row, SaddleRate, Sibling, Theory, TransitionRate, TransitionRow, Way,
    ZeroKind, ZeroModes,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct RateEntry {
    pub saddle: usize,
    pub direction: Way,
    pub barrier_meV: Option<Number>,
    pub htst_prefactor_Hz: Option<Number>,
    pub langer_prefactor_Hz: Option<Number>,
    prefactor_temperature_K: Option<Number>,
    prefactor_temperature_exponent: Number,
    dynamical_factor_per_s: Option<Number>,
    growth_rate_per_s: Option<Number>,
    crossover_temperature_K: Option<Number>,
    entropy_factor: Option<Number>,
    minimum_zero_modes: Vec<ZeroEntry>,
    saddle_zero_modes: Vec<ZeroEntry>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    soft_modes_change_at_K: Vec<Number>,
    equivalent_saddles: usize,
    equivalent_by: String,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    nearly_equivalent_saddles: Vec<SiblingEntry>,
    damping: Number,
    g_factor: Number,
    blocking_temperature_1_s_K: Option<Number>,
    blocking_temperature_10_years_K: Option<Number>,
    refused: BTreeMap<Theory, String>,
    warnings: Vec<String>,
    temperatures: Vec<TemperatureEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct TransitionEntry {
    pub direction: Way,
    saddles: usize,
    equivalent_paths: usize,
    equivalent_by: String,
    barrier_meV: Number,
    blocking_temperature_1_s_K: Option<Number>,
    blocking_temperature_10_years_K: Option<Number>,
    refused: Option<String>,
    pub temperatures: Vec<PassageEntry>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
struct SiblingEntry {
    above_meV: Number,
    saddles: usize,
}

fn sibling(s: &Sibling) -> SiblingEntry {
    SiblingEntry { above_meV: Number(s.above_mev), saddles: s.places }
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
struct ZeroEntry {
    kind: ZeroKind,
    modes: usize,
    volume_rad: Number,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    hop_volume_rad: Option<Number>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pinning_meV: Vec<Number>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    top_meV: Vec<Number>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
struct TemperatureEntry {
    temperature_K: Number,
    barrier_over_kT: Number,
    htst_rate_per_s: Option<Number>,
    langer_rate_per_s: Option<Number>,
    lifetime_s: Option<Number>,
    log10_lifetime_s: Option<Number>,
    known_within_factor: Option<Number>,
    reason: Option<String>,
}

/// The rates are the inverse of the mean first passage.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[allow(non_snake_case)]
pub(super) struct PassageEntry {
    pub temperature_K: Number,
    pub barrier_over_kT: Number,
    pub htst_rate_per_s: Option<Number>,
    pub langer_rate_per_s: Option<Number>,
    pub escape_lifetime_s: Option<Number>,
    pub log10_escape_lifetime_s: Option<Number>,
    first_passage_s: Option<Number>,
    pub log10_first_passage_s: Option<Number>,
    pub known_within_factor: Option<Number>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    network_first_passage_s: Option<Number>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    log10_network_first_passage_s: Option<Number>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    network_known_within_factor: Option<Number>,
    reason: Option<String>,
}

/// An entry for each saddle and direction.
pub(super) fn saddles(rates: &Rates) -> Vec<RateEntry> {
    rates.saddles.iter().map(|r| saddle(rates, r)).collect()
}

/// An entry for each direction of the whole path.
pub(super) fn transitions(rates: &Rates) -> Vec<TransitionEntry> {
    rates.transitions.iter().map(transition).collect()
}

fn saddle(rates: &Rates, r: &SaddleRate) -> RateEntry {
    let (settings, told) = (&rates.settings, rates.told(r));
    let known = told.htst.or(told.langer);
    let first = settings.temperatures_k.first().copied();
    let prefactor = |p: Option<Prefactor>| p.zip(first).and_then(|(p, t)| held(p.hz_at(t)));
    let frequency = |p: Option<Prefactor>| p.map(|p| Number(p.frequency_per_s));
    RateEntry {
        saddle: r.saddle,
        direction: r.way,
        barrier_meV: r.barrier_mev.map(Number),
        htst_prefactor_Hz: prefactor(told.htst),
        langer_prefactor_Hz: prefactor(told.langer),
        prefactor_temperature_K: first.filter(|_| known.is_some()).map(Number),
        prefactor_temperature_exponent: Number(known.map_or(0.0, |p| p.exponent)),
        dynamical_factor_per_s: frequency(told.htst),
        growth_rate_per_s: frequency(told.langer),
        crossover_temperature_K: r.crossover_k.map(Number),
        entropy_factor: told.entropy_factor.map(Number),
        minimum_zero_modes: zeros(&told.minimum_zeros),
        saddle_zero_modes: zeros(&told.saddle_zeros),
        soft_modes_change_at_K: r.regimes.iter().skip(1).map(|regime| Number(regime.above_k)).collect(),
        equivalent_saddles: told.equivalents.count,
        equivalent_by: told.equivalents.by.clone(),
        nearly_equivalent_saddles: told.siblings.0.iter().map(sibling).collect(),
        damping: Number(settings.damping),
        g_factor: Number(settings.g_factor),
        blocking_temperature_1_s_K: r.blocking_k[0].map(Number),
        blocking_temperature_10_years_K: r.blocking_k[1].map(Number),
        refused: told.refused.iter().map(|(theory, reason)| (*theory, reason.to_string())).collect(),
        warnings: r.warnings.clone(),
        temperatures: r.rows.iter().map(temperature).collect(),
    }
}

fn transition(t: &TransitionRate) -> TransitionEntry {
    TransitionEntry {
        direction: t.way,
        saddles: t.saddles,
        equivalent_paths: t.equivalents.count,
        equivalent_by: t.equivalents.by.clone(),
        barrier_meV: Number(t.barrier_mev),
        blocking_temperature_1_s_K: t.blocking_k[0].map(Number),
        blocking_temperature_10_years_K: t.blocking_k[1].map(Number),
        refused: t.refused.as_ref().map(Refusal::to_string),
        temperatures: t.rows.iter().enumerate().map(|(k, row)| passage(row, t.network.get(k))).collect(),
    }
}

fn zeros(modes: &[ZeroModes]) -> Vec<ZeroEntry> {
    let entry = |z: &ZeroModes| ZeroEntry {
        kind: z.kind,
        modes: z.count,
        volume_rad: Number(z.volume),
        hop_volume_rad: z.hop_volume.map(Number),
        pinning_meV: z.pinning.iter().map(|p| Number(p.curved_mev)).collect(),
        top_meV: z.pinning.iter().map(|p| Number(p.top_mev)).collect(),
    };
    modes.iter().map(entry).collect()
}

fn temperature(row: &Row) -> TemperatureEntry {
    TemperatureEntry {
        temperature_K: Number(row.temperature_k),
        barrier_over_kT: Number(row.barrier_over_kt),
        htst_rate_per_s: exp(row.ln_htst_per_s),
        langer_rate_per_s: exp(row.ln_langer_per_s),
        lifetime_s: exp(row.ln_lifetime_s()),
        log10_lifetime_s: log10(row.ln_lifetime_s()),
        known_within_factor: row.known_within.and_then(held),
        reason: row.reason.clone(),
    }
}

fn passage(row: &TransitionRow, network: Option<&NetworkTime>) -> PassageEntry {
    let ln_network_s = network.and_then(NetworkTime::ln_s);
    let (whole, first) = (&row.passage, &row.escape);
    let reason = match (&whole.reason, &first.reason) {
        (None, Some(reason)) => Some(format!("no escape over the first saddle alone: {reason}")),
        (reason, _) => reason.clone(),
    };
    PassageEntry {
        temperature_K: Number(whole.temperature_k),
        barrier_over_kT: Number(whole.barrier_over_kt),
        htst_rate_per_s: exp(whole.ln_htst_per_s),
        langer_rate_per_s: exp(whole.ln_langer_per_s),
        escape_lifetime_s: exp(first.ln_lifetime_s()),
        log10_escape_lifetime_s: log10(first.ln_lifetime_s()),
        first_passage_s: exp(whole.ln_lifetime_s()),
        log10_first_passage_s: log10(whole.ln_lifetime_s()),
        known_within_factor: whole.known_within.and_then(held),
        network_first_passage_s: exp(ln_network_s),
        log10_network_first_passage_s: log10(ln_network_s),
        network_known_within_factor: network.and_then(|network| network.known_within).and_then(held),
        reason,
    }
}

fn exp(ln: Option<f64>) -> Option<Number> {
    ln.and_then(|ln| held(libm::exp(ln)))
}

fn log10(ln: Option<f64>) -> Option<Number> {
    ln.map(|ln| Number(ln / std::f64::consts::LN_10))
}

/// A number that a double holds.
fn held(x: f64) -> Option<Number> {
    x.is_finite().then_some(Number(x))
}
