//! The record of a run on the disk, so that the run survives whatever ends it.
//!
//! ```text
//! checkpoint/journal             who recorded, then a frame for each finished computation: grows at its end
//! checkpoint/snapshot            who recorded, then the state of the relaxation in progress: replaced as a whole
//! checkpoint/snapshot.previous   the one before it
//! ```
//! Written at intervals only; what a kill in the middle of a write leaves at the journal's end is no whole frame and is dropped.
//! A snapshot counts only behind just as many finished computations as it says.

use super::Keep;
use super::frame::{self, Frames, HEAD};
use crate::error::{Error, Result};
use crate::files::disk;
use crc32fast::Hasher;
use serde::{Deserialize, Serialize};
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufReader, BufWriter, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The folder of a checkpoint in that of the result.
pub const FOLDER: &str = "checkpoint";
const JOURNAL: &str = "journal";
const SNAPSHOT: &str = "snapshot";
const PREVIOUS: &str = "snapshot.previous";
/// So many bytes waiting to be written are written before it is time to (a chain of a million spins has large records).
const MOST_WAITING: usize = 1 << 28;

/// Who records: only the same config, version and build of the program can go on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Identity {
    /// Version of the program.
    pub version: String,
    /// Hash of the config as run.
    pub config_sha256: String,
    /// CRC-32 of the program itself, to tell builds apart; 0 where that cannot be read.
    pub program_crc32: u32,
}

impl Identity {
    /// Of the running program with a config.
    pub fn of(version: &str, config_sha256: &str) -> Identity {
        let program_crc32 = program().unwrap_or_default();
        Identity { version: version.into(), config_sha256: config_sha256.into(), program_crc32 }
    }

    /// What another one was, if it was another.
    pub(super) fn differs(&self, other: &Identity) -> Option<String> {
        if self.config_sha256 != other.config_sha256 {
            Some("another config".into())
        } else if self.version != other.version {
            Some(format!("version {} (this is {})", other.version, self.version))
        } else {
            (self != other).then(|| format!("another build of version {}", self.version))
        }
    }
}

/// The frames of a file behind the first, and who recorded it, which that one tells.
type Begun<'f> = (Frames<BufReader<&'f File>>, Identity);

/// Reads who recorded a journal or a snapshot; nothing where that cannot be read.
fn begun(file: &File) -> io::Result<Option<Begun<'_>>> {
    let size = file.metadata()?.len();
    let Some(mut frames) = Frames::of(BufReader::with_capacity(1 << 16, file), size)? else { return Ok(None) };
    let identity = frames.next_frame()?.and_then(|json| serde_json::from_slice(&json).ok());
    Ok(identity.map(|identity| (frames, identity)))
}

/// The library of another program that this code is in, such as Python's, if it is in one and the system tells.
fn library() -> Option<PathBuf> {
    let here = library as *const () as usize;
    let maps = fs::read("/proc/self/maps").ok()?;
    // begin-end permissions offset device inode path
    let holds = |line: &&str| {
        let range = line.split_once(' ').and_then(|(range, _)| range.split_once('-'));
        let [begin, end] = range.map_or([None; 2], |(a, b)| [a, b].map(|x| usize::from_str_radix(x, 16).ok()));
        begin.zip(end).is_some_and(|(begin, end)| (begin..end).contains(&here))
    };
    let maps = String::from_utf8_lossy(&maps);
    let path = maps.lines().find(holds).and_then(|line| line.find('/').map(|k| PathBuf::from(&line[k..])))?;
    (path != fs::read_link("/proc/self/exe").ok()?).then_some(path)
}

/// Check value of the running program, or of the library that it is, also where the program's file has been replaced meanwhile.
fn program() -> io::Result<u32> {
    let running = Path::new("/proc/self/exe");
    let path = match library() {
        Some(path) => path,
        None if running.exists() => running.into(),
        None => std::env::current_exe()?,
    };
    let mut hash = Hasher::new();
    let mut file = File::open(path)?;
    let mut some = vec![0; 1 << 20];
    loop {
        match file.read(&mut some)? {
            0 => break,
            n => hash.update(&some[..n]),
        }
    }
    Ok(hash.finalize())
}

