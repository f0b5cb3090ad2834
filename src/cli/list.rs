//! `list`: what a config can ask for, from the registries that the code itself uses.

use super::{List, USAGE, What, note};
use crate::config::library::{self, LibraryMaterial};
use crate::config::{MaterialScales, keys};
use crate::energy::TermSpec;
use crate::files::FORMATS;
use crate::lattice::LatticeSpec;
use crate::optimise::OptimiserSpec;
use crate::output::{Group, KINDS};
use crate::path::guess::GuessSpec;
use crate::registry::Entry;
use crate::state::StateSpec;
use crate::words::{nearest, quoted};
use anyhow::Result;
use clap::ValueEnum;
use std::io::{self, Write};

/// Prints the lists asked for.
pub fn list(arguments: &List) -> Result<u8> {
    let mut out = io::stdout().lock();
    match (arguments.what, &arguments.name) {
        (Some(what), Some(name)) => {
            if let Err(known) = one(&mut out, what, name)? {
                let hint = match nearest(name, known.iter().map(String::as_str)) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("known are {}", known.join(", ")),
                };
                note(&format!("error: {} has no entry {}: {hint}", plural(what), quoted(name)));
                return Ok(USAGE);
            }
        }
        (Some(what), None) => print(&mut out, what, "")?,
        (None, _) => {
            for (k, what) in What::value_variants().iter().enumerate() {
                writeln!(out, "{}{}", if k > 0 { "\n" } else { "" }, plural(*what))?;
                print(&mut out, *what, "  ")?;
            }
        }
    }
    out.flush()?;
    Ok(0)
}

/// What is listed, as on the command line.
fn plural(what: What) -> String {
    what.to_possible_value().map(|v| v.get_name().to_string()).unwrap_or_default()
}

/// One entry with all that it takes; the names that there are, where it is none of them.
fn one(out: &mut impl Write, what: What, name: &str) -> io::Result<Result<(), Vec<String>>> {
    let (family, entries) = match what {
        What::Terms => ("TermSpec", TermSpec::ENTRIES),
        What::Lattices => ("LatticeSpec", LatticeSpec::ENTRIES),
        What::States => ("StateSpec", StateSpec::ENTRIES),
        What::Guesses => ("GuessSpec", GuessSpec::ENTRIES),
        What::Optimisers => ("OptimiserSpec", OptimiserSpec::ENTRIES),
        What::Formats => return one_format(out, name),
        What::Materials => return one_material(out, name),
    };
    let Some(entry) = entries.iter().find(|entry| entry.name == name) else {
        return Ok(Err(entries.iter().map(|entry| entry.name.to_string()).collect()));
    };
    writeln!(out, "{}: {}\n  {}\n", entry.name, entry.summary, entry.example)?;
    let keys = keys(family, name);
    if keys.is_empty() {
        writeln!(out, "no keys")?;
    }
    let width = keys.iter().map(|key| key.name.len()).max().unwrap_or(0);
    for key in keys {
        let default = match (key.required, &key.default) {
            (true, _) => "required".into(),
            (false, Some(default)) => format!("{default} if left out"),
            (false, None) => "may be left out".into(),
        };
        writeln!(out, "{:width$}  {} ({default})", key.name, key.meaning)?;
        writeln!(out, "{:width$}  {}", "", key.value)?;
    }
    Ok(Ok(()))
}

fn one_format(out: &mut impl Write, name: &str) -> io::Result<Result<(), Vec<String>>> {
    let (written, read) = (KINDS.iter().find(|kind| kind.name == name), FORMATS.iter().find(|f| f.name == name));
    if let Some(kind) = written {
        let asked = match kind.group {
            Group::Always => "always written",
            Group::Formats => "written if named in output.formats, or if that is left out",
            Group::OnRequest => "written if named in output.formats",
            Group::Plots => "drawn if named in output.plots, or if that is left out",
        };
        writeln!(out, "{name}: {}\n{asked}", kind.summary)?;
    }
    if let Some(format) = read {
        let endings: Vec<String> = format.extensions.iter().map(|e| format!(".{e}")).collect();
        writeln!(out, "{name}, read as states and paths ({}): {}", endings.join(", "), format.summary)?;
    }
    let known = KINDS.iter().map(|kind| kind.name).chain(FORMATS.iter().map(|format| format.name));
    Ok(match (written, read) {
        (None, None) => Err(known.map(String::from).collect()),
        _ => Ok(()),
    })
}

