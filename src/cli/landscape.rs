//! `landscape`: all minima and saddles of a config below an energy.

use super::messages::{Messages, how_it_goes_on};
use super::points::{ShareOf, share};
use super::progress::Progress;
use super::run::no_figure;
use super::signals::Signals;
use super::threads::start_threads;
use super::{Interval, Looking, UNFINISHED, at_least_one, interval, report};
use crate::config::{Keeping, Loaded, discard_leftovers, load_landscape};
use crate::drive::survey::{Survey, survey};
use crate::error::Error;
use crate::files::disk;
use crate::output::folder::{self, NewResult};
use anyhow::Result;
use clap::Args;
use serde_json::{Value, json};
use std::fs;
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// The arguments of `landscape`.
#[derive(Debug, Args)]
#[command(after_help = "\
A config of landscape needs no \"initial\" and no \"final\" state; its block \"landscape\" says how far above the lowest minimum is
looked (energy_window), for how long (effort), from which further states, and at which temperatures lifetimes are wanted.

With --index the search is shared by several processes, on as many machines as see the folder: each makes its share of all climbs
and takes over what the others have made. A share that does not come in time is made by those that are there, so any of them may
start late, be killed or be missing. What is found depends on the number of shares alone, to the bit.

Examples:
  spinneb landscape island.json
  spinneb landscape island.json --set 'landscape.energy_window=\"20 meV\"' --effort thorough
  spinneb landscape island.json --resume
  spinneb landscape island.json --index 3/8     one of eight shares: with a Slurm array, --index $SLURM_ARRAY_TASK_ID/8
  spinneb landscape island.json --index 0-3/8   the first four of them
  spinneb collect island.json                   the results of a shared search

Exit codes: 0 the search came to its stop, 3 the work that it may do, or the states that it may find, were spent before, 2 the
command line or a config is wrong")]
pub struct Arguments {
    /// The config
    #[arg(value_name = "CONFIG")]
    pub config: PathBuf,

    /// Folder for the results [default: results/<name>_landscape]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Number of threads; results do not depend on it [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub threads: Option<NonZeroUsize>,

    /// Change a value of the config first, as in `run`; may be given several times
    #[arg(long, value_name = "KEY.PATH=JSON")]
    pub set: Vec<String>,

    /// How long minima and saddles are looked for, in place of the config's `landscape.effort`
    ///
    /// none: not at all; the others until so many searches in a row brought no news: quick 8, normal 40, thorough 400, or 1, 3 and 10 of
    /// them for each pass that is known, where those are more.
    #[arg(long, value_enum, hide_possible_values = true, value_name = "none|quick|normal|thorough")]
    pub effort: Option<Looking>,

    /// Replace results that are in the folder
    #[arg(long)]
    pub force: bool,

    /// No progress and no messages, only errors
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON on stdout
    #[arg(long)]
    pub json: bool,

    /// Make this share of the search, counted from 0, or those from one to another: 0-3/8
    #[arg(short, long, value_name = "SHARE/SHARES", value_parser = share, conflicts_with_all = ["force", "resume", "checkpoint_every"])]
    pub index: Option<ShareOf>,

    /// Go on from the last checkpoint in the folder; without one, start anew
    #[arg(long)]
    pub resume: bool,

    /// How often a checkpoint is written; "off" writes none
    #[arg(long, value_name = "TIME", default_value_t, value_parser = interval)]
    pub checkpoint_every: Interval,
}

