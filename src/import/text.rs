//! A file of another code, line by line: words and numbers, each with its place for messages.

use crate::error::{Error, Result};
use crate::files::open_file;
use crate::geometry::Vector;
use crate::words::quoted;
use std::io::{self, Read};
use std::path::Path;

/// Longest file that is read (bytes).
const LONGEST: u64 = 1 << 30;

/// A file's text and its name for messages.
#[derive(Clone, Debug)]
pub struct Text {
    /// The file as messages name it.
    pub file: String,
    /// What it says.
    pub text: String,
}

/// A line that says something.
#[derive(Clone, Debug)]
pub struct Line<'a> {
    file: &'a str,
    /// Its number, counted from 1.
    pub number: usize,
    /// Its words, each with its column.
    words: Vec<(usize, &'a str)>,
}

impl Text {
    /// Reads a file. Comments may be in any encoding: what is no UTF-8 is no number either.
    pub fn read(path: &Path) -> Result<Text> {
        let failed = |source| Error::Io { path: path.into(), source };
        let mut bytes = Vec::new();
        let file = open_file(path).map_err(failed)?;
        file.take(LONGEST + 1).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > LONGEST {
            return Err(failed(io::Error::new(io::ErrorKind::FileTooLarge, "the file is larger than 1 GiB")));
        }
        let text = Text { file: path.display().to_string(), text: String::from_utf8_lossy(&bytes).into_owned() };
        match bytes.iter().position(|b| *b == 0) {
            Some(zero) => {
                let line = bytes[..zero].iter().filter(|b| **b == b'\n').count() + 1;
                Err(text.error(line, "a byte of value 0: the file is no text, but binary"))
            }
            None => Ok(text),
        }
    }

    /// The lines with words; what follows one of the `comments` is none. `parted` are characters between words beside white space.
    pub fn lines<'a>(&'a self, comments: &[char], parted: &[char]) -> Vec<Line<'a>> {
        let line = |(k, line): (usize, &'a str)| {
            let said = line.split(comments).next().unwrap_or_default();
            let words = said.split(|c: char| c.is_whitespace() || parted.contains(&c)).filter(|word| !word.is_empty());
            let column = |word: &str| said[..word.as_ptr() as usize - said.as_ptr() as usize].chars().count() + 1;
            Line { file: &self.file, number: k + 1, words: words.map(|word| (column(word), word)).collect() }
        };
        self.text.lines().enumerate().map(line).filter(|line| !line.words.is_empty()).collect()
    }

    /// What is wrong in a line.
    pub fn error(&self, line: usize, message: impl Into<String>) -> Error {
        Error::Config { file: self.file.clone(), line, column: 1, place: ".".into(), message: message.into() }
    }

    /// What is wrong with the end of the file.
    pub fn ends(&self, message: impl Into<String>) -> Error {
        self.error(self.text.lines().count().max(1), format!("the file ends here: {}", message.into()))
    }
}

impl<'a> Line<'a> {
    /// Number of words.
    pub fn count(&self) -> usize {
        self.words.len()
    }

