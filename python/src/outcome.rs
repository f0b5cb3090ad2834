//! What a run has found.

use crate::buffer::Buffer;
use crate::errors::{failed, raised};
use crate::handing::{dictionary, places, save, vacant};
use crate::supervise::{ONE, supervised};
use crate::term::Trouble;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spinneb::config::{Loaded, OutputConfig, RatesConfig, Source, Text};
use spinneb::drive;
use spinneb::error::Error;
use spinneb::files::disk::File;
use spinneb::output::{Certainty, Format, Group, KINDS, ReportPage, StoredOutcome, SummaryJson, render_files};
use std::path::PathBuf;
use std::sync::Arc;

/// A finished run.
#[pyclass(frozen, module = "spinneb._core")]
pub struct Outcome {
    loaded: Arc<Loaded>,
    found: Arc<drive::Outcome>,
    trouble: Trouble,
}

impl Outcome {
    pub fn new(loaded: Arc<Loaded>, found: drive::Outcome, trouble: Trouble) -> Outcome {
        Outcome { loaded, found: Arc::new(found), trouble }
    }

    /// The topological charge of each image of a film or crystal.
    fn charge(&self) -> Option<Vec<f64>> {
        let path = &self.found.path;
        self.loaded.lattice.triangles().charges((0..path.images()).map(|k| path.image(k)))
    }

    /// Renders something of the report, on threads of its own.
    fn rendered<T: Send + 'static>(
        &self,
        py: Python,
        render: impl FnOnce(&Loaded, &drive::Outcome) -> Result<T, Error> + Send + 'static,
    ) -> PyResult<T> {
        let (loaded, found) = (self.loaded.clone(), self.found.clone());
        supervised(py, None, None, &self.trouble, move |_| render(&loaded, &found))
    }
}

/// What the files of a result in a folder tell.
#[pyfunction]
pub fn read(py: Python, dir: PathBuf) -> PyResult<Outcome> {
    let trouble = Trouble::default();
    let (loaded, stored) = supervised(py, ONE, None, &trouble, move |_| {
        let loaded = Source::file(&dir.join("config.json"))?.load()?;
        let stored = StoredOutcome::read(&dir, &loaded.lattice)?;
        Ok((loaded, stored))
    })?;
    let found = stored.map_err(|why| failed(py, why))?.outcome;
    Ok(Outcome::new(Arc::new(loaded), found, trouble))
}