/// Surveys a config into its folder, or says that it is done.
pub fn landscape(arguments: &Arguments) -> Result<u8> {
    start_threads(arguments.threads)?;
    let loaded = load_landscape(&arguments.config, &arguments.set())?;
    let messages = Messages { name: &loaded.name, quiet: arguments.quiet };
    let directory = folder_of(messages.name, arguments.out.as_deref());
    let mut asked = loaded.survey()?;
    let signals = Signals::watch()?;
    asked.problem.control.obey(signals.switch());
    let Some(lock) = loaded.reserve(&directory, &loaded.survey_file_names(), arguments.force)? else {
        messages.is_done(&directory, "makes");
        return print(arguments.json, messages.name, &directory);
    };
    messages.lock(&lock, &directory, "nobody else");
    let mut progress = Progress::new(messages.name, arguments.quiet);
    let keeping = Keeping { every: arguments.checkpoint_every.0, resume: arguments.resume, force: arguments.force };
    if let Some(checkpoint) = loaded.checkpoint(&directory, &keeping, || progress.speaker())? {
        asked.problem.control.record(Box::new(checkpoint));
    }
    let found = match (survey(&asked, &mut progress), signals.caught()) {
        (Ok(found), _) => found,
        (Err(Error::Stopped), Some((code, word))) => {
            let stage = progress.stage_now().to_string();
            drop(progress);
            messages.line(format_args!("{word} while {stage}; {}", how_it_goes_on(&directory, arguments.resume)));
            return Ok(code);
        }
        (Err(error), _) => return Err(error.into()),
    };
    drop(progress);
    if let Err(error) = write(&loaded, &found, &directory, arguments.force) {
        // what was computed is not lost with the files
        asked.problem.control.recorder().save();
        return Err(error.into());
    }
    drop(asked);
    if let Err(error) = discard_leftovers(&directory) {
        report(&error.into());
    }
    messages.warnings(&loaded.survey_report(&found)?.warnings());
    let temperatures = found.lifetimes.as_ref().map_or(0, |lifetimes| lifetimes.settings.temperatures_k.len());
    let missing = no_figure(&directory, "lifetimes", temperatures, &loaded.config.output.plots);
    missing.into_iter().for_each(|line| messages.line(line));
    print(arguments.json, messages.name, &directory)
}

impl Arguments {
    /// What of the config is changed first.
    pub(super) fn set(&self) -> Vec<String> {
        let effort = self.effort.map(|effort| effort.setting("landscape"));
        self.set.iter().cloned().chain(effort).collect()
    }
}

/// Where the results of a landscape go.
pub(super) fn folder_of(name: &str, out: Option<&Path>) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(format!("{name}_landscape")), Path::to_path_buf)
}

/// Writes all files of a survey; by `force` in place of whatever is there.
pub(super) fn write(loaded: &Loaded, found: &Survey, directory: &Path, force: bool) -> crate::error::Result<()> {
    let files = loaded.survey_report(found)?.files()?;
    let source = loaded.source_name();
    let new = NewResult { files: &files, source: source.as_deref(), keep_earlier: !force, force };
    folder::write_result(directory, &new).map(|_| ())
}

/// The line about a result on standard output; the exit code.
pub(super) fn print(as_json: bool, name: &str, directory: &Path) -> Result<u8> {
    let read = |file: &str| -> Result<Value> { Ok(serde_json::from_str(&fs::read_to_string(directory.join(file))?)?) };
    let summary = read(disk::MARK)?;
    let code = if summary["converged"] == true { 0 } else { UNFINISHED };
    let count = |key: &str| summary[key].as_u64().unwrap_or(0);
    let words = format!(
        "{name}: {} of {}, {} of {}; {}; results in {}",
        numbered(count("minima"), "minimum", "minima"),
        numbered(count("kinds_of_minima"), "kind", "kinds"),
        numbered(count("saddles"), "saddle", "saddles"),
        numbered(count("kinds_of_saddles"), "kind", "kinds"),
        summary["stop_reason"].as_str().unwrap_or_default(),
        directory.display()
    );
    let line = match as_json {
        true => json!({
            "name": name,
            "minima": count("minima"),
            "kinds_of_minima": count("kinds_of_minima"),
            "saddles": count("saddles"),
            "kinds_of_saddles": count("kinds_of_saddles"),
            "finished": code == 0,
            "warnings": summary["warnings"],
            "exit_code": code,
            "directory": directory.to_string_lossy(),
        })
        .to_string(),
        false => words,
    };
    writeln!(io::stdout(), "{line}")?;
    Ok(code)
}

/// A number of things, with their name.
fn numbered(count: u64, one: &str, several: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { several })
}
