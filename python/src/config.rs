//! A config with all that it names, and what can be done with it.

use crate::buffer::Buffer;
use crate::errors::raised;
use crate::handing::{dictionary, places, vacant};
use crate::landscape::Landscape;
use crate::outcome::Outcome;
use crate::recorded::{Computed, Recorded};
use crate::supervise::{ONE, supervised};
use crate::term::{Term, Trouble};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use spinneb::config::{Loaded, Source, VERSION};
use spinneb::drive::survey::SurveyProblem;
use spinneb::drive::{Problem, relaxed_state};
use spinneb::energy::{CustomEnergy, Evaluator};
use spinneb::files::disk::File;
use spinneb::output::RelaxReport;
use std::collections::HashMap;
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::sync::Arc;

/// Which states a config may lack.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Run,
    Relax,
    Landscape,
}

/// A config, read.
#[pyclass(frozen, module = "spinneb._core")]
pub struct Config {
    loaded: Arc<Loaded>,
    /// It has a final state.
    with_final: bool,
    trouble: Trouble,
}

#[pymethods]
impl Config {
    /// From a file, or from JSON whose files are in `folder`; `kind` is run, relax or landscape.
    #[new]
    #[pyo3(signature = (path, json, folder, sets, terms, kind))]
    fn new(
        py: Python,
        path: Option<PathBuf>,
        json: Option<String>,
        folder: PathBuf,
        sets: Vec<String>,
        terms: Vec<Bound<PyAny>>,
        kind: &str,
    ) -> PyResult<Config> {
        let trouble = Trouble::default();
        let own = terms.iter().map(|term| Ok(Arc::new(Term::new(term, &trouble)?) as Arc<dyn CustomEnergy>));
        let own = own.collect::<PyResult<Vec<_>>>()?;
        let kind = match kind {
            "relax" => Kind::Relax,
            "landscape" => Kind::Landscape,
            _ => Kind::Run,
        };
        let read = move |_: &mut crate::supervise::Ways| {
            let source = match (path, json) {
                (Some(path), _) => Source::file(&path)?,
                (None, json) => Source::value(&folder, "untitled", json.unwrap_or_default()),
            };
            let source = source.set(&sets)?;
            match kind {
                Kind::Run => Ok((source.load()?, true)),
                Kind::Relax => source.load_states(),
                Kind::Landscape => Ok((source.load_landscape()?, true)),
            }
        };
        let (loaded, with_final) = supervised(py, ONE, None, &trouble, read)?;
        Ok(Config { loaded: Arc::new(loaded.with_terms(own)), with_final, trouble })
    }

    /// The config as run.
    #[getter]
    fn json(&self) -> &str {
        &self.loaded.as_run
    }

    /// Name of the run.
    #[getter]
    fn name(&self) -> &str {
        &self.loaded.name
    }

    /// What it would run, in rows of a key and words.
    fn check(&self, py: Python) -> PyResult<Vec<(&'static str, String)>> {
        let loaded = self.loaded.clone();
        supervised(py, ONE, None, &self.trouble, move |_| Ok(spinneb::cli::report_of(&loaded, &loaded.problem()?)))
    }

    /// Sites as (site, xyz) in lattice constants; in a chain x is the number of the site.
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

    /// The initial and the final state as they are given, before anything is relaxed.
    fn states(&self, py: Python) -> PyResult<Vec<Buffer>> {
        let (loaded, with_final) = (self.loaded.clone(), self.with_final);
        let states = supervised(py, ONE, None, &self.trouble, move |_| loaded.states(with_final))?;
        let all = std::iter::once(states.initial).chain(states.final_state);
        Ok(all.map(|spins| Buffer::spins(&Arc::new(spins), |spins| spins.as_slice(), None)).collect())
    }

    /// The minimum-energy path; into a folder, if there is to be one.
    fn run(
        &self,
        py: Python,
        threads: Option<NonZeroUsize>,
        progress: Option<Bound<PyAny>>,
        recorded: Recorded,
    ) -> PyResult<Outcome> {
        let loaded = self.loaded.clone();
        let found = supervised(py, threads, progress.as_ref(), &self.trouble, move |ways| {
            recorded.make::<Problem>(&loaded, ways)
        })?;
        Ok(Outcome::new(self.loaded.clone(), found, self.trouble.clone()))
    }

    /// Whether a folder holds the finished result already, of terms that nobody can have changed since.
    fn is_finished(&self, py: Python, dir: PathBuf, landscape: bool) -> PyResult<bool> {
        let loaded = &self.loaded;
        let names = if landscape { SurveyProblem::names(loaded) } else { Problem::names(loaded) };
        let finished =
            loaded.custom.is_empty() && loaded.is_finished(&dir, &names, false).map_err(|e| raised(py, e))?;
        Ok(finished)
    }

    /// The files of the states relaxed.
    fn relax<'py>(
        &self,
        py: Python<'py>,
        modes: usize,
        threads: Option<NonZeroUsize>,
        progress: Option<Bound<PyAny>>,
    ) -> PyResult<(Bound<'py, PyDict>, Vec<Buffer>)> {
        let (loaded, with_final) = (self.loaded.clone(), self.with_final);
        let (files, states) = supervised(py, threads, progress.as_ref(), &self.trouble, move |ways| {
            let states = loaded.states(with_final)?;
            let mut control = spinneb::control::Control::default();
            control.obey(ways.switch.clone());
            let h = Evaluator::new(&states.hamiltonian, &control);
            let given = [("initial", Some(&states.initial)), ("final", states.final_state.as_ref())];
            let mut relaxed = Vec::new();
            for (which, spins) in given.into_iter().filter_map(|(which, spins)| Some((which, spins?))) {
                relaxed.push((which, control.relied_on(relaxed_state(h, spins, modes, which))?));
            }
            let same_minimum = match &relaxed[..] {
                [(_, a), (_, b)] => Some(a.minimum.is_same(h, &b.minimum)),
                _ => None,
            };
            let report = RelaxReport {
                name: &loaded.name,
                version: VERSION,
                lattice: states.hamiltonian.lattice(),
                hamiltonian: &states.hamiltonian,
                states: &relaxed,
                same_minimum,
                formats: &loaded.config.output.formats,
                warnings: &loaded.warnings,
            };
            let files = report.files()?;
            Ok((files, relaxed.into_iter().map(|(_, state)| state.relaxed.spins).collect::<Vec<_>>()))
        })?;
        let states = states.into_iter().map(|s| Buffer::spins(&Arc::new(s), |spins| spins.as_slice(), None));
        Ok((dictionary(py, &files)?, states.collect()))
    }

    /// All minima and saddles below an energy; into a folder, if there is to be one.
    fn landscape(
        &self,
        py: Python,
        threads: Option<NonZeroUsize>,
        progress: Option<Bound<PyAny>>,
        recorded: Recorded,
    ) -> PyResult<Landscape> {
        let loaded = self.loaded.clone();
        let files = supervised(py, threads, progress.as_ref(), &self.trouble, move |ways| {
            let found = recorded.make::<SurveyProblem>(&loaded, ways)?;
            SurveyProblem::files(&loaded, &found)
        })?;
        Ok(Landscape { loaded: self.loaded.clone(), files })
    }

    /// One that was found before, from its files by name.
    fn landscape_of(&self, mut files: HashMap<String, Vec<u8>>) -> Landscape {
        let names = self.loaded.survey_file_names().into_iter();
        let files = names.filter_map(|name| files.remove(&name).map(|bytes| File { name, bytes })).collect();
        Landscape { loaded: self.loaded.clone(), files }
    }
}
