//! A sweep: one config at many values of some of its keys.
//!
//! ```json
//! {
//!   "config": "ring.json",
//!   "set": {"output.plots": []},
//!   "grid": {
//!     "energy[0].anisotropy.K": ["0.1 meV", "0.2 meV"],
//!     "energy[1].zeeman.B[2]": {"from": "-0.1 T", "to": "-0.8 T", "points": 8}
//!   }
//! }
//! ```
//! `grid` takes every value with every other, the last key changing fastest; `zip` the first values of all keys, then the
//! second ones, and so on. Keys are paths as in `run --set`; `set` changes the config of all points. What is wrong with a point
//! is said at its value in the sweep's file.

mod blame;
mod names;
mod range;

use super::json::{Holds, Step, at, steps, tree};
use super::load::{Loaded, load_text, not_a};
use super::schema;
use super::source::read;
use super::text::{Text, apply_set};
use super::{Comment, Name};
use crate::drive::Problem;
use crate::error::{Error, Result};
use crate::output::sweep::{IndexedKey, IndexedPoint, SweepIndex};
use crate::words::quoted;
use range::Values;
use schemars::JsonSchema;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Most points of a sweep.
const MOST: usize = 1_000_000;

/// The JSON Schema of a sweep as text.
pub fn sweep_schema() -> String {
    format!("{:#}\n", schema::of::<SweepFile>("a sweep of spinneb"))
}

/// A sweep's file: a config at many values of some of its keys.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["grid"]}, {"required": ["zip"]}]))]
struct SweepFile {
    /// Where editors find the schema; not used here.
    #[serde(default, rename = "$schema")]
    _schema: Option<String>,
    /// What you want to say about it: a text, or one of several lines.
    #[serde(default, rename = "comment")]
    _comment: Option<Comment>,
    /// Name of the sweep and of its folder; the file's name without its ending if absent.
    #[serde(default)]
    name: Option<Name>,
    /// The config, beside the sweep's file.
    config: String,
    /// Changes of the config for all points, by paths of keys as in `run --set`.
    #[serde(default)]
    set: BTreeMap<String, Value>,
    /// Every value of each of these keys with every other, the last key changing fastest.
    #[serde(default)]
    grid: Option<BTreeMap<String, Values>>,
    /// The first values of all these keys, then the second ones, and so on.
    #[serde(default)]
    zip: Option<BTreeMap<String, Values>>,
}

/// A key with the values that it takes.
#[derive(Clone, Debug, PartialEq)]
pub struct SweptKey {
    /// Its path, as written.
    pub key: String,
    /// The shortest end of it that no other swept key has: `K`, `B_z`.
    pub label: String,
    /// The values, as a config has them.
    pub values: Vec<Value>,
    /// They are spaced by equal factors.
    pub log: bool,
    /// They are written as a range.
    range: bool,
    steps: Vec<Step>,
}

/// A sweep with its config.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// Its name, also of the folder of its results.
    pub name: String,
    /// The config that it changes.
    pub config: PathBuf,
    /// The swept keys in the order of the file.
    pub keys: Vec<SweptKey>,
    /// Which value of each key a point takes.
    points: Vec<Vec<usize>>,
    /// The folder of each point, in that of the sweep.
    directories: Vec<String>,
    file: String,
    text: String,
    /// `grid` or `zip`.
    list: &'static str,
    /// The config, with `set` carried out.
    base: String,
}

impl Sweep {
    /// Reads a sweep's file and the config that it names.
    pub fn load(path: &Path) -> Result<Sweep> {
        let read_text = read(path)?;
        let content: SweepFile = read_text.parse().map_err(|e| not_a(&read_text, "sweep", e))?;
        let Text { file, text, .. } = read_text;
        let root = tree(&file, &text)?;
        let here = |place: &[Step], message: String| at(&file, &text, root.descend(place).0.start, place, message);
        let key = |name: &str| Step::Key(name.into());
        let (list, mut given) = match (content.grid, content.zip) {
            (Some(grid), None) => ("grid", grid),
            (None, Some(zip)) => ("zip", zip),
            (Some(_), Some(_)) => {
                return Err(here(&[key("zip")], "found \"grid\" and \"zip\": one of them is wanted".into()));
            }
            (None, None) => {
                let message = "neither \"grid\" nor \"zip\" is there: which keys take which values?";
                return Err(here(&[], message.into()));
            }
        };
        let name = match &content.name {
            Some(name) => name.to_string(),
            None => stem(path).map_err(|message| here(&[], message))?,
        };
        // the order of the keys is that of the file
        let mut keys = Vec::new();
        if let Holds::Members(members) = &root.descend(&[key(list)]).0.holds {
            for member in members {
                let Some(values) = given.remove(&member.key) else { continue };
                let wrong = |message: String| at(&file, &text, member.at, &[key(list), key(&member.key)], message);
                let steps = swept_steps(&member.key, &keys).map_err(wrong)?;
                let Values { list: values, log, range } = values;
                let label = String::new();
                keys.push(SweptKey { key: member.key.clone(), label, values, log, range, steps });
            }
        }
        if keys.is_empty() {
            return Err(here(&[key(list)], "no key is swept: add one, such as \"energy[0].anisotropy.K\"".into()));
        }
        let points = if list == "grid" { product(&keys) } else { together(&keys) };
        let points = points.map_err(|(k, message)| here(&[key(list), key(&keys[k].key)], message))?;
        names::label(&mut keys);
        let directories = names::directories(&keys, &points).map_err(|message| here(&[key(list)], message))?;
        let config = path.parent().unwrap_or(Path::new("")).join(&content.config);
        let mut base = read(&config).map(|base| base.text).map_err(|e| match e {
            Error::Io { path, source } => {
                here(&[key("config")], format!("the config {} cannot be read: {source}", path.display()))
            }
            other => other,
        })?;
        let config_file = config.display().to_string();
        for (path, value) in &content.set {
            if let Some(swept) = overwrites(&keys, path) {
                let words = format!("every point sets this by {} again, so it would have no effect", quoted(swept));
                return Err(here(&[key("set"), key(path)], words));
            }
            base = apply_set(&config_file, &base, &[format!("{path}={value}")])
                .map_err(|e| blame::carried(e, |message| here(&[key("set"), key(path)], message)))?;
        }
        Ok(Sweep { name, config, keys, points, directories, file, text, list, base })
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Never: a sweep has points.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }

