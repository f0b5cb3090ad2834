//! Computations that are recorded in the folder of their results, so that they can go on after an interruption.

use crate::handing::Place;
use crate::supervise::{Teller, Ways};
use pyo3::prelude::*;
use spinneb::config::{Keeping, Loaded, discard_leftovers};
use spinneb::control::Control;
use spinneb::drive::survey::{Survey, SurveyProblem, survey};
use spinneb::drive::{self, Outcome, Problem};
use spinneb::error::Error;
use spinneb::files::disk::File;
use std::path::PathBuf;

/// What is computed, and the files that come of it.
pub trait Computed: Sized {
    type Found;
    fn asked(loaded: &Loaded) -> Result<Self, Error>;
    fn control(&mut self) -> &mut Control;
    fn compute(&self, teller: &mut Teller) -> Result<Self::Found, Error>;
    /// Names of all files that there may be.
    fn names(loaded: &Loaded) -> Vec<String>;
    fn files(loaded: &Loaded, found: &Self::Found) -> Result<Vec<File>, Error>;
}

impl Computed for Problem {
    type Found = Outcome;

    fn asked(loaded: &Loaded) -> Result<Problem, Error> {
        loaded.problem()
    }

    fn control(&mut self) -> &mut Control {
        &mut self.control
    }

    fn compute(&self, teller: &mut Teller) -> Result<Outcome, Error> {
        drive::run(self, teller)
    }

    fn names(loaded: &Loaded) -> Vec<String> {
        loaded.file_names()
    }

    fn files(loaded: &Loaded, found: &Outcome) -> Result<Vec<File>, Error> {
        loaded.files(found)
    }
}

impl Computed for SurveyProblem {
    type Found = Survey;

    fn asked(loaded: &Loaded) -> Result<SurveyProblem, Error> {
        loaded.survey()
    }

    fn control(&mut self) -> &mut Control {
        &mut self.problem.control
    }

    fn compute(&self, teller: &mut Teller) -> Result<Survey, Error> {
        survey(self, teller)
    }

    fn names(loaded: &Loaded) -> Vec<String> {
        loaded.survey_file_names()
    }

    fn files(loaded: &Loaded, found: &Survey) -> Result<Vec<File>, Error> {
        loaded.survey_report(found)?.files()
    }
}

/// Where a computation is recorded and its files go: the folder, if there is to be one; whether it goes on from what is there, and whether
/// it replaces that.
#[derive(FromPyObject)]
pub struct Recorded(Option<PathBuf>, bool, bool);

impl Recorded {
    /// Computes what a config asks for, and writes it.
    pub fn make<C: Computed>(self, loaded: &Loaded, ways: &mut Ways) -> Result<C::Found, Error> {
        let Recorded(out, resume, force) = self;
        let mut asked = C::asked(loaded)?;
        asked.control().obey(ways.switch.clone());
        let Some(dir) = out else { return asked.compute(&mut ways.teller) };
        let place = Place::take(loaded, dir, &C::names(loaded), force)?;
        let keeping = Keeping { resume, force: place.force, ..Keeping::default() };
        if let Some(checkpoint) = loaded.checkpoint(&place.dir, &keeping, || ways.teller.speaker())? {
            asked.control().record(Box::new(checkpoint));
        }
        let found = asked.compute(&mut ways.teller)?;
        if let Err(error) = C::files(loaded, &found).and_then(|files| place.write(loaded, &files)) {
            // what was computed is not lost with the files
            asked.control().recorder().save();
            return Err(error);
        }
        // its checkpoint is closed
        drop(asked);
        discard_leftovers(&place.dir)?;
        Ok(found)
    }
}
