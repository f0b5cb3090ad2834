//! Files of a result, read back.

use super::columns::WAY_OUT;
use super::disk;
use crate::error::{Error, Result};
use crate::files;
use crate::geometry::Vector;
use crate::lattice::Lattice;
use crate::spins::Spins;
use std::path::Path;

/// A file of a result, as it is named to the user.
pub(super) fn shown(dir: &Path, name: &str) -> String {
    dir.join(name).display().to_string()
}

/// A file's text; nothing where there is no such file.
pub(super) fn text(dir: &Path, name: &str) -> Result<Option<String>> {
    let Some(bytes) = bytes(dir, name)? else { return Ok(None) };
    let no_text = |_| Error::invalid(shown(dir, name), format!("is no text: {WAY_OUT}"));
    String::from_utf8(bytes).map(Some).map_err(no_text)
}

pub(super) fn bytes(dir: &Path, name: &str) -> Result<Option<Vec<u8>>> {
    disk::read_if_there(&dir.join(name))
}

/// The states in a file of spins of a lattice.
pub(super) fn read_spins(dir: &Path, name: &str, bytes: &[u8], lattice: &Lattice) -> Result<Vec<Spins>> {
    let file = shown(dir, name);
    let found = files::read(&file, bytes)?;
    // the reader's vectors are of unit length already
    let state = |image: &Vec<Vector>| found.placed(image, lattice).map(|m| Spins::from_unit_vectors(&m));
    found.images.iter().map(state).collect::<Result<_>>().map_err(|e| e.within(&file))
}
