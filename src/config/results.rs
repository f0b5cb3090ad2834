//! What results of a config consist of, and the folder that they go to.

use super::Loaded;
use crate::drive::Outcome;
use crate::drive::survey::Survey;
use crate::error::Result;
use crate::files::disk::{self, File};
use crate::output::canvas::Look;
use crate::output::folder::{self, Destination, Intent};
use crate::output::{
    INPUTS, LandscapeReport, RunReport, discard_partial, file_names, is_partial_left, landscape_file_names,
    render_files,
};
use crate::record::{Checkpoint, Lock};
use std::path::Path;

/// The version that results name.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

impl Loaded {
    /// How figures look.
    pub fn look(&self) -> Result<Look> {
        self.config.output.look().map_err(|e| self.text.locate(e.within("output")))
    }

    /// What of a run goes into files.
    pub fn report<'a>(&'a self, outcome: &'a Outcome) -> Result<RunReport<'a>> {
        Ok(RunReport {
            name: &self.name,
            version: VERSION,
            config_sha256: &self.sha256,
            config_text: &self.as_run,
            inputs: &self.inputs,
            lattice: &self.lattice,
            look: self.look()?,
            outcome,
        })
    }

    /// The files of a run that the config asks for.
    pub fn files(&self, outcome: &Outcome) -> Result<Vec<File>> {
        render_files(&self.report(outcome)?, |kind| self.config.output.wants(kind))
    }

    /// Names of all files that its result may have.
    pub fn file_names(&self) -> Vec<String> {
        let folder = format!("{INPUTS}/");
        let own = file_names(|kind| self.config.output.wants(kind)).into_iter().filter(|name| *name != folder);
        own.chain(self.input_names()).collect()
    }

    /// What of a survey goes into files.
    pub fn survey_report<'a>(&'a self, survey: &'a Survey) -> Result<LandscapeReport<'a>> {
        Ok(LandscapeReport {
            name: &self.name,
            version: VERSION,
            config_sha256: &self.sha256,
            config_text: &self.as_run,
            inputs: &self.inputs,
            lattice: &self.lattice,
            look: self.look()?,
            plots: &self.config.output.plots,
            survey,
        })
    }

    /// Names of all files that its survey may have.
    pub fn survey_file_names(&self) -> Vec<String> {
        landscape_file_names(&self.config.output.plots).into_iter().chain(self.input_names()).collect()
    }

    fn input_names(&self) -> impl Iterator<Item = String> {
        self.inputs.iter().map(|file| file.name.clone())
    }

    /// The config's file, as the manifest of its result names it.
    pub fn source_name(&self) -> Option<String> {
        self.source.as_ref().map(|path| path.to_string_lossy().into_owned())
    }

    /// Sees that files of these names can be written, and that nobody else writes there; nothing if the finished result is there
    /// already.
    pub fn reserve(&self, directory: &Path, names: &[String], force: bool) -> Result<Option<Lock>> {
        let finished = || self.is_finished(directory, names, force);
        match finished() {
            Ok(true) => {
                // a run that was killed between its last file and the end leaves some
                let left = Checkpoint::is_left(directory) || Lock::is_left(directory) || is_partial_left(directory);
                if (left || folder::is_note_left(directory))
                    && let Ok(_lock) = Lock::of(directory)
                {
                    discard_leftovers(directory)?;
                }
                return Ok(None);
            }
            // a folder that another run is writing is looked at once it is locked
            Err(error) if !Lock::is_left(directory) => return Err(error),
            _ => {}
        }
        let lock = Lock::of(directory)?;
        // who held the lock may have finished meanwhile
        if finished()? {
            return Ok(None);
        }
        // not before: who is at work there has its snapshot under no name for a moment
        Checkpoint::check(directory, force)?;
        disk::clean(directory)?;
        let all = file_names(|_| true);
        all.iter().filter_map(|name| name.strip_suffix('/')).try_for_each(|name| disk::clean(&directory.join(name)))?;
        Ok(Some(lock))
    }

    /// Whether the finished result is there already; an error where files of these names cannot be written.
    pub fn is_finished(&self, directory: &Path, names: &[String], force: bool) -> Result<bool> {
        let source = self.source_name();
        let known = self.known_files();
        let intent = Intent {
            version: VERSION,
            config_sha256: &self.sha256,
            source: source.as_deref(),
            names,
            known: &known,
            made_from: &self.made_from,
            force,
        };
        Ok(matches!(folder::prepare(directory, &intent)?, Destination::Finished(_)))
    }

    /// The files of the result that are known before the work.
    fn known_files(&self) -> Vec<File> {
        let config = File { name: "config.json".into(), bytes: self.as_run.clone().into_bytes() };
        self.inputs.iter().cloned().chain([config]).collect()
    }
}

/// Takes away what only an unfinished run needs.
pub fn discard_leftovers(directory: &Path) -> Result<()> {
    folder::discard_note(directory)?;
    Checkpoint::discard(directory)?;
    discard_partial(directory)
}
