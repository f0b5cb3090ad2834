//! The record of a run that several processes make together, on a disk that all of them see.
//!
//! ```text
//! shares/about.json      who may take part: the same config, version and build, so many shares; where the config is
//! shares/12              call 12, made by any process
//! shares/13.4            part 4 of call 13
//! shares/done            the run is at its end: all calls are there
//! ```
//! All processes make the same calls in the same order; those of many things alike are in parts, and each process makes its own. What
//! does not come in time is made by whoever waits for it, to the same bytes, so that it does not matter who is there and who is not.

use super::checkpoint::Identity;
use super::frame::{self, Frames};
use super::{Keep, Share};
use crate::error::Result;
use crate::files::disk::{self, io_error};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::fs;
use std::io::Write;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The folder in that of the result.
const FOLDER: &str = "shares";
const ABOUT: &str = "about.json";
const DONE: &str = "done";

/// Who takes part.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ShareHead {
    /// Program and config.
    pub identity: Identity,
    /// How many shares.
    pub shares: usize,
    /// The config's file.
    pub config: PathBuf,
    /// What of it is changed first.
    pub set: Vec<String>,
}

impl ShareHead {
    /// The one in the folder of a result; nothing if there are no shares.
    pub fn read(directory: &Path) -> Result<Option<ShareHead>> {
        let path = directory.join(FOLDER).join(ABOUT);
        let Some(bytes) = disk::read_if_there(&path)? else { return Ok(None) };
        let wrong = |_| disk::refused(&path, "is no list of shares, or a damaged one: take the folder away");
        serde_json::from_slice(&bytes).map(Some).map_err(wrong)
    }

    /// An error where another one does not belong to the same run.
    fn fit(&self, other: &ShareHead, folder: &Path) -> Result<()> {
        let of = match self.identity.differs(&other.identity) {
            Some(other) => other,
            None if self.shares != other.shares => {
                format!("a run in {} shares (this is one of {})", other.shares, self.shares)
            }
            None => return Ok(()),
        };
        let words = format!("is of {of}: give another directory with --out, or take the folder away");
        Err(disk::refused(folder, words))
    }
}

/// The record, as one of the processes sees it.
pub struct Shares {
    folder: PathBuf,
    parts: usize,
    own: Option<RangeInclusive<usize>>,
    late: BTreeSet<usize>,
    fault: Option<String>,
    in_trouble: bool,
    say: Box<dyn FnMut(&str) + Send>,
}

impl Shares {
    /// In the folder of a result, made there if it is the first. This process is to make the shares `own`, or none. `say` is told what
    /// the user should know.
    pub fn join(
        directory: &Path,
        head: &ShareHead,
        own: Option<RangeInclusive<usize>>,
        say: Box<dyn FnMut(&str) + Send>,
    ) -> Result<Shares> {
        let folder = directory.join(FOLDER);
        let io = |source| io_error(&folder, source);
        match disk::kind(&folder)? {
            disk::Kind::Nothing | disk::Kind::Folder => {}
            _ => return Err(disk::refused(&folder, "is in the way of shares: take it away")),
        }
        fs::create_dir_all(&folder).map_err(io)?;
        if ShareHead::read(directory)?.is_none() {
            foreign(&folder)?;
            let mut file = disk::temporary_file(&folder).map_err(io)?;
            let json = serde_json::to_vec_pretty(head).map_err(|e| io(e.into()))?;
            file.as_file_mut().write_all(&json).map_err(io)?;
            // another process may be as quick
            let _ = file.persist_noclobber(folder.join(ABOUT));
        }
        let there = ShareHead::read(directory)?;
        let there = there.ok_or_else(|| disk::refused(&folder, "has no list of shares, and none can be written"))?;
        head.fit(&there, &folder)?;
        foreign(&folder)?;
        Ok(Shares { folder, parts: head.shares, own, late: BTreeSet::new(), fault: None, in_trouble: false, say })
    }

    /// Whether the run in the folder of a result is at its end.
    pub fn are_done(directory: &Path) -> bool {
        directory.join(FOLDER).join(DONE).is_file()
    }

    /// Says that the run is at its end.
    pub fn end(directory: &Path) -> Result<()> {
        let path = directory.join(FOLDER).join(DONE);
        let mut bytes = Vec::new();
        frame::begin(&mut bytes).map_err(|source| io_error(&path, source))?;
        disk::write_file(&path, &bytes)
    }

