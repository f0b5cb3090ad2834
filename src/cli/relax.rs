//! `relax`: the ends of a path by themselves, what they relax to and whether that is a minimum.

use super::messages::Messages;
use super::threads::start_threads;
use super::{UNFINISHED, at_least_one, in_the_way, report, worse};
use crate::config::{Loaded, OutputConfig, load_states};
use crate::drive::{RelaxedState, relaxed_state};
use crate::error::Error;
use crate::files::disk;
use crate::output::{RelaxReport, formats_of_paths, relaxed_file_names};
use crate::path::is_within;
use crate::sphere::SAME;
use crate::words::counted;
use anyhow::Result;
use clap::Args;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// The arguments of `relax`.
#[derive(Debug, Args)]
#[command(after_help = "\
A config of relax needs no \"final\" state, and the two may be the same. A state is named a minimum if no torque remains but for
rounding and no direction leads down; zero modes are rotations about symmetry axes, flat ones lie below the rounding error.

Examples:
  spinneb relax wall.json
  spinneb relax wall.json --set initial.domain_wall.center=30 --modes 12
  spinneb relax wall.json --out relaxed      then in a config: \"initial\": {\"file\": {\"path\": \"relaxed/initial.ovf\"}}

Exit codes: 0 every state is a minimum, 3 one is not, 2 the command line or a config is wrong")]
pub struct Relax {
    /// Configs whose states to relax
    #[arg(required = true, value_name = "CONFIG")]
    pub configs: Vec<PathBuf>,

    /// Folder for relax.json and the states, in those of the config's output.formats that are not of paths alone; with several configs, each gets a folder of its
    /// name in it [default: nothing is written]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// How many of the lowest eigenvalues are computed
    #[arg(long, default_value_t = 6, value_name = "COUNT")]
    pub modes: usize,

    /// Number of threads; results do not depend on it [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub threads: Option<NonZeroUsize>,

    /// Change a value of the config first, as in `run`; may be given several times
    #[arg(long, value_name = "KEY.PATH=JSON")]
    pub set: Vec<String>,

    /// Replace files that are in the folder
    #[arg(long, requires = "out")]
    pub force: bool,

    /// No progress and no messages, only errors
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON for each state on stdout instead of the report
    #[arg(long)]
    pub json: bool,
}

/// Relaxes the states of all configs, one after the other.
pub fn relax(arguments: &Relax) -> Result<u8> {
    start_threads(arguments.threads)?;
    let mut code = 0;
    for config in &arguments.configs {
        code = worse(code, relax_one(arguments, config).unwrap_or_else(|error| report(&error)));
    }
    Ok(code)
}

fn relax_one(arguments: &Relax, config: &Path) -> Result<u8> {
    let (loaded, with_final) = load_states(config, &arguments.set)?;
    let states = loaded.states(with_final)?;
    let (name, formats) = (&loaded.name, &loaded.config.output.formats);
    let messages = Messages { name, quiet: arguments.quiet };
    let given = [("initial", Some(&states.initial)), ("final", states.final_state.as_ref())];
    let given: Vec<_> = given.into_iter().filter_map(|(which, spins)| Some((which, spins?))).collect();
    let directory = directory(arguments, &loaded);
    if let Some(dir) = &directory {
        let which: Vec<&str> = given.iter().map(|(which, _)| *which).collect();
        free(
            dir,
            &relaxed_file_names(&which, formats, states.hamiltonian.lattice()),
            arguments.force,
            &loaded.made_from,
        )?;
    }
    messages.warnings(&loaded.warnings);
    let h = &states.hamiltonian;
    let mut relaxed = Vec::new();
    for (which, spins) in given {
        messages.line(format_args!("relaxing the {which} state"));
        let state = relaxed_state(h.into(), spins, arguments.modes, which)?;
        messages.warnings(&state.warnings);
        relaxed.push((which, state));
    }
    let same_minimum = match &relaxed[..] {
        [(_, a), (_, b)] => Some(a.minimum.is_same(h.into(), &b.minimum)),
        _ => None,
    };
    let found = RelaxReport {
        name,
        version: env!("CARGO_PKG_VERSION"),
        lattice: states.hamiltonian.lattice(),
        hamiltonian: h,
        states: &relaxed,
        same_minimum,
        formats,
        warnings: &loaded.warnings,
    };
    if let Some(dir) = &directory {
        for file in found.files()? {
            disk::write_file(&dir.join(&file.name), &file.bytes)?;
        }
        messages.line(format_args!("the states are in {}", dir.display()));
        let left_out = formats_of_paths(formats);
        // the default, which nobody wrote, has formats of paths
        if !left_out.is_empty() && *formats != OutputConfig::default().formats {
            messages.line(format_args!(
                "not written: {}, which a path has and a single state has not",
                left_out.join(", ")
            ));
        }
    }
    print(arguments, &found, directory.is_some())?;
    Ok(if relaxed.iter().all(|(_, state)| state.is_proven()) { 0 } else { UNFINISHED })
}

