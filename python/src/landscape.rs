//! A landscape as its files tell it.

use crate::errors::raised;
use crate::handing::{dictionary, save};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spinneb::config::Loaded;
use spinneb::files::disk::File;
use std::path::PathBuf;
use std::sync::Arc;

/// Minima and saddles, in files.
#[pyclass(frozen, module = "spinneb._core")]
pub struct Landscape {
    pub loaded: Arc<Loaded>,
    pub files: Vec<File>,
}

#[pymethods]
impl Landscape {
    /// Its files by name.
    fn files<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dictionary(py, &self.files)
    }

    /// Writes them to a folder.
    fn save(&self, py: Python, dir: PathBuf, force: bool) -> PyResult<()> {
        let (loaded, files) = (self.loaded.clone(), &self.files);
        py.detach(|| save(&loaded, dir, &loaded.survey_file_names(), force, files)).map_err(|e| raised(py, e))
    }
}
