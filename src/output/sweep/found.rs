//! What the folder of a point holds.

use super::SweepIndex;
use crate::drive::Barrier;
use crate::error::Result;
use crate::output::folder::stored_result;
use crate::output::head::Head;
use crate::output::summary::{Saddle, Summary};
use crate::rates::Way;
use crate::stationary::ALIKE;
use std::path::Path;

/// What is there for a point of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub enum PointState {
    /// No finished result.
    Missing,
    /// A result of another config.
    Other,
    /// A result whose files are not as they were written.
    Damaged,
    /// Its result.
    Found(Box<Found>),
}

impl PointState {
    /// In a word.
    pub fn word(&self) -> &'static str {
        match self {
            PointState::Missing => "missing",
            PointState::Other => "another result",
            PointState::Damaged => "damaged",
            PointState::Found(found) if found.head.is_proven() => "certified",
            PointState::Found(_) => "not certified",
        }
    }

    /// The result, if it is there.
    pub fn found(&self) -> Option<&Found> {
        match self {
            PointState::Found(found) => Some(&**found),
            _ => None,
        }
    }
}

/// A point's result in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// Which it is.
    pub head: Head,
    /// The barrier, where there is one.
    pub barrier: Option<Barrier>,
    /// Number of saddles on the path.
    pub saddles: usize,
    /// Negative eigenvalues of the highest of them, where counted.
    pub negative_modes: Option<usize>,
    /// Prefactors of the barriers (Hz), where rates were asked for: those that the saddles next to the ends have if they are the highest.
    pub prefactors: Option<Prefactors>,
    /// How long the states live, forward and then backward, where rates were asked for.
    pub times: Vec<Times>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

/// Mean times of a whole path at one temperature, as decimal logarithms of seconds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Times {
    /// From which end.
    pub way: Way,
    /// Temperature (K).
    pub temperature_k: f64,
    /// Δ = ΔE/k_BT.
    pub barrier_over_kt: f64,
    /// Escape from that end over the first saddle.
    pub log10_escape_s: Option<f64>,
    /// First passage to the other end.
    pub log10_passage_s: Option<f64>,
    /// Both may be longer or shorter by this factor.
    pub known_within: Option<f64>,
}

/// Prefactors over a saddle (Hz): forward and backward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prefactors {
    /// By harmonic transition-state theory.
    pub htst_hz: [Option<f64>; 2],
    /// By Langer's theory.
    pub langer_hz: [Option<f64>; 2],
}

/// Looks into the folder of a point; a damaged result is an error.
pub fn look(dir: &Path, index: &SweepIndex, point: usize) -> Result<PointState> {
    let point = &index.points[point];
    let dir = dir.join(&point.directory);
    if stored_result(&dir, |_| true)?.is_none() {
        return Ok(PointState::Missing);
    }
    let summary = Summary::read(&dir)?;
    Ok(match summary.head.config_sha256 == point.config_sha256 {
        true => PointState::Found(Box::new(found(summary))),
        false => PointState::Other,
    })
}

fn found(summary: Summary) -> Found {
    let above = |s: &Saddle| s.energy_above_initial_meV.0;
    let highest = (summary.saddles.iter().enumerate()).max_by(|(_, a), (_, b)| above(a).total_cmp(&above(b)));
    let barrier = summary.barrier_meV.map(Barrier::from);
    // what leaves an end over a lower saddle, or over none of its own, is no prefactor of the barrier
    let rate = |way: Way| {
        let (leaving, mev) = match way {
            Way::Forward => (0, barrier?.forward_mev),
            Way::Backward => (summary.saddles.len().checked_sub(1)?, barrier?.backward_mev),
        };
        let mut rates = summary.rates.iter().flatten();
        let own = rates.find(|r| r.direction == way && r.saddle == leaving)?;
        own.barrier_meV.filter(|b| (b.0 - mev).abs() <= ALIKE * mev.abs()).map(|_| own)
    };
    let both = Way::BOTH.map(rate);
    let prefactors = summary.rates.as_ref().map(|_| Prefactors {
        htst_hz: both.map(|r| Some(r?.htst_prefactor_Hz?.0)),
        langer_hz: both.map(|r| Some(r?.langer_prefactor_Hz?.0)),
    });
    let times = summary.transition_rates.iter().flatten().flat_map(|t| {
        t.temperatures.iter().map(|row| Times {
            way: t.direction,
            temperature_k: row.temperature_K.0,
            barrier_over_kt: row.barrier_over_kT.0,
            log10_escape_s: row.log10_escape_lifetime_s.map(|n| n.0),
            log10_passage_s: row.log10_first_passage_s.map(|n| n.0),
            known_within: row.known_within_factor.map(|n| n.0),
        })
    });
    let times = times.collect();
    Found {
        times,
        barrier,
        saddles: summary.saddles.len(),
        negative_modes: highest.and_then(|(_, s)| s.negative_modes),
        prefactors,
        head: summary.head,
        warnings: summary.warnings,
    }
}
