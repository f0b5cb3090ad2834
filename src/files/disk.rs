//! The one place that writes files: each appears whole or not at all, and no symbolic link is followed or replaced.
//!
//! All files of a result are first written under temporary names in the same folder, flushed to the disk and closed; a full disk
//! therefore leaves an older result as it was. Only then the new files take their names ([`folder`](crate::output::folder)).

use super::open_file;
use crate::error::{Error, Result};
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Read, Write};
use std::path::Path;
use tempfile::{NamedTempFile, TempPath};

/// How temporary names begin; [`RANDOM`] letters and digits follow.
const PREFIX: &str = ".spinneb-unfinished-";
const RANDOM: usize = 6;

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

/// What has a path, itself: a symbolic link is one, wherever it leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Nothing.
    Nothing,
    /// A file.
    File,
    /// A folder.
    Folder,
    /// A symbolic link.
    Link,
    /// A pipe, a device.
    Other,
}

/// What has this path.
pub fn kind(path: &Path) -> Result<Kind> {
    match fs::symlink_metadata(path).map(|m| m.file_type()) {
        Ok(found) if found.is_file() => Ok(Kind::File),
        Ok(found) if found.is_dir() => Ok(Kind::Folder),
        Ok(found) if found.is_symlink() => Ok(Kind::Link),
        Ok(_) => Ok(Kind::Other),
        Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(Kind::Nothing),
        Err(e) => Err(io_error(path, e)),
    }
}

/// The bytes of a file of a result, which is no link, pipe or device.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let found = match kind(path)? {
        Kind::Link => Err(io::Error::other("is a symbolic link, and none is followed")),
        _ => open_file(path).and_then(|mut file| file.read_to_end(&mut bytes)),
    };
    found.map_err(|e| io_error(path, e))?;
    Ok(bytes)
}

/// The same; nothing where there is none.
pub fn read_if_there(path: &Path) -> Result<Option<Vec<u8>>> {
    match kind(path)? {
        Kind::Nothing => Ok(None),
        _ => read(path).map(Some),
    }
}

/// An error that the user can mend: something is there already.
pub(crate) fn refused(path: &Path, words: impl Into<String>) -> Error {
    io_error(path, io::Error::new(ErrorKind::AlreadyExists, words.into()))
}

/// Makes a directory, and makes sure that files can be written in it.
pub(crate) fn make_ready(dir: &Path) -> Result<()> {
    create(dir)?;
    // an empty file can be made on a disk that is full
    let (mut file, _path) = temporary(dir)?.into_parts();
    file.write_all(&PROBE).map_err(|e| io_error(dir, unwritable(&e)))
}

/// Takes away the temporary files of a writer that was killed. Nobody else may write there meanwhile.
pub fn clean(dir: &Path) -> Result<()> {
    if kind(dir)? != Kind::Folder {
        return Ok(());
    }
    let Ok(entries) = fs::read_dir(dir) else { return Ok(()) };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let own = |rest: &str| rest.len() == RANDOM && rest.bytes().all(|b| b.is_ascii_alphanumeric());
        if name.to_str().and_then(|name| name.strip_prefix(PREFIX)).is_some_and(own)
            && kind(&entry.path())? == Kind::File
        {
            remove(&entry.path())?;
        }
    }
    Ok(())
}

/// Writes files that may be there already, all of them or none. One that is there is replaced if it `may_be`, or by `force`; it is an
/// error ([`ErrorKind::AlreadyExists`]) otherwise, and whatever is no file is.
pub fn replace(dir: &Path, files: &[File], may_be: impl Fn(&File, &[u8]) -> bool, force: bool) -> Result<()> {
    create(dir)?;
    for file in files {
        let path = dir.join(&file.name);
        match kind(&path)? {
            Kind::Nothing => {}
            Kind::File if force || may_be(file, &read(&path)?) => {}
            Kind::File => {
                let words = "is there and is not an earlier one of this file; use --force to replace it, or another place \
                             with --out";
                return Err(refused(&path, words));
            }
            Kind::Link => {
                return Err(refused(&path, "is a symbolic link, and none is followed or replaced: take it away"));
            }
            _ => {
                return Err(refused(
                    &path,
                    "is a folder or a device, where a file is to be; give another place with --out",
                ));
            }
        }
    }
    let staged = files.iter().map(|file| stage(dir, &file.name, &file.bytes)).collect::<Result<Vec<_>>>()?;
    for (file, staged) in files.iter().zip(staged) {
        put(staged, &dir.join(&file.name))?;
    }
    flush_directory(dir)
}

