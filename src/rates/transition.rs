//! The rate of the whole path, over all its saddles.

use super::passage::{TEN_YEARS_S, blocking_temperature, first_passage};
use super::{Equivalents, RateSettings, Row, SaddleRate, Theory, Way};
use crate::units::K_B;

/// The whole way from one end to the other: one over the mean first-passage time through the minima between.
#[derive(Clone, Debug, PartialEq)]
pub struct TransitionRate {
    /// In which direction.
    pub way: Way,
    /// Saddles on the way.
    pub saddles: usize,
    /// Ways of the same kind, through other minima; the rate is over all of them.
    pub equivalents: Equivalents,
    /// The highest saddle above the first minimum (meV).
    pub barrier_mev: f64,
    /// One row a temperature.
    pub rows: Vec<Row>,
    /// Temperature (K) at which the mean lifetime is 1 s, and at which it is ten years.
    pub blocking_k: [Option<f64>; 2],
    /// Why there is no rate; nothing if there is one.
    pub refused: Option<String>,
}

/// The rates of the whole path in both directions, from those of its saddles (forward and backward, in path order) and the number
/// of equivalent paths. `doubt` is what stands against a certificate of the path.
pub fn transitions(
    saddles: &[SaddleRate],
    paths: &Equivalents,
    settings: &RateSettings,
    doubt: Option<&str>,
) -> Vec<TransitionRate> {
    if saddles.is_empty() {
        return Vec::new();
    }
    Way::BOTH.map(|way| transition(saddles, paths, settings, doubt, way)).into()
}

fn transition(
    saddles: &[SaddleRate],
    paths: &Equivalents,
    settings: &RateSettings,
    doubt: Option<&str>,
    way: Way,
) -> TransitionRate {
    let mut onward: Vec<&SaddleRate> = saddles.iter().filter(|r| r.way == way).collect();
    let mut back: Vec<&SaddleRate> = saddles.iter().filter(|r| r.way != way).collect();
    if way == Way::Backward {
        onward.reverse();
        back.reverse();
    }
    let barrier_mev = highest(&onward, &back);
    let ln_rate = |theory: Theory, t: f64| -> Option<f64> {
        let all =
            |rates: &[&SaddleRate]| -> Option<Vec<f64>> { rates.iter().map(|r| r.ln_rate_per_s(theory, t)).collect() };
        let many = libm::log(paths.count as f64);
        (doubt.is_none()).then_some(many - first_passage(&all(&onward)?, &all(&back)?))
    };
    let row = |t: f64| Row {
        temperature_k: t,
        barrier_over_kt: barrier_mev / (K_B * t),
        ln_htst_per_s: ln_rate(Theory::Htst, t),
        ln_langer_per_s: ln_rate(Theory::Langer, t),
    };
    let lifetime = |t: f64| row(t).ln_lifetime_s();
    let blocking_k = [1.0, TEN_YEARS_S].map(|s| blocking_temperature(lifetime, barrier_mev, s));
    let rows: Vec<Row> = settings.temperatures_k.iter().map(|t| row(*t)).collect();
    let reasons = || onward.iter().flat_map(|r| &r.refused).map(|(_, reason)| reason.clone()).next();
    let refused = match rows.iter().any(|r| r.ln_lifetime_s().is_some()) {
        true => None,
        false => doubt.map(String::from).or_else(reasons),
    };
    let equivalents = paths.clone();
    TransitionRate { way, saddles: onward.len(), equivalents, barrier_mev, rows, blocking_k, refused }
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
