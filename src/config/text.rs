//! Strict JSON with helpful messages, whatever the document is about.
//!
//! A text is read three times: by a scanner that knows where everything stands and says in words what is no JSON, by
//! serde_json, and by the type that is wanted. What that type refuses is put in plain words, with the line and column
//! of the value itself.

use super::json::{self, Node, Step, position, scan, written};
use super::strict::Strict;
use crate::error::{Error, Result};
use crate::words::quoted;
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;

pub use super::set::apply_set;
pub use crate::words::nearest;

/// The text of a file's bytes, which must be UTF-8.
pub fn decode(file: &str, bytes: Vec<u8>) -> Result<String> {
    let wide =
        bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]) || bytes.iter().take(2).any(|b| *b == 0);
    if wide {
        return Err(at(file, "", 0, &[], "the file is UTF-16: save it as UTF-8".into()));
    }
    String::from_utf8(bytes).map_err(|e| {
        let good = e.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&e.as_bytes()[..good]).into_owned();
        at(file, &text, good, &[], "a byte that is not UTF-8: save the file as UTF-8".into())
    })
}

/// The value of a JSON text; `file` is the name that messages begin with.
pub fn parse<T: DeserializeOwned>(file: &str, text: &str) -> Result<T> {
    let root = tree(file, text)?;
    let bare = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let value: serde_json::Value = serde_json::from_str(bare).map_err(|e| Error::Config {
        file: file.into(),
        line: e.line(),
        column: e.column(),
        place: ".".into(),
        message: e.to_string(),
    })?;
    serde_path_to_error::deserialize(Strict(&value)).map_err(|e| {
        let steps = e.path().iter().filter_map(step).collect();
        refusal(file, text, &root, steps, &e.inner().to_string())
    })
}

/// Line and column (from 1) of the value at a JSON path, as far down as the text goes; of the start if it is no JSON.
pub fn locate(text: &str, place: &str) -> (usize, usize) {
    let found = scan(text).ok().zip(json::steps(place)).map(|(root, steps)| root.descend(&steps).0.start);
    position(text, found.unwrap_or(0))
}

/// An unusable value ([`Error::Invalid`]) with the file, line and column of its place; other errors as they are.
pub fn at_place(file: &str, text: &str, error: Error) -> Error {
    match error {
        Error::Invalid { place, message } => {
            let (line, column) = locate(text, &place);
            let place = if place.is_empty() { ".".into() } else { place };
            Error::Config { file: file.into(), line, column, place, message }
        }
        other => other,
    }
}

/// Where everything stands in the text, or what is wrong with it.
pub(super) fn tree(file: &str, text: &str) -> Result<Node> {
    scan(text).map_err(|fault| at(file, text, fault.at, &fault.steps, fault.message))
}

/// An error at a byte of a text.
pub(super) fn at(file: &str, text: &str, at: usize, steps: &[Step], message: String) -> Error {
    let (line, column) = position(text, at);
    Error::Config { file: file.into(), line, column, place: written(steps), message }
}

fn step(segment: &Segment) -> Option<Step> {
    match segment {
        Segment::Seq { index } => Some(Step::Index(*index)),
        Segment::Map { key } | Segment::Enum { variant: key } => Some(Step::Key(key.clone())),
        Segment::Unknown => None,
    }
}

/// What serde refused, in plain words and at its own place.
fn refusal(file: &str, text: &str, root: &Node, mut steps: Vec<Step>, said: &str) -> Error {
    let (node, depth) = root.descend(&steps);
    // A kind given as a string is a step for serde, but not for the reader.
    if depth + 1 == steps.len() && matches!(node.holds, json::Holds::Nothing) {
        steps.pop();
    }
    let (found, message) = if let Some((found, known)) = unknown(said, "field") {
        (found, suggestion("key", "keys", found, &known))
    } else if let Some((found, known)) = unknown(said, "variant") {
        (found, suggestion("kind", "kinds", found, &known))
    } else {
        return at(file, text, node.start, &steps, plain(said, text, node));
    };
    // What is unknown is the key, so that is where to look, and not at its value.
    let key = Step::Key(found.into());
    if matches!(node.holds, json::Holds::Members(_)) && node.child(&key).is_some() && steps.last() != Some(&key) {
        steps.push(key);
    }
    let (parent, _) = root.descend(&steps[..steps.len().saturating_sub(1)]);
    let own = match steps.last() {
        Some(Step::Key(last)) if last == found => steps.last().and_then(|step| parent.child(step)),
        _ => None,
    };
    at(file, text, own.map_or(node.start, |(_, at)| at), &steps, message)
}

/// The unknown word and the known ones of "unknown field `x`, expected one of `a`, `b`".
fn unknown<'a>(said: &'a str, what: &str) -> Option<(&'a str, Vec<&'a str>)> {
    let rest = said.strip_prefix(&format!("unknown {what} `"))?;
    let (found, known) = rest.rsplit_once("`, expected ").or_else(|| rest.rsplit_once("`, there are no "))?;
    Some((found, known.split('`').skip(1).step_by(2).collect()))
}

