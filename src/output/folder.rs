//! The folder of a result: what may be written, replaced and taken away there, and in which order.
//!
//! ```text
//! 1  all new files are staged under temporary names
//! 2  an earlier result of the same source, if it is to be kept, is put into NAME.1 in just this way; it stays in NAME until then
//! 3  .spinneb.writing names the old files and the new ones with their hashes
//! 4  the old summary.json is taken away, then the old files that the new result does not have
//! 5  the new files take their names, summary.json last
//! 6  .spinneb.writing is taken away
//! ```
//! So wherever it is killed, there is a whole result in NAME or, from step 4 to 5, none; the earlier one is whole in NAME or NAME.1;
//! and what lies about is known to be the program's, from the manifest of `summary.json` or from `.spinneb.writing`.

use super::disk::{self, File, Kind, MARK, io_error, refused};
use super::head::Head;
use super::manifest::{Manifest, Owned, There, hash};
use crate::error::{Error, Result};
use crate::record::Lock;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::TempPath;

/// Which files are the program's while they are written.
const NOTE: &str = ".spinneb.writing";

/// A finished result, as its `summary.json` tells.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(expecting = "the summary of a result")]
pub struct StoredResult {
    /// Which it is.
    #[serde(flatten)]
    pub head: Head,
    /// Its files; nothing of version 0.1.0.
    pub manifest: Option<Manifest>,
}

impl StoredResult {
    /// The exit code of the run that wrote it: 0 converged and certified, 3 otherwise.
    pub fn exit_code(&self) -> u8 {
        if self.head.is_proven() { 0 } else { 3 }
    }

    fn is_from(&self, source: Option<&str>) -> bool {
        source.is_some() && self.manifest.as_ref().is_some_and(|m| m.source.as_deref() == source)
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

/// What a run is about to write.
#[derive(Clone, Copy, Debug)]
pub struct Intent<'a> {
    /// Version of the program.
    pub version: &'a str,
    /// Hash of the config.
    pub config_sha256: &'a str,
    /// The config's canonical path; nothing where it is no file, or where an earlier result is not to give way.
    pub source: Option<&'a str>,
    /// Names of its files; one that ends in `/` is a folder of images.
    pub names: &'a [String],
    /// Those of its files that are known before the work.
    pub known: &'a [File],
    /// The files that it is made from, canonical: they are never replaced.
    pub made_from: &'a [PathBuf],
    /// Replace whatever is there.
    pub force: bool,
}

/// A result to write: its files, `summary.json` among them, and what is to happen with one that is there.
#[derive(Clone, Copy, Debug)]
pub struct NewResult<'a> {
    /// All files.
    pub files: &'a [File],
    /// The config's canonical path.
    pub source: Option<&'a str>,
    /// Keep a result that is there as the earlier one.
    pub keep_earlier: bool,
    /// Replace files of others too.
    pub force: bool,
}

/// Makes `dir` ready for the result of a config: creates it, makes sure that files can be written and that none of somebody else is
/// in the way, and looks for an existing result. What is in the way is an error ([`io::ErrorKind::AlreadyExists`]).
pub fn prepare(dir: &Path, intent: &Intent) -> Result<Destination> {
    disk::create(dir)?;
    let folder = Folder::open(dir)?;
    if !intent.force {
        folder.refuse_damage(|_| true, "; use --force to replace it, or another directory with --out")?;
        match &folder.stored {
            Some(s) if s.head.version == intent.version && s.head.config_sha256 == intent.config_sha256 => {
                return Ok(Destination::Finished(s.clone()));
            }
            Some(stored) if stored.is_from(intent.source) => folder.earlier()?.spare(intent.made_from, &[], &[])?,
            Some(stored) => return Err(folder.occupied(stored, intent)),
            None => {}
        }
    }
    for name in intent.names {
        folder.free(name, intent.known, intent.force)?;
    }
    folder.spare(intent.made_from, intent.names, intent.known)?;
    disk::make_ready(dir)?;
    Ok(Destination::Ready)
}