    /// The folder of a point, in that of the sweep.
    pub fn directory(&self, point: usize) -> &str {
        &self.directories[point]
    }

    /// The values of a point, one a key.
    pub fn values(&self, point: usize) -> impl Iterator<Item = &Value> {
        self.keys.iter().zip(&self.points[point]).map(|(key, k)| &key.values[*k])
    }

    /// The config of a point, named after its values.
    pub fn load_point(&self, point: usize) -> Result<Loaded> {
        let file = self.config.display().to_string();
        let mut text = self.base.clone();
        for (k, value) in self.values(point).enumerate() {
            let set = format!("{}={value}", self.keys[k].key);
            text =
                apply_set(&file, &text, &[set]).map_err(|e| blame::carried(e, |message| self.wrong_key(k, message)))?;
        }
        let name = format!("name={}", Value::from(self.directory(point)));
        text = apply_set(&file, &text, &[name])?;
        load_text(&self.config, text).map_err(|e| self.blame(point, e))
    }

    /// What the folder of the results keeps of the sweep, with the hash of each point's config.
    pub fn index(&self, hashes: Vec<String>) -> SweepIndex {
        let key = |k: &SweptKey| IndexedKey { key: k.key.clone(), label: k.label.clone(), log: k.log };
        SweepIndex {
            collected: Default::default(),
            name: self.name.clone(),
            keys: self.keys.iter().map(key).collect(),
            points: hashes.into_iter().enumerate().map(|(k, hash)| self.indexed(k, hash)).collect(),
        }
    }

    /// What the folder of the results keeps of a point with this hash.
    pub fn indexed(&self, point: usize, config_sha256: String) -> IndexedPoint {
        let values = self.values(point).cloned().collect();
        IndexedPoint { values, directory: self.directory(point).into(), config_sha256 }
    }

    /// The problem that a point's config states.
    pub fn problem(&self, point: usize, loaded: &Loaded) -> Result<Problem> {
        loaded.problem().map_err(|e| self.blame(point, e))
    }
}

/// The name of a sweep without one of its own.
fn stem(path: &Path) -> std::result::Result<String, String> {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    Name::new(&stem)
        .map(|name| name.to_string())
        .map_err(|e| format!("the file's name cannot name the sweep, which needs a \"name\" of its own: {e}"))
}

/// The steps of a key that may be swept beside others.
fn swept_steps(key: &str, others: &[SweptKey]) -> std::result::Result<Vec<Step>, String> {
    let own = match steps(key) {
        Some(own) if !own.is_empty() && !key.contains('=') => own.iter().map(indexed).collect::<Vec<_>>(),
        _ => return Err(format!("{} is not a path of keys, such as energy[0].anisotropy.K", quoted(key))),
    };
    if own == [Step::Key("name".into())] {
        return Err("the name of a point is made of its values: it cannot be swept".into());
    }
    match others.iter().find(|o| o.steps.starts_with(&own) || own.starts_with(&o.steps)) {
        Some(other) if other.steps == own => Err(format!("this is the key {} again", quoted(&other.key))),
        Some(other) => Err(format!("this key and {} set the same value", quoted(&other.key))),
        None => Ok(own),
    }
}

/// The swept key that sets what this path names, or something around it.
fn overwrites<'a>(keys: &'a [SweptKey], path: &str) -> Option<&'a str> {
    let own: Vec<Step> = steps(path)?.iter().map(indexed).collect();
    keys.iter().find(|swept| own.starts_with(&swept.steps)).map(|swept| swept.key.as_str())
}

/// An index that is written `.2` as an index.
fn indexed(step: &Step) -> Step {
    match step {
        Step::Key(key) => key.parse().map_or_else(|_| step.clone(), Step::Index),
        Step::Index(_) => step.clone(),
    }
}

type Points = std::result::Result<Vec<Vec<usize>>, (usize, String)>;

/// Every value with every other, the last key changing fastest.
fn product(keys: &[SweptKey]) -> Points {
    let mut points: Vec<Vec<usize>> = vec![Vec::new()];
    for (k, key) in keys.iter().enumerate() {
        let count = points.len().saturating_mul(key.values.len());
        if count > MOST {
            return Err((k, format!("with this key the sweep has {count} points, more than {MOST}")));
        }
        points = points.iter().flat_map(|p| (0..key.values.len()).map(|v| [&p[..], &[v]].concat())).collect();
    }
    Ok(points)
}

/// The first values of all keys, the second ones, and so on.
fn together(keys: &[SweptKey]) -> Points {
    let count = keys[0].values.len();
    match keys.iter().position(|key| key.values.len() != count) {
        Some(k) => {
            let (own, first) = (keys[k].values.len(), quoted(&keys[0].key));
            Err((k, format!("found {own} values, but {first} has {count}: in \"zip\" all keys have as many")))
        }
        None => Ok((0..count).map(|v| vec![v; keys.len()]).collect()),
    }
}

#[cfg(test)]
mod tests;
