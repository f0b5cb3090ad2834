//! `list`: what a config can ask for, from the registries that the code itself uses.

use super::{List, What};
use anyhow::Result;
use clap::ValueEnum;
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
        What::Materials => writeln!(
            out,
            "{indent}none comes with the program yet: \"material\" is the path of a file, or the material itself"
        ),
    }
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