fn one_material(out: &mut impl Write, name: &str) -> io::Result<Result<(), Vec<String>>> {
    let Some(found) = library::find(name).map_err(io::Error::other)? else {
        let all = library::library().map_err(io::Error::other)?;
        return Ok(Err(all.iter().map(|m| m.key.to_string()).collect()));
    };
    let s = MaterialScales::of(&found.material);
    writeln!(out, "{}: {}", found.key, found.material.name)?;
    for (what, value, unit) in [
        ("exchange length √(2A/μ₀Ms²)", s.exchange_length_nm, "nm"),
        ("wall width √(A/|K|)", s.wall_width_nm, "nm"),
        ("wall width √(J/2K)", s.wall_width_sites, "sites"),
        ("wall energy 4√(AK)", s.wall_energy_mj_per_m2, "mJ/m²"),
        ("wall energy 2√(2JK)", s.wall_energy_mev, "meV"),
    ] {
        if let Some(value) = value {
            writeln!(out, "  {what}: {value:.4} {unit}")?;
        }
    }
    writeln!(out, "\n{}", found.text.trim_end())?;
    Ok(Ok(()))
}

fn print(out: &mut impl Write, what: What, indent: &str) -> io::Result<()> {
    match what {
        What::Terms => family(out, TermSpec::ENTRIES, indent),
        What::Lattices => family(out, LatticeSpec::ENTRIES, indent),
        What::States => family(out, StateSpec::ENTRIES, indent),
        What::Guesses => family(out, GuessSpec::ENTRIES, indent),
        What::Optimisers => family(out, OptimiserSpec::ENTRIES, indent),
        What::Formats => {
            let rows: Vec<_> = KINDS.iter().map(|kind| (kind.name, kind.summary)).collect();
            table(out, &rows, indent)?;
            writeln!(out, "{indent}read as states and paths:")?;
            let rows: Vec<_> = FORMATS.iter().map(|format| (format.name, format.summary)).collect();
            table(out, &rows, &format!("{indent}  "))
        }
        What::Materials => materials(out, indent),
    }
}

/// The library, with what follows from each material's numbers.
fn materials(out: &mut impl Write, indent: &str) -> io::Result<()> {
    let all = library::library().map_err(io::Error::other)?;
    let heads = ["name", "what it is", "Ms or moment", "l_ex", "wall width", "wall energy"].map(String::from);
    let shown = |m: &LibraryMaterial| {
        let s = MaterialScales::of(&m.material);
        let (ms, moment) = (m.material.Ms.as_ref(), m.material.moment.as_ref());
        let ms = ms.and_then(|p| p.written().first().map(|ms| format!("{:.0} kA/m", 1e-3 * ms.0)));
        let moment = moment.and_then(|p| p.written().first().map(|m| format!("{} μ_B", m.0)));
        let or = |a: Option<String>, b: Option<String>| a.or(b).unwrap_or_else(|| "–".into());
        let with = |x: Option<f64>, unit: &str| x.map(|x| format!("{x:.2} {unit}"));
        [
            m.key.to_string(),
            m.material.name.clone(),
            or(ms, moment),
            or(with(s.exchange_length_nm, "nm"), None),
            or(with(s.wall_width_nm, "nm"), with(s.wall_width_sites, "sites")),
            or(with(s.wall_energy_mj_per_m2, "mJ/m²"), with(s.wall_energy_mev, "meV")),
        ]
    };
    let rows: Vec<[String; 6]> = std::iter::once(heads).chain(all.iter().map(shown)).collect();
    let width = |c: usize| rows.iter().map(|r| r[c].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2, 3, 4, 5].map(width);
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, w)| format!("{cell:w$}")).collect();
        writeln!(out, "{indent}{}", cells.join("  ").trim_end())?;
    }
    writeln!(
        out,
        "{indent}l_ex = √(2A/μ₀Ms²), wall width δ = √(A/|K|) or √(J/2K), wall energy 4√(AK) or 2√(2JK) a chain."
    )?;
    writeln!(
        out,
        "{indent}Magnetostatics are a term of the config: \"energy\": [{{\"demag\": {{}}}}]. Sources: configs/materials/."
    )
}

fn family(out: &mut impl Write, entries: &[Entry], indent: &str) -> io::Result<()> {
    let width = entries.iter().map(|e| e.name.len()).max().unwrap_or(0);
    for e in entries {
        writeln!(out, "{indent}{:width$}  {}", e.name, e.summary)?;
        writeln!(out, "{indent}{:width$}  {}", "", e.example)?;
    }
    Ok(())
}

fn table(out: &mut impl Write, rows: &[(&str, &str)], indent: &str) -> io::Result<()> {
    let width = rows.iter().map(|(name, _)| name.len()).max().unwrap_or(0);
    rows.iter().try_for_each(|(name, summary)| writeln!(out, "{indent}{name:width$}  {summary}"))
}
