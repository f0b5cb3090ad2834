//! `min.data` and `ts.data`: the network as PATHSAMPLE and PyGT read it.
//!
//! A row a minimum: energy (meV), S, 1, and three numbers without meaning here. A row a saddle: energy (meV), S, 1, its two minima
//! counted from 1, and three numbers. Their readers make of it
//!
//! ```text
//! k(a over s) = 1/2π e^((S_a − S_s)/2) e^(−β(E_s − E_a))      β in 1/meV, k in 1/s
//! ```
//! so S_a − S_s = 2 ln(2π A) with the prefactor A in Hz: Langer's, where all saddles have it, else that of HTST, at the first of the
//! temperatures; of states that stand for n_a and n_s places, S_a − S_s = 2 ln(2π A n_s/n_a). Each part of the network that no pass
//! joins with another has an S of its own to count from.

use super::LandscapeReport;
use crate::drive::survey::{Kind, Survey};
use crate::error::{Error, Result};
use crate::rates::{SaddleRate, Theory};
use std::f64::consts::PI;
use std::fmt::Write;

pub(super) fn minima(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let row =
        |(k, entropy): (usize, &f64)| format!("{:?} {entropy:?} 1 1.0 1.0 1.0\n", s.minimum_kind(k).above_lowest_mev);
    Ok(entropies(s, &steps(s))?.iter().enumerate().map(row).collect::<String>().into_bytes())
}

pub(super) fn saddles(report: &LandscapeReport) -> Result<Vec<u8>> {
    let s = report.survey;
    let steps = steps(s);
    let entropies = entropies(s, &steps)?;
    let mut text = String::new();
    for (saddle, ([a, b], e)) in s.saddles.iter().zip(s.passes()) {
        let Some([step, _]) = steps[saddle.kind] else { continue };
        // writing into a string cannot fail
        let _ = writeln!(text, "{e:?} {:?} 1 {} {} 1.0 1.0 1.0", entropies[a] - step, a + 1, b + 1);
    }
    Ok(text.into_bytes())
}

/// S_a − S_s of each kind of saddles, from the first of its two minima and from the second; nothing where a rate was refused.
fn steps(s: &Survey) -> Vec<Option<[f64; 2]>> {
    let Some(lifetimes) = &s.lifetimes else { return vec![None; s.saddle_kinds.len()] };
    let kelvin = lifetimes.settings.temperatures_k[0];
    let all_have_langer = lifetimes.saddles.iter().flatten().all(|r| r.at(kelvin).langer.is_some());
    let step = |r: &SaddleRate, ln_ways: f64| {
        let prefactor = r.at(kelvin).prefactor(if all_have_langer { Theory::Langer } else { Theory::Htst })?;
        // of a state that slides the prefactor is that of all its places
        let ln_hz = prefactor.ln_hz_at(kelvin) + r.at(kelvin).ln_places;
        Some(2.0 * (libm::log(2.0 * PI) + ln_hz + ln_ways))
    };
    let steps = |(kind, [on, back]): (&Kind, &[SaddleRate; 2])| {
        let [a, b] = s.saddles[kind.first].minima.map(|from| kind.ln_ways(s.minimum_kind(from)));
        Some([step(on, a)?, step(back, b)?])
    };
    s.saddle_kinds.iter().zip(&lifetimes.saddles).map(steps).collect()
}

/// S of each minimum: along saddles from the first of each part of the network, whose S is 0.
fn entropies(s: &Survey, steps: &[Option<[f64; 2]>]) -> Result<Vec<f64>> {
    let mut beside: Vec<Vec<usize>> = vec![Vec::new(); s.minima.len()];
    for (k, saddle) in s.saddles.iter().enumerate() {
        saddle.minima.iter().for_each(|minimum| beside[*minimum].push(k));
    }
    let mut found = vec![f64::NAN; s.minima.len()];
    for start in 0..found.len() {
        if !found[start].is_nan() {
            continue;
        }
        found[start] = 0.0;
        let mut front = vec![start];
        while let Some(here) = front.pop() {
            for saddle in beside[here].iter().map(|k| &s.saddles[*k]) {
                let side = usize::from(saddle.minima[0] != here);
                let there = saddle.minima[1 - side];
                if let (true, Some(step)) = (found[there].is_nan(), steps[saddle.kind]) {
                    found[there] = found[here] - step[side] + step[1 - side];
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
