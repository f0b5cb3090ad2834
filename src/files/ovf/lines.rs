//! The lines of an OVF file, and the bytes between them.

use std::borrow::Cow;

/// A place in the bytes, at the beginning of a line or of data.
pub(super) struct Lines<'a> {
    bytes: &'a [u8],
    at: usize,
    number: usize,
}

/// A line with its number, counted from 1.
pub(super) struct Line<'a> {
    pub(super) text: Cow<'a, str>,
    pub(super) number: usize,
    /// Whether a line feed ends it; the last line of a file need not have one.
    pub(super) ended: bool,
}

impl Line<'_> {
    pub(super) fn place(&self) -> String {
        format!("line {}", self.number)
    }

    /// Nothing, or nothing but a comment (`## …`).
    pub(super) fn is_blank(&self) -> bool {
        let text = self.text.trim();
        text.is_empty() || text.starts_with("##") || text.trim_start_matches('#').trim().is_empty()
    }

    /// The key, in lower case without white space, and the value of `# key: value`; what follows `##` is a comment.
    pub(super) fn entry(&self) -> Option<(String, String)> {
        let text = self.text.trim().strip_prefix('#')?;
        let text = text.split("##").next().unwrap_or_default();
        let (key, value) = text.split_once(':')?;
        Some((squeezed(key), value.trim().to_string()))
    }
}

/// In lower case without white space.
pub(super) fn squeezed(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect()
}

impl<'a> Lines<'a> {
    pub(super) fn new(bytes: &'a [u8]) -> Lines<'a> {
        Lines { bytes, at: 0, number: 0 }
    }

    /// The next line without its end.
    pub(super) fn next(&mut self) -> Option<Line<'a>> {
        let rest = &self.bytes[self.at..];
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|b| *b == b'\n');
        let text = String::from_utf8_lossy(&rest[..end.unwrap_or(rest.len())]);
        self.at += end.map_or(rest.len(), |n| n + 1);
        self.number += 1;
        Some(Line { text, number: self.number, ended: end.is_some() })
    }

    /// The line that would come next.
    pub(super) fn peek(&self) -> Option<Line<'a>> {
        Lines { ..*self }.next()
    }

    /// Where the next byte is.
    pub(super) fn byte(&self) -> usize {
        self.at
    }

    /// All bytes from here.
    pub(super) fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Goes over `count` bytes that are no lines.
    pub(super) fn skip(&mut self, count: usize) {
        self.at += count.min(self.bytes.len() - self.at);
    }

    /// The line last read, in words.
    pub(super) fn place(&self) -> String {
        format!("line {}", self.number.max(1))
    }
}
