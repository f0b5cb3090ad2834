//! Strict JSON with helpful messages, whatever the document is about.
//!
//! A text is read three times: by a scanner that knows where everything stands and says in words what is no JSON, by
//! serde_json, and by the type that is wanted. What that type refuses is put in plain words, with the line and column
//! of the value itself.

use super::json::{self, Node, Step, at, position, scan, tree, written};
use super::refusals::{self, Refusal, inline, missing, unknown};
use crate::error::{Error, Result};
use crate::words::quoted;
use serde::de::DeserializeOwned;
use std::ops::Range;

pub use super::set::apply_set;
pub use crate::words::nearest;

/// A text and the file it is from, for messages.
#[derive(Clone, Debug)]
pub struct Text {
    /// The file as messages name it; empty where a program has made the text, of which messages then tell the key alone.
    pub file: String,
    /// Its content, with `--set` carried out.
    pub text: String,
    /// The content as the file has it, where `--set` changed it.
    before: Option<String>,
    /// The paths of `--set`.
    sets: Vec<Vec<Step>>,
}

impl Text {
    /// A text as its file has it.
    pub fn new(file: impl Into<String>, text: String) -> Text {
        Text { file: file.into(), text, before: None, sets: Vec::new() }
    }

    /// The text with each assignment carried out; see [`apply_set`].
    pub fn set(self, assignments: &[String]) -> Result<Text> {
        let text = apply_set(&self.file, &self.text, assignments)?;
        let path = |assignment: &String| json::steps(assignment.split('=').next()?.trim());
        Ok(Text { text, before: Some(self.text), sets: assignments.iter().filter_map(path).collect(), ..self })
    }

    /// The text with these pieces, in order, replaced; errors go on speaking of the text as it was.
    pub(super) fn replaced(self, pieces: Vec<(Range<usize>, String)>) -> Text {
        if pieces.is_empty() {
            return self;
        }
        let mut text = self.text.clone();
        pieces.into_iter().rev().for_each(|(range, piece)| text.replace_range(range, &piece));
        Text { text, before: Some(self.before.unwrap_or(self.text)), ..self }
    }

    /// The value that it is, or all that is wrong with it.
    pub fn parse<T: DeserializeOwned>(&self) -> Result<T> {
        let root = tree(&self.file, &self.text)?;
        let bare = self.text.strip_prefix('\u{FEFF}').unwrap_or(&self.text);
        let value: serde_json::Value = serde_json::from_str(bare).map_err(|e| Error::Config {
            file: self.file.clone(),
            line: e.line(),
            column: e.column(),
            place: ".".into(),
            message: e.to_string(),
        })?;
        refusals::read(&value, self.text.len()).map_err(|refused| {
            let errors = refused.into_iter().map(|r| {
                let message = in_words(&self.text, &root, &r);
                self.at(&r.steps, r.of_key(), written(&r.steps), message)
            });
            Error::several(errors.collect())
        })
    }

    /// The error with the file, line and column of its place here, or with the `--set` that it comes from.
    pub fn locate(&self, error: Error) -> Error {
        match error {
            Error::Invalid { place, message } => {
                let steps = json::steps(&place).unwrap_or_default();
                let place = if place.is_empty() { ".".into() } else { place };
                self.at(&steps, false, place, message)
            }
            Error::Several(errors) => Error::several(errors.into_iter().map(|e| self.locate(e)).collect()),
            other => other,
        }
    }

    /// An error of a value, or of its key.
    fn at(&self, steps: &[Step], of_key: bool, place: String, message: String) -> Error {
        let own = self.before.as_ref().unwrap_or(&self.text);
        let root = scan(own).ok();
        let depth = root.as_ref().map_or(0, |root| root.descend(steps).1);
        let made_by = |set: &&Vec<Step>| within(set, steps) || (depth < steps.len() && within(steps, set));
        if let Some(set) = self.sets.iter().rev().find(made_by) {
            let message = if set.len() == steps.len() { message } else { format!("{place}: {message}") };
            return Error::invalid(format!("--set {}", written(set)), message);
        }
        let message = match self.sets.iter().find(|set| !of_key && !steps.is_empty() && within(steps, set)) {
            Some(set) => format!("{message} (with --set {})", written(set)),
            None => message,
        };
        let start = root.map_or(0, |root| match steps.split_last().filter(|_| of_key) {
            Some((last, parent)) => {
                let parent = root.descend(parent).0;
                parent.child(last).map_or(parent.start, |(_, at)| at)
            }
            None => root.descend(steps).0.start,
        });
        if self.file.is_empty() {
            return Error::invalid(if place == "." { String::new() } else { place }, message);
        }
        let (line, column) = position(own, start);
        Error::Config { file: self.file.clone(), line, column, place, message }
    }
}