/// The finished result in `dir`, if there is one. A damaged one is an error; only files whose names `matter` can show that.
pub fn stored_result(dir: &Path, matter: impl Fn(&str) -> bool) -> Result<Option<StoredResult>> {
    let folder = Folder::open(dir)?;
    folder.refuse_damage(
        matter,
        &format!("; `spinneb run` on its config with --force and --out {} writes it anew", dir.display()),
    )?;
    Ok(folder.stored)
}

/// Makes sure that nobody else's files have these names of a result.
pub fn are_free(dir: &Path, names: &[String]) -> Result<()> {
    let folder = Folder::open(dir)?;
    names.iter().try_for_each(|name| folder.free(name, &[], false))
}

/// Where an earlier result is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// The folder.
    pub place: PathBuf,
    /// It held a still earlier one, which is gone.
    pub another_gave_way: bool,
}

/// Writes a result in the place of the one that is there; where that is kept, if it is.
pub fn write_result(dir: &Path, new: &NewResult) -> Result<Option<Kept>> {
    disk::create(dir)?;
    let folder = Folder::open(dir)?;
    let others = || new.files.iter().filter(|file| file.name != MARK);
    for file in new.files {
        folder.free(&file.name, new.files, new.force)?;
    }
    let mut contents: Vec<Content> = others().map(|file| Content::of(&file.name, &file.bytes)).collect();
    let summary = new.files.iter().find(|file| file.name == MARK).map_or(&b"{}"[..], |file| &file.bytes);
    let manifest = Manifest {
        source: new.source.map(String::from),
        earlier_of: None,
        summary_sha256: hash(MARK, summary),
        files: contents.iter().map(|c| (c.name.to_string(), c.hash.clone())).collect(),
    };
    let summary = manifest.put_into(summary)?;
    contents.push(Content::of(MARK, &summary));
    let staged = folder.stage(contents)?;
    let kept = match new.keep_earlier && folder.stored.is_some() {
        true => Some(folder.keep()?),
        false => None,
    };
    folder.put(staged, None)?;
    Ok(kept)
}

/// Adds files to the result in a folder, or to a folder without one. A file that is there is replaced if the result has it and
/// nobody changed it (where there is no result, if it `may_be`), or by `force`; it is an error otherwise.
pub fn add(dir: &Path, files: &[File], may_be: impl Fn(&File, &[u8]) -> bool, force: bool) -> Result<()> {
    disk::create(dir)?;
    let folder = Folder::open(dir)?;
    let Some(mut manifest) = folder.stored.as_ref().and_then(|stored| stored.manifest.clone()) else {
        return disk::replace(dir, files, may_be, force);
    };
    let _lock = Lock::of(dir)?;
    for file in files {
        folder.free(&file.name, &[], force)?;
    }
    let mut contents: Vec<Content> = files.iter().map(|file| Content::of(&file.name, &file.bytes)).collect();
    manifest.files.extend(contents.iter().map(|c| (c.name.to_string(), c.hash.clone())));
    let summary = manifest.put_into(&disk::read(&dir.join(MARK))?)?;
    contents.push(Content::of(MARK, &summary));
    let staged = folder.stage(contents)?;
    folder.note(&staged, manifest.earlier_of)?;
    folder.name(staged)
}

/// Whether a writer left its note there, and takes it away. Nobody else may write there meanwhile.
pub fn discard_note(dir: &Path) -> Result<()> {
    match disk::kind(&dir.join(NOTE))? {
        Kind::File => read_note(dir).and_then(|_| disk::remove(&dir.join(NOTE))),
        _ => Ok(()),
    }
}

/// What the note of a writer says, if there is one; whatever else has its name is an error.
fn read_note(dir: &Path) -> Result<Owned> {
    let path = dir.join(NOTE);
    match disk::kind(&path)? {
        Kind::Nothing => Ok(Owned::default()),
        Kind::File => match disk::read(&path)? {
            // a power cut may leave it empty
            bytes if bytes.is_empty() => Ok(Owned::default()),
            bytes => serde_json::from_slice(&bytes)
                .map_err(|_| refused(&path, "has the name of a note of this program's, and is none: take it away")),
        },
        _ => Err(refused(&path, "is a symbolic link, a folder or a device: take it away")),
    }
}

