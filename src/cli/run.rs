//! `run`: from each config to its results.

use super::messages::{Messages, how_it_goes_on};
pub(super) use super::progress::Progress;
use super::signals::Signals;
use super::threads::start_threads;
use super::write::{Earlier, write};
use super::{Run, UNFINISHED, USAGE, note, report, worse};
use crate::config::{Keeping, Loaded, VERSION, discard_leftovers, load};
use crate::drive;
use crate::error::Error;
use crate::output::{StoppedRun, Summary, Told, partial_files, write_partial};
use crate::record::Checkpoint;
use anyhow::Result;
use serde_json::{Value, json};
use std::collections::HashMap;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

impl Run {
    fn keeping(&self) -> Keeping {
        Keeping { every: self.checkpoint_every.0, resume: self.resume, force: self.force }
    }
}

/// Runs all configs, one after the other. Nothing starts before all of them are known to be right.
pub fn run(arguments: &Run) -> Result<u8> {
    start_threads(arguments.threads)?;
    let mut code = 0;
    let mut loaded = Vec::new();
    let set: Vec<String> =
        arguments.set.iter().cloned().chain(arguments.effort.map(|effort| effort.setting("search"))).collect();
    for path in &arguments.configs {
        match load(path, &set) {
            Ok(one) => loaded.push(one),
            Err(error) => {
                report(&error.into());
                code = USAGE;
            }
        }
    }
    if loaded.len() > 1 {
        for error in loaded.iter().filter_map(|one| one.problem().err()) {
            code = worse(code, report(&error.into()));
        }
    }
    let directories: Vec<PathBuf> = loaded.iter().map(|one| directory(arguments, one)).collect();
    code = worse(code, distinct(&loaded, &directories));
    if code != 0 {
        return Ok(code);
    }
    let signals = Signals::watch()?;
    for (one, directory) in loaded.iter().zip(&directories) {
        let done = run_one(arguments, &signals, one, directory).unwrap_or_else(|error| report(&error));
        // a signal that comes while the last result is written does not make it another one
        let left = !std::ptr::eq(one, &loaded[loaded.len() - 1]);
        match signals.caught() {
            Some((code, _)) if left || done == code => return Ok(code),
            _ => code = worse(code, done),
        }
    }
    Ok(code)
}

/// Where the results of a config go.
fn directory(arguments: &Run, loaded: &Loaded) -> PathBuf {
    match &arguments.out {
        Some(out) if arguments.configs.len() == 1 => out.clone(),
        Some(out) => out.join(&loaded.name),
        None => Path::new("results").join(&loaded.name),
    }
}

/// Two configs cannot share a folder.
fn distinct(loaded: &[Loaded], directories: &[PathBuf]) -> u8 {
    let mut taken: HashMap<&PathBuf, &str> = HashMap::new();
    let mut code = 0;
    for (one, directory) in loaded.iter().zip(directories) {
        let file = one.text.file.as_str();
        if let Some(first) = taken.insert(directory, file) {
            note(&format!(
                "error: {first} and {file} are both named \"{}\", so both would write {}: give one another \"name\"",
                one.name,
                directory.display()
            ));
            code = USAGE;
        }
    }
    code
}

/// Runs one config into its folder, or says that it is done.
pub(super) fn run_one(arguments: &Run, signals: &Signals, loaded: &Loaded, directory: &Path) -> Result<u8> {
    let messages = Messages { name: &loaded.name, quiet: arguments.quiet };
    let mut problem = loaded.problem()?;
    problem.control.obey(signals.switch());
    let Some(lock) = loaded.reserve(directory, &loaded.file_names(), arguments.force)? else {
        messages.is_done(directory, "runs");
        return print(arguments, messages.name, directory);
    };
    messages.lock(&lock, directory, "no other run");
    let mut progress = Progress::new(messages.name, arguments.quiet);
    if let Some(checkpoint) = loaded.checkpoint(directory, &arguments.keeping(), || progress.speaker())? {
        problem.control.record(Box::new(checkpoint));
    }
    let outcome = match (drive::run(&problem, &mut progress), signals.caught()) {
        (Ok(outcome), _) => outcome,
        (Err(Error::Stopped), Some((code, word))) => {
            let (stage, band) = (progress.stage_now().to_string(), progress.band());
            drop(progress);
            let partial = match leave_partial(loaded, &problem, band.as_ref(), directory, &stage, word) {
                Ok(()) => format!("partial results in {}", directory.display()),
                Err(error) => {
                    report(&error);
                    "no partial results were written".into()
                }
            };
            let on = how_it_goes_on(directory, arguments.resume);
            messages.line(format_args!("{word} while {stage}; {on}; {partial}"));
            return Ok(code);
        }
        (Err(error), _) => return Err(error.into()),
    };
    drop(progress);
    keep(messages, arguments, loaded, &problem, &outcome, directory)?;
    // its checkpoint is closed
    drop(problem);
    if let Err(error) = discard_leftovers(directory) {
        messages.line(format_args!("the checkpoint is of no use any more but cannot be taken away: {error}"));
    }
    tell(messages, &outcome, directory, &loaded.config.output.plots);
    print(arguments, messages.name, directory)
}