/// Whether the inner path begins as the outer one; an index may be written as a key.
fn within(outer: &[Step], inner: &[Step]) -> bool {
    let same = |(a, b): (&Step, &Step)| match (a, b) {
        (Step::Index(i), Step::Key(key)) | (Step::Key(key), Step::Index(i)) => key.parse() == Ok(*i),
        _ => a == b,
    };
    outer.len() <= inner.len() && outer.iter().zip(inner).all(same)
}

/// Whether a JSON text has two bytes a character: it begins with a byte order mark, or with two characters of ASCII (RFC 4627, 3).
fn is_utf_16(bytes: &[u8]) -> bool {
    let marked = bytes.starts_with(&[0xFF, 0xFE]) || bytes.starts_with(&[0xFE, 0xFF]);
    marked || matches!(bytes, [0, 1..=127, 0, 1..=127, ..] | [1..=127, 0, 1..=127, 0, ..])
}

/// The text of a file's bytes, which must be UTF-8.
pub fn decode(file: &str, bytes: Vec<u8>) -> Result<String> {
    if is_utf_16(&bytes) {
        return Err(at(file, "", 0, &[], "the file is UTF-16: save it as UTF-8".into()));
    }
    if let Some(zero) = bytes.iter().position(|b| *b == 0) {
        let text = String::from_utf8_lossy(&bytes[..zero]).into_owned();
        return Err(at(file, &text, zero, &[], "a byte of value 0: the file is no text, but binary".into()));
    }
    String::from_utf8(bytes).map_err(|e| {
        let good = e.utf8_error().valid_up_to();
        let text = String::from_utf8_lossy(&e.as_bytes()[..good]).into_owned();
        at(file, &text, good, &[], "a byte that is not UTF-8: save the file as UTF-8".into())
    })
}

/// The value of a JSON text, or all that is wrong with it; `file` is the name that messages begin with.
pub fn parse<T: DeserializeOwned>(file: &str, text: &str) -> Result<T> {
    Text::new(file, text.into()).parse()
}

/// What was refused, in plain words.
fn in_words(text: &str, root: &Node, refusal: &Refusal) -> String {
    let Refusal { steps, said, example } = refusal;
    if let Some((found, known)) = unknown(said, "field") {
        return suggestion("key", "keys", found, &known);
    }
    if let Some((found, known)) = unknown(said, "variant") {
        return suggestion("kind", "kinds", found, &known);
    }
    let (message, example) = (plain(said, text, root.descend(steps).0), example.as_ref().map(inline));
    match (missing(said), example.filter(|e| e.len() <= LONGEST_EXAMPLE && !["[]", "{}"].contains(&e.as_str()))) {
        (Some(key), Some(example)) => format!("{message}, such as {}: {example}", quoted(key)),
        (None, Some(example)) if FORMS.iter().any(|form| message.ends_with(form)) => {
            format!("{message}, such as {example}")
        }
        _ => message,
    }
}

/// Longer examples are not shown.
const LONGEST_EXAMPLE: usize = 100;
/// What is said of a value whose form alone is wanted.
const FORMS: [&str; 5] =
    ["expected an array", "expected an object", "which names the kind", " values", "fewer are expected"];

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

/// Whether a document is an object that has this key.
fn has_key(text: &str, key: &str) -> bool {
    serde_json::from_str::<serde_json::Value>(text).is_ok_and(|document| document.get(key).is_some())
}

/// serde's other messages in plain words; what a type says itself is left as it is.
fn plain(said: &str, text: &str, node: &Node) -> String {
    let word = |prefix: &str| said.strip_prefix(prefix).and_then(|rest| rest.strip_suffix('`'));
    if let Some(key) = missing(said) {
        let of_a_landscape = ["initial", "final"].contains(&key) && has_key(text, "landscape");
        let way_out = if of_a_landscape { " (`spinneb landscape` takes a config without it)" } else { "" };
        return format!("key \"{key}\" is missing{way_out}");
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
