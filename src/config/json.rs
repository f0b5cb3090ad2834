//! Where every value of a JSON text stands; and what is wrong with a text that is no JSON, in words.

use crate::error::Error;
use crate::words::quoted;
use std::collections::HashMap;

/// Objects and arrays may stand in each other this deep.
const DEEPEST: usize = 64;

/// One step down a JSON document.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Step {
    Key(String),
    Index(usize),
}

/// A path as people write it: `energy[2].anisotropy.K`, `.` for the document; a key that looks like a path in `["…"]`.
pub(super) fn written(steps: &[Step]) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Key(key) if key.contains(['.', '[']) => text.push_str(&format!("[{}]", quoted(key))),
            Step::Key(key) if text.is_empty() => text.push_str(key),
            Step::Key(key) => {
                text.push('.');
                text.push_str(key);
            }
            Step::Index(i) => text.push_str(&format!("[{i}]")),
        }
    }
    if text.is_empty() { ".".into() } else { text }
}

/// The steps of a written path; an index may also be written `.2`, which reads as a key until an array is met.
pub(super) fn steps(place: &str) -> Option<Vec<Step>> {
    let mut steps = Vec::new();
    for part in place.split('.').filter(|_| place != ".") {
        let (key, mut rest) = part.split_at(part.find('[').unwrap_or(part.len()));
        if key.is_empty() && (rest.is_empty() || !steps.is_empty()) {
            return None;
        }
        if !key.is_empty() {
            steps.push(Step::Key(key.to_string()));
        }
        while !rest.is_empty() {
            let (index, tail) = rest.strip_prefix('[')?.split_once(']')?;
            steps.push(Step::Index(index.parse().ok()?));
            rest = tail;
        }
    }
    Some(steps)
}

/// A value: its bytes in the text and what it holds.
#[derive(Debug)]
pub(super) struct Node {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) holds: Holds,
}

/// What a value holds.
#[derive(Debug)]
pub(super) enum Holds {
    Nothing,
    Values(Vec<Node>),
    Members(Vec<Member>),
}

/// A key with its value.
#[derive(Debug)]
pub(super) struct Member {
    pub(super) key: String,
    pub(super) at: usize,
    pub(super) value: Node,
}

impl Node {
    /// The value one step down, and where its key (or itself) begins.
    pub(super) fn child(&self, step: &Step) -> Option<(&Node, usize)> {
        match (&self.holds, step) {
            (Holds::Members(members), Step::Key(key)) => {
                members.iter().find(|m| m.key == *key).map(|m| (&m.value, m.at))
            }
            (Holds::Values(values), Step::Index(i)) => values.get(*i).map(|v| (v, v.start)),
            (Holds::Values(values), Step::Key(key)) => values.get(key.parse::<usize>().ok()?).map(|v| (v, v.start)),
            _ => None,
        }
    }

    /// The value as deep down the path as the document goes, and how many steps that were.
    pub(super) fn descend(&self, steps: &[Step]) -> (&Node, usize) {
        let mut node = self;
        for (depth, step) in steps.iter().enumerate() {
            match node.child(step) {
                Some((child, _)) => node = child,
                None => return (node, depth),
            }
        }
        (node, steps.len())
    }
}

/// What is wrong with a text that is no JSON.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) at: usize,
    pub(super) steps: Vec<Step>,
    pub(super) message: String,
}

/// Line and column (from 1, in characters) of a byte; a byte-order mark is not counted.
pub(super) fn position(text: &str, at: usize) -> (usize, usize) {
    let before = &text.as_bytes()[..at.min(text.len())];
    let line_start = before.iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
    let line = before.iter().filter(|b| **b == b'\n').count() + 1;
    // A continuation byte of UTF-8 begins with the bits 10.
    let column = before[line_start..].iter().filter(|b| **b & 0xC0 != 0x80).count() + 1;
    let mark = line == 1 && at > 0 && text.starts_with('\u{FEFF}');
    (line, column - usize::from(mark))
}

/// Where everything stands in a JSON text.
pub(super) fn scan(text: &str) -> Result<Node, Fault> {
    let mut scanner = Scanner { text, at: 0, open: Vec::new() };
    scanner.document().map_err(|(at, message)| {
        let steps = scanner.open.iter().filter_map(Open::step).collect();
        Fault { at, steps, message }
    })
}

type Scanned<T> = Result<T, (usize, String)>;

/// An object or array that has not ended yet.
enum Open {
    Array { start: usize, values: Vec<Node> },
    Object { start: usize, members: Vec<Member>, seen: HashMap<String, usize>, key: Option<(String, usize)> },
}

impl Open {
    /// The step to the value that is being read.
    fn step(&self) -> Option<Step> {
        match self {
            Open::Array { values, .. } => Some(Step::Index(values.len())),
            Open::Object { key, .. } => key.as_ref().map(|(key, _)| Step::Key(key.clone())),
        }
    }
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    open: Vec<Open>,
}

