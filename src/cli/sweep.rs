//! `sweep`: a config at many values, the points one by one or several at a time.
//!
//! Each point of a local sweep is a process of its own: what happens to one, be it killed for its memory, does not touch the others.
//! When the sweep itself is killed its points stop as if they were terminated, since their standard input ends.

use super::collect::{self, json_line, states};
use super::jobs::{Ended, run_all};
use super::points::{Part, checked, folder, part};
use super::run::run_one;
use super::signals::Signals;
use super::threads::{check_threads, start_threads};
use super::{Run, UNFINISHED, USAGE, at_least_one, note, worse};
use crate::config::Loaded;
use crate::config::sweep::Sweep;
use crate::landscape::Doubt;
use crate::output::sweep::{IndexedPoint, PointState, SweepIndex, look};
use anyhow::Result;
use clap::Args;
use rayon::prelude::*;
use std::ffi::OsString;
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::available_parallelism;

/// Most points that are told one by one.
const TOLD: usize = 20;

/// The arguments of `sweep`.
#[derive(Debug, Args)]
#[command(after_help = "\
A sweep's file names a config and the values of its keys (paths as in `run --set`), a list or a range with both ends:

  {\"config\": \"ring.json\",
   \"set\": {\"output.plots\": []},
   \"grid\": {\"energy[0].anisotropy.K\": [\"0.1 meV\", \"0.2 meV\"],
            \"energy[1].zeeman.B[2]\": {\"from\": \"-0.1 T\", \"to\": \"-0.8 T\", \"points\": 8, \"scale\": \"linear\"}}}

\"grid\" takes every value with every other, the last key changing fastest; \"zip\" takes the first values together, then the
second ones. \"set\" changes the config of all points. Each point has a folder of its own, named after its values. Points that
are done are not run again, and a point that fails does not stop the others.

Examples:
  spinneb sweep field.json                      all points, as many at a time as there are cores
  spinneb sweep field.json --list               index, values, folder and state of each point
  spinneb sweep field.json --index 17           one point: with a Slurm array, --index $SLURM_ARRAY_TASK_ID
  spinneb sweep field.json --index 20-39        twenty of them, as many at a time as there are cores
  spinneb collect field.json                    barriers.csv and barriers.svg, .png of what is there")]
pub struct Arguments {
    /// The sweep's file
    #[arg(value_name = "SWEEP")]
    pub file: PathBuf,

    /// Folder for the results, a folder a point in it [default: results/<name of the sweep>]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Print the points: index, values, folder, and whether they are done
    #[arg(short, long, conflicts_with_all = ["count", "index", "jobs", "threads", "force"])]
    pub list: bool,

    /// Print the number of points
    #[arg(long, conflicts_with_all = ["index", "jobs", "threads", "force", "json"])]
    pub count: bool,

    /// Run this point alone, counted from 0, or those from one to another: 20-39
    #[arg(short, long, value_name = "INDEX|FIRST-LAST", value_parser = part)]
    pub index: Option<Part>,

    /// How many points run at a time [default: all cores over --threads]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub jobs: Option<NonZeroUsize>,

    /// Number of threads of a point; results do not depend on it [default: 1, and all cores with --index]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub threads: Option<NonZeroUsize>,

    /// Run all points anew and replace what is in their folders
    #[arg(long)]
    pub force: bool,

    /// No progress and no messages, only errors
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON for each point on stdout
    #[arg(long)]
    pub json: bool,

    /// Stop, as when terminated, at the end of standard input: the whole sweep has ended
    #[arg(long, hide = true, requires = "index")]
    pub leashed: bool,
}

impl Arguments {
    fn say(&self, line: &str) {
        if !self.quiet {
            note(line)
        }
    }
}

/// Runs a sweep, or the part that is asked for.
pub fn sweep(arguments: &Arguments, program: &[OsString]) -> Result<u8> {
    let sweep = Sweep::load(&arguments.file)?;
    let dir = folder(arguments.out.as_deref(), &sweep);
    if arguments.count {
        writeln!(io::stdout(), "{}", sweep.len())?;
        return Ok(0);
    }
    check_threads(arguments.jobs.map_or(1, NonZeroUsize::get), arguments.threads.map_or(1, NonZeroUsize::get))?;
    if let Some(part) = arguments.index {
        if part.last >= sweep.len() {
            let (file, last) = (arguments.file.display(), sweep.len() - 1);
            note(&format!("error: there is no point {}: {file} has the points 0 to {last}", part.last));
            return Ok(USAGE);
        }
        if part.first == part.last {
            if arguments.jobs.is_some() {
                note("error: --jobs says how many points run at a time, and --index names one: leave --jobs out");
                return Ok(USAGE);
            }
            return one(arguments, &sweep, &dir, part.first);
        }
    }
    let Some(index) = checked(&sweep, !arguments.list)? else { return Ok(USAGE) };
    if arguments.list {
        return list(arguments, &index, &dir);
    }
    let before = states(&dir, &index);
    let points = arguments.index.map_or(0..before.len(), |part| part.first..part.last + 1);
    if !arguments.force && occupied(&dir, &index, &before, points.clone()) {
        return Ok(USAGE);
    }
    several(arguments, &index, &dir, (&before, points), program)
}

/// One point, as `run` runs a config.
fn one(arguments: &Arguments, sweep: &Sweep, dir: &Path, point: usize) -> Result<u8> {
    start_threads(arguments.threads)?;
    // the points of a sweep share their source: each keeps its result
    let loaded = Loaded { source: None, ..sweep.load_point(point)? };
    sweep.problem(point, &loaded)?;
    let known = |index: &SweepIndex| {
        let same = |p: &IndexedPoint| *p == sweep.indexed(point, loaded.sha256.clone());
        index.points.len() == sweep.len() && index.points.get(point).is_some_and(same)
    };
    if !SweepIndex::read(dir)?.is_some_and(|index| known(&index)) {
        // what is wrong with other points is theirs to say
        let hash = |k: usize| sweep.load_point(k).map(|loaded| loaded.sha256).unwrap_or_default();
        sweep.index((0..sweep.len()).into_par_iter().map(hash).collect()).write(dir)?;
    }
    let run = Run {
        configs: vec![sweep.config.clone()],
        out: None,
        threads: arguments.threads,
        set: Vec::new(),
        effort: None,
        force: arguments.force,
        quiet: arguments.quiet,
        json: arguments.json,
        resume: !arguments.force,
        checkpoint_every: super::Interval::default(),
    };
    let signals = Signals::watch()?;
    if arguments.leashed {
        signals.end_with_stdin();
    }
    run_one(&run, &signals, &loaded, &dir.join(sweep.directory(point)))
}

/// A line a point.
fn list(arguments: &Arguments, index: &SweepIndex, dir: &Path) -> Result<u8> {
    let states = states(dir, index);
    let mut out = io::stdout().lock();
    if arguments.json {
        for (k, state) in states.iter().enumerate() {
            writeln!(out, "{}", json_line(index, dir, k, state))?;
        }
        return Ok(0);
    }
    let head = ["index".to_string()].into_iter().chain(index.keys.iter().map(|k| k.label.clone()));
    let mut rows: Vec<Vec<String>> = vec![head.chain(["state", "directory"].map(String::from)).collect()];
    for (k, (point, state)) in index.points.iter().zip(&states).enumerate() {
        let values = point.values.iter().map(|v| v.as_str().map_or_else(|| v.to_string(), String::from));
        let place = dir.join(&point.directory).display().to_string();
        rows.push([k.to_string()].into_iter().chain(values).chain([state.word().into(), place]).collect());
    }
    let width = |c: usize| rows.iter().map(|row| row[c].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..rows[0].len()).map(width).collect();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, w)| format!("{cell:w$}")).collect();
        writeln!(out, "{}", cells.join("  ").trim_end())?;
    }
    out.flush()?;
    Ok(0)
}