/// The checkpoint of a run.
pub struct Checkpoint {
    folder: PathBuf,
    version: String,
    config_sha256: String,
    identity: Option<Identity>,
    interval: Duration,
    saved: Instant,
    say: Box<dyn FnMut(&str) + Send>,
    journal: Option<File>,
    /// Where the frames of the finished computations are in the journal, and their ends.
    frames: Vec<(u64, u64)>,
    /// Where the first of them begins.
    start: u64,
    waiting: Vec<Vec<u8>>,
    underway: Option<(u64, Vec<u8>)>,
    previous_is_good: bool,
    in_trouble: bool,
    gave_up: bool,
}

impl Checkpoint {
    /// Records into the folder of a result every `interval`; what is there of an earlier run gives way at the first time.
    /// `say` is told what the user should know.
    pub fn new(
        directory: &Path,
        version: &str,
        config_sha256: &str,
        interval: Duration,
        say: Box<dyn FnMut(&str) + Send>,
    ) -> Checkpoint {
        Checkpoint {
            folder: directory.join(FOLDER),
            version: version.into(),
            config_sha256: config_sha256.into(),
            identity: None,
            interval,
            saved: Instant::now(),
            say,
            journal: None,
            frames: Vec::new(),
            start: 0,
            waiting: Vec::new(),
            underway: None,
            previous_is_good: false,
            in_trouble: false,
            gave_up: false,
        }
    }

    /// Whether the folder of a result has a checkpoint.
    pub fn exists(directory: &Path) -> bool {
        directory.join(FOLDER).join(JOURNAL).is_file()
    }

    /// Whether anything of a checkpoint is there.
    pub fn is_left(directory: &Path) -> bool {
        directory.join(FOLDER).exists()
    }

    /// Makes sure that what has the name of a checkpoint in the folder of a result is one, if perhaps a damaged one, or nothing; with
    /// `force` any files of the names of its own will do.
    pub fn check(directory: &Path, force: bool) -> Result<()> {
        let folder = directory.join(FOLDER);
        let in_the_way = |path: &Path| Err(disk::refused(path, "is in the way of a checkpoint: take it away"));
        match disk::kind(&folder)? {
            disk::Kind::Nothing => return Ok(()),
            disk::Kind::Folder => {}
            _ => return in_the_way(&folder),
        }
        let mut files = Vec::new();
        for path in [JOURNAL, SNAPSHOT, PREVIOUS].map(|name| folder.join(name)) {
            match disk::kind(&path)? {
                disk::Kind::Nothing => {}
                disk::Kind::File => files.push(path),
                _ => return in_the_way(&path),
            }
        }
        let mut own = files.is_empty() || force;
        for path in &files {
            // a power cut leaves empty files
            own |= frame::is_begun(path).map_err(|source| Error::Io { path: path.clone(), source })?;
        }
        match (own, files.first()) {
            (false, Some(first)) => {
                let words = "is there and is no checkpoint: take it away, use --force to replace it, or give another \
                             directory with --out";
                Err(disk::refused(first, words))
            }
            _ => Ok(()),
        }
    }

    /// Takes a checkpoint away, if there is one.
    pub fn discard(directory: &Path) -> Result<()> {
        Checkpoint::check(directory, false)?;
        let folder = directory.join(FOLDER);
        for name in [SNAPSHOT, PREVIOUS, JOURNAL] {
            disk::remove(&folder.join(name))?;
        }
        disk::clean(&folder)?;
        // with something else in it, it stays
        let _ = fs::remove_dir(&folder);
        Ok(())
    }

    /// Goes on from what the folder has. A checkpoint of another config, version or build is an error
    /// ([`ErrorKind::AlreadyExists`]); one that is damaged is used as far as it is whole.
    pub fn resume(mut self) -> Result<Checkpoint> {
        let path = self.folder.join(JOURNAL);
        let Some(file) = self.there()? else {
            (self.say)("no checkpoint to go on from: starting anew");
            return Ok(self);
        };
        let Some(found) = self.scan(&file).map_err(|source| Error::Io { path: path.clone(), source })? else {
            (self.say)(&format!("{} is damaged and cannot be used: starting anew", path.display()));
            return Ok(self);
        };
        self.refuse_other(&found)?;
        self.journal = Some(file);
        self.read_snapshots();
        Ok(self)
    }

