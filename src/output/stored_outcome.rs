//! A result read back in full from its files, bit for bit, to be written again with more in it.

use super::columns::{Columns, WAY_OUT};
use super::number::Number;
use super::read::{bytes, read_spins, shown, text};
use super::stored_run::history;
use super::summary::{End, Minimum, Rejected, Saddle, Search, State, Summary};
use crate::drive::{
    Barrier, EndPoint, ImageTable, IntermediateMinimum, Outcome, ProfilePoint, RejectedPath, SaddlePoint, SearchReport,
};
use crate::error::{Error, Result};
use crate::files;
use crate::lattice::Lattice;
use crate::path::Path as SpinPath;
use crate::spins::Spins;
use std::path::Path;

/// Files that hold what `summary.json` does not, and the one that is there if there is a saddle.
const NEEDED: [&str; 4] = ["path.npz", "minima.ovf", "profile.csv", "history.csv"];
const SADDLES: &str = "saddle.ovf";

/// An outcome from its files, without rates.
#[derive(Clone, Debug)]
pub struct StoredOutcome {
    /// The outcome.
    pub outcome: Outcome,
    /// The minima on the way with both ends, in path order.
    pub minima: Vec<Spins>,
}

impl StoredOutcome {
    /// Reads the result in `dir` of a lattice; what is not there, in words, where its files do not hold all of it.
    pub fn read(dir: &Path, lattice: &Lattice) -> Result<std::result::Result<StoredOutcome, String>> {
        let summary = Summary::read(dir)?;
        let has_saddles = !summary.saddles.is_empty();
        let needed = NEEDED.into_iter().chain(has_saddles.then_some(SADDLES));
        let missing: Vec<&str> = needed.filter(|name| !dir.join(name).is_file()).collect();
        if !missing.is_empty() {
            return Ok(Err(format!("there is no {} with the result", missing.join(", no "))));
        }
        let Some(stop_code) = summary.stop_code else {
            return Ok(Err("its summary.json does not say how the run ended".into()));
        };
        let path = states(dir, "path.npz", lattice)?;
        let saddles = if has_saddles { states(dir, SADDLES, lattice)? } else { Vec::new() };
        let minima = states(dir, "minima.ovf", lattice)?;
        let told = [summary.saddles.len(), summary.intermediate_minima.len()];
        if path.len() < 2 || [saddles.len(), minima.len().saturating_sub(2)] != told {
            return Ok(Err("its files of spins are not of one result with summary.json".into()));
        }
        let images = images(dir)?;
        let along = table(dir, "profile.csv")?;
        let history = history(&table(dir, "history.csv")?)?;
        let (certificate, between) = (summary.told(), summary.intermediate_minima);
        let outcome = Outcome {
            converged: summary.head.converged,
            certified: summary.head.certified,
            certificate,
            stop_code,
            stop_reason: summary.stop_reason,
            warnings: summary.warnings,
            barrier: summary.barrier_meV.map(Barrier::from),
            highest_climb: summary.highest_climb_meV.map(Barrier::from),
            saddles: summary.saddles.into_iter().zip(saddles).map(saddle).collect(),
            initial: end(&summary.initial),
            final_state: end(&summary.r#final),
            intermediate_minima: between.into_iter().zip(minima.iter().skip(1)).map(minimum).collect(),
            rates: None,
            search: summary.search.map(searched).unwrap_or_default(),
            rejected_paths: summary.rejected_paths.into_iter().map(rejected).collect(),
            path: SpinPath::new(&path),
            images,
            profile: profile(&along)?,
            profile_terms_mev: profile_terms(&along),
            history,
            work: summary.work,
            max_perpendicular_torque_mev: summary.path.max_perpendicular_torque_meV.0,
            largest_predicted_rotation_rad: summary.path.largest_predicted_rotation_rad.0,
        };
        Ok(Ok(StoredOutcome { outcome, minima }))
    }
}

fn searched(found: Search) -> SearchReport {
    let Search { effort, searches, quiet, minima, saddles, lowered_by_meV, spent, lowest_exit_meV, lowest_exit_from_K } =
        found;
    let lowest_exits_mev = [lowest_exit_meV.initial, lowest_exit_meV.r#final].map(|mev| mev.map(|Number(mev)| mev));
    SearchReport {
        effort,
        searches,
        quiet,
        minima,
        saddles,
        lowered_by_mev: lowered_by_meV.0,
        spent,
        lowest_exits_mev,
        exits_from_k: lowest_exit_from_K.map(|Number(k)| k),
    }
}

fn point(s: &State, moved: Option<Number>) -> EndPoint {
    EndPoint {
        energy_mev: s.energy_meV.0,
        max_torque_mev: s.max_torque_meV.0,
        negative_modes: s.negative_modes,
        zero_modes: s.zero_modes,
        moved_rad: moved.map(|angle| angle.0),
    }
}

fn end(e: &End) -> EndPoint {
    point(&e.state, e.moved_rad)
}

fn minimum((m, spins): (Minimum, &Spins)) -> IntermediateMinimum {
    let (image, reaction_coordinate_rad) = (m.image, m.reaction_coordinate_rad.0);
    IntermediateMinimum { image, reaction_coordinate_rad, spins: spins.clone(), state: point(&m.state, None) }
}

fn saddle((s, spins): (Saddle, Spins)) -> SaddlePoint {
    SaddlePoint {
        energy_mev: s.energy_meV.0,
        above_initial_mev: s.energy_above_initial_meV.0,
        reaction_coordinate_rad: s.reaction_coordinate_rad.0,
        image: s.image,
        spins,
        max_torque_mev: s.max_torque_meV.map(|mev| mev.0),
        negative_modes: s.negative_modes,
        zero_modes: s.zero_modes,
        lowest_eigenvalues_mev: s.lowest_eigenvalues_meV.iter().map(|mev| mev.0).collect(),
    }
}

fn rejected(r: Rejected) -> RejectedPath {
    let barrier_mev = r.barrier_meV.map(|mev| mev.0);
    RejectedPath { guess: r.guess, barrier_mev, negative_modes: r.negative_modes, reason: r.reason }
}

/// The states in a file of spins.
fn states(dir: &Path, name: &str, lattice: &Lattice) -> Result<Vec<Spins>> {
    read_spins(dir, name, &bytes(dir, name)?.unwrap_or_default(), lattice)
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

/// A table that has to be there.
fn table(dir: &Path, name: &str) -> Result<Columns> {
    let there = text(dir, name)?;
    let text = there.ok_or_else(|| Error::invalid(shown(dir, name), format!("is not there: {WAY_OUT}")))?;
    Columns::read(&shown(dir, name), &text)
}

/// The interpolated energy path.
fn profile(table: &Columns) -> Result<Vec<ProfilePoint>> {
    let point = |(s, e)| ProfilePoint { reaction_coordinate_rad: s, above_initial_mev: e };
    Ok(table.points("reaction_coordinate_rad", "energy_above_initial_meV")?.into_iter().map(point).collect())
}

/// And that of each term.
fn profile_terms(table: &Columns) -> Vec<(String, Vec<f64>)> {
    let term = |(name, column): &(String, Vec<f64>)| {
        let term = name.strip_suffix("_above_initial_meV").filter(|term| *term != "energy")?;
        Some((term.to_string(), column.clone()))
    };
    table.all().iter().filter_map(term).collect()
}
