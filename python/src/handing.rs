//! What a config's results are handed over as: files by name, a folder of them, places of sites.

use crate::buffer::Buffer;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use spinneb::config::{Loaded, discard_leftovers};
use spinneb::error::Error;
use spinneb::files::disk::File;
use spinneb::output::folder::{self, NewResult};
use spinneb::record::Lock;
use std::path::PathBuf;
use std::sync::Arc;

/// Files by name.
pub fn dictionary<'py>(py: Python<'py>, files: &[File]) -> PyResult<Bound<'py, PyDict>> {
    let all = PyDict::new(py);
    for file in files {
        all.set_item(&file.name, PyBytes::new(py, &file.bytes))?;
    }
    Ok(all)
}

/// Where the files of a config go, with the care of the command line for what is there.
pub struct Place {
    pub dir: PathBuf,
    pub force: bool,
    /// Nobody else writes there.
    _lock: Option<Lock>,
}

impl Place {
    /// Takes the folder; an error where files of these names cannot be written.
    pub fn take(loaded: &Loaded, dir: PathBuf, names: &[String], force: bool) -> Result<Place, Error> {
        let lock = loaded.reserve(&dir, names, force)?;
        if lock.is_some() {
            return Ok(Place { dir, force, _lock: lock });
        }
        // a result of the same config, perhaps with other files, or other functions of its own terms
        let lock = loaded.reserve(&dir, names, true)?;
        Ok(Place { dir, force: true, _lock: lock })
    }

    /// Puts files there in the place of what is.
    pub fn write(&self, loaded: &Loaded, files: &[File]) -> Result<(), Error> {
        let source = loaded.source_name();
        let new = NewResult { files, source: source.as_deref(), keep_earlier: !self.force, force: self.force };
        folder::write_result(&self.dir, &new).map(|_| ())
    }
}

/// Puts files where the config's results go.
pub fn save(loaded: &Loaded, dir: PathBuf, names: &[String], force: bool, files: &[File]) -> Result<(), Error> {
    let place = Place::take(loaded, dir, names, force)?;
    place.write(loaded, files)?;
    discard_leftovers(&place.dir)
}

/// Which sites of a config have no spin.
pub fn vacant(loaded: &Loaded) -> Vec<bool> {
    (0..loaded.lattice.sites).map(|i| loaded.lattice.vacant[i]).collect()
}

/// Places of the sites of a config.
pub fn places(loaded: &Loaded) -> Buffer {
    let lattice = &loaded.lattice;
    let all: Vec<[f64; 3]> = (0..lattice.sites).map(|i| lattice.place(i)).collect();
    let components: Vec<f64> = (0..3).flat_map(|c| all.iter().map(move |r| r[c])).collect();
    Buffer::spins(&Arc::new(components), |numbers: &Vec<f64>| numbers, None)
}
