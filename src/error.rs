//! What can go wrong, in words that help.

use std::path::PathBuf;

/// The result of anything here that can fail.
pub type Result<T> = std::result::Result<T, Error>;

/// Every error of the library.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A value that cannot be used, with its place in the JSON it came from (`energy[2].exchange.J`; empty where there is none).
    #[error("{}{message}", if .place.is_empty() { String::new() } else { format!("{place}: ", place = .place) })]
    Invalid {
        /// JSON path of the value.
        place: String,
        /// What was found and what would do.
        message: String,
    },
    /// An error in a text with its file, line and column.
    #[error("{file}:{line}:{column}: {place}: {message}")]
    Config {
        /// The file as the user named it.
        file: String,
        /// Line, counted from 1.
        line: usize,
        /// Column, counted from 1 in characters.
        column: usize,
        /// JSON path of the value (`.` for the whole document).
        place: String,
        /// What was found and what would do.
        message: String,
    },
    /// All that is wrong with a config: one a line.
    #[error("{}", .0.iter().map(Error::to_string).collect::<Vec<_>>().join("\n"))]
    Several(Vec<Error>),
    /// The file system said no.
    #[error("{}: {source}", .path.display())]
    Io {
        /// The file or folder.
        path: PathBuf,
        /// What the system answered.
        source: std::io::Error,
    },
    /// A computation that cannot go on (says why).
    #[error("{0}")]
    Numerical(String),
    /// Someone asked it to stop ([`Control`](crate::control::Control)); what was found so far is incomplete.
    #[error("stopped as asked, before the end")]
    Stopped,
}

impl Error {
    /// An unusable value at a JSON path.
    pub fn invalid(place: impl Into<String>, message: impl Into<String>) -> Self {
        Error::Invalid { place: place.into(), message: message.into() }
    }

    /// Several errors as one, in the order of their places in each file; they must be at least one.
    pub fn several(errors: Vec<Error>) -> Self {
        let mut all: Vec<Error> = Vec::new();
        for error in errors {
            match error {
                Error::Several(more) => all.extend(more),
                one => all.push(one),
            }
        }
        let files: Vec<String> = all.iter().filter_map(|e| e.at().map(|(file, ..)| file.to_string())).collect();
        // the sort is stable: files stay in their order, and so do errors without a place
        all.sort_by_key(|e| e.at().map(|(file, l, c)| (files.iter().position(|f| f == file), l, c)));
        match all.len() {
            1 => all.remove(0),
            _ => Error::Several(all),
        }
    }

    /// File, line and column.
    fn at(&self) -> Option<(&str, usize, usize)> {
        match self {
            Error::Config { file, line, column, .. } => Some((file, *line, *column)),
            _ => None,
        }
    }

    /// The same error with `prefix` in front of its place (`energy[2]` + `.exchange.J`).
    pub fn within(self, prefix: &str) -> Self {
        match self {
            Error::Invalid { place, message } => {
                let place = match place.chars().next() {
                    None => prefix.to_string(),
                    Some('[') => format!("{prefix}{place}"),
                    Some(_) => format!("{prefix}.{place}"),
                };
                Error::Invalid { place, message }
            }
            Error::Several(errors) => Error::Several(errors.into_iter().map(|e| e.within(prefix)).collect()),
            other => other,
        }
    }
}

/// Both values, or what is wrong with either.
pub fn both<A, B>(a: Result<A>, b: Result<B>) -> Result<(A, B)> {
    match (a, b) {
        (Ok(a), Ok(b)) => Ok((a, b)),
        (Err(a), Err(b)) => Err(Error::several(vec![a, b])),
        (Err(e), _) | (_, Err(e)) => Err(e),
    }
}
