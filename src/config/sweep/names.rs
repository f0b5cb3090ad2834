//! What the keys and the points of a sweep are called.
//!
//! A point's folder is named after its values, so that it stays the same when others are added: `K_0.1meV__B_z_-0.8T`.

use super::super::json::{Step, written};
use super::super::schema::{component, value};
use super::SweptKey;
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// Longest name that is made of values.
const LONGEST: usize = 100;
/// Digits of a hash that tells points apart.
const HASH: usize = 10;

/// Gives each key the shortest end of its path that no other has; a vector's component has its letter, `B_z`, in the place of its index.
pub(super) fn label(keys: &mut [SweptKey]) {
    let schema = value();
    let ends: Vec<Vec<String>> = keys.iter().map(|key| ends(&key.steps, component(&schema, &key.steps))).collect();
    for (k, key) in keys.iter_mut().enumerate() {
        let unique = |end: &&String| ends.iter().enumerate().all(|(j, other)| j == k || !other.contains(end));
        key.label = ends[k].iter().find(unique).unwrap_or(&key.key).clone();
    }
}

/// All ends of a path that begin with a key, the shortest first.
fn ends(steps: &[Step], component: Option<String>) -> Vec<String> {
    let starts = (0..steps.len()).rev().filter(|i| matches!(steps[*i], Step::Key(_)));
    let end = |i: usize| match &component {
        Some(letter) => format!("{}_{letter}", written(&steps[i..steps.len() - 1])),
        None => written(&steps[i..]),
    };
    starts.map(end).collect()
}

/// The folder of each point; an error where two points are the same.
pub(super) fn directories(keys: &[SweptKey], points: &[Vec<usize>]) -> Result<Vec<String>, String> {
    let hashed = |point: &[usize]| hash(keys, point);
    let plain: Vec<(String, bool)> = points.iter().map(|point| plain(keys, point)).collect();
    // some file systems do not tell cases apart
    let mut alike: BTreeMap<String, usize> = BTreeMap::new();
    for (name, _) in &plain {
        *alike.entry(name.to_lowercase()).or_default() += 1;
    }
    let names = points.iter().zip(plain).map(|(point, (name, exact))| match name.len() {
        n if n > LONGEST => format!("point_{}", hashed(point)),
        _ if !exact || alike.get(&name.to_lowercase()).is_some_and(|n| *n > 1) => format!("{name}-{}", hashed(point)),
        _ => name,
    });
    let names: Vec<String> = names.collect();
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    for (k, name) in names.iter().enumerate() {
        if let Some(other) = first.insert(name, k) {
            return Err(format!("the points {other} and {k} (counted from 0) have the same values"));
        }
    }
    Ok(names)
}

/// The keys' labels with their values, and whether nothing was lost on the way.
fn plain(keys: &[SweptKey], point: &[usize]) -> (String, bool) {
    let mut exact = true;
    let parts = keys.iter().zip(point).map(|(key, k)| {
        let (label, _) = cleaned(&key.label.replace('[', ".").replace(']', ""));
        let value = match &key.values[*k] {
            Value::String(text) => text.replace(' ', "").replace('/', "per").replace('^', "").replace(['µ', 'μ'], "u"),
            other => other.to_string(),
        };
        let (value, same) = cleaned(&value);
        exact &= same;
        format!("{label}_{value}")
    });
    let name = parts.collect::<Vec<_>>().join("__");
    (name, exact)
}

/// The text with a hyphen for each character that a name cannot have, and whether there was none.
fn cleaned(text: &str) -> (String, bool) {
    let allowed = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-');
    (text.chars().map(|c| if allowed(c) { c } else { '-' }).collect(), text.chars().all(allowed))
}

/// The first digits of the SHA-256 of a point's values.
fn hash(keys: &[SweptKey], point: &[usize]) -> String {
    let values: Vec<&Value> = keys.iter().zip(point).map(|(key, k)| &key.values[*k]).collect();
    let written = Value::from_iter(values.into_iter().cloned()).to_string();
    let digits: String = Sha256::digest(written.as_bytes()).iter().map(|byte| format!("{byte:02x}")).collect();
    digits[..HASH].into()
}
