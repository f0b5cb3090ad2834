//! The results of a sweep together: `points.json` says which folder holds which values, `barriers.csv` has a row a point, and
//! `barriers.svg` and `.png` show the barrier against a swept key. Where rates are asked for, `lifetimes.csv` has a row a point, direction
//! and temperature, and `lifetime_map.svg` and `.png` show how long the initial state lives over the key and temperature.

mod contours;
mod found;
mod map;
mod plot;
mod table;

pub use found::{Found, PointState, Times, look};
pub use map::draw_map;
pub use plot::draw_sweep;
pub use table::{lifetime_table, sweep_table};

use super::disk;
use super::manifest::{Owned, There, hash};
use crate::error::{Error, Result};
use crate::units::AnyQuantity;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::Path;

/// The file that says what is where.
pub const POINTS: &str = "points.json";
/// What is collected.
const COLLECTED: [&str; 6] =
    ["barriers.csv", "barriers.svg", "barriers.png", "lifetimes.csv", "lifetime_map.svg", "lifetime_map.png"];

/// The points of a sweep, as the folder of their results keeps them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepIndex {
    /// Name of the sweep.
    pub name: String,
    /// The swept keys.
    pub keys: Vec<IndexedKey>,
    /// The points in order, from 0.
    pub points: Vec<IndexedPoint>,
    /// Hashes of the table and the figures that were collected: they alone are replaced when that is done again.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub collected: BTreeMap<String, BTreeSet<String>>,
}

/// A swept key.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IndexedKey {
    /// Its path.
    pub key: String,
    /// In short; a component has its letter behind a low line: `B_z`.
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
        let Some(bytes) = disk::read_if_there(&path)? else { return Ok(None) };
        let index: SweepIndex = serde_json::from_slice(&bytes)
            .map_err(|e| wrong(io::Error::other(format!("this is not what `sweep` writes: {e}"))))?;
        match index.points.iter().position(|p| p.values.len() != index.keys.len()) {
            Some(k) => Err(wrong(io::Error::other(format!("point {k} has not as many values as there are keys")))),
            None => Ok(Some(index)),
        }
    }

    /// Writes `points.json`, unless it is there as it should be. What else has its name is an error.
    pub fn write(&self, dir: &Path) -> Result<()> {
        let there = SweepIndex::read(dir)?;
        let collected = there.as_ref().map(|there| there.collected.clone()).unwrap_or_default();
        let new = SweepIndex { collected, ..self.clone() };
        if there.as_ref() == Some(&new) { Ok(()) } else { new.put(dir) }
    }

    fn put(&self, dir: &Path) -> Result<()> {
        let text = format!("{:#}\n", serde_json::to_value(self).map_err(|e| Error::Numerical(e.to_string()))?);
        disk::write_file(&dir.join(POINTS), text.as_bytes())
    }

    /// Makes sure that the table and the figures of a sweep may be written: nothing has their names but what was collected before.
    pub fn is_free(dir: &Path, force: bool) -> Result<()> {
        let owned = SweepIndex::owned(dir)?;
        for name in COLLECTED {
            match owned.look(dir, name)? {
                There::Nothing | There::Own => {}
                There::Foreign if force => {}
                There::Foreign => {
                    let words = "is there and was not collected here, or was changed since: take it away or rename it";
                    return Err(disk::refused(&dir.join(name), words));
                }
                There::InTheWay(words) => return Err(disk::refused(&dir.join(name), format!("{words}: take it away"))),
            }
        }
        Ok(())
    }

    /// Writes the table and the figures of the sweep in the place of earlier ones.
    pub fn collect(&self, dir: &Path, files: &[disk::File], force: bool) -> Result<()> {
        SweepIndex::is_free(dir, force)?;
        let old = SweepIndex::owned(dir)?;
        let hashes: Vec<String> = files.iter().map(|file| hash(&file.name, &file.bytes)).collect();
        let new = || files.iter().zip(&hashes).map(|(file, hash)| (file.name.as_str(), hash.as_str()));
        // until all of them are there, the older ones are known too
        let mut all = old.clone();
        all.add(new());
        SweepIndex { collected: all.files, ..self.clone() }.put(dir)?;
        for name in old.files.keys().filter(|name| new().all(|(new, _)| new != name.as_str())) {
            if old.look(dir, name)? == There::Own {
                disk::remove(&dir.join(name))?;
            }
        }
        disk::replace(dir, files, |_, _| true, false)?;
        let mut all = Owned::default();
        all.add(new());
        SweepIndex { collected: all.files, ..self.clone() }.put(dir)
    }

    fn owned(dir: &Path) -> Result<Owned> {
        let mut owned = Owned::default();
        if let Some(index) = SweepIndex::read(dir)? {
            owned.files = index.collected.into_iter().filter(|(name, _)| COLLECTED.contains(&name.as_str())).collect();
        }
        Ok(owned)
    }

    /// A swept key with its values as numbers, where they are numbers.
    fn parameter(&self, k: usize) -> Parameter {
        let (label, drawn) = (&self.keys[k].label, self.keys[k].drawn());
        let values: Vec<&Value> = self.points.iter().map(|p| &p.values[k]).collect();
        if let Some(numbers) = values.iter().map(|v| v.as_f64()).collect::<Option<Vec<f64>>>() {
            return Parameter { column: label.clone(), title: drawn, unit: String::new(), numbers: Some(numbers) };
        }
        let quantity = |v: &&Value| v.as_str().and_then(|text| AnyQuantity::new(text).ok());
        let quantities: Option<Vec<AnyQuantity>> = values.iter().map(quantity).collect();
        let first = quantities.as_ref().and_then(|q| q.first());
        let numbers = first.zip(quantities.as_ref());
        let numbers = numbers.and_then(|(first, all)| all.iter().map(|q| q.value_as(first).ok()).collect());
        match first.filter(|_| numbers.is_some()) {
            Some(first) => Parameter {
                column: format!("{label}_{}", first.unit_name()),
                title: format!("{drawn} ({})", powers_drawn(&first.unit)),
                unit: format!(" {}", powers_drawn(&first.unit)),
                numbers,
            },
            None => Parameter { column: label.clone(), title: drawn, unit: String::new(), numbers: None },
        }
    }
}

impl IndexedKey {
    /// The label in a figure, where a component is a subscript.
    fn drawn(&self) -> String {
        match self.label.rsplit_once('_') {
            Some((vector, component @ ("x" | "y" | "z"))) => format!("{vector}_{{{component}}}"),
            _ => self.label.clone(),
        }
    }
}

/// A unit as figures show it: `mJ/m²` of `mJ/m^2`.
fn powers_drawn(unit: &str) -> String {
    unit.replace("^2", "²").replace("^3", "³")
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_of_figures_have_their_powers_raised() {
        assert_eq!(["mJ/m^2", "kJ/m^3", "meV"].map(powers_drawn), ["mJ/m²", "kJ/m³", "meV"]);
    }
}
