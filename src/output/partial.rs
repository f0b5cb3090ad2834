//! What a run that was stopped leaves to look at: files whose names say that they are no result.

use super::disk::{self, File};
use super::{Format, HistoryCsv, PathCsv, PathNpz, RunReport};
use crate::error::{Error, Result};
use serde_json::{Value, json};
use std::path::Path;

/// How their names begin.
const PARTIAL: &str = "partial";

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

/// `partial.json`, and tables and spins of the band as it stood, if there was one.
pub fn partial_files(run: &StoppedRun, band: Option<&RunReport>) -> Result<Vec<File>> {
    let mut files = Vec::new();
    if let Some(report) = band {
        for format in formats() {
            files.push(File { name: name(format.as_ref()), bytes: format.render(report)? });
        }
    }
    let last = band.and_then(|report| report.outcome.history.last());
    let number = |x: Option<f64>| x.filter(|x| x.is_finite()).map_or(Value::Null, |x| json!(x));
    let summary = json!({
        "partial": true,
        "name": run.name,
        "version": run.version,
        "config_sha256": run.config_sha256,
        "converged": false,
        "certified": false,
        "stop_reason": run.reason,
        "stage": run.stage,
        "iteration": last.map(|row| row.iteration),
        "images": last.map(|row| row.images),
        "highest_image_above_initial_meV": number(last.map(|row| row.highest_image_mev)),
        "largest_predicted_rotation_rad": number(last.map(|row| row.largest_predicted_rotation_rad)),
    });
    let mut bytes = serde_json::to_vec_pretty(&summary).map_err(|e| Error::Numerical(e.to_string()))?;
    bytes.push(b'\n');
    files.push(File { name: format!("{PARTIAL}.json"), bytes });
    Ok(files)
}

/// Whether some of them are there; `partial.json` is taken away last.
pub fn is_partial_left(directory: &Path) -> bool {
    directory.join(format!("{PARTIAL}.json")).exists()
}

/// Takes them away.
pub fn discard_partial(directory: &Path) -> Result<()> {
    let names = formats().into_iter().map(|format| name(format.as_ref()));
    names.chain([format!("{PARTIAL}.json")]).try_for_each(|name| disk::remove(&directory.join(name)))
}

fn formats() -> Vec<Box<dyn Format>> {
    vec![Box::new(PathCsv), Box::new(HistoryCsv), Box::new(PathNpz)]
}

fn name(format: &dyn Format) -> String {
    format!("{PARTIAL}_{}", format.file_name())
}
