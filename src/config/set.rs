//! `--set KEY.PATH=JSON`: values of a config changed on the command line.

use super::json::{Holds, Node, Step, position, scan, steps, tree};
use crate::error::{Error, Result};
use crate::words::{nearest, quoted};

/// The text with each assignment (`path.images=21`, `energy[0].anisotropy.K="1 meV"`, `energy.0.…`) carried out in
/// turn; `file` is the name that messages about the text begin with.
///
/// Only the value itself is replaced, so the order of keys, the layout and the lines of everything else stay those of the
/// user's file. Keys that are missing are added, with the objects on the way; an array grows by its next index.
pub fn apply_set(file: &str, text: &str, assignments: &[String]) -> Result<String> {
    let mut text = text.to_string();
    for assignment in assignments {
        let root = tree(file, &text)?;
        let (path, value) = split(assignment)?;
        let place = format!("--set {path}");
        let wanted = match steps(path) {
            Some(steps) if !steps.is_empty() => steps,
            _ => {
                return Err(Error::invalid(
                    place,
                    format!("{} is not a path of keys, such as path.images", quoted(path)),
                ));
            }
        };
        let edit = edit(&root, &wanted, value).map_err(|message| Error::invalid(place.clone(), message))?;
        text.replace_range(edit.0..edit.1, &edit.2);
    }
    Ok(text)
}

/// The path and the JSON of an assignment.
fn split(assignment: &str) -> Result<(&str, &str)> {
    let Some((path, value)) = assignment.split_once('=') else {
        let message = format!("{} has no \"=\": write KEY.PATH=JSON, such as path.images=21", quoted(assignment));
        return Err(Error::invalid("--set", message));
    };
    let (path, value) = (path.trim(), value.trim());
    let place = format!("--set {path}");
    if value.is_empty() {
        return Err(Error::invalid(place, "no value after \"=\": write KEY.PATH=JSON, such as path.images=21"));
    }
    match scan(value) {
        Ok(_) => Ok((path, value)),
        // a number that is none in JSON, such as NaN, is not meant as a string either
        Err(fault) if value.starts_with(['{', '[', '"']) || value.parse::<f64>().is_ok() => Err(Error::invalid(
            place,
            format!("the value is not JSON: column {}: {}", position(value, fault.at).1, fault.message),
        )),
        Err(_) => {
            let string = serde_json::Value::from(value).to_string().replace('\'', r"'\''");
            let message = format!("{} is not JSON; a string is written --set '{path}={string}'", quoted(value));
            Err(Error::invalid(place, message))
        }
    }
}

/// The bytes to replace, and by what.
fn edit(root: &Node, steps: &[Step], value: &str) -> std::result::Result<(usize, usize, String), String> {
    let (node, depth) = root.descend(steps);
    let Some((next, rest)) = steps[depth..].split_first() else {
        return Ok((node.start, node.end, value.into()));
    };
    // What is missing from here on is made of objects.
    let mut new = value.to_string();
    for step in rest.iter().rev() {
        match step {
            Step::Key(key) => new = format!("{{{}: {new}}}", serde_json::Value::from(key.as_str())),
            Step::Index(i) => {
                let hint = match (&node.holds, next) {
                    (Holds::Members(members), Step::Key(key)) => nearest(key, members.iter().map(|m| m.key.as_str())),
                    _ => None,
                };
                let hint = hint.map_or("give the whole array".into(), |near| format!("did you mean {}?", quoted(near)));
                return Err(format!("there is no array to take [{i}] of: {hint}"));
            }
        }
    }
    let here = super::json::written(&steps[..depth]);
    match (&node.holds, next) {
        (Holds::Members(members), Step::Key(key)) => {
            let member = format!("{}: {new}", serde_json::Value::from(key.as_str()));
            Ok(match members.last() {
                Some(last) => (last.value.end, last.value.end, format!(", {member}")),
                None => (node.start, node.end, format!("{{{member}}}")),
            })
        }
        (Holds::Members(_), Step::Index(i)) => Err(format!("{here} is an object: it has keys and no [{i}]")),
        (Holds::Values(values), step) => {
            let index = match step {
                Step::Index(i) => Some(*i),
                Step::Key(key) => key.parse().ok(),
            };
            match index {
                Some(i) if i == values.len() => Ok(match values.last() {
                    Some(last) => (last.end, last.end, format!(", {new}")),
                    None => (node.start, node.end, format!("[{new}]")),
                }),
                Some(i) if values.is_empty() => Err(format!("{here} is empty: there is no [{i}]")),
                Some(i) => Err(format!("{here} ends with [{}]: there is no [{i}]", values.len() - 1)),
                None => Err(format!("{here} is an array: an index is expected, such as [0]")),
            }
        }
        (Holds::Nothing, Step::Key(key)) => Err(format!("{here} holds a single value: it has no key {}", quoted(key))),
        (Holds::Nothing, Step::Index(i)) => Err(format!("{here} holds a single value: it has no [{i}]")),
    }
}