    /// Begins anew in the place of what the folder has, of which only this run's own gives way: a checkpoint of another config, version or
    /// build is an error as it is for [`resume`](Self::resume).
    pub fn anew(mut self) -> Result<Checkpoint> {
        if let Some(file) = self.there()? {
            let unreadable = |source| Error::Io { path: self.folder.join(JOURNAL), source };
            if let Some((_, found)) = begun(&file).map_err(unreadable)? {
                self.refuse_other(&found)?;
                (self.say)("starting anew; --resume would have gone on from the checkpoint that is there");
            }
        }
        Ok(self)
    }

    /// The journal that is there.
    fn there(&self) -> Result<Option<File>> {
        let path = self.folder.join(JOURNAL);
        match OpenOptions::new().read(true).write(true).open(&path) {
            Ok(file) => Ok(Some(file)),
            Err(e) if matches!(e.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => Ok(None),
            Err(source) => Err(Error::Io { path, source }),
        }
    }

    fn refuse_other(&mut self, found: &Identity) -> Result<()> {
        let Some(other) = self.identity().differs(found) else { return Ok(()) };
        let words = format!(
            "is the checkpoint of {other}, from which this run cannot go on: --force starts anew and replaces it, or give another \
             directory with --out"
        );
        Err(Error::Io { path: self.folder.clone(), source: io::Error::new(ErrorKind::AlreadyExists, words) })
    }

    /// How many finished computations there are to go on from.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether there is nothing to go on from.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty() && self.underway.is_none()
    }

    fn identity(&mut self) -> &Identity {
        let (version, config) = (&self.version, &self.config_sha256);
        self.identity.get_or_insert_with(|| Identity::of(version, config))
    }

    /// Finds the whole frames of a journal; who recorded it.
    fn scan(&mut self, file: &File) -> io::Result<Option<Identity>> {
        let Some((mut frames, identity)) = begun(file)? else { return Ok(None) };
        self.start = frames.end;
        let mut begin = frames.end;
        while frames.next_frame()?.is_some() {
            self.frames.push((begin, frames.end));
            begin = frames.end;
        }
        if frames.has_rest() {
            (self.say)(&format!("the end of {} is damaged and left out", self.folder.join(JOURNAL).display()));
        }
        Ok(Some(identity))
    }

    /// The newest snapshot that is whole and of this run.
    fn read_snapshots(&mut self) {
        let mut damaged = false;
        for name in [SNAPSHOT, PREVIOUS] {
            let path = self.folder.join(name);
            match self.read_snapshot(&path) {
                Ok(Some(found)) => {
                    self.previous_is_good = name == SNAPSHOT;
                    if damaged {
                        (self.say)(&format!("going on from the one before it, {}", path.display()));
                    }
                    self.underway = Some(found);
                    return;
                }
                Ok(None) => {
                    damaged = true;
                    (self.say)(&format!("{} is damaged and not used", path.display()));
                }
                Err(e) if e.kind() == ErrorKind::NotFound => {}
                Err(e) => (self.say)(&format!("{} cannot be read: {e}", path.display())),
            }
        }
    }

    fn read_snapshot(&mut self, path: &Path) -> io::Result<Option<(u64, Vec<u8>)>> {
        let file = File::open(path)?;
        let Some((mut frames, identity)) = begun(&file)? else { return Ok(None) };
        if identity != *self.identity() {
            return Ok(None);
        }
        let (Some(place), Some(state)) = (frames.next_frame()?, frames.next_frame()?) else { return Ok(None) };
        let place = place.try_into().map(u64::from_le_bytes).ok();
        Ok(place.map(|place| (place, state)))
    }

    /// Everything that waits, and the state of the relaxation behind `k` finished computations, onto the disk.
    fn write(&mut self, k: usize, underway: Option<Vec<u8>>) -> io::Result<()> {
        if self.journal.is_none() {
            self.begin()?;
        }
        if let Some(journal) = &mut self.journal
            && !self.waiting.is_empty()
        {
            let mut end = self.frames.last().map_or(self.start, |frame| frame.1);
            // what was not written to its end, or is of no use any more
            journal.set_len(end)?;
            journal.seek(SeekFrom::Start(end))?;
            let mut out = BufWriter::with_capacity(1 << 16, &*journal);
            let mut ends = Vec::new();
            for record in &self.waiting {
                frame::write(&mut out, record)?;
                ends.push((end, end + HEAD + record.len() as u64));
                end += HEAD + record.len() as u64;
            }
            out.flush()?;
            drop(out);
            journal.sync_data()?;
            self.frames.extend(ends);
            self.waiting.clear();
        }
        match underway {
            Some(state) => self.write_snapshot(k, &state),
            None => Ok(()),
        }
    }

