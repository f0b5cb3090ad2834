//! Where a config comes from: a file, standard input, or a program.

use super::text::{Text, decode};
use crate::error::{Error, Result};
use crate::files::open_file;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Longest text that is read (bytes).
const LONGEST: u64 = 1 << 30;
/// What stands on a command line for a config from standard input, and what that is called.
const STDIN: [&str; 2] = ["-", "stdin"];

/// A config's text before it is read.
#[derive(Clone, Debug)]
pub struct Source {
    /// Files that it names are looked for beside this one, whose name is that of the run if it has none.
    pub(super) path: PathBuf,
    /// The text.
    pub(super) text: Text,
    /// The file as the system knows it, if there is one.
    pub(super) known: Option<PathBuf>,
}

impl Source {
    /// A file, or standard input where the path is `-`.
    pub fn file(path: &Path) -> Result<Source> {
        Ok(Source { path: shown(path).into(), text: read(path)?, known: known_file(path) })
    }

    /// A text as if it were read from `path`.
    pub fn text(path: &Path, text: String) -> Source {
        Source { path: path.into(), text: Text::new(path.display().to_string(), text), known: known_file(path) }
    }

    /// A config that a program has made, with the name that it has if it has none, and the folder where its files are. Messages tell
    /// the path of a key alone, for there is no line that anybody saw.
    pub fn value(folder: &Path, name: &str, json: String) -> Source {
        Source { path: folder.join(format!("{name}.json")), text: Text::new("", json), known: None }
    }

    /// With each of these assignments (`KEY.PATH=JSON`) carried out.
    pub fn set(self, assignments: &[String]) -> Result<Source> {
        Ok(Source { text: self.text.set(assignments)?, ..self })
    }
}

/// What messages call a config.
fn shown(path: &Path) -> &Path {
    if is_stdin(path) { Path::new(STDIN[1]) } else { path }
}

fn is_stdin(path: &Path) -> bool {
    path == Path::new(STDIN[0])
}

/// A file as the system knows it.
pub(super) fn known_file(path: &Path) -> Option<PathBuf> {
    if is_stdin(path) { None } else { fs::canonicalize(path).ok() }
}

/// The text of a file, for messages named as it was given.
pub(super) fn read(path: &Path) -> Result<Text> {
    let bytes = match is_stdin(path) {
        true => whole(io::stdin()),
        false => bytes(path).map_err(|error| hinted(error, path)),
    };
    let bytes = bytes.map_err(|source| Error::Io { path: shown(path).into(), source })?;
    let file = shown(path).display().to_string();
    decode(&file, bytes).map(|text| Text::new(file, text))
}

/// Where a config may come from that is no file.
fn hinted(error: io::Error, path: &Path) -> io::Error {
    let is_stream = |kind: fs::FileType| !kind.is_file() && !kind.is_dir();
    match fs::metadata(path) {
        Ok(found) if is_stream(found.file_type()) => {
            let words = format!("{error}; to read the standard input, give {} in its place", STDIN[0]);
            io::Error::new(error.kind(), words)
        }
        _ => error,
    }
}

pub(super) fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    whole(open_file(path)?)
}

fn whole(source: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    source.take(LONGEST + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > LONGEST {
        true => {
            Err(io::Error::new(io::ErrorKind::FileTooLarge, "the file is larger than 1 GiB, too large for a config"))
        }
        false => Ok(bytes),
    }
}