/// Whether a writer that was killed left its note.
pub fn is_note_left(dir: &Path) -> bool {
    dir.join(NOTE).exists()
}

/// What is in a folder.
struct Folder {
    dir: PathBuf,
    owned: Owned,
    stored: Option<StoredResult>,
    /// Why the result that is there cannot be read.
    unreadable: Option<String>,
}

/// A file to stage.
struct Content<'a> {
    name: &'a str,
    hash: String,
    bytes: Bytes<'a>,
}

enum Bytes<'a> {
    These(&'a [u8]),
    /// Those of a file that is there.
    Of(PathBuf),
}

impl<'a> Content<'a> {
    fn of(name: &'a str, bytes: &'a [u8]) -> Content<'a> {
        Content { name, hash: hash(name, bytes), bytes: Bytes::These(bytes) }
    }
}

struct Staged {
    name: String,
    hash: String,
    file: TempPath,
}

impl Folder {
    fn open(dir: &Path) -> Result<Folder> {
        let mut folder = Folder { dir: dir.into(), owned: read_note(dir)?, stored: None, unreadable: None };
        let path = dir.join(MARK);
        match disk::kind(&path)? {
            Kind::Nothing => {}
            Kind::File => match serde_json::from_slice::<StoredResult>(&disk::read(&path)?) {
                Ok(stored) if stored.manifest.as_ref().is_none_or(Manifest::is_plain) => {
                    folder.owned.add(stored.manifest.iter().flat_map(Manifest::hashes));
                    folder.stored = Some(stored);
                }
                Ok(_) => folder.unreadable = Some(format!("{MARK} names files outside its folder")),
                Err(e) => folder.unreadable = Some(format!("{MARK} is not a whole result ({e})")),
            },
            _ => folder.unreadable = Some(format!("{MARK} is a symbolic link, a folder or a device")),
        }
        Ok(folder)
    }

    /// An error where the result that is there is not as it was written.
    fn refuse_damage(&self, matter: impl Fn(&str) -> bool, way_out: &str) -> Result<()> {
        let mut changed = Vec::new();
        for (name, _) in self.stored.iter().filter_map(|s| s.manifest.as_ref()).flat_map(Manifest::hashes) {
            if matter(name) && !matches!(self.owned.look(&self.dir, name)?, There::Nothing | There::Own) {
                changed.push(name);
            }
        }
        let words = match (&self.unreadable, &changed[..]) {
            (Some(words), _) => words.clone(),
            (None, []) => return Ok(()),
            (None, [one]) => format!("{one} is not as the run wrote it (its hash is not that of the manifest)"),
            (None, [one, more @ ..]) => format!(
                "{one} and {} more are not as the run wrote them (their hashes are not those of the manifest)",
                more.len()
            ),
        };
        Err(refused(&self.dir, format!("the result here is damaged: {words}{way_out}")))
    }

    fn occupied(&self, stored: &StoredResult, intent: &Intent) -> Error {
        let what = if stored.head.config_sha256 == intent.config_sha256 {
            format!("of this config by version {} (this is {})", stored.head.version, intent.version)
        } else {
            "of another config".to_string()
        };
        refused(&self.dir, format!("holds a result {what}; use --force to replace it, or another directory with --out"))
    }

    /// An error unless a file of the result may have this name: nothing else has it, or it is the program's own, or one of the very
    /// bytes that are `known` to be written; a name that ends in `/` is that of a folder of images.
    fn free(&self, name: &str, known: &[File], force: bool) -> Result<()> {
        if let Some(folder) = name.strip_suffix('/') {
            let images = self.images(folder)?;
            return images.iter().try_for_each(|image| self.free(image, known, force));
        }
        let path = self.dir.join(name);
        match self.owned.look(&self.dir, name)? {
            There::Nothing | There::Own => Ok(()),
            There::Foreign if force || is_known(known, name, &path)? => Ok(()),
            There::Foreign => {
                let words = "is there, was not written by an earlier run or was changed since, and the result would replace \
                             it: take it away, use --force to replace it, or give another directory with --out";
                Err(refused(&path, words))
            }
            There::InTheWay(words) => {
                Err(refused(&path, format!("{words}: take it away, or give another directory with --out")))
            }
        }
    }