/// Where the files of a config go, if anywhere.
fn directory(arguments: &Relax, loaded: &Loaded) -> Option<PathBuf> {
    let out = arguments.out.as_ref()?;
    Some(if arguments.configs.len() == 1 { out.clone() } else { out.join(&loaded.name) })
}

/// Nothing that is there may be replaced unless that is wished, and no link or file that the states are made from even then.
fn free(dir: &Path, names: &[String], force: bool, made_from: &[PathBuf]) -> Result<()> {
    for path in names.iter().map(|name| dir.join(name)) {
        let own = |path: &Path| fs::canonicalize(path).is_ok_and(|path| made_from.contains(&path));
        let words = match disk::kind(&path)? {
            disk::Kind::File if own(&path) => {
                Some("is a file that the states are made from; give another folder with --out".to_string())
            }
            kind => in_the_way(kind, force, "folder"),
        };
        if let Some(words) = words {
            return Err(Error::Io { path, source: io::Error::new(ErrorKind::AlreadyExists, words) }.into());
        }
    }
    Ok(())
}

fn print(arguments: &Relax, found: &RelaxReport, written: bool) -> Result<()> {
    let mut out = io::stdout().lock();
    if arguments.json {
        for state in found.states(written) {
            writeln!(out, "{}", serde_json::to_string(&state)?)?;
        }
    } else {
        writeln!(out, "{}", found.name)?;
        found.states.iter().try_for_each(|(which, state)| print_state(&mut out, found, which, state))?;
        if found.same_minimum == Some(true) {
            let spins = |k: usize| found.states[k].1.minimum.spins.as_slice();
            let words = if is_within(spins(0), spins(1), SAME) { "" } else { ", turned about an axis of symmetry" };
            writeln!(out, "  both states relax to the same minimum{words}")?;
        }
    }
    Ok(out.flush()?)
}

/// An eigenvalue to six decimals, or, where these are not four digits of it, with those.
fn eigenvalue(mev: f64) -> String {
    if mev.abs() < 1e-3 && mev != 0.0 { format!("{mev:.3e}") } else { format!("{mev:.6}") }
}

fn print_state(out: &mut impl Write, found: &RelaxReport, which: &str, state: &RelaxedState) -> io::Result<()> {
    let (relaxed, minimum) = (&state.relaxed, &state.minimum);
    let s = &minimum.spectrum;
    let kind = match (state.is_proven(), s.flat) {
        (true, 0) => "a minimum".into(),
        (true, _) => format!("a minimum, flat to {:.1e} meV", s.floor_mev),
        (false, _) if s.negative > 0 => {
            let down = counted(s.negative, "direction leads", "directions lead");
            format!("no minimum: {down} down (Morse index)")
        }
        _ => "not proven to be a minimum: a torque remains".into(),
    };
    writeln!(out, "  {which}: {kind}")?;
    let mut row = |key: &str, value: String| writeln!(out, "    {key:<12}{value}");
    row("energy", format!("{:.9} meV", minimum.energy_mev))?;
    for (term, energy) in found.hamiltonian.energies_mev(relaxed.spins.as_slice()) {
        row("", format!("{energy:.9} meV {term}"))?;
    }
    row("torque", format!("{:.1e} meV at most", minimum.max_torque_mev))?;
    let turned = relaxed.largest_rotation_rad.to_degrees();
    row(
        "as given",
        format!(
            "{:.9} meV, torque {:.1e} meV; then a spin turned by up to {turned:.3} degrees in {}",
            state.given_mev,
            state.given_torque_mev,
            counted(relaxed.steps, "step", "steps")
        ),
    )?;
    let zero = if s.zero > 0 { " (rotations about symmetry axes)" } else { "" };
    row(
        "modes",
        format!("{} negative, {} zero{zero}, {} flat (below {:.1e} meV)", s.negative, s.zero, s.flat, s.floor_mev),
    )?;
    if !s.lowest_mev.is_empty() {
        let lowest: Vec<String> = s.lowest_mev.iter().map(|e| eigenvalue(*e)).collect();
        row("lowest", format!("{} meV, zero modes apart", lowest.join(", ")))?;
    }
    Ok(())
}
