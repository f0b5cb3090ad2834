//! The one place that writes results: files appear whole or not at all, and `summary.json` appears last, as the mark of a
//! finished result.
//!
//! All files are first written under temporary names in the same directory and flushed to the disk; a full disk therefore leaves
//! an older result as it was. Only then is an old mark taken away, and the new files take their names.

use crate::error::{Error, Result};
use serde::Deserialize;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// How temporary names begin.
const PREFIX: &str = ".spinneb-";

/// What is written to see whether there is room.
static PROBE: [u8; 1 << 16] = [0; 1 << 16];

/// The file that marks a finished result.
pub const MARK: &str = "summary.json";

/// A file to write.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name in the directory; `/` stands before a file in a folder of it.
    pub name: String,
    /// Its content.
    pub bytes: Vec<u8>,
}

/// A finished result, as its `summary.json` tells.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
pub struct StoredResult {
    /// The version that wrote it.
    pub version: String,
    /// The hash of its config.
    pub config_sha256: String,
    converged: bool,
    certified: bool,
}

impl StoredResult {
    /// The exit code of the run that wrote it: 0 converged and certified, 3 otherwise.
    pub fn exit_code(&self) -> u8 {
        if self.converged && self.certified { 0 } else { 3 }
    }
}

/// What a run finds in its directory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Destination {
    /// It may write there.
    Ready,
    /// This very config was run before by this version.
    Finished(StoredResult),
}

/// Makes `dir` ready for the result of a config: creates it, makes sure that files can be written, and looks for an existing
/// result. Another result is an error ([`ErrorKind::AlreadyExists`]) unless `force`d.
pub fn prepare(dir: &Path, version: &str, config_sha256: &str, force: bool) -> Result<Destination> {
    create(dir)?;
    if !force {
        match stored_result(dir)? {
            Some(stored) if stored.version == version && stored.config_sha256 == config_sha256 => {
                return Ok(Destination::Finished(stored));
            }
            Some(stored) => return Err(occupied(dir, &stored, version, config_sha256)),
            None => {}
        }
    }
    // an empty file can be made on a disk that is full
    fill(&mut temporary(dir)?, &PROBE, false).map_err(|e| io_error(dir, unwritable(&e)))?;
    Ok(Destination::Ready)
}

/// Takes away the temporary files of a writer that was killed. Nobody else may write there meanwhile.
pub fn clean(dir: &Path) -> Result<()> {
    let Ok(entries) = fs::read_dir(dir) else { return Ok(()) };
    for entry in entries.flatten() {
        let name = entry.file_name();
        if name.to_string_lossy().starts_with(PREFIX) && entry.path().is_file() {
            remove(&entry.path())?;
        }
    }
    Ok(())
}

/// The finished result in `dir`, if there is one. An error where `summary.json` cannot be understood.
pub fn stored_result(dir: &Path) -> Result<Option<StoredResult>> {
    let path = dir.join(MARK);
    let text = match fs::read(&path) {
        Ok(text) => text,
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => return Ok(None),
        Err(e) => return Err(io_error(&path, e)),
    };
    serde_json::from_slice(&text).map(Some).map_err(|e| {
        let words = format!("is there but is not a result ({e}); use --force to replace it, or another directory");
        io_error(&path, io::Error::new(ErrorKind::AlreadyExists, words))
    })
}

/// Writes the files of a result. Of a result that was there before, files named in `known` that the new one does not have are
/// taken away, so that old and new do not mix; files of other names are left alone. A name in `known` that ends in `/` is a folder:
/// what is in it is the result's.
pub fn write_result(dir: &Path, files: &[File], known: &[String]) -> Result<()> {
    create(dir)?;
    let mut staged = files.iter().map(|file| stage(dir, file)).collect::<Result<Vec<_>>>()?;
    staged.sort_by_key(|(name, _)| *name == MARK);
    if dir.join(MARK).is_file() {
        remove(&dir.join(MARK))?;
        for name in known {
            match name.strip_suffix('/') {
                Some(folder) => clear(dir, folder, files)?,
                None if files.iter().all(|file| file.name != *name) => remove(&dir.join(name))?,
                None => {}
            }
        }
    }
    for (name, file) in staged {
        let path = dir.join(name);
        if name == MARK {
            flush_directory(dir)?;
        }
        file.persist(&path).map_err(|e| io_error(&path, e.error))?;
    }
    flush_directory(dir)
}