impl Scanner<'_> {
    fn document(&mut self) -> Scanned<Node> {
        if self.text.starts_with('\u{FEFF}') {
            self.at = '\u{FEFF}'.len_utf8();
        }
        self.space()?;
        if self.peek().is_none() {
            return Err((0, "the file is empty: a JSON object {…} is expected".into()));
        }
        let document = loop {
            if let Some(value) = self.value()?
                && let Some(document) = self.close(value)?
            {
                break document;
            }
        };
        self.space()?;
        match self.peek() {
            None => Ok(document),
            Some(_) => Err((self.at, format!("found {} after the end of the JSON value", self.found()))),
        }
    }

    /// The next value, if it is complete; an object or array is left open.
    fn value(&mut self) -> Scanned<Option<Node>> {
        self.space()?;
        let start = self.at;
        match self.peek() {
            Some(c @ ('{' | '[')) => {
                if self.open.len() == DEEPEST {
                    return Err((start, format!("nested more than {DEEPEST} deep")));
                }
                self.at += 1;
                self.space()?;
                if self.peek() == Some(if c == '{' { '}' } else { ']' }) {
                    self.at += 1;
                    let holds = if c == '{' { Holds::Members(Vec::new()) } else { Holds::Values(Vec::new()) };
                    return Ok(Some(Node { start, end: self.at, holds }));
                }
                if c == '{' {
                    let (members, seen) = (Vec::new(), HashMap::new());
                    self.open.push(Open::Object { start, members, seen, key: None });
                    self.key()?;
                } else {
                    self.open.push(Open::Array { start, values: Vec::new() });
                }
                Ok(None)
            }
            Some('"') => {
                self.string()?;
                Ok(Some(Node { start, end: self.at, holds: Holds::Nothing }))
            }
            _ => {
                self.word()?;
                Ok(Some(Node { start, end: self.at, holds: Holds::Nothing }))
            }
        }
    }

    /// Puts a finished value where it belongs and ends what ends after it; the document when nothing is open.
    fn close(&mut self, mut value: Node) -> Scanned<Option<Node>> {
        loop {
            let end = match self.open.last_mut() {
                None => return Ok(Some(value)),
                Some(Open::Array { values, .. }) => {
                    values.push(value);
                    ']'
                }
                Some(Open::Object { members, key, .. }) => {
                    if let Some((key, at)) = key.take() {
                        members.push(Member { key, at, value });
                    }
                    '}'
                }
            };
            self.space()?;
            match self.peek() {
                Some(',') => {
                    let comma = self.at;
                    self.at += 1;
                    self.space()?;
                    if let Some(c @ ('}' | ']')) = self.peek() {
                        return Err((comma, format!("a comma right before \"{c}\": remove it")));
                    }
                    if end == '}' {
                        self.key()?;
                    }
                    return Ok(None);
                }
                Some(c) if c == end => {
                    self.at += 1;
                    value = match self.open.pop() {
                        Some(Open::Array { start, values }) => {
                            Node { start, end: self.at, holds: Holds::Values(values) }
                        }
                        Some(Open::Object { start, members, .. }) => {
                            Node { start, end: self.at, holds: Holds::Members(members) }
                        }
                        None => return Ok(None),
                    };
                }
                _ => return Err((self.at, format!("found {}, expected \",\" or \"{end}\"", self.found()))),
            }
        }
    }

    /// A key and its colon.
    fn key(&mut self) -> Scanned<()> {
        let at = self.at;
        if self.peek() != Some('"') {
            return Err((at, format!("found {}, expected a key in double quotes", self.found())));
        }
        let name = self.string()?;
        if let Some(Open::Object { seen, key, .. }) = self.open.last_mut() {
            let first = seen.insert(name.clone(), at);
            *key = Some((name.clone(), at));
            if let Some(first) = first {
                let (line, _) = position(self.text, first);
                return Err((at, format!("key {} appears twice, first in line {line}", quoted(&name))));
            }
        }
        self.space()?;
        if self.peek() != Some(':') {
            let message = format!("found {}, expected \":\" after the key {}", self.found(), quoted(&name));
            return Err((self.at, message));
        }
        self.at += 1;
        Ok(())
    }

    fn string(&mut self) -> Scanned<String> {
        let start = self.at;
        let bytes = self.text.as_bytes();
        self.at += 1;
        loop {
            match bytes.get(self.at) {
                None => return Err((start, "this string has no closing double quote".into())),
                Some(b'"') => break,
                Some(b'\n' | b'\r') => {
                    return Err((start, "this string has no closing double quote on its line".into()));
                }
                Some(b'\\') => {
                    let escape = self.text[self.at + 1..].chars().next();
                    let hex = bytes.get(self.at + 2..self.at + 6);
                    match escape {
                        Some('"' | '\\' | '/' | 'b' | 'f' | 'n' | 'r' | 't') => self.at += 2,
                        Some('u') if hex.is_some_and(|h| h.iter().all(u8::is_ascii_hexdigit)) => self.at += 6,
                        _ => {
                            let shown: String = escape.into_iter().filter(|c| !c.is_control()).collect();
                            let message = format!("unknown escape \\{shown} in a string: a backslash is written \\\\");
                            return Err((self.at, message));
                        }
                    }
                }
                Some(b) if *b < 0x20 => {
                    let message = format!("a control character in a string: write it as \\u{b:04x}");
                    return Err((self.at, message));
                }
                Some(_) => self.at += 1,
            }
        }
        self.at += 1;
        let text = &self.text[start..self.at];
        serde_json::from_str(text).map_err(|_| (start, "half of a surrogate pair in a \\u escape".into()))
    }

    /// A number, `true`, `false` or `null`.
    fn word(&mut self) -> Scanned<()> {
        let start = self.at;
        let rest = &self.text[start..];
        let ends = |c: char| c.is_whitespace() || matches!(c, ',' | ':' | '[' | ']' | '{' | '}' | '"' | '/' | '#');
        let word = &rest[..rest.find(ends).unwrap_or(rest.len())];
        let fail = |message: String| Err((start, message));
        self.at += word.len();
        match word {
            "true" | "false" | "null" => return Ok(()),
            "" => {
                return fail(match self.peek() {
                    None => "the text ends where a value is expected".into(),
                    Some(_) => format!("found {} where a value is expected", self.found()),
                });
            }
            _ => {}
        }
        let lower = word.to_ascii_lowercase();
        let bare = lower.trim_start_matches(['+', '-']);
        if matches!(lower.as_str(), "true" | "false" | "null" | "none") {
            let json = if lower == "none" { "null" } else { &lower };
            return fail(format!("found {}: in JSON it is written {json}", quoted(word)));
        }
        if matches!(bare, "nan" | "inf" | "infinity" | ".nan" | ".inf") {
            return fail(format!("found {}: numbers must be finite", quoted(word)));
        }
        if word.starts_with('\'') {
            return fail("a string is written in double quotes, not in single ones".into());
        }
        if !bare.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
            return fail(format!("found {} where a value is expected: a string needs double quotes", quoted(word)));
        }
        if !is_number(word) {
            return fail(format!(
                "{} is not a JSON number (such as 12, -0.5 or 1e-6; a quantity with a unit is a string, \"0.5 meV\")",
                quoted(word)
            ));
        }
        match word.parse::<f64>() {
            Ok(x) if x.is_finite() => Ok(()),
            _ => fail(format!("the number {} is too large for double precision", quoted(word))),
        }
    }

    /// Skips white space; comments are refused by name.
    fn space(&mut self) -> Scanned<()> {
        let rest = &self.text[self.at..];
        self.at += rest.len() - rest.trim_start_matches([' ', '\t', '\n', '\r']).len();
        let rest = &self.text[self.at..];
        if rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#') {
            return Err((self.at, "a comment: JSON has none, remove it".into()));
        }
        Ok(())
    }

    fn peek(&self) -> Option<char> {
        self.text[self.at..].chars().next()
    }

    /// The next character (or word) for a message.
    fn found(&self) -> String {
        let rest = &self.text[self.at..];
        let end = rest.find(|c: char| !c.is_alphanumeric()).unwrap_or(rest.len());
        match rest.chars().next() {
            None => "the end of the text".into(),
            Some('"') => "a string".into(),
            Some(c) if end == 0 => quoted(&c.to_string()),
            Some(_) => quoted(&rest[..end]),
        }
    }
}

