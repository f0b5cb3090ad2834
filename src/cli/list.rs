//! `list`: what a config can ask for, from the registries that the code itself uses.

use super::{List, What};
use anyhow::Result;
use clap::ValueEnum;
use spinneb::config::MaterialScales;
use spinneb::config::library::{self, LibraryMaterial};
use spinneb::energy::TermSpec;
use spinneb::files::FORMATS;
use spinneb::optimise::OptimiserSpec;
use spinneb::output::KINDS;
use spinneb::path::guess::GuessSpec;
use spinneb::registry::Entry;
use spinneb::state::StateSpec;
use std::io::{self, Write};

/// Prints the lists asked for.
pub fn list(arguments: &List) -> Result<u8> {
    let mut out = io::stdout().lock();
    match arguments.what {
        Some(what) => print(&mut out, what, "")?,
        None => {
            for (k, what) in What::value_variants().iter().enumerate() {
                let name = what.to_possible_value().map(|v| v.get_name().to_string()).unwrap_or_default();
                writeln!(out, "{}{name}", if k > 0 { "\n" } else { "" })?;
                print(&mut out, *what, "  ")?;
            }
        }
    }
    out.flush()?;
    Ok(0)
}

fn print(out: &mut impl Write, what: What, indent: &str) -> io::Result<()> {
    match what {
        What::Terms => family(out, TermSpec::ENTRIES, indent),
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
