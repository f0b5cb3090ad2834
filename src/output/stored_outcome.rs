//! A result read back in full from its files, bit for bit, to be written again with more in it.

use super::columns::{Columns, WAY_OUT};
use super::disk::MARK;
use super::stored_run::{bytes, history, shown, text};
use crate::drive::{
    Barrier, EndPoint, ImageTable, IntermediateMinimum, Outcome, ProfilePoint, RejectedPath, SaddlePoint, StopCode,
    Work,
};
use crate::error::{Error, Result};
use crate::files;
use crate::path::Path as SpinPath;
use crate::spins::Spins;
use serde::Deserialize;
use std::path::Path;

/// Files that hold what `summary.json` does not.
const NEEDED: [&str; 5] = ["path.npz", "saddle.ovf", "minima.ovf", "profile.csv", "history.csv"];

/// An outcome from its files, without rates.
#[derive(Clone, Debug)]
pub struct StoredOutcome {
    /// The outcome.
    pub outcome: Outcome,
    /// The minima on the way with both ends, in path order.
    pub minima: Vec<Spins>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Summary {
    converged: bool,
    certified: bool,
    stop_code: StopCode,
    stop_reason: String,
    warnings: Vec<String>,
    barrier_meV: Option<BothWays>,
    #[serde(default)]
    highest_climb_meV: Option<BothWays>,
    saddles: Vec<Saddle>,
    initial: End,
    r#final: End,
    intermediate_minima: Vec<Minimum>,
    rejected_paths: Vec<Rejected>,
    path: Band,
    work: Cost,
}

#[derive(Deserialize)]
struct BothWays {
    forward: f64,
    backward: f64,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Saddle {
    energy_meV: f64,
    energy_above_initial_meV: f64,
    reaction_coordinate_rad: f64,
    image: usize,
    max_torque_meV: Option<f64>,
    negative_modes: Option<usize>,
    zero_modes: Option<usize>,
    lowest_eigenvalues_meV: Vec<f64>,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct End {
    energy_meV: f64,
    max_torque_meV: f64,
    negative_modes: Option<usize>,
    zero_modes: Option<usize>,
    moved_rad: Option<f64>,
}

#[derive(Deserialize)]
struct Minimum {
    image: usize,
    reaction_coordinate_rad: f64,
    #[serde(flatten)]
    state: End,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Rejected {
    guess: String,
    barrier_meV: Option<f64>,
    negative_modes: Option<usize>,
    reason: String,
}

#[derive(Deserialize)]
#[allow(non_snake_case)]
struct Band {
    max_perpendicular_torque_meV: f64,
    largest_predicted_rotation_rad: f64,
}

#[derive(Deserialize)]
struct Cost {
    iterations: usize,
    force_evaluations: usize,
    seconds: f64,
    threads: usize,
}

impl StoredOutcome {
    /// Reads the result in `dir`; what is not there, in words, where its files do not hold all of it.
    pub fn read(dir: &Path) -> Result<std::result::Result<StoredOutcome, String>> {
        let missing: Vec<&str> = NEEDED.into_iter().filter(|name| !dir.join(name).is_file()).collect();
        if !missing.is_empty() {
            return Ok(Err(format!("there is no {} with the result", missing.join(", no "))));
        }
        let must = |name: &str| {
            text(dir, name)?.ok_or_else(|| Error::invalid(shown(dir, name), format!("is not there: {WAY_OUT}")))
        };
        let summary: Summary = serde_json::from_str(&must(MARK)?)
            .map_err(|e| Error::invalid(shown(dir, MARK), format!("{e}: {WAY_OUT}")))?;
        let path = states(dir, "path.npz")?;
        let (saddles, minima) = (states(dir, "saddle.ovf")?, states(dir, "minima.ovf")?);
        let between = minima.len().saturating_sub(2);
        if path.len() < 2 || saddles.len() != summary.saddles.len() || between != summary.intermediate_minima.len() {
            return Ok(Err("its files of spins are not of one result with summary.json".into()));
        }
        let images = images(dir)?;
        let table = Columns::read(&shown(dir, "profile.csv"), &must("profile.csv")?)?;
        let profile = table.points("reaction_coordinate_rad", "energy_above_initial_meV")?;
        let term = |(name, column): &(String, Vec<f64>)| {
            let term = name.strip_suffix("_above_initial_meV").filter(|term| *term != "energy")?;
            Some((term.to_string(), column.clone()))
        };
        let history = history(&Columns::read(&shown(dir, "history.csv"), &must("history.csv")?)?)?;
        let point = |(s, e)| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: e };
        let outcome = Outcome {
            converged: summary.converged,
            certified: summary.certified,
            stop_code: summary.stop_code,
            stop_reason: summary.stop_reason,
            warnings: summary.warnings,
            barrier: summary.barrier_meV.map(barrier),
            highest_climb: summary.highest_climb_meV.map(barrier),
            saddles: summary.saddles.into_iter().zip(saddles).map(saddle).collect(),
            initial: end(summary.initial),
            final_state: end(summary.r#final),
            intermediate_minima: summary
                .intermediate_minima
                .into_iter()
                .zip(minima.iter().skip(1))
                .map(minimum)
                .collect(),
            rates: None,
            rejected_paths: summary.rejected_paths.into_iter().map(rejected).collect(),
            path: SpinPath::new(&path),
            images,
            profile: profile.into_iter().map(point).collect(),
            profile_terms_mev: table.all().iter().filter_map(term).collect(),
            history,
            work: cost(&summary.work),
            max_perpendicular_torque_mev: summary.path.max_perpendicular_torque_meV,
            largest_predicted_rotation_rad: summary.path.largest_predicted_rotation_rad,
        };
        Ok(Ok(StoredOutcome { outcome, minima }))
    }
}

fn barrier(b: BothWays) -> Barrier {
    Barrier { forward_mev: b.forward, backward_mev: b.backward }
}

fn end(e: End) -> EndPoint {
    let End { energy_meV, max_torque_meV, negative_modes, zero_modes, moved_rad } = e;
    EndPoint { energy_mev: energy_meV, max_torque_mev: max_torque_meV, negative_modes, zero_modes, moved_rad }
}

fn minimum((m, spins): (Minimum, &Spins)) -> IntermediateMinimum {
    let (image, reaction_coordinate_rad) = (m.image, m.reaction_coordinate_rad);
    IntermediateMinimum { image, reaction_coordinate_rad, spins: spins.clone(), state: end(m.state) }
}

fn saddle((s, spins): (Saddle, Spins)) -> SaddlePoint {
    SaddlePoint {
        energy_mev: s.energy_meV,
        above_initial_mev: s.energy_above_initial_meV,
        reaction_coordinate_rad: s.reaction_coordinate_rad,
        image: s.image,
        spins,
        max_torque_mev: s.max_torque_meV,
        negative_modes: s.negative_modes,
        zero_modes: s.zero_modes,
        lowest_eigenvalues_mev: s.lowest_eigenvalues_meV,
    }
}

fn rejected(r: Rejected) -> RejectedPath {
    RejectedPath { guess: r.guess, barrier_mev: r.barrier_meV, negative_modes: r.negative_modes, reason: r.reason }
}

fn cost(w: &Cost) -> Work {
    let &Cost { iterations, force_evaluations, seconds, threads } = w;
    Work { iterations, force_evaluations, seconds, threads }
}

/// The states in a file of spins.
fn states(dir: &Path, name: &str) -> Result<Vec<Spins>> {
    let found = files::read(&shown(dir, name), &bytes(dir, name)?.unwrap_or_default())?.images;
    // the reader's vectors are of unit length already
    Ok(found.iter().map(|v| Spins::from_unit_vectors(v)).collect())
}

/// The columns beside the spins.
fn images(dir: &Path) -> Result<ImageTable> {
    let file = shown(dir, "path.npz");
    let columns = files::read_npz_columns(&file, &bytes(dir, "path.npz")?.unwrap_or_default())?;
    let mut table = ImageTable::default();
    for (name, column) in columns {
        match name.as_str() {
            "reaction_coordinate_rad" => table.reaction_coordinate_rad = column,
            "energy_meV" => table.energy_mev = column,
            "energy_above_initial_meV" => table.above_initial_mev = column,
            "max_perpendicular_torque_meV" => table.max_perpendicular_torque_mev = column,
            other => table.terms_mev.extend(other.strip_suffix("_meV").map(|term| (term.to_string(), column.clone()))),
        }
    }
    Ok(table)
}
