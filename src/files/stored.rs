//! A file as a config names it: read once, known by its hash.

use super::{Images, npy, read};
use crate::error::{Error, Result};
use crate::geometry::Vector;
use crate::lattice::Lattice;
use crate::words::quoted;
use sha2::{Digest, Sha256};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use std::sync::Arc;

/// Largest file that is read (bytes).
pub const LARGEST_FILE: u64 = 16 << 30;

/// What a file holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Stored {
    /// The file as messages name it.
    pub file: String,
    /// Its images.
    pub content: Images,
}

/// Reads the file `named`, looked for in `folder`. If a hash is given the file must have it.
pub fn open(folder: &Path, named: &str, sha256: Option<&str>) -> Result<Arc<Stored>> {
    let path = folder.join(named);
    let file = path.display().to_string();
    let bytes = bytes(&path).map_err(|e| {
        let message = match e.kind() {
            io::ErrorKind::NotFound => format!("there is no file {file}"),
            _ => format!("the file {file} cannot be read: {e}"),
        };
        Error::invalid("path", message)
    })?;
    if let Some(wanted) = sha256 {
        let found = sha256_of(&bytes);
        if !found.eq_ignore_ascii_case(wanted) {
            let message =
                format!("the file {file} has the hash {found}: it is not the one this config was written for");
            return Err(Error::invalid("sha256", message));
        }
    }
    let content = read(&file, &bytes).map_err(|e| e.within("path"))?;
    Ok(Arc::new(Stored { file, content }))
}

/// Opens what is a file indeed: to open a pipe would wait for a writer, and a device may have no end.
pub fn open_file(path: &Path) -> io::Result<File> {
    let kind = fs::metadata(path)?.file_type();
    let wrong = match kind {
        _ if kind.is_file() => return File::open(path),
        _ if kind.is_dir() => "it is a folder, not a file",
        _ => "it is a pipe or a device, not a file",
    };
    Err(io::Error::new(io::ErrorKind::InvalidInput, wrong))
}

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_file(path)?.take(LARGEST_FILE + 1).read_to_end(&mut bytes)?;
    match bytes.len() as u64 > LARGEST_FILE {
        true => Err(io::Error::new(io::ErrorKind::FileTooLarge, "it is larger than 16 GiB")),
        false => Ok(bytes),
    }
}

/// SHA-256 in hexadecimal.
fn sha256_of(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

impl Stored {
    /// The image to take: the only one, or the one counted from 0, or from the end if negative.
    pub fn image(&self, segment: Option<i64>) -> Result<&[Vector]> {
        let images = &self.content.images;
        let count = images.len();
        let Some(segment) = segment else {
            return match count {
                1 => Ok(&images[0]),
                _ => Err(Error::invalid(
                    "path",
                    format!(
                        "{} holds {count} images: say which one with \"segment\", 0 to {} (or -1 for the last)",
                        self.file,
                        count - 1
                    ),
                )),
            };
        };
        let index = if segment < 0 { segment.checked_add(count as i64) } else { Some(segment) };
        let chosen = index.and_then(|i| usize::try_from(i).ok()).and_then(|i| images.get(i));
        chosen.map(Vec::as_slice).ok_or_else(|| {
            let which = if count == 1 { "one image, 0".into() } else { format!("images 0 to {}", count - 1) };
            Error::invalid("segment", format!("found {segment}, but {} holds {which}", quoted(&self.file)))
        })
    }

    /// One of its images for the sites of a lattice.
    pub fn placed(&self, image: &[Vector], lattice: &Lattice) -> Result<Vec<Vector>> {
        let named = |e: Error| match e {
            Error::Invalid { message, .. } => Error::invalid("path", format!("{} {message}", self.file)),
            other => other,
        };
        self.content.placed(image, lattice).map_err(named)
    }

    /// The same with all its images for the sites of a lattice.
    pub fn on(&self, lattice: &Lattice) -> Result<Arc<Stored>> {
        let placed = self.content.images.iter().map(|image| self.placed(image, lattice));
        let images = placed.collect::<Result<_>>()?;
        let content = Images { images, warnings: self.content.warnings.clone(), ..Images::default() };
        Ok(Arc::new(Stored { file: self.file.clone(), content }))
    }

    /// These images as the bytes of an npy file, and its hash: what a config is stored with.
    pub fn portable(images: &[Vec<Vector>], single: bool) -> (Vec<u8>, String) {
        let sites = images.first().map_or(0, Vec::len);
        let numbers = images.iter().flatten().flatten().copied().collect();
        let shape = if single { vec![sites, 3] } else { vec![images.len(), sites, 3] };
        let bytes = npy::write_npy(&npy::Array { shape, numbers });
        let hash = sha256_of(&bytes);
        (bytes, hash)
    }
}