/// Whether folders hold results of other configs or versions, which is said.
fn occupied(dir: &Path, index: &SweepIndex, before: &[PointState], points: Range<usize>) -> bool {
    let other = |state: &PointState| match state {
        PointState::Other | PointState::Damaged => true,
        PointState::Found(found) => found.head.version != env!("CARGO_PKG_VERSION"),
        PointState::Missing => false,
    };
    let count = points.len();
    let taken: Vec<usize> = points.filter(|k| other(&before[*k])).collect();
    if let Some(first) = taken.first() {
        let place = dir.join(&index.points[*first].directory);
        note(&format!(
            "error: {} of {} points have a folder with a damaged result or one of another config or version, the first {}; \
             use --force to replace them, or another folder with --out",
            taken.len(),
            count,
            place.display()
        ));
    }
    !taken.is_empty()
}

/// A point in a process of its own, until that ends.
fn apart(arguments: &Arguments, dir: &Path, point: usize, threads: usize, program: &[OsString]) -> io::Result<Output> {
    let (program, first) =
        program.split_first().ok_or_else(|| io::Error::other("the program does not know where it is"))?;
    let mut command = Command::new(program);
    command.args(first).arg("sweep").arg(&arguments.file).arg("--out").arg(dir);
    command.args(["--index", &point.to_string(), "--threads", &threads.to_string(), "--quiet", "--leashed"]);
    if arguments.force {
        command.arg("--force");
    }
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::piped()).spawn()?;
    // held until the point is done: the system lets go of it with this process, however that ends
    let _leash = child.stdin.take();
    child.wait_with_output()
}

