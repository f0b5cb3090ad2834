//! What a run that was stopped leaves to look at: files whose names say that they are no result.

use super::disk::{self, File};
use super::manifest::{Owned, There, hash};
use super::{Format, HistoryCsv, PathCsv, PathNpz, RunReport};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// How their names begin.
const PARTIAL: &str = "partial";
/// The file that tells of the others.
const MARK: &str = "partial.json";

/// Who was stopped, and where.
#[derive(Clone, Copy, Debug)]
pub struct StoppedRun<'a> {
    /// Name of the run.
    pub name: &'a str,
    /// Version of the program.
    pub version: &'a str,
    /// Hash of the config.
    pub config_sha256: &'a str,
    /// The stage that it was in, in words.
    pub stage: &'a str,
    /// Why it was stopped, in words.
    pub reason: &'a str,
}

/// What `partial.json` holds; a number that is not finite is null.
#[derive(Serialize, Deserialize)]
#[allow(non_snake_case)]
struct Partial {
    partial: bool,
    name: String,
    version: String,
    config_sha256: String,
    converged: bool,
    certified: bool,
    stop_reason: String,
    stage: String,
    iteration: Option<usize>,
    images: Option<usize>,
    highest_image_above_initial_meV: Option<f64>,
    largest_predicted_rotation_rad: Option<f64>,
    manifest: Tables,
}

/// The hashes of the tables.
#[derive(Serialize, Deserialize)]
struct Tables {
    files: BTreeMap<String, String>,
}

/// `partial.json`, and tables and spins of the band as it stood, if there was one.
pub fn partial_files(run: &StoppedRun, band: Option<&RunReport>) -> Result<Vec<File>> {
    let mut files = Vec::new();
    if let Some(report) = band {
        for format in formats() {
            files.push(File { name: name(format.as_ref()), bytes: format.render(report)? });
        }
    }
    let last = band.and_then(|report| report.outcome.history.last());
    let partial = Partial {
        partial: true,
        name: run.name.into(),
        version: run.version.into(),
        config_sha256: run.config_sha256.into(),
        converged: false,
        certified: false,
        stop_reason: run.reason.into(),
        stage: run.stage.into(),
        iteration: last.map(|row| row.iteration),
        images: last.map(|row| row.images),
        highest_image_above_initial_meV: last.map(|row| row.highest_image_mev),
        largest_predicted_rotation_rad: last.map(|row| row.largest_predicted_rotation_rad),
        manifest: Tables { files: files.iter().map(|f| (f.name.clone(), hash(&f.name, &f.bytes))).collect() },
    };
    let mut bytes = serde_json::to_vec_pretty(&partial).map_err(|e| Error::Numerical(e.to_string()))?;
    bytes.push(b'\n');
    // the first to be written and the last to go: whatever else is there, it has its hash
    files.insert(0, File { name: MARK.into(), bytes });
    Ok(files)
}

/// Whether some of them are there; `partial.json` is taken away last.
pub fn is_partial_left(directory: &Path) -> bool {
    directory.join(MARK).exists()
}

/// Takes them away, if they are as they were written.
pub fn discard_partial(directory: &Path) -> Result<()> {
    let mark = directory.join(MARK);
    let Some(owned) = owned(directory)? else { return Ok(()) };
    for name in owned.files.keys() {
        if owned.look(directory, name)? == There::Own {
            disk::remove(&directory.join(name))?;
        }
    }
    disk::remove(&mark)
}

/// Writes them; an error where files of others have their names.
pub fn write_partial(directory: &Path, files: &[File]) -> Result<()> {
    discard_partial(directory)?;
    disk::replace(directory, files, |_, _| false, false)
}

/// The tables that `partial.json` names, with their hashes; nothing where there is no such file of a run.
fn owned(directory: &Path) -> Result<Option<Owned>> {
    let path = directory.join(MARK);
    if disk::kind(&path)? != disk::Kind::File {
        return Ok(None);
    }
    let Ok(Partial { partial: true, manifest, .. }) = serde_json::from_slice(&disk::read(&path)?) else {
        return Ok(None);
    };
    let mut owned = Owned::default();
    for name in formats().iter().map(|format| name(format.as_ref())) {
        owned.add(manifest.files.get_key_value(&name).map(|(name, hash)| (name.as_str(), hash.as_str())));
    }
    Ok(Some(owned))
}

fn formats() -> Vec<Box<dyn Format>> {
    vec![Box::new(PathCsv), Box::new(HistoryCsv), Box::new(PathNpz)]
}

fn name(format: &dyn Format) -> String {
    format!("{PARTIAL}_{}", format.file_name())
}