/// Writes the files of a result; where that fails, what was computed is not lost with them.
fn keep(
    messages: Messages,
    arguments: &Run,
    loaded: &Loaded,
    problem: &drive::Problem,
    outcome: &drive::Outcome,
    directory: &Path,
) -> Result<()> {
    let earlier = if arguments.force { Earlier::GivesWay } else { Earlier::IsKept };
    match write(loaded, outcome, directory, earlier(loaded.source_name().as_deref()), arguments.force) {
        Ok(Some(kept)) => {
            let still_earlier = if kept.another_gave_way { ", in the place of a still earlier one" } else { "" };
            messages.line(format_args!("the earlier result is kept in {}{still_earlier}", kept.place.display()));
        }
        Ok(None) => {}
        Err(error) => {
            problem.control.recorder().save();
            if Checkpoint::exists(directory) {
                messages.line("the checkpoint is kept: once files can be written, --resume makes the result of it");
            }
            return Err(error.into());
        }
    }
    Ok(())
}

/// Its warnings, its lifetimes, and which figure it has not.
fn tell(messages: Messages, outcome: &drive::Outcome, directory: &Path, plots: &[String]) {
    messages.warnings(&outcome.warnings);
    let temperatures = outcome.rates.as_ref().map_or(0, |rates| rates.settings.temperatures_k.len());
    let lines = super::rate::lifetimes(outcome).into_iter();
    lines.chain(no_figure(directory, "arrhenius", temperatures, plots)).for_each(|line| messages.line(line));
}

/// That a figure of times which was asked for, at several temperatures, is not there.
pub(super) fn no_figure(directory: &Path, figure: &str, temperatures: usize, plots: &[String]) -> Option<String> {
    let is_there = |ending: &String| directory.join(figure).with_extension(ending).exists();
    let is_missing = temperatures > 1 && !plots.is_empty() && !plots.iter().any(is_there);
    is_missing.then(|| format!("there is no figure {figure}: it takes times of 1e-15 to 1e25 s at two temperatures"))
}

/// What is known of a run that was stopped.
fn leave_partial(
    loaded: &Loaded,
    problem: &drive::Problem,
    band: Option<&drive::Partial>,
    directory: &Path,
    stage: &str,
    word: &str,
) -> Result<()> {
    let reason = format!("{word} while {stage}: this is no result; run the config with --resume to go on");
    let (name, sha) = (loaded.name.as_str(), loaded.sha256.as_str());
    let stopped = StoppedRun { name, version: VERSION, config_sha256: sha, stage, reason: &reason };
    let outcome = band.map(|band| drive::partial(problem, band, &reason));
    let report = outcome.as_ref().map(|outcome| loaded.report(outcome)).transpose()?;
    let files = partial_files(&stopped, report.as_ref())?;
    Ok(write_partial(directory, &files)?)
}

/// What is said about the result in a folder: its line on standard output, or one of JSON there; the exit code.
fn print(arguments: &Run, name: &str, directory: &Path) -> Result<u8> {
    let summary = Summary::read(directory)?;
    let code = if summary.head.is_proven() { 0 } else { UNFINISHED };
    let words = format!("{name}: {}; results in {}", in_words(&summary), directory.display());
    let line = match arguments.json {
        true => json_line(&summary, name, directory, code).to_string(),
        false => words.clone(),
    };
    if arguments.json && !arguments.quiet {
        note(&words);
    }
    writeln!(io::stdout(), "{line}")?;
    Ok(code)
}

/// A result in a line: barrier, certificate, why it ended.
fn in_words(summary: &Summary) -> String {
    let certainty = summary.certainty();
    let digits = |b: drive::Barrier| [b.forward_mev, b.backward_mev].map(|mev| certainty.number(mev, 1.0, 7));
    let [barrier, climb] = [summary.barrier_meV, summary.highest_climb_meV].map(|b| b.map(drive::Barrier::from));
    let climb = match climb.map(digits) {
        Some([f, b]) if climb.map(digits) != barrier.map(digits) => {
            format!("; highest climb on the way {f} and {b} meV")
        }
        _ => String::new(),
    };
    let by = if summary.certificate == Some(Told::Bounded) { " (bounded, not counted)" } else { "" };
    let spent =
        if summary.search_is_spent() { "; the search for lower passes ended early as its work was spent" } else { "" };
    format!("{}{by}{climb}; {}{spent}", certainty.barrier_words(barrier), summary.stop_reason)
}

fn json_line(summary: &Summary, name: &str, directory: &Path, code: u8) -> Value {
    json!({
        "name": name,
        "barrier_meV": summary.barrier_meV,
        "highest_climb_meV": summary.highest_climb_meV,
        "converged": summary.head.converged,
        "certified": summary.head.certified,
        "certificate": summary.certificate,
        "stop_code": summary.stop_code,
        "warnings": summary.warnings,
        "exit_code": code,
        "directory": directory.to_string_lossy(),
    })
}