/// Writes one file, whole or not at all, in place of an older one.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<()> {
    let dir = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    create(dir)?;
    if !matches!(kind(path)?, Kind::Nothing | Kind::File) {
        return Err(refused(path, "is a symbolic link, a folder or a device, and is not replaced: take it away"));
    }
    let mut file = temporary(dir)?;
    fill(&mut file, bytes).map_err(|e| io_error(path, e))?;
    put(file.into_temp_path(), path)
}

/// The file under a temporary name, on the disk, and closed: as many may be staged as there are.
pub(crate) fn stage(dir: &Path, name: &str, bytes: &[u8]) -> Result<TempPath> {
    let mut staged = temporary(folder_of(dir, name)?)?;
    fill(&mut staged, bytes).map_err(|e| io_error(&dir.join(name), e))?;
    Ok(staged.into_temp_path())
}

/// The same of a file that is there under another path: by a second name where the file system has those, else by a copy.
pub(crate) fn stage_same(dir: &Path, name: &str, there: &Path) -> Result<TempPath> {
    let second = |path: &Path| fs::hard_link(there, path).or_else(|_| copy(there, path));
    let staged = builder().make_in(folder_of(dir, name)?, second);
    staged.map(NamedTempFile::into_temp_path).map_err(|e| io_error(&dir.join(name), e))
}

fn copy(from: &Path, to: &Path) -> io::Result<()> {
    let mut file = new_file(to)?;
    io::copy(&mut fs::File::open(from)?, &mut file)?;
    file.sync_all()
}

/// The folder of a file of a result, made if it is not there.
fn folder_of(dir: &Path, name: &str) -> Result<std::path::PathBuf> {
    let path = dir.join(name);
    let folder = path.parent().unwrap_or(dir);
    create(folder)?;
    Ok(folder.into())
}

/// Gives a staged file its name.
pub(crate) fn put(staged: TempPath, path: &Path) -> Result<()> {
    staged.persist(path).map_err(|e| io_error(path, e.error))
}

fn fill(file: &mut NamedTempFile, bytes: &[u8]) -> io::Result<()> {
    file.as_file_mut().write_all(bytes)?;
    file.as_file().sync_all()
}

/// A new file that vanishes unless it is given a name; readable by all whom the umask allows.
fn temporary(dir: impl AsRef<Path>) -> Result<NamedTempFile> {
    let dir = dir.as_ref();
    temporary_file(dir).map_err(|e| io_error(dir, unwritable(&e)))
}

pub(crate) fn temporary_file(dir: &Path) -> io::Result<NamedTempFile> {
    builder().make_in(dir, new_file)
}

fn builder() -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).rand_bytes(RANDOM);
    builder
}

fn new_file(path: &Path) -> io::Result<fs::File> {
    OpenOptions::new().read(true).write(true).create_new(true).open(path)
}

fn unwritable(e: &io::Error) -> io::Error {
    io::Error::new(e.kind(), format!("cannot write here: {}", reason(e)))
}

pub(crate) fn create(dir: &Path) -> Result<()> {
    if dir.is_symlink() && !dir.exists() {
        let words = "is a link that leads nowhere, and results need a directory; give another with --out";
        return Err(io_error(dir, io::Error::new(ErrorKind::NotADirectory, words)));
    }
    // the part of the way that is there
    if let Some(file) = dir.ancestors().find(|part| part.exists()).filter(|part| !part.is_dir()) {
        let words = "is a file, and results need a directory; give another with --out";
        return Err(io_error(file, io::Error::new(ErrorKind::NotADirectory, words)));
    }
    fs::create_dir_all(dir).map_err(|e| {
        let words = format!("the directory cannot be made: {}", reason(&e));
        // as under a place that takes no folders
        let kind = if e.kind() == ErrorKind::NotFound { ErrorKind::NotADirectory } else { e.kind() };
        io_error(dir, io::Error::new(kind, words))
    })
}

pub(crate) fn remove(path: &Path) -> Result<()> {
    match fs::remove_file(path) {
        Err(e) if !matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Err(io_error(path, e)),
        _ => Ok(()),
    }
}

/// Makes the new names survive a power cut, where the system can.
pub(crate) fn flush_directory(dir: &Path) -> Result<()> {
    if cfg!(unix) {
        fs::File::open(dir).and_then(|d| d.sync_all()).map_err(|e| io_error(dir, e))?;
    }
    Ok(())
}

/// What the system says, without the path that a temporary file had.
fn reason(e: &io::Error) -> String {
    e.raw_os_error().map_or_else(|| e.kind().to_string(), |code| io::Error::from_raw_os_error(code).to_string())
}

pub(crate) fn io_error(path: &Path, source: io::Error) -> Error {
    Error::Io { path: path.into(), source }
}
