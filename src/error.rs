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
    #[error("{file}: line {line}, column {column}: {place}: {message}")]
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
    /// Someone asked it to stop ([`Hamiltonian::obey`](crate::energy::Hamiltonian::obey)); what was found so far is incomplete.
    #[error("stopped as asked, before the end")]
    Stopped,
}

impl Error {
    /// An unusable value at a JSON path.
    pub fn invalid(place: impl Into<String>, message: impl Into<String>) -> Self {
        Error::Invalid { place: place.into(), message: message.into() }
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
            other => other,
        }
    }
}
