//! `collect`: the results of a sweep as one table and one figure; the shares of a landscape as its results.

use super::messages::Messages;
use super::points::{checked, folder};
use super::{UNFINISHED, USAGE, note};
use crate::config::sweep::Sweep;
use crate::files::disk::File;
use crate::output::Picture;
use crate::output::sweep::{
    Found, POINTS, PointState, SweepIndex, draw_map, draw_sweep, lifetime_table, look, sweep_table,
};
use anyhow::Result;
use clap::Args;
use serde_json::{Value, json};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Most indices that are told one by one.
const TOLD: usize = 12;

/// The arguments of `collect`.
#[derive(Debug, Args)]
#[command(after_help = "\
barriers.csv has a row a point: index, swept values with their units, barriers in meV, whether they are certified, prefactors if
there are rates, and the folder. A point without a result has empty cells. barriers.svg and .png show the forward barrier
against the key with the most values, a curve for each value of the others. With \"rates\", lifetimes.csv has a row a point, direction
and temperature; where one key alone has several values and there are several temperatures, lifetime_map.svg and .png show the
mean first passage to the final state over both. Older files are replaced, unless they were changed.

Of a landscape that was searched in shares (`landscape --index`) the results are written, and the shares taken away.

Examples:
  spinneb collect field.json
  spinneb collect results/field
  spinneb collect island.json
  spinneb collect results/island_landscape

Exit codes: 0 every point is there and certified, or the search came to its stop; 3 otherwise, also where shares are at work
still; 2 the command line, the sweep or the config is wrong")]
pub struct Collect {
    /// The sweep's file, the landscape's config, or the folder of the results
    #[arg(value_name = "SWEEP|CONFIG|DIR")]
    pub target: PathBuf,

    /// Folder of the results, where a file is given [default: results/<name of the sweep>, results/<name>_landscape]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// No messages, only errors
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON for each point, or for the landscape, on stdout
    #[arg(long)]
    pub json: bool,
}

/// Collects a sweep's results.
pub fn collect(arguments: &Collect) -> Result<u8> {
    let (index, dir) = if arguments.target.is_dir() {
        let dir = arguments.target.clone();
        let Some(index) = SweepIndex::read(&dir)? else {
            let (dir, file) = (dir.display(), POINTS);
            note(&format!(
                "error: {dir} is not the folder of a sweep's results: there is no {file} in it; give the sweep's file, or the config \
                 of a landscape that was searched in shares"
            ));
            return Ok(USAGE);
        };
        (index, dir)
    } else {
        let sweep = Sweep::load(&arguments.target)?;
        let Some(index) = checked(&sweep, false)? else { return Ok(USAGE) };
        (index, folder(arguments.out.as_deref(), &sweep))
    };
    let states = states(&dir, &index);
    if arguments.json {
        let mut out = io::stdout().lock();
        for (k, state) in states.iter().enumerate() {
            writeln!(out, "{}", json_line(&index, &dir, k, state))?;
        }
    }
    write(&index, &dir, &states, arguments.quiet, false)?;
    let proven = |state: &PointState| state.found().is_some_and(|f| f.head.is_proven());
    Ok(if states.iter().all(proven) { 0 } else { UNFINISHED })
}

/// What is there for each point. What cannot be read is said and taken for damaged.
pub(super) fn states(dir: &Path, index: &SweepIndex) -> Vec<PointState> {
    let state = |k: usize| {
        look(dir, index, k).unwrap_or_else(|e| {
            note(&format!("error: {e}"));
            PointState::Damaged
        })
    };
    (0..index.points.len()).map(state).collect()
}

/// Writes the table and the figure, and says what is in them and what is missing.
pub(super) fn write(index: &SweepIndex, dir: &Path, states: &[PointState], quiet: bool, force: bool) -> Result<()> {
    let messages = Messages { name: &index.name, quiet };
    let of = |word: &str| (0..states.len()).filter(|k| states[*k].word() == word).collect::<Vec<_>>();
    let counts = ["certified", "not certified", "missing", "another result", "damaged"].map(|word| (word, of(word)));
    let counted: Vec<String> =
        counts.iter().filter(|(_, points)| !points.is_empty()).map(|(word, p)| format!("{} {word}", p.len())).collect();
    messages.line(format_args!("{} points: {}", states.len(), counted.join(", ")));
    for (word, points) in counts.iter().skip(1).filter(|(_, points)| !points.is_empty()) {
        messages.line(format_args!("{word}: {}", few(points)));
    }
    if states.iter().all(|state| state.found().is_none()) {
        messages.line(format_args!("no point has a result in {}: nothing is collected", dir.display()));
        return Ok(());
    }
    let place = dir.join("barriers.csv");
    let mut files = vec![File { name: "barriers.csv".into(), bytes: sweep_table(index, states)? }];
    if let Some(canvas) = draw_sweep(index, states)? {
        for picture in [Picture::Svg, Picture::Png] {
            let name = format!("barriers.{}", picture.extension());
            files.push(File { name, bytes: picture.render(&canvas)? });
        }
    }
    let barriers = files.len();
    if let Some(bytes) = lifetime_table(index, states)? {
        files.push(File { name: "lifetimes.csv".into(), bytes });
    }
    if let Some(canvas) = draw_map(index, states)? {
        for picture in [Picture::Svg, Picture::Png] {
            let name = format!("lifetime_map.{}", picture.extension());
            files.push(File { name, bytes: picture.render(&canvas)? });
        }
    }
    index.collect(dir, &files, force)?;
    match barriers {
        1 => messages.line(format_args!("{} is written; no point has a barrier to draw", place.display())),
        _ => messages.line(format_args!("{}, barriers.svg and barriers.png are written", place.display())),
    }
    let more: Vec<&str> = files[barriers..].iter().map(|file| file.name.as_str()).collect();
    if !more.is_empty() {
        messages.line(format_args!("{} too", more.join(", ")));
    }
    Ok(())
}

/// The indices of points.
fn few(points: &[usize]) -> String {
    let told: Vec<String> = points.iter().take(TOLD).map(usize::to_string).collect();
    let more = points.len().saturating_sub(TOLD);
    if more > 0 { format!("{} and {more} more", told.join(", ")) } else { told.join(", ") }
}

/// A result in a few words.
pub(super) fn words(found: &Found) -> String {
    let barrier = found.barrier.map_or("no barrier".into(), |b| format!("barrier {:.6} meV", b.forward_mev));
    format!("{barrier}, {}certified", if found.head.is_proven() { "" } else { "not " })
}

/// A point as a line of JSON.
pub(super) fn json_line(index: &SweepIndex, dir: &Path, k: usize, state: &PointState) -> Value {
    let point = &index.points[k];
    let values: serde_json::Map<String, Value> =
        index.keys.iter().map(|key| key.key.clone()).zip(point.values.iter().cloned()).collect();
    let found = state.found();
    let both = found.and_then(|f| f.barrier).map(|b| json!({"forward": b.forward_mev, "backward": b.backward_mev}));
    json!({
        "index": k,
        "values": values,
        "state": state.word(),
        "barrier_meV": both,
        "converged": found.map(|f| f.head.converged),
        "certified": found.map(|f| f.head.certified),
        "directory": dir.join(&point.directory).to_string_lossy(),
    })
}