    /// What in a folder has the name of an image, or would be in the way of one.
    fn images(&self, folder: &str) -> Result<Vec<String>> {
        let path = self.dir.join(folder);
        if disk::kind(&path)? != Kind::Folder {
            return Ok(vec![format!("{folder}/image_000")]);
        }
        let entries = fs::read_dir(&path).map_err(|e| io_error(&path, e))?;
        let names = entries.flatten().map(|entry| entry.file_name().to_string_lossy().into_owned());
        Ok(names.filter(|name| name.starts_with("image_")).map(|name| format!("{folder}/{name}")).collect())
    }

    /// An error where one of the files that a run is made from would be replaced, or taken away with an earlier result.
    fn spare(&self, made_from: &[PathBuf], names: &[String], known: &[File]) -> Result<()> {
        let Ok(here) = fs::canonicalize(&self.dir) else { return Ok(()) };
        for file in made_from {
            let Some(name) = file.strip_prefix(&here).ok().and_then(Path::to_str) else { continue };
            let in_folder = |n: &String| n.ends_with('/') && name.starts_with(n.as_str());
            let touched = names.iter().any(|n| n == name || in_folder(n)) || self.owned.files.contains_key(name);
            if touched && !is_known(known, name, file)? {
                let words = "this run is made from this file, and its result would replace it, even with --force: copy it to \
                             another place, or give another directory with --out";
                return Err(refused(&self.dir.join(name), words));
            }
        }
        Ok(())
    }

    /// The folder for the earlier result, NAME.1; an error where that is anybody else's.
    fn earlier(&self) -> Result<Folder> {
        let (path, name) = beside(&self.dir)?;
        let foreign = |words: &str| {
            let words = format!(
                "{words}; the result in {} is to be kept here: take this away, use --force to replace that result without \
                 keeping it, or give another directory with --out",
                self.dir.display()
            );
            Err(refused(&path, words))
        };
        match disk::kind(&path)? {
            Kind::Nothing | Kind::Folder => {}
            Kind::Link => return foreign("is a symbolic link, and none is followed"),
            _ => return foreign("is no folder"),
        }
        let folder = Folder::open(&path)?;
        let marked = folder.stored.as_ref().and_then(|s| s.manifest.as_ref()?.earlier_of.clone());
        if marked.as_ref() != Some(&name) && folder.owned.earlier_of.as_ref() != Some(&name) && !is_empty(&path)? {
            return foreign(&format!("is not the earlier result of {name} that a run keeps"));
        }
        let files = self.stored.iter().filter_map(|s| s.manifest.as_ref()).flat_map(Manifest::hashes);
        files.into_iter().try_for_each(|(name, _)| folder.free(name, &[], false))?;
        Ok(folder)
    }

    /// Keeps the result that is here as the earlier one; where.
    fn keep(&self) -> Result<Kept> {
        let (path, name) = beside(&self.dir)?;
        let Some(mut manifest) = self.stored.as_ref().and_then(|s| s.manifest.clone()) else {
            return Ok(Kept { place: path, another_gave_way: false });
        };
        self.earlier()?;
        disk::create(&path)?;
        let _lock = Lock::of(&path)?;
        let target = self.earlier()?;
        disk::clean(&path)?;
        // from here on the folder is known to be meant for this
        target.note(&[], Some(name.clone()))?;
        for name in manifest.files.keys().cloned().collect::<Vec<_>>() {
            // what somebody took away cannot be kept
            if self.owned.look(&self.dir, &name)? != There::Own {
                manifest.files.remove(&name);
            }
        }
        manifest.earlier_of = Some(name.clone());
        let summary = manifest.put_into(&disk::read(&self.dir.join(MARK))?)?;
        let same = |(name, hash)| Content { name, hash: String::clone(hash), bytes: Bytes::Of(self.dir.join(name)) };
        let contents = manifest.files.iter().map(|(name, hash)| (name.as_str(), hash)).map(same);
        let staged = target.stage(contents.chain([Content::of(MARK, &summary)]).collect())?;
        let another_gave_way = target.stored.is_some();
        target.put(staged, Some(name))?;
        Ok(Kept { place: path, another_gave_way })
    }