/// Whether the word is a number by JSON's grammar: no sign +, no leading zeros, digits on both sides of the point.
fn is_number(word: &str) -> bool {
    let digits = |s: &str| !s.is_empty() && s.bytes().all(|b| b.is_ascii_digit());
    let word = word.strip_prefix('-').unwrap_or(word);
    let (mantissa, exponent) = word.split_at(word.find(['e', 'E']).unwrap_or(word.len()));
    let (whole, fraction) = mantissa.split_once('.').map_or((mantissa, None), |(w, f)| (w, Some(f)));
    let exponent = exponent.get(1..).map(|e| e.strip_prefix(['+', '-']).unwrap_or(e));
    digits(whole)
        && (whole == "0" || !whole.starts_with('0'))
        && fraction.is_none_or(digits)
        && exponent.is_none_or(digits)
}

/// Where everything stands in the text, or what is wrong with it.
pub(super) fn tree(file: &str, text: &str) -> Result<Node, Error> {
    scan(text).map_err(|fault| at(file, text, fault.at, &fault.steps, fault.message))
}

/// An error at a byte of a text.
pub(super) fn at(file: &str, text: &str, at: usize, steps: &[Step], message: String) -> Error {
    let (line, column) = position(text, at);
    Error::Config { file: file.into(), line, column, place: written(steps), message }
}