/// The points of a range that are not done, several at a time; once all of the sweep are asked for, what they come to.
fn several(
    arguments: &Arguments,
    index: &SweepIndex,
    dir: &Path,
    (before, points): (&[PointState], Range<usize>),
    program: &[OsString],
) -> Result<u8> {
    SweepIndex::is_free(dir, arguments.force)?;
    index.write(dir)?;
    let todo: Vec<usize> = points.clone().filter(|k| arguments.force || before[*k].found().is_none()).collect();
    let threads = arguments.threads.map_or(1, NonZeroUsize::get);
    let cores = available_parallelism().map_or(1, NonZeroUsize::get);
    let jobs = arguments.jobs.map_or((cores / threads).max(1), NonZeroUsize::get);
    let (name, total) = (&index.name, todo.len());
    let (interrupted, quiet) = (name.clone(), arguments.quiet);
    let again = if arguments.force { "the same command without --force" } else { "the same command" };
    Signals::watch()?.end_saying(move |word| {
        if !quiet {
            note(&format!("{interrupted}: {word}; what is done is kept, and {again} goes on from there"));
        }
    });
    if total < points.len() {
        arguments.say(&format!("{name}: {} of {} points are done already", points.len() - total, points.len()));
    }
    let start = |point: usize| apart(arguments, dir, point, threads, program);
    let mut failed: Vec<(usize, String, u8)> = Vec::new();
    let mut count = 0;
    let stopped = run_all(&todo, jobs, start, |point, ended: &Ended| {
        count += 1;
        let state = look(dir, index, point).unwrap_or(PointState::Missing);
        let said = match (&state, ended.failure()) {
            (PointState::Found(found), None) => collect::words(found),
            (_, failure) => {
                let (words, code) = failure.unwrap_or(("no result was written".into(), 1));
                failed.push((point, words.clone(), code));
                format!("failed: {words}")
            }
        };
        arguments.say(&format!("{name}: {count} of {total}: {}: {said}", index.points[point].directory));
    });
    failed.sort();
    let after = states(dir, index);
    if stopped.is_none() && points.len() == before.len() {
        collect::write(index, dir, &after, arguments.quiet, arguments.force)?;
    }
    if arguments.json {
        let mut out = io::stdout().lock();
        for k in points.clone() {
            writeln!(out, "{}", json_line(index, dir, k, &after[k]))?;
        }
    }
    tell(index, &after, points.clone(), &failed, arguments.quiet);
    let codes = failed.iter().map(|(.., code)| *code);
    let doubtful = after[points].iter().any(|state| state.found().is_none_or(|f| !f.head.is_proven()));
    Ok(stopped.unwrap_or_else(|| codes.fold(if doubtful { UNFINISHED } else { 0 }, worse)))
}

/// What has failed and what is not certified, each in a line.
fn tell(index: &SweepIndex, after: &[PointState], points: Range<usize>, failed: &[(usize, String, u8)], quiet: bool) {
    let mut lines: Vec<String> = Vec::new();
    for (point, words, _) in failed {
        lines.push(format!("error: point {point}, {}: {words}", index.points[*point].directory));
    }
    for k in points.filter(|_| !quiet) {
        if let Some(found) = after[k].found().filter(|f| !f.head.is_proven()) {
            let reason = found.warnings.last().map(|w| Doubt::of_warning(w).unwrap_or(w));
            let reason = reason.map_or(String::new(), |w| format!(": {w}"));
            lines.push(format!("point {k}, {}: not certified{reason}", index.points[k].directory));
        }
    }
    lines.iter().take(TOLD).for_each(|line| note(line));
    if lines.len() > TOLD {
        note(&format!("and {} more; `spinneb sweep --list` shows all", lines.len() - TOLD));
    }
}