#[pymethods]
impl Outcome {
    /// The text of summary.json.
    fn summary(&self, py: Python) -> PyResult<String> {
        let bytes = self.rendered(py, |loaded, found| SummaryJson.render(&loaded.report(found)?))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The report, a page for a browser.
    fn html(&self, py: Python) -> PyResult<String> {
        let bytes = self.rendered(py, |loaded, found| ReportPage.render(&loaded.report(found)?))?;
        Ok(String::from_utf8_lossy(&bytes).into_owned())
    }

    /// The config as run.
    #[getter]
    fn json(&self) -> &str {
        &self.loaded.as_run
    }

    /// Sites as (site, xyz) in lattice constants.
    #[getter]
    fn places(&self) -> Buffer {
        places(&self.loaded)
    }

    /// A lattice constant in nm, if it is known.
    #[getter]
    fn spacing_nm(&self) -> Option<f64> {
        self.loaded.lattice.spacing_nm
    }

    /// Which sites have no spin.
    #[getter]
    fn vacant(&self) -> Vec<bool> {
        vacant(&self.loaded)
    }

    /// The path as (image, site, xyz).
    #[getter]
    fn spins(&self) -> Buffer {
        Buffer::spins(&self.found, |found| found.path.as_slice(), Some(self.found.path.images()))
    }

    /// The saddles, each as (site, xyz).
    #[getter]
    fn saddles(&self) -> Vec<Buffer> {
        let all = 0..self.found.saddles.len();
        all.map(|k| Buffer::spins(&self.found, |found| found.saddles[k].spins.as_slice(), None)).collect()
    }

    /// The minima between the ends, each as (site, xyz).
    #[getter]
    fn minima(&self) -> Vec<Buffer> {
        let all = 0..self.found.intermediate_minima.len();
        all.map(|k| Buffer::spins(&self.found, |found| found.intermediate_minima[k].spins.as_slice(), None)).collect()
    }

    /// A column of path.csv, by name.
    fn column(&self, name: &str) -> Option<Buffer> {
        let images = |pick: fn(&drive::Outcome) -> &[f64]| Some(Buffer::row(&self.found, pick));
        match name {
            "energies_meV" => images(|found| &found.images.energy_mev),
            "above_initial_meV" => images(|found| &found.images.above_initial_mev),
            "reaction_coordinate_rad" => images(|found| &found.images.reaction_coordinate_rad),
            "max_perpendicular_torque_meV" => images(|found| &found.images.max_perpendicular_torque_mev),
            "charge" => self.charge().map(|charge| Buffer::row(&Arc::new(charge), |charge| charge)),
            _ => None,
        }
    }

    /// The barrier in words, with the digits that are known.
    fn words(&self) -> String {
        Certainty::of(&self.found).barrier_words(self.found.barrier)
    }

    /// An energy of the path (meV) with the digits that are known.
    fn told(&self, mev: f64) -> String {
        Certainty::of(&self.found).number(mev, 1.0, 4)
    }

    /// What must be said beside every figure.
    #[getter]
    fn notes(&self) -> Vec<String> {
        Certainty::of(&self.found).notes()
    }

    /// The energy of each term along the path (meV).
    #[getter]
    fn terms(&self) -> Vec<(String, Buffer)> {
        let terms = self.found.images.terms_mev.iter();
        terms.map(|(name, mev)| (name.clone(), Buffer::row(&Arc::new(mev.clone()), |mev| mev))).collect()
    }

    /// The interpolated energy path: reaction coordinate (rad) and energy above the initial state (meV).
    #[getter]
    fn profile(&self) -> [Buffer; 2] {
        let column = |of: fn(&drive::ProfilePoint) -> f64| {
            let numbers: Vec<f64> = self.found.profile.iter().map(of).collect();
            Buffer::row(&Arc::new(numbers), |numbers: &Vec<f64>| numbers)
        };
        [column(|point| point.reaction_coordinate_rad), column(|point| point.above_initial_mev)]
    }

    /// Files by name: those that the config asks for, or those of these kinds.
    fn files<'py>(&self, py: Python<'py>, kinds: Option<Vec<String>>) -> PyResult<Bound<'py, PyDict>> {
        let files = self.rendered(py, move |loaded, found| wanted(loaded, found, kinds))?;
        dictionary(py, &files)
    }

    /// Writes the files to a folder.
    fn save(&self, py: Python, dir: PathBuf, kinds: Option<Vec<String>>, force: bool) -> PyResult<()> {
        self.rendered(py, move |loaded, found| {
            let loaded = asking_for(loaded, kinds)?;
            save(&loaded, dir, &loaded.file_names(), force, &loaded.files(found)?)
        })
    }

    /// The same with rates, which are asked for in the JSON of a config.
    fn with_rates(&self, py: Python, json: String) -> PyResult<Outcome> {
        let mut rates: RatesConfig = Text::new("", json.clone()).parse().map_err(|e| raised(py, e.within("rates")))?;
        let (mut loaded, found) = ((*self.loaded).clone(), self.found.clone());
        if let Some(earlier) = loaded.config.rates.take() {
            rates = left_open(&json, rates, earlier);
        }
        loaded.config.rates = Some(rates);
        let own = loaded.clone();
        let done = supervised(py, None, None, &self.trouble, move |ways| {
            let mut problem = own.problem()?;
            problem.control.obey(ways.switch.clone());
            let found = drive::Outcome::clone(&found);
            let minima = found.minima();
            Ok(found.with_rates(&problem, &minima, &own.warnings))
        })?;
        let found = done.map_err(|why| failed(py, why))?;
        Ok(Outcome { loaded: Arc::new(loaded), found: Arc::new(found), trouble: self.trouble.clone() })
    }
}

/// What was asked for, and where that leaves a key open what was asked for before.
fn left_open(json: &str, asked: RatesConfig, earlier: RatesConfig) -> RatesConfig {
    let keys: serde_json::Value = serde_json::from_str(json).unwrap_or_default();
    let said = |key: &str| keys.get(key).is_some();
    RatesConfig {
        damping: if said("damping") { asked.damping } else { earlier.damping },
        g_factor: if said("g_factor") { asked.g_factor } else { earlier.g_factor },
        theory: if said("theory") { asked.theory } else { earlier.theory },
        temperatures: asked.temperatures,
    }
}

/// The config, asking for files of these kinds.
fn asking_for(loaded: &Loaded, kinds: Option<Vec<String>>) -> Result<Loaded, Error> {
    let mut loaded = loaded.clone();
    if let Some(kinds) = kinds {
        let (plots, formats) = kinds.into_iter().partition(|kind| is_plot(kind));
        let known: Vec<&str> = KINDS.iter().filter(|kind| kind.group != Group::Always).map(|kind| kind.name).collect();
        let unknown = |list: &Vec<String>| list.iter().find(|kind| !known.contains(&kind.as_str())).cloned();
        if let Some(kind) = unknown(&formats) {
            return Err(Error::invalid(
                "formats",
                format!("unknown kind {kind:?} (known kinds: {})", known.join(", ")),
            ));
        }
        loaded.config.output = OutputConfig { formats, plots, ..loaded.config.output };
    }
    Ok(loaded)
}

fn is_plot(name: &str) -> bool {
    KINDS.iter().any(|kind| kind.group == Group::Plots && kind.name == name)
}

fn wanted(loaded: &Loaded, found: &drive::Outcome, kinds: Option<Vec<String>>) -> Result<Vec<File>, Error> {
    let loaded = asking_for(loaded, kinds)?;
    render_files(&loaded.report(found)?, |kind| loaded.config.output.wants(kind))
}