fn suggestion(one: &str, many: &str, found: &str, known: &[&str]) -> String {
    let start = format!("unknown {one} {}", quoted(found));
    if known.is_empty() {
        return format!("{start}: no {one} is possible here");
    }
    let list = known.join(", ");
    match nearest(found, known.iter().copied()) {
        Some(near) => format!("{start}: did you mean \"{near}\"? (known {many}: {list})"),
        None => format!("{start} (known {many}: {list})"),
    }
}

/// serde's other messages in plain words; what a type says itself is left as it is.
fn plain(said: &str, text: &str, node: &Node) -> String {
    let word = |prefix: &str| said.strip_prefix(prefix).and_then(|rest| rest.strip_suffix('`'));
    if let Some(key) = word("missing field `") {
        return format!("key \"{key}\" is missing");
    }
    if let Some(key) = word("duplicate field `") {
        return format!("key \"{key}\" appears twice");
    }
    if said.starts_with("invalid type: unit variant, expected ") {
        let kind = text.get(node.start..node.end).unwrap_or_default();
        return format!("found the kind {kind} alone, expected an object: {{{kind}: {{…}}}}");
    }
    if said.starts_with("data did not match any variant of untagged enum") {
        return format!("found {}, which has none of the possible forms", found(node, text));
    }
    let expectation = |prefix: &str| said.strip_prefix(prefix).and_then(|rest| rest.rsplit_once(", expected "));
    if let Some((length, wanted)) = expectation("invalid length ") {
        let values = if length == "1" { "value" } else { "values" };
        if wanted.starts_with("struct ") {
            return format!("found {}, expected an object", found(node, text));
        }
        return match wanted.starts_with("fewer ") {
            true => format!("found {length} {values}, fewer are expected"),
            false => format!("found {length} {values}, expected {}", expected(wanted)),
        };
    }
    match expectation("invalid type: ").or_else(|| expectation("invalid value: ")) {
        Some((what, wanted)) => {
            let what = match what {
                // The value itself is shown, unless serde speaks of a part of it.
                "map" | "sequence" | "null" | "unit value" | "newtype variant" => found(node, text),
                _ if what.starts_with(['i', 'f']) && matches!(node.holds, json::Holds::Nothing) => found(node, text),
                _ => in_json(what),
            };
            format!("found {what}, expected {}", expected(wanted))
        }
        None => said.to_string(),
    }
}

/// What stands at a value.
fn found(node: &Node, text: &str) -> String {
    let own = text.get(node.start..node.end).unwrap_or("");
    match &node.holds {
        json::Holds::Members(members) if members.is_empty() => "an empty object".into(),
        json::Holds::Members(members) => {
            let keys: Vec<String> = members.iter().take(4).map(|m| quoted(&m.key)).collect();
            let more = if members.len() > 4 { ", …" } else { "" };
            let noun = if members.len() == 1 { "the key" } else { "the keys" };
            format!("an object with {noun} {}{more}", keys.join(", "))
        }
        json::Holds::Values(values) if values.is_empty() => "an empty array".into(),
        json::Holds::Values(_) => "an array".into(),
        json::Holds::Nothing if own.starts_with('"') => {
            format!("the string {}", quoted(&serde_json::from_str::<String>(own).unwrap_or_default()))
        }
        json::Holds::Nothing if own.starts_with(|c: char| c.is_ascii_digit() || c == '-') => {
            format!("the number {own}")
        }
        json::Holds::Nothing => own.to_string(),
    }
}

/// serde's words for what it found, in JSON's.
fn in_json(what: &str) -> String {
    let inner = |prefix: &str| what.strip_prefix(prefix).and_then(|rest| rest.strip_suffix('`'));
    if let Some(value) = inner("boolean `") {
        value.into()
    } else if let Some(value) = inner("integer `").or_else(|| inner("floating point `")) {
        format!("the number {value}")
    } else if what.starts_with("string ") {
        format!("the {what}")
    } else {
        what.into()
    }
}

/// serde's words for what it wanted, in JSON's.
fn expected(wanted: &str) -> String {
    let count = wanted.strip_prefix("an array of length ").or_else(|| wanted.strip_prefix("a tuple of size "));
    if let Some(count) = count {
        return format!("an array of {count} values");
    }
    match wanted {
        "f64" | "f32" => "a number",
        "usize" | "u64" | "u32" | "u16" | "u8" => "a whole number in digits, not negative",
        "isize" | "i64" | "i32" | "i16" | "i8" => "a whole number in digits",
        "a boolean" => "true or false",
        "a sequence" | "sequence" => "an array",
        "a map" | "map" => "an object",
        "string or map" | "map with a single key" => "an object with exactly one key, which names the kind",
        "unit" | "unit variant" => "the name alone, as a string",
        _ if wanted.starts_with("enum ") => "an object with exactly one key, which names the kind",
        _ if ["struct ", "tuple ", "unit struct "].iter().any(|kind| wanted.starts_with(kind)) => "an object",
        _ => wanted,
    }
    .into()
}

#[cfg(test)]
mod tests;
