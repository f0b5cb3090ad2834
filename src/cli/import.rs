//! `import`: a config from the files of another code.

use super::{USAGE, in_the_way, note};
use crate::config::Source;
use crate::error::Error;
use crate::files::disk;
use crate::import::{FORMATS, Format, Model, Told};
use anyhow::Result;
use clap::Args;
use clap::builder::PossibleValue;
use serde_json::{Map, Value};
use std::fs;
use std::io::{self, Write};
use std::path::PathBuf;

/// The arguments of `import`.
#[derive(Debug, Args)]
#[command(after_help = "\
The convention of the format is used, and printed; where a format leaves it open --convention is needed.
Compare the printed energies with the other code or a paper before you run anything.

Examples:
  spinneb import uppasd bccFe/inpsd.dat
  spinneb import uppasd film/inpsd.dat --convention -D --out film.json
  spinneb import vampire input
  spinneb import tb2j TB2J_results --cells 20,20,1
  spinneb import spirit input/input.cfg")]
pub(crate) struct Arguments {
    /// Whose files they are
    #[arg(value_parser = clap::builder::PossibleValuesParser::new(FORMATS.iter().map(|f| PossibleValue::new(f.name).help(f.summary))))]
    pub format: String,

    /// The files, or the folder that holds them
    #[arg(required = true, value_name = "PATH")]
    pub paths: Vec<PathBuf>,

    /// How pairs are counted and what stands in front of J and D, in place of the format's own: "both directions, -J, +D"
    #[arg(long, value_name = "WORDS", allow_hyphen_values = true)]
    pub convention: Option<String>,

    /// Cells along each direction, in place of those of the files
    #[arg(long, value_name = "N,N,N", value_parser = cells)]
    pub cells: Option<Cells>,

    /// The config to write [default: the name of the first path, with .json, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
}

/// Cells along each direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cells([usize; 3]);

fn cells(text: &str) -> Result<Cells, String> {
    let parts: Vec<Option<usize>> =
        text.split(',').map(|n| n.trim().parse().ok().filter(|n| (1..1 << 24).contains(n))).collect();
    match parts[..] {
        [Some(a), Some(b), Some(c)] => Ok(Cells([a, b, c])),
        _ => Err(format!("found {text:?}, expected three numbers of cells, 20,20,1")),
    }
}

/// Writes the config and prints what is in it.
pub fn import(arguments: &Arguments) -> Result<u8> {
    let file = arguments.out.clone().unwrap_or_else(|| default_name(&arguments.paths[0]));
    let shown = file.display();
    if let Some(words) = in_the_way(disk::kind(&file)?, arguments.force, "name") {
        note(&format!("error: {shown} {words}"));
        return Ok(USAGE);
    }
    if fs::read_to_string(&file).is_ok_and(|text| serde_json::from_str::<Map<String, Value>>(&text).is_err()) {
        let words = "exists and is no config, perhaps an input of what is imported; it stays, even with --force: take it away, or give another";
        note(&format!("error: {shown} {words} name with --out"));
        return Ok(USAGE);
    }
    // a wrong file is no failure of the machine, so that all that is wrong with it exits alike
    let model = match read(arguments) {
        Err(Error::Io { path, source }) => {
            note(&format!("error: {}: {source}", path.display()));
            return Ok(USAGE);
        }
        other => other?,
    };
    let config = model.config();
    // what is written is what is read
    let ends = ["initial", "final"]
        .map(|end| format!(r#"{end}={{"uniform": {{"direction": [0, 0, {}]}}}}"#, if end == "final" { -1 } else { 1 }));
    Source::text(&file, config.clone()).set(&ends)?.load()?.problem()?;
    disk::write_file(&file, config.as_bytes())?;
    let mut out = io::stdout().lock();
    model.report().iter().try_for_each(|(key, value)| writeln!(out, "  {key:<13}{value}"))?;
    out.flush()?;
    note(&format!("{shown} is written; it lacks its two ends: \"initial\" and \"final\""));
    Ok(0)
}

fn read(arguments: &Arguments) -> crate::error::Result<Model> {
    let told = arguments.convention.as_deref().map_or(Ok(Told::default()), Told::parse)?;
    let format: Option<&Format> = FORMATS.iter().find(|format| format.name == arguments.format);
    // clap lets only known names through
    let format = format.ok_or_else(|| Error::invalid("FORMAT", "no format is called this"))?;
    (format.read)(&arguments.paths, told)?.with_cells(arguments.cells.map(|cells| cells.0)).in_its_box()
}

/// The name of a path with another ending, in the current folder.
fn default_name(path: &std::path::Path) -> PathBuf {
    let known = path.canonicalize();
    let stem = known.as_deref().unwrap_or(path).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let usable = |c: char| if c.is_ascii_alphanumeric() || "._-".contains(c) { c } else { '_' };
    let name: String = stem.unwrap_or_default().chars().map(usable).collect();
    PathBuf::from(format!("{}.json", if name.is_empty() { "imported" } else { &name }))
}
