//! `run`: from each config to its results.

use super::{Run, UNFINISHED, USAGE, note, report, worse};
use anyhow::{Context, Result};
use serde_json::{Value, json};
use spinneb::config::{Loaded, load};
use spinneb::drive::{self, HistoryRow, Observer, Outcome};
use spinneb::error::Error;
use spinneb::output::disk::{self, Destination};
use spinneb::output::{Group, Kind, RunReport, known_files, render_files};
use std::collections::HashMap;
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Runs all configs, one after the other. Nothing starts before all of them are known to be right.
pub fn run(arguments: &Run) -> Result<u8> {
    start_threads(arguments.threads)?;
    let mut code = 0;
    let mut loaded = Vec::new();
    for path in &arguments.configs {
        match load(path, &arguments.set) {
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
    for (one, directory) in loaded.iter().zip(&directories) {
        code = worse(code, run_one(arguments, one, directory).unwrap_or_else(|error| report(&error)));
    }
    Ok(code)
}

/// As many threads as asked for.
pub(super) fn start_threads(count: Option<NonZeroUsize>) -> Result<()> {
    if let Some(n) = count {
        rayon::ThreadPoolBuilder::new().num_threads(n.get()).build_global().context("the threads cannot be started")?;
    }
    Ok(())
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
pub(super) fn run_one(arguments: &Run, loaded: &Loaded, directory: &Path) -> Result<u8> {
    let started = Instant::now();
    let say = |line: &str| {
        if !arguments.quiet {
            note(line)
        }
    };
    let problem = loaded.problem()?;
    let (name, place) = (&loaded.name, directory.display());
    if let Destination::Finished(_) = disk::prepare(directory, VERSION, &loaded.sha256, arguments.force)? {
        let stored = Stored::read(directory)?;
        say(&format!("{name}: {place} holds the finished result of this config already; --force runs it again"));
        return print(arguments, name, directory, &stored);
    }
    let mut progress = Progress::new(name, arguments.quiet);
    let outcome = outcome(loaded, &problem, &mut progress, started)?;
    write(loaded, &outcome, directory)?;
    for warning in &outcome.warnings {
        say(&format!("{name}: warning: {warning}"));
    }
    let stored = Stored::of(&outcome);
    if let Some(line) = super::rate::lifetimes(&outcome) {
        say(&format!("{name}: {line}"));
    }
    let proof = if outcome.certified { "certified" } else { "not certified" };
    say(&format!("{name}: {}, {proof}; {}; results in {place}", barrier(&outcome), outcome.stop_reason));
    print(arguments, name, directory, &stored)
}

/// The outcome of a config's problem, as it is written.
pub(super) fn outcome(
    loaded: &Loaded,
    problem: &drive::Problem,
    observer: &mut dyn Observer,
    started: Instant,
) -> Result<Outcome> {
    let mut outcome = drive::run(problem, observer)?;
    outcome.work.seconds = started.elapsed().as_secs_f64();
    outcome.warnings.extend(loaded.warnings.iter().cloned());
    Ok(outcome)
}

pub(super) fn write(loaded: &Loaded, outcome: &Outcome, directory: &Path) -> spinneb::error::Result<()> {
    let (name, sha) = (loaded.name.as_str(), loaded.sha256.as_str());
    let run = RunReport {
        name,
        version: VERSION,
        config_sha256: sha,
        config_text: &loaded.as_run,
        inputs: &loaded.inputs,
        chain: loaded.chain(),
        look: loaded.look()?,
        outcome,
    };
    let output = &loaded.config.output;
    let named = |list: &[String], kind: &Kind| list.iter().any(|name| name == kind.name);
    let files = render_files(&run, |kind| match kind.group {
        Group::Always => true,
        Group::Formats | Group::OnRequest => named(&output.formats, kind),
        Group::Plots => named(&output.plots, kind),
    })?;
    disk::write_result(directory, &files, &known_files())
}

fn barrier(outcome: &Outcome) -> String {
    match outcome.barrier {
        Some(b) => format!("barrier {:.6} meV forward, {:.6} meV backward", b.forward_mev, b.backward_mev),
        None => "no barrier".into(),
    }
}

/// What is said about a result on stdout: from an outcome, or from its `summary.json`.
struct Stored {
    barrier_mev: Value,
    converged: bool,
    certified: bool,
}

impl Stored {
    fn of(outcome: &Outcome) -> Stored {
        let both = |b: drive::Barrier| json!({"forward": b.forward_mev, "backward": b.backward_mev});
        let barrier_mev = outcome.barrier.map_or(Value::Null, both);
        Stored { barrier_mev, converged: outcome.converged, certified: outcome.certified }
    }

    fn read(directory: &Path) -> Result<Stored> {
        let path = directory.join(disk::MARK);
        let bytes = std::fs::read(&path).map_err(|source| Error::Io { path: path.clone(), source })?;
        let summary: Value =
            serde_json::from_slice(&bytes).map_err(|e| Error::Io { path, source: io::Error::other(e) })?;
        let flag = |key: &str| summary.get(key).and_then(Value::as_bool).unwrap_or(false);
        let barrier_mev = summary.get("barrier_meV").cloned().unwrap_or(Value::Null);
        Ok(Stored { barrier_mev, converged: flag("converged"), certified: flag("certified") })
    }

    fn exit_code(&self) -> u8 {
        if self.converged && self.certified { 0 } else { UNFINISHED }
    }
}

/// The line of JSON, if asked for; the exit code.
fn print(arguments: &Run, name: &str, directory: &Path, stored: &Stored) -> Result<u8> {
    let code = stored.exit_code();
    if arguments.json {
        let line = json!({
            "name": name,
            "barrier_meV": stored.barrier_mev,
            "converged": stored.converged,
            "certified": stored.certified,
            "exit_code": code,
            "directory": directory.to_string_lossy(),
        });
        writeln!(io::stdout(), "{line}")?;
    }
    Ok(code)
}

/// Progress in plain lines, at most one a second and one a stage.
pub(super) struct Progress<'a> {
    name: &'a str,
    quiet: bool,
    last: Instant,
}

impl<'a> Progress<'a> {
    pub(super) fn new(name: &'a str, quiet: bool) -> Progress<'a> {
        Progress { name, quiet, last: Instant::now() }
    }

    fn say(&mut self, words: &str) {
        if !self.quiet {
            note(&format!("{}: {words}", self.name));
        }
        self.last = Instant::now();
    }
}

impl Observer for Progress<'_> {
    fn iteration(&mut self, row: &HistoryRow) {
        if self.last.elapsed() >= Duration::from_secs(1) {
            self.say(&format!(
                "iteration {}, {} images: highest {:.6} meV, still turning by {:.1e} rad",
                row.iteration, row.images, row.highest_image_mev, row.largest_predicted_rotation_rad
            ));
        }
    }

    fn stage(&mut self, what: &str) {
        self.say(what);
    }
}
