//! What the folder of a point holds.

use super::SweepIndex;
use crate::drive::Barrier;
use crate::error::Result;
use crate::output::disk::{self, MARK};
use crate::output::folder::stored_result;
use serde::Deserialize;
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
    Found(Found),
}

impl PointState {
    /// In a word.
    pub fn word(&self) -> &'static str {
        match self {
            PointState::Missing => "missing",
            PointState::Other => "another result",
            PointState::Damaged => "damaged",
            PointState::Found(found) if found.is_proven() => "certified",
            PointState::Found(_) => "not certified",
        }
    }

    /// The result, if it is there.
    pub fn found(&self) -> Option<&Found> {
        match self {
            PointState::Found(found) => Some(found),
            _ => None,
        }
    }
}

/// A point's result in short.
#[derive(Clone, Debug, PartialEq)]
pub struct Found {
    /// The version that wrote it.
    pub version: String,
    /// The band met its tolerance.
    pub converged: bool,
    /// Ends and saddles are proven.
    pub certified: bool,
    /// The barrier, where there is one.
    pub barrier: Option<Barrier>,
    /// Number of saddles on the path.
    pub saddles: usize,
    /// Negative eigenvalues of the highest of them, where counted.
    pub negative_modes: Option<usize>,
    /// Prefactors over the highest saddle (Hz), where rates were asked for.
    pub prefactors: Option<Prefactors>,
    /// What the user should know.
    pub warnings: Vec<String>,
}

impl Found {
    /// Converged and certified.
    pub fn is_proven(&self) -> bool {
        self.converged && self.certified
    }
}

/// Prefactors over a saddle (Hz): forward and backward.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prefactors {
    /// By harmonic transition-state theory.
    pub htst_hz: [Option<f64>; 2],
    /// By Langer's theory.
    pub langer_hz: [Option<f64>; 2],
}

/// What of `summary.json` matters here.
#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Summary {
    version: String,
    config_sha256: String,
    converged: bool,
    certified: bool,
    warnings: Vec<String>,
    barrier_meV: Option<BothWays>,
    saddles: Vec<Saddle>,
    rates: Option<Vec<Rate>>,
}

#[derive(Deserialize)]
struct BothWays {
    forward: f64,
    backward: f64,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Saddle {
    energy_above_initial_meV: f64,
    negative_modes: Option<usize>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Rate {
    saddle: usize,
    direction: String,
    htst_prefactor_Hz: Option<f64>,
    langer_prefactor_Hz: Option<f64>,
}

/// Looks into the folder of a point; a damaged result is an error.
pub fn look(dir: &Path, index: &SweepIndex, point: usize) -> Result<PointState> {
    let point = &index.points[point];
    let dir = dir.join(&point.directory);
    if stored_result(&dir, |_| true)?.is_none() {
        return Ok(PointState::Missing);
    }
    let path = dir.join(MARK);
    let summary: Summary = serde_json::from_slice(&disk::read(&path)?)
        .map_err(|e| disk::refused(&dir, format!("the result here is damaged: {MARK} is not a whole result ({e})")))?;
    Ok(match summary.config_sha256 == point.config_sha256 {
        true => PointState::Found(found(summary)),
        false => PointState::Other,
    })
}

fn found(summary: Summary) -> Found {
    let above = |s: &Saddle| s.energy_above_initial_meV;
    let highest = (summary.saddles.iter().enumerate()).max_by(|(_, a), (_, b)| above(a).total_cmp(&above(b)));
    let rate = |direction: &str| {
        let rates = summary.rates.as_ref()?;
        rates.iter().find(|r| r.direction == direction && Some(r.saddle) == highest.map(|(k, _)| k))
    };
    let both = ["forward", "backward"].map(rate);
    let prefactors = summary.rates.as_ref().map(|_| Prefactors {
        htst_hz: both.map(|r| r?.htst_prefactor_Hz),
        langer_hz: both.map(|r| r?.langer_prefactor_Hz),
    });
    Found {
        converged: summary.converged,
        certified: summary.certified,
        barrier: summary.barrier_meV.map(|b| Barrier { forward_mev: b.forward, backward_mev: b.backward }),
        saddles: summary.saddles.len(),
        negative_modes: highest.and_then(|(_, s)| s.negative_modes),
        prefactors,
        version: summary.version,
        warnings: summary.warnings,
    }
}