    /// A journal without computations, in the place of whatever was there.
    fn begin(&mut self) -> io::Result<()> {
        fs::create_dir_all(&self.folder)?;
        for name in [SNAPSHOT, PREVIOUS] {
            match fs::remove_file(self.folder.join(name)) {
                Err(e) if e.kind() != ErrorKind::NotFound => return Err(e),
                _ => {}
            }
        }
        self.previous_is_good = false;
        let head = self.head()?;
        self.start = head.len() as u64;
        let file = self.replace(JOURNAL, &head)?;
        self.journal = Some(file);
        Ok(())
    }

    /// How a file of this run begins.
    fn head(&mut self) -> io::Result<Vec<u8>> {
        let mut head = Vec::new();
        frame::begin(&mut head)?;
        let identity = serde_json::to_vec(self.identity())?;
        frame::write(&mut head, &identity)?;
        Ok(head)
    }

    fn write_snapshot(&mut self, k: usize, state: &[u8]) -> io::Result<()> {
        let mut bytes = self.head()?;
        frame::write(&mut bytes, &(k as u64).to_le_bytes())?;
        frame::write(&mut bytes, state)?;
        if self.previous_is_good {
            fs::rename(self.folder.join(SNAPSHOT), self.folder.join(PREVIOUS))?;
        }
        self.previous_is_good = false;
        self.replace(SNAPSHOT, &bytes)?;
        self.previous_is_good = true;
        Ok(())
    }

    /// A file, whole or not at all.
    fn replace(&self, name: &str, bytes: &[u8]) -> io::Result<File> {
        let mut file = disk::temporary_file(&self.folder)?;
        file.as_file_mut().write_all(bytes)?;
        file.as_file().sync_data()?;
        Ok(file.persist(self.folder.join(name))?)
    }

    fn waiting_bytes(&self) -> usize {
        self.waiting.iter().map(Vec::len).sum()
    }

    fn read_frame(&mut self, k: usize) -> io::Result<Option<Vec<u8>>> {
        let (Some(&(begin, end)), Some(journal)) = (self.frames.get(k), &mut self.journal) else { return Ok(None) };
        journal.seek(SeekFrom::Start(begin + HEAD))?;
        let mut record = vec![0; usize::try_from(end - begin - HEAD).map_err(io::Error::other)?];
        journal.read_exact(&mut record)?;
        Ok(Some(record))
    }
}

impl Keep for Checkpoint {
    fn finished(&mut self, k: usize) -> Option<Vec<u8>> {
        match self.read_frame(k) {
            Ok(record) => record,
            Err(e) => {
                (self.say)(&format!("{} cannot be read: {e}", self.folder.join(JOURNAL).display()));
                None
            }
        }
    }

    fn underway(&mut self, k: usize) -> Option<Vec<u8>> {
        self.underway.take_if(|(place, _)| *place == k as u64).map(|(_, state)| state)
    }

    fn add(&mut self, k: usize, record: Vec<u8>) {
        if self.gave_up {
            return;
        }
        if k < self.frames.len() {
            (self.say)("the checkpoint does not fit from here on; the rest is computed anew");
            self.frames.truncate(k);
        }
        self.waiting.truncate(k - self.frames.len());
        self.waiting.push(record);
    }

    fn is_due(&mut self) -> bool {
        let many = self.waiting_bytes() > MOST_WAITING && !self.in_trouble;
        !self.gave_up && (many || self.saved.elapsed() >= self.interval)
    }

    /// A run does not end because its checkpoint cannot be written: that is said once, and tried again the next time.
    fn save(&mut self, k: usize, underway: Option<Vec<u8>>) {
        if self.gave_up {
            return;
        }
        match self.write(k, underway) {
            Ok(()) if self.in_trouble => {
                self.in_trouble = false;
                (self.say)("the checkpoint could be written again");
            }
            Ok(()) => {}
            Err(e) if !self.in_trouble => {
                self.in_trouble = true;
                let place = self.folder.display();
                (self.say)(&format!("{place}: the checkpoint cannot be written: {e}; the run goes on without"));
            }
            Err(_) => {
                // memory is for the run itself
                self.gave_up = self.waiting_bytes() > 2 * MOST_WAITING;
            }
        }
        if self.gave_up {
            self.waiting.clear();
        }
        self.saved = Instant::now();
    }
}
