//! One run at a time in a folder: a lock that the system takes away when the process ends, however it ends.

use crate::error::{Error, Result};
use crate::files::disk;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};

/// The file that is locked; it is there only while somebody works in the folder, or after a kill.
const NAME: &str = ".spinneb.lock";
/// What a holder writes into it: the number of its process, and where that is.
const PROCESS: &str = "process ";
const ON: &str = " on ";
/// How often a lock is tried whose file the last holder just took away.
const TRIES: usize = 100;

/// Held until it is dropped.
#[derive(Debug)]
pub struct Lock {
    path: PathBuf,
    file: File,
    sure: bool,
}

impl Lock {
    /// Locks an existing folder. An error ([`ErrorKind::WouldBlock`]) that names the holder where somebody has it.
    pub fn of(directory: &Path) -> Result<Lock> {
        let path = directory.join(NAME);
        let io_error = |source| Error::Io { path: path.clone(), source };
        if !matches!(disk::kind(&path)?, disk::Kind::Nothing | disk::Kind::File) {
            return Err(disk::refused(&path, "is a symbolic link, a folder or a device, and no lock: take it away"));
        }
        for _ in 0..TRIES {
            let mut options = OpenOptions::new();
            let file = options.read(true).write(true).create(true).truncate(false).open(&path).map_err(io_error)?;
            let sure = match file.try_lock() {
                Ok(()) => true,
                Err(TryLockError::WouldBlock) => return Err(held(directory, file)),
                Err(TryLockError::Error(e)) if e.kind() == ErrorKind::Unsupported => false,
                Err(TryLockError::Error(e)) => return Err(io_error(e)),
            };
            if is_still(&file, &path) {
                if !is_signed(&file).map_err(io_error)? {
                    return Err(disk::refused(
                        &path,
                        "has the name of a lock of this program's, and is none: take it away",
                    ));
                }
                let mut lock = Lock { path, file, sure };
                // who holds it is a courtesy to others
                let _ = lock.sign();
                return Ok(lock);
            }
        }
        Err(held(directory, File::open(&path).map_err(io_error)?))
    }

    /// Whether the file of a lock is there, held or left by a kill.
    pub fn is_left(directory: &Path) -> bool {
        directory.join(NAME).exists()
    }

    /// Whether the file system knows locks: where not, nothing keeps another run away.
    pub fn is_sure(&self) -> bool {
        self.sure
    }

    fn sign(&mut self) -> io::Result<()> {
        self.file.set_len(0)?;
        self.file.rewind()?;
        let host = fs::read_to_string("/proc/sys/kernel/hostname").unwrap_or_default();
        let host = host.trim();
        let place = if host.is_empty() { String::new() } else { format!("{ON}{host}") };
        self.file.write_all(format!("{PROCESS}{}{place}", std::process::id()).as_bytes())
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        // first the name, then the lock: who has opened the file meanwhile sees that it has lost its name
        let _ = fs::remove_file(&self.path);
    }
}

/// Whether the path still leads to the file.
#[cfg(unix)]
fn is_still(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let place = |m: io::Result<fs::Metadata>| m.ok().map(|m| (m.dev(), m.ino()));
    let open = place(file.metadata());
    open.is_some() && open == place(fs::symlink_metadata(path))
}

/// An open file keeps its name.
#[cfg(not(unix))]
fn is_still(_: &File, _: &Path) -> bool {
    true
}

/// Whether a file of a lock's name is one that a holder left, or new: whatever else is there is somebody's own.
fn is_signed(mut file: &File) -> io::Result<bool> {
    let mut bytes = Vec::new();
    file.read_to_end(&mut bytes)?;
    let text = String::from_utf8_lossy(&bytes);
    let number = text.strip_prefix(PROCESS).map(|rest| rest.split_once(ON).map_or(rest, |(number, _)| number));
    Ok(text.is_empty() || number.is_some_and(|number| number.parse::<u32>().is_ok()))
}

fn held(directory: &Path, mut file: File) -> Error {
    let mut who = String::new();
    let _ = file.read_to_string(&mut who);
    let who = if who.is_empty() { "another run".to_string() } else { format!("another run ({who})") };
    let words = format!("{who} is at work in this directory: wait for it, or give another with --out");
    Error::Io { path: directory.into(), source: io::Error::new(ErrorKind::WouldBlock, words) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_locked_once_and_free_again_afterwards() {
        let folder = tempfile::tempdir().unwrap();
        let first = Lock::of(folder.path()).unwrap();
        assert!(first.is_sure());
        let Err(Error::Io { source, .. }) = Lock::of(folder.path()) else { panic!("locked twice") };
        assert_eq!(source.kind(), ErrorKind::WouldBlock);
        let me = format!("another run (process {}", std::process::id());
        assert!(source.to_string().starts_with(&me), "{source}");
        drop(first);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
        // a file that a killed run left is no lock
        fs::write(folder.path().join(NAME), "process 1").unwrap();
        Lock::of(folder.path()).unwrap();
    }

    #[test]
    fn a_file_of_somebody_with_the_name_of_a_lock_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(NAME);
        for own in ["work of years", "process of 1929", "process "] {
            fs::write(&path, own).unwrap();
            let Err(Error::Io { source, .. }) = Lock::of(folder.path()) else { panic!("locked {own:?}") };
            assert_eq!(source.kind(), ErrorKind::AlreadyExists);
            assert_eq!(fs::read_to_string(&path).unwrap(), own);
        }
        for left in ["", "process 12", "process 12 on a host"] {
            fs::write(&path, left).unwrap();
            Lock::of(folder.path()).unwrap();
        }
    }

    #[test]
    #[cfg(unix)]
    fn a_lock_that_is_a_link_is_refused_and_what_it_leads_to_stays_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let [precious, nothing] = ["precious", "nothing"].map(|name| folder.path().join(name));
        fs::write(&precious, "work of years").unwrap();
        for target in [&precious, &nothing] {
            std::os::unix::fs::symlink(target, folder.path().join(NAME)).unwrap();
            let Err(Error::Io { source, .. }) = Lock::of(folder.path()) else { panic!("locked through a link") };
            assert_eq!(source.kind(), ErrorKind::AlreadyExists);
            fs::remove_file(folder.path().join(NAME)).unwrap();
        }
        assert_eq!(fs::read_to_string(&precious).unwrap(), "work of years");
        assert!(!nothing.exists());
    }

    #[test]
    fn of_many_at_once_one_has_the_lock_at_any_time() {
        let folder = tempfile::tempdir().unwrap();
        let (inside, got) = (std::sync::atomic::AtomicUsize::new(0), std::sync::atomic::AtomicUsize::new(0));
        use std::sync::atomic::Ordering::SeqCst;
        std::thread::scope(|scope| {
            for _ in 0..8 {
                scope.spawn(|| {
                    for _ in 0..200 {
                        let Ok(lock) = Lock::of(folder.path()) else { continue };
                        assert_eq!(inside.fetch_add(1, SeqCst), 0);
                        std::thread::yield_now();
                        inside.fetch_sub(1, SeqCst);
                        got.fetch_add(1, SeqCst);
                        drop(lock);
                    }
                });
            }
        });
        assert!(got.load(SeqCst) > 0);
        Lock::of(folder.path()).unwrap();
    }
}