/// Writes files that may be there already, all of them or none. One that is there is replaced if it `may_be`, or by `force`; it is an
/// error ([`ErrorKind::AlreadyExists`]) otherwise.
pub fn replace(dir: &Path, files: &[File], may_be: impl Fn(&File, &[u8]) -> bool, force: bool) -> Result<()> {
    create(dir)?;
    for file in files {
        let path = dir.join(&file.name);
        if path.is_dir() {
            let words = "is a directory, where a figure is to be; give another place with --out";
            return Err(io_error(&path, io::Error::new(ErrorKind::AlreadyExists, words)));
        }
        match fs::read(&path) {
            Ok(old) if force || may_be(file, &old) => {}
            Ok(_) => {
                let words = "is there and is not this figure; use --force to replace it, or another place with --out";
                return Err(io_error(&path, io::Error::new(ErrorKind::AlreadyExists, words)));
            }
            Err(e) if e.kind() == ErrorKind::NotFound => {}
            Err(e) => return Err(io_error(&path, e)),
        }
    }
    let staged = files.iter().map(|file| stage(dir, file)).collect::<Result<Vec<_>>>()?;
    for (name, file) in staged {
        let path = dir.join(name);
        file.persist(&path).map_err(|e| io_error(&path, e.error))?;
    }
    flush_directory(dir)
}

/// Writes one file, whole or not at all, in place of an older one.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let dir = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    create(dir)?;
    let mut file = temporary(dir)?;
    fill(&mut file, bytes, true).map_err(|e| io_error(path, e))?;
    file.persist(path).map_err(|e| io_error(path, e.error))?;
    Ok(())
}

/// The file under a temporary name, on the disk.
fn stage<'a>(dir: &Path, file: &'a File) -> Result<(&'a str, NamedTempFile)> {
    let path = dir.join(&file.name);
    let folder = path.parent().unwrap_or(dir);
    create(folder)?;
    let mut staged = temporary(folder)?;
    fill(&mut staged, &file.bytes, true).map_err(|e| io_error(&dir.join(&file.name), e))?;
    Ok((&file.name, staged))
}

fn fill(file: &mut NamedTempFile, bytes: &[u8], flush: bool) -> io::Result<()> {
    file.as_file_mut().write_all(bytes)?;
    if flush { file.as_file().sync_all() } else { Ok(()) }
}

/// A new file that vanishes unless it is given a name; readable by all whom the umask allows.
fn temporary(dir: &Path) -> Result<NamedTempFile> {
    temporary_file(dir).map_err(|e| io_error(dir, unwritable(&e)))
}

pub(super) fn temporary_file(dir: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(dir)
}

fn unwritable(e: &io::Error) -> io::Error {
    io::Error::new(e.kind(), format!("cannot write here: {}", reason(e)))
}

fn create(dir: &Path) -> Result<()> {
    if dir.exists() && !dir.is_dir() {
        let words = "is a file, and results need a directory; give another with --out";
        return Err(io_error(dir, io::Error::new(ErrorKind::NotADirectory, words)));
    }
    fs::create_dir_all(dir).map_err(|e| {
        let words = format!("the directory cannot be made: {}", reason(&e));
        io_error(dir, io::Error::new(e.kind(), words))
    })
}

/// Takes away what an older result left in a folder of its own, and the folder if it is empty then.
fn clear(dir: &Path, folder: &str, files: &[File]) -> Result<()> {
    let path = dir.join(folder);
    let entries = match fs::read_dir(&path) {
        Ok(entries) => entries,
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => return Ok(()),
        Err(e) => return Err(io_error(&path, e)),
    };
    for entry in entries {
        let entry = entry.map_err(|e| io_error(&path, e))?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let staged = name.starts_with(PREFIX);
        if !staged && entry.path().is_file() && files.iter().all(|file| file.name != format!("{folder}/{name}")) {
            remove(&entry.path())?;
        }
    }
    // with something in it, it stays
    let _ = fs::remove_dir(&path);
    Ok(())
}

pub(super) fn remove(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if !matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Err(io_error(path, e)),
        _ => Ok(()),
    }
}

/// Makes the new names survive a power cut, where the system can.
fn flush_directory(dir: &Path) -> Result<()> {
    if cfg!(unix) {
        fs::File::open(dir).and_then(|d| d.sync_all()).map_err(|e| io_error(dir, e))?;
    }
    Ok(())
}

fn occupied(dir: &Path, stored: &StoredResult, version: &str, config_sha256: &str) -> Error {
    let what = if stored.config_sha256 == config_sha256 {
        format!("of this config by version {} (this is {version})", stored.version)
    } else {
        "of another config".to_string()
    };
    let words = format!("holds a result {what}; use --force to replace it, or another directory with --out");
    io_error(dir, io::Error::new(ErrorKind::AlreadyExists, words))
}

/// What the system says, without the path that a temporary file had.
fn reason(e: &io::Error) -> String {
    e.raw_os_error().map_or_else(|| e.kind().to_string(), |code| io::Error::from_raw_os_error(code).to_string())
}

fn io_error(path: &Path, source: io::Error) -> Error {
    Error::Io { path: path.into(), source }
}
