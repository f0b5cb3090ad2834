//! What a config's results are handed over as: files by name, a folder of them, places of sites.

use crate::buffer::Buffer;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use spinneb::config::{Loaded, discard_leftovers};
use spinneb::error::Error;
use spinneb::files::disk::File;
use spinneb::output::folder::{self, NewResult};
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

/// Puts files where the config's results go, with the care of the command line for what is there.
pub fn save(loaded: &Loaded, dir: PathBuf, names: &[String], force: bool, files: &[File]) -> Result<(), Error> {
    let mut force = force;
    let _lock = match loaded.reserve(&dir, names, force)? {
        Some(lock) => lock,
        None => {
            // a result of the same config, perhaps with other files, or other functions of its own terms
            force = true;
            let Some(lock) = loaded.reserve(&dir, names, force)? else { return Ok(()) };
            lock
        }
    };
    let source = loaded.source_name();
    let new = NewResult { files, source: source.as_deref(), keep_earlier: !force, force };
    folder::write_result(&dir, &new)?;
    discard_leftovers(&dir)
}

/// Places of the sites of a config.
pub fn places(loaded: &Loaded) -> Buffer {
    let lattice = &loaded.lattice;
    let all: Vec<[f64; 3]> = (0..lattice.sites).map(|i| lattice.place(i)).collect();
    let components: Vec<f64> = (0..3).flat_map(|c| all.iter().map(move |r| r[c])).collect();
    Buffer::spins(&Arc::new(components), |numbers: &Vec<f64>| numbers, None)
}