    /// Its first word.
    pub fn first(&self) -> &'a str {
        self.words.first().map_or("", |(_, word)| word)
    }

    /// A word, if it is there.
    pub fn get(&self, k: usize) -> Option<&'a str> {
        self.words.get(k).map(|(_, word)| *word)
    }

    /// All words.
    pub fn words(&self) -> impl Iterator<Item = &'a str> {
        self.words.iter().map(|(_, word)| *word)
    }

    /// What is wrong with a word, or with its absence.
    pub fn error(&self, k: usize, what: &str, message: impl Into<String>) -> Error {
        let last = || self.words.last().map_or(1, |(column, word)| column + word.chars().count());
        let column = self.words.get(k).map_or_else(last, |(column, _)| *column);
        Error::Config { file: self.file.into(), line: self.number, column, place: what.into(), message: message.into() }
    }

    /// A word.
    pub fn word(&self, k: usize, what: &str) -> Result<&'a str> {
        let missing = || format!("the line ends here, after {} words: this is to be the {}", self.count(), nth(k));
        self.get(k).ok_or_else(|| self.error(k, what, missing()))
    }

    /// A finite number. Fortran's `1.0d-3` is one.
    pub fn number(&self, k: usize, what: &str) -> Result<f64> {
        let word = self.word(k, what)?;
        let found = word.replace(['d', 'D'], "e").parse::<f64>().ok().filter(|x| x.is_finite());
        // "inf" and "nan" parse, and are filtered out with the rest
        found.ok_or_else(|| self.error(k, what, format!("found {}, expected a number", quoted(word))))
    }

    /// Three numbers.
    pub fn vector(&self, k: usize, what: &str) -> Result<Vector> {
        Ok([self.number(k, what)?, self.number(k + 1, what)?, self.number(k + 2, what)?])
    }

    /// A whole number.
    pub fn whole(&self, k: usize, what: &str) -> Result<isize> {
        let word = self.word(k, what)?;
        // some codes write cells as 1.0
        let rounded = || self.number(k, what).ok().filter(|x| x.fract() == 0.0 && x.abs() < 1e9).map(|x| x as isize);
        let found = word.parse::<isize>().ok().filter(|n| n.unsigned_abs() < 1 << 40).or_else(rounded);
        found.ok_or_else(|| self.error(k, what, format!("found {}, expected a whole number", quoted(word))))
    }

    /// Three whole numbers.
    pub fn shift(&self, k: usize, what: &str) -> Result<[isize; 3]> {
        Ok([self.whole(k, what)?, self.whole(k + 1, what)?, self.whole(k + 2, what)?])
    }

    /// A whole number from `first` on, as an index below `count`.
    pub fn index(&self, k: usize, what: &str, first: isize, count: usize) -> Result<usize> {
        let found = self.whole(k, what)?;
        let index = usize::try_from(found - first).ok().filter(|i| *i < count);
        let last = first + count as isize - 1;
        index.ok_or_else(|| self.error(k, what, format!("found {found}, but there are {first} to {last}")))
    }

    /// Three whole numbers of at least 1.
    pub fn cells(&self, k: usize, what: &str) -> Result<[usize; 3]> {
        let one = |k| {
            let n = self.whole(k, what)?;
            let positive = usize::try_from(n).ok().filter(|n| *n > 0);
            positive.ok_or_else(|| self.error(k, what, format!("found {n} cells, but there is at least 1 a direction")))
        };
        Ok([one(k)?, one(k + 1)?, one(k + 2)?])
    }
}

/// "4th word".
fn nth(k: usize) -> String {
    let ending = match k {
        0 => "st",
        1 => "nd",
        2 => "rd",
        _ => "th",
    };
    format!("{}{ending}", k + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> Text {
        Text { file: "a.dat".into(), text: text.into() }
    }

    #[test]
    fn words_are_told_with_line_and_column() {
        let text = text("# head\n\n  1 2.5d-1 x # rest\n");
        let lines = text.lines(&['#'], &[]);
        assert_eq!((lines.len(), lines[0].number, lines[0].count()), (1, 3, 3));
        assert_eq!((lines[0].whole(0, "i").unwrap(), lines[0].number(1, "J").unwrap()), (1, 0.25));
        let said = |error: Error| error.to_string();
        assert_eq!(said(lines[0].number(2, "J").unwrap_err()), "a.dat:3:12: J: found \"x\", expected a number");
        let missing = "a.dat:3:13: D: the line ends here, after 3 words: this is to be the 4th";
        assert_eq!(said(lines[0].number(3, "D").unwrap_err()), missing);
        assert!(lines[0].index(0, "i", 1, 1).is_ok());
        assert!(said(lines[0].index(0, "i", 2, 1).unwrap_err()).contains("there are 2 to 2"));
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        let text = text("nan inf 1e999 0x1 99999999999999999999");
        let line = &text.lines(&[], &[])[0];
        assert!((0..4).all(|k| line.number(k, "J").is_err()) && line.whole(4, "i").is_err());
    }
}