    fn stage(&self, contents: Vec<Content>) -> Result<Vec<Staged>> {
        let stage = |content: Content| {
            let file = match &content.bytes {
                Bytes::These(bytes) => disk::stage(&self.dir, content.name, bytes)?,
                Bytes::Of(there) => disk::stage_same(&self.dir, content.name, there)?,
            };
            Ok(Staged { name: content.name.into(), hash: content.hash, file })
        };
        contents.into_iter().map(stage).collect()
    }

    /// Notes whose the files are that are here, and those to come.
    fn note(&self, staged: &[Staged], earlier_of: Option<String>) -> Result<()> {
        let mut note = Owned { earlier_of, ..self.owned.clone() };
        note.add(staged.iter().map(|s| (s.name.as_str(), s.hash.as_str())));
        let bytes = serde_json::to_vec(&note).map_err(|e| Error::Numerical(e.to_string()))?;
        disk::write_file(&self.dir.join(NOTE), &bytes)?;
        disk::flush_directory(&self.dir)
    }

    /// The staged files in the place of what is here.
    fn put(&self, staged: Vec<Staged>, earlier_of: Option<String>) -> Result<()> {
        self.note(&staged, earlier_of)?;
        disk::remove(&self.dir.join(MARK))?;
        let mut emptied = BTreeSet::new();
        for name in self.owned.files.keys().filter(|name| staged.iter().all(|s| s.name != **name)) {
            if self.owned.look(&self.dir, name)? == There::Own {
                disk::remove(&self.dir.join(name))?;
                emptied.extend(name.split_once('/').map(|(folder, _)| folder));
            }
        }
        for folder in emptied {
            // with something in it, it stays
            let _ = fs::remove_dir(self.dir.join(folder));
        }
        self.name(staged)
    }

    /// Gives staged files their names, `summary.json` last; the note has done its work then.
    fn name(&self, staged: Vec<Staged>) -> Result<()> {
        let (marks, others): (Vec<Staged>, Vec<Staged>) = staged.into_iter().partition(|s| s.name == MARK);
        for part in [others, marks] {
            for Staged { name, file, .. } in part {
                disk::put(file, &self.dir.join(name))?;
            }
            disk::flush_directory(&self.dir)?;
        }
        disk::remove(&self.dir.join(NOTE))
    }
}

/// Whether a file has the very bytes that are to be written.
fn is_known(known: &[File], name: &str, path: &Path) -> Result<bool> {
    match known.iter().find(|file| file.name == name) {
        Some(file) if name != MARK => Ok(disk::read(path)? == file.bytes),
        _ => Ok(false),
    }
}

/// Whether nothing is in a folder but what a writer left that was killed as it began.
fn is_empty(dir: &Path) -> Result<bool> {
    if disk::kind(dir)? == Kind::Nothing {
        return Ok(true);
    }
    let entries = fs::read_dir(dir).map_err(|e| io_error(dir, e))?;
    Ok(entries.flatten().all(|entry| entry.file_name().to_string_lossy().starts_with(".spinneb")))
}

/// The folder for the earlier result, beside that of the result, and the name of that.
fn beside(dir: &Path) -> Result<(PathBuf, String)> {
    let whole = match dir.file_name() {
        Some(_) => dir.to_path_buf(),
        None => fs::canonicalize(dir).map_err(|e| io_error(dir, e))?,
    };
    let Some(name) = whole.file_name().map(|name| name.to_string_lossy().into_owned()) else {
        return Err(io_error(
            dir,
            io::Error::other("an earlier result cannot be kept beside this folder: it has no name"),
        ));
    };
    Ok((whole.with_file_name(format!("{name}.1")), name))
}
