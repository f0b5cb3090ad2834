//! What belongs to a result: the manifest at the end of its `summary.json`.
//!
//! ```text
//! "manifest": {
//!   "source": "/home/me/wall.json",      the config that was run (canonical path); null where there was no file
//!   "earlier_of": null,                  in NAME.1, kept when NAME was run anew: NAME
//!   "summary_sha256": "…",               of summary.json itself, but for this manifest, work.seconds and work.threads
//!   "files": {"config.json": "…", …}     SHA-256 of every other file
//! }
//! ```
//! Only files that it names, and that still have these hashes, are the program's to replace or to take away.

use super::disk::{self, MARK};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use serde_json::Value;
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Component, Path};

/// How the manifest begins in a summary, whose last key it is.
const START: &str = ",\n  \"manifest\": {";

/// The files of a result.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// The config that was run, nothing where it was no file.
    pub source: Option<String>,
    /// The folder whose earlier result this is.
    pub earlier_of: Option<String>,
    /// Hash of what `summary.json` says beside this.
    pub summary_sha256: String,
    /// Hashes of the other files.
    pub files: BTreeMap<String, String>,
}

impl Manifest {
    /// Whether all names are of files in the folder, or in a folder of it.
    pub fn is_plain(&self) -> bool {
        self.files.keys().all(|name| is_plain(name))
    }

    /// The hash of every file, the summary's among them.
    pub fn hashes(&self) -> impl Iterator<Item = (&str, &str)> {
        let mark = (MARK, self.summary_sha256.as_str());
        self.files.iter().map(|(name, hash)| (name.as_str(), hash.as_str())).chain([mark])
    }

    /// A summary with this as its manifest, in the place of one that it has.
    pub fn put_into(&self, summary: &[u8]) -> Result<Vec<u8>> {
        let wrong = |e: serde_json::Error| Error::Numerical(format!("{MARK}: {e}"));
        let text = String::from_utf8_lossy(summary);
        let body = match text.find(START) {
            Some(at) => &text[..at],
            None => text.trim_end().strip_suffix('}').unwrap_or(&text).trim_end(),
        };
        let own = serde_json::to_string_pretty(self).map_err(wrong)?.replace('\n', "\n  ");
        Ok(format!("{body},\n  \"manifest\": {own}\n}}\n").into_bytes())
    }
}

/// Whether a name stays in its folder.
pub fn is_plain(name: &str) -> bool {
    let parts = || Path::new(name).components();
    !name.contains('\\')
        && parts().all(|part| matches!(part, Component::Normal(_)))
        && (1..=2).contains(&parts().count())
}

/// The hash by which a file of this name is known.
pub fn hash(name: &str, bytes: &[u8]) -> String {
    match name {
        MARK => summary_hash(bytes).unwrap_or_else(|| sha256(bytes)),
        _ => sha256(bytes),
    }
}

/// SHA-256 in hexadecimal.
fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The hash of a summary without its manifest, time and threads; nothing where it is no summary.
fn summary_hash(bytes: &[u8]) -> Option<String> {
    let mut summary: Value = serde_json::from_slice(bytes).ok()?;
    summary.as_object_mut()?.remove("manifest");
    if let Some(work) = summary.get_mut("work").and_then(Value::as_object_mut) {
        work.retain(|key, _| key != "seconds" && key != "threads");
    }
    serde_json::to_vec(&summary).ok().map(|text| sha256(&text))
}

/// What of a folder's files is the program's: names, each with the hashes that the file may have.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Owned {
    /// The folder whose earlier result they are to be.
    pub earlier_of: Option<String>,
    /// The names.
    pub files: BTreeMap<String, BTreeSet<String>>,
}

/// What has the name of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum There {
    /// Nothing.
    Nothing,
    /// A file that the program wrote, as it wrote it.
    Own,
    /// A file of somebody else, or one that was changed.
    Foreign,
    /// What no file may replace, in words.
    InTheWay(&'static str),
}

impl Owned {
    /// Adds files with their hashes.
    pub fn add<'a>(&mut self, files: impl IntoIterator<Item = (&'a str, &'a str)>) {
        for (name, hash) in files {
            self.files.entry(name.into()).or_default().insert(hash.into());
        }
    }

    /// What has this name in the folder.
    pub fn look(&self, dir: &Path, name: &str) -> Result<There> {
        if let Some((folder, _)) = name.split_once('/') {
            match disk::kind(&dir.join(folder))? {
                disk::Kind::Nothing => return Ok(There::Nothing),
                disk::Kind::Folder => {}
                disk::Kind::Link => return Ok(There::InTheWay("its folder is a symbolic link, and none is followed")),
                _ => return Ok(There::InTheWay("what should be its folder is a file")),
            }
        }
        let path = dir.join(name);
        Ok(match disk::kind(&path)? {
            disk::Kind::Nothing => There::Nothing,
            disk::Kind::Link => There::InTheWay("is a symbolic link, and none is followed or replaced"),
            disk::Kind::Folder => There::InTheWay("is a folder, where a file is to be"),
            disk::Kind::Other => There::InTheWay("is a pipe or a device, where a file is to be"),
            disk::Kind::File => match self.files.get(name) {
                Some(hashes) if hashes.contains(&hash(name, &disk::read(&path)?)) => There::Own,
                _ => There::Foreign,
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUMMARY: &str =
        "{\n  \"name\": \"a\",\n  \"x\": 1e-13,\n  \"work\": {\n    \"seconds\": 1.5,\n    \"threads\": 2\n  }\n}\n";

    #[test]
    fn a_manifest_is_the_last_key_of_a_summary_and_gives_way_to_another() {
        let manifest = |source: &str| Manifest {
            source: Some(source.into()),
            summary_sha256: hash(MARK, SUMMARY.as_bytes()),
            files: [("path.csv".to_string(), "12".to_string())].into(),
            ..Manifest::default()
        };
        let once = manifest("a").put_into(SUMMARY.as_bytes()).unwrap();
        assert!(once.starts_with(&SUMMARY.as_bytes()[..SUMMARY.len() - 3]));
        let twice = manifest("b").put_into(&once).unwrap();
        assert_eq!(twice, manifest("b").put_into(SUMMARY.as_bytes()).unwrap());
        let read: Value = serde_json::from_slice(&twice).unwrap();
        assert_eq!(serde_json::from_value::<Manifest>(read["manifest"].clone()).unwrap(), manifest("b"));
        assert_eq!(hash(MARK, &twice), manifest("b").summary_sha256);
        let slower = SUMMARY.replace("1.5", "2.5");
        assert_eq!(hash(MARK, slower.as_bytes()), manifest("b").summary_sha256);
        assert_ne!(hash(MARK, SUMMARY.replace("1e-13", "2e-13").as_bytes()), manifest("b").summary_sha256);
    }

    #[test]
    fn a_name_that_leaves_the_folder_is_none_of_a_result() {
        assert!(["path.csv", "inputs/initial.npy"].iter().all(|name| is_plain(name)));
        let bad = ["", ".", "..", "../a", "/etc/passwd", "a/../../b", "a/b/c", "./a/../b", "a\\b"];
        assert!(bad.iter().all(|name| !is_plain(name)));
    }
}
