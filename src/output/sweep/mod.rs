//! The results of a sweep together: `points.json` says which folder holds which values, `barriers.csv` has a row a point, and
//! `barriers.svg` and `.png` show the barrier against a swept key.

mod found;
mod plot;
mod table;

pub use found::{Found, PointState, look};
pub use plot::draw_sweep;
pub use table::sweep_table;

use super::disk;
use crate::error::{Error, Result};
use crate::units::AnyQuantity;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::fs;
use std::io;
use std::path::Path;

/// The file that says what is where.
pub const POINTS: &str = "points.json";

/// The points of a sweep, as the folder of their results keeps them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepIndex {
    /// Name of the sweep.
    pub name: String,
    /// The swept keys.
    pub keys: Vec<IndexedKey>,
    /// The points in order, from 0.
    pub points: Vec<IndexedPoint>,
}

/// A swept key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndexedKey {
    /// Its path.
    pub key: String,
    /// In short.
    pub label: String,
    /// Its values are spaced by equal factors.
    pub log: bool,
}

/// A point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndexedPoint {
    /// Its values, one a key, as a config has them.
    pub values: Vec<Value>,
    /// The folder of its result, in that of the sweep.
    pub directory: String,
    /// The hash of its config.
    pub config_sha256: String,
}

impl SweepIndex {
    /// Reads `points.json` of a folder; nothing where there is none.
    pub fn read(dir: &Path) -> Result<Option<SweepIndex>> {
        let path = dir.join(POINTS);
        let wrong = |source| Error::Io { path: path.clone(), source };
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(e) if matches!(e.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory) => return Ok(None),
            Err(e) => return Err(wrong(e)),
        };
        let index: SweepIndex = serde_json::from_slice(&bytes)
            .map_err(|e| wrong(io::Error::other(format!("this is not what `sweep` writes: {e}"))))?;
        match index.points.iter().position(|p| p.values.len() != index.keys.len()) {
            Some(k) => Err(wrong(io::Error::other(format!("point {k} has not as many values as there are keys")))),
            None => Ok(Some(index)),
        }
    }

    /// Writes `points.json`, unless it is there as it should be.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let text = format!("{:#}\n", serde_json::to_value(self).map_err(|e| Error::Numerical(e.to_string()))?);
        let path = dir.join(POINTS);
        match fs::read(&path) {
            Ok(bytes) if bytes == text.as_bytes() => Ok(()),
            _ => disk::write_file(&path, text.as_bytes()),
        }
    }

    /// A swept key with its values as numbers, where they are numbers.
    fn parameter(&self, k: usize) -> Parameter {
        let label = &self.keys[k].label;
        let values: Vec<&Value> = self.points.iter().map(|p| &p.values[k]).collect();
        if let Some(numbers) = values.iter().map(|v| v.as_f64()).collect::<Option<Vec<f64>>>() {
            return Parameter {
                column: label.clone(),
                title: label.clone(),
                unit: String::new(),
                numbers: Some(numbers),
            };
        }
        let quantity = |v: &&Value| v.as_str().and_then(|text| AnyQuantity::new(text).ok());
        let quantities: Option<Vec<AnyQuantity>> = values.iter().map(quantity).collect();
        let first = quantities.as_ref().and_then(|q| q.first());
        let numbers = first.zip(quantities.as_ref());
        let numbers = numbers.and_then(|(first, all)| all.iter().map(|q| q.value_as(first).ok()).collect());
        match first.filter(|_| numbers.is_some()) {
            Some(first) => Parameter {
                column: format!("{label}_{}", first.unit_name()),
                title: format!("{label} ({})", first.unit),
                unit: format!(" {}", first.unit),
                numbers,
            },
            None => Parameter { column: label.clone(), title: label.clone(), unit: String::new(), numbers: None },
        }
    }
}

/// A swept key as tables and figures show it.
struct Parameter {
    /// The head of its column: `K_meV`.
    column: String,
    /// The label of its axis: `K (meV)`.
    title: String,
    /// What stands behind a number, with a space: ` meV`.
    unit: String,
    /// Its value at each point, in one unit; nothing where the values are no numbers.
    numbers: Option<Vec<f64>>,
}

/// The value as a word: a text without its quotes.
fn word(value: &Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), String::from)
}
