//! `min.data` and `ts.data`: the network as PATHSAMPLE and PyGT read it.
//!
//! A row a minimum: energy (meV), S, 1, and three numbers without meaning here. A row a saddle: energy (meV), S, 1, its two minima
//! counted from 1, and three numbers. Their readers make of it
//!
//! ```text
//! k(a over s) = 1/2π e^((S_a − S_s)/2) e^(−β(E_s − E_a))      β in 1/meV, k in 1/s
//! ```
//! so S_a − S_s = 2 ln(2π A) with the prefactor A in Hz: Langer's, where all saddles have it, else that of HTST, at the first of the
//! temperatures. Each part of the network that no pass joins with another has an S of its own to count from.

use super::LandscapeReport;
use crate::error::{Error, Result};
use crate::rates::{SaddleRate, Theory};
use std::f64::consts::PI;
use std::fmt::Write;

pub(super) fn minima(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let entropies = entropies(report)?;
    let row = |k: usize| (s.minimum_kinds[s.minima[k].kind].above_lowest_mev, entropies[k]);
    let lines = (0..s.minima.len()).map(row).map(|(e, entropy)| format!("{e:?} {entropy:?} 1 1.0 1.0 1.0\n"));
    Ok(lines.collect::<String>().into_bytes())
}

pub(super) fn saddles(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let entropies = entropies(report)?;
    let mut text = String::new();
    for saddle in &s.saddles {
        let ([a, b], e) = (saddle.minima, s.saddle_kinds[saddle.kind].above_lowest_mev);
        let Some(step) = step(report, saddle.kind, 0) else { continue };
        // writing into a string cannot fail
        let _ = writeln!(text, "{e:?} {:?} 1 {} {} 1.0 1.0 1.0", entropies[a] - step, a + 1, b + 1);
    }
    Ok(text.into_bytes())
}

/// S_a − S_s from one of a saddle's minima; nothing where a rate was refused.
fn step(report: &LandscapeReport, kind: usize, side: usize) -> Option<f64> {
    let lifetimes = report.survey.lifetimes.as_ref()?;
    let has = |theory: Theory| lifetimes.saddles.iter().flatten().all(|r| prefactor(r, theory).is_some());
    let theory = if has(Theory::Langer) { Theory::Langer } else { Theory::Htst };
    let prefactor = prefactor(&lifetimes.saddles[kind][side], theory)?;
    Some(2.0 * (libm::log(2.0 * PI) + prefactor.ln_hz_at(lifetimes.settings.temperatures_k[0])))
}

fn prefactor(r: &SaddleRate, theory: Theory) -> Option<crate::rates::Prefactor> {
    match theory {
        Theory::Htst => r.htst,
        Theory::Langer => r.langer,
    }
}

/// S of each minimum: along saddles from the first of each part of the network, whose S is 0.
fn entropies(report: &LandscapeReport) -> Result<Vec<f64>> {
    let s = report.survey;
    let mut found = vec![f64::NAN; s.minima.len()];
    for start in 0..found.len() {
        if !found[start].is_nan() {
            continue;
        }
        found[start] = 0.0;
        let mut front = vec![start];
        while let Some(here) = front.pop() {
            for saddle in s.saddles.iter().filter(|x| x.minima.contains(&here)) {
                let side = usize::from(saddle.minima[0] != here);
                let there = saddle.minima[1 - side];
                let steps = (step(report, saddle.kind, side), step(report, saddle.kind, 1 - side));
                if let (true, (Some(up), Some(down))) = (found[there].is_nan(), steps) {
                    found[there] = found[here] - up + down;
                    front.push(there);
                }
            }
        }
    }
    match found.iter().all(|x| x.is_finite()) {
        true => Ok(found),
        false => Err(Error::Numerical("min.data: an entropy is not finite".into())),
    }
}