    /// Takes the shares in the folder of a result away, if there are any.
    pub fn discard(directory: &Path) -> Result<()> {
        let folder = directory.join(FOLDER);
        if ShareHead::read(directory)?.is_none() {
            return Ok(());
        }
        for path in own_files(&folder)? {
            if is_share(&path)? {
                disk::remove(&path)?;
            }
        }
        disk::remove(&folder.join(ABOUT))?;
        disk::clean(&folder)?;
        // with something else in it, it stays
        let _ = fs::remove_dir(&folder);
        Ok(())
    }

    fn read(&mut self, name: &str) -> Option<Vec<u8>> {
        let path = self.folder.join(name);
        let bytes = disk::read_if_there(&path).ok()??;
        let frame = Frames::of(&bytes[..], bytes.len() as u64).ok()??.next_frame().ok()?;
        if frame.is_none() {
            (self.say)(&format!("{} is damaged and made anew", path.display()));
        }
        frame
    }

    fn write(&mut self, name: &str, record: &[u8]) {
        if let Some(there) = self.read(name) {
            if there != record {
                self.fault.get_or_insert(format!(
                    "{} does not hold what is computed here: let machines of one kind share the folder; if it was changed, take it away",
                    self.folder.join(name).display()
                ));
            }
            return;
        }
        let written = (|| {
            let mut file = disk::temporary_file(&self.folder)?;
            frame::begin(&mut file)?;
            frame::write(&mut file, record)?;
            file.persist(self.folder.join(name)).map_err(|e| e.error)
        })();
        match written {
            Ok(_) => self.in_trouble = false,
            Err(e) if !self.in_trouble => {
                self.in_trouble = true;
                (self.say)(&format!("{}: a share cannot be written: {e}", self.folder.display()));
            }
            Err(_) => {}
        }
    }
}

/// Files of the names of shares, in no order.
fn own_files(folder: &Path) -> Result<Vec<PathBuf>> {
    let io = |source| io_error(folder, source);
    let is_own =
        |name: &str| name == DONE || name.split('.').all(|n| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).map_err(io)? {
        let entry = entry.map_err(io)?;
        if entry.file_name().to_str().is_some_and(is_own) {
            files.push(entry.path());
        }
    }
    Ok(files)
}

/// Whether what has the name of a share is one.
fn is_share(path: &Path) -> Result<bool> {
    let begun = || frame::is_begun(path).map_err(|source| io_error(path, source));
    Ok(matches!(disk::kind(path)?, disk::Kind::File) && begun()?)
}

/// An error where a file has the name of a share and is none.
fn foreign(folder: &Path) -> Result<()> {
    for path in own_files(folder)? {
        if !is_share(&path)? {
            return Err(disk::refused(
                &path,
                "is there and is no share: take it away, or give another directory with --out",
            ));
        }
    }
    Ok(())
}

impl Keep for Shares {
    fn finished(&mut self, k: usize) -> Option<Vec<u8>> {
        self.read(&k.to_string())
    }

    fn underway(&mut self, _: usize) -> Option<Vec<u8>> {
        None
    }

    fn add(&mut self, k: usize, record: Vec<u8>) {
        self.write(&k.to_string(), &record);
    }

    fn is_due(&mut self) -> bool {
        false
    }

    fn save(&mut self, _: usize, _: Option<Vec<u8>>) {}

    fn share(&mut self) -> Option<&mut dyn Share> {
        Some(self)
    }
}

impl Share for Shares {
    fn parts(&self) -> usize {
        self.parts
    }

    fn is_mine(&self, part: usize) -> bool {
        self.own.as_ref().is_some_and(|own| own.contains(&part))
    }

    fn is_late(&self, part: usize) -> bool {
        self.own.is_none() || self.late.contains(&part)
    }

    fn part(&mut self, k: usize, part: usize) -> Option<Vec<u8>> {
        let found = self.read(&format!("{k}.{part}"))?;
        self.late.remove(&part);
        Some(found)
    }

    fn add_part(&mut self, k: usize, part: usize, record: Vec<u8>) {
        if !self.is_mine(part) {
            self.late.insert(part);
        }
        self.write(&format!("{k}.{part}"), &record);
    }

    fn fault(&self) -> Option<String> {
        self.fault.clone()
    }
}
