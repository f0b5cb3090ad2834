//! What helps to start: starter configs, the schema, completions of the command line, man pages.

use super::{Cli, Completions, Init, Man, SchemaOf, USAGE, note};
use crate::config::{SCHEMA_FILE, landscape_schema, schema, sweep_schema};
use crate::files::disk;
use anyhow::Result;
use clap::{CommandFactory, ValueEnum};
use serde_json::Value;
use std::io::{self, Write};
use std::path::PathBuf;

/// The starter configs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Template {
    /// Reversal of a chain of atoms, with most keys explained
    Chain,
    /// A domain wall in a wire of micromagnetic cells, in SI units
    Nanowire,
    /// Rates and lifetimes of a short chain
    Lifetime,
    /// A skyrmion in a film of atoms, and how it leaves
    Film,
    /// A particle cut from a crystal of two kinds of atoms
    Crystal,
}

impl Template {
    fn text(self) -> &'static str {
        match self {
            Template::Chain => include_str!("templates/chain.json"),
            Template::Nanowire => include_str!("templates/nanowire.json"),
            Template::Lifetime => include_str!("templates/lifetime.json"),
            Template::Film => include_str!("templates/film.json"),
            Template::Crystal => include_str!("templates/crystal.json"),
        }
    }

    fn name(self) -> String {
        self.to_possible_value().map_or_else(String::new, |v| v.get_name().to_string())
    }
}

/// Writes a starter config and the schema that it names beside it.
pub fn init(arguments: &Init) -> Result<u8> {
    let file = arguments.out.clone().unwrap_or_else(|| PathBuf::from(format!("{}.json", arguments.template.name())));
    let shown = file.display();
    if disk::kind(&file)? != disk::Kind::Nothing && !arguments.force {
        note(&format!("error: {shown} exists already; use --force to replace it, or another name with --out"));
        return Ok(USAGE);
    }
    // an older schema gives way
    let beside = file.with_file_name(SCHEMA_FILE);
    if !arguments.force && !is_schema(disk::read_if_there(&beside)?) {
        let beside = beside.display();
        note(&format!("error: {beside} is there and is not the schema of another version; use --force to replace it"));
        return Ok(USAGE);
    }
    disk::write_file(&file, arguments.template.text().as_bytes())?;
    disk::write_file(&beside, schema().as_bytes())?;
    note(&format!("{shown} is written, and {} for editors that complete and check it", beside.display()));
    note(&format!("next: spinneb check {shown}, then spinneb run {shown}"));
    Ok(0)
}

/// Whether a file is a schema of configs, or not there.
fn is_schema(bytes: Option<Vec<u8>>) -> bool {
    let title = |text: &[u8]| Some(serde_json::from_slice::<Value>(text).ok()?.get("title")?.clone());
    bytes.is_none_or(|bytes| title(&bytes).is_some() && title(&bytes) == title(schema().as_bytes()))
}

/// Files that have a schema.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Described {
    /// A config, for `run`, `relax` and `check`
    Config,
    /// A sweep
    Sweep,
    /// A config for `landscape`, whose ends may be left out
    Landscape,
}

/// Prints a schema.
pub fn print_schema(arguments: &SchemaOf) -> Result<u8> {
    let text = match arguments.what {
        Described::Config => schema(),
        Described::Sweep => sweep_schema(),
        Described::Landscape => landscape_schema(),
    };
    print(text.as_bytes())
}

/// Prints the completions for a shell.
pub fn completions(arguments: &Completions) -> Result<u8> {
    let mut script = Vec::new();
    clap_complete::generate(arguments.shell, &mut Cli::command(), "spinneb", &mut script);
    print(&script)
}

/// Prints a man page.
pub fn man(arguments: &Man) -> Result<u8> {
    let mut all = Cli::command();
    all.build();
    let page = match &arguments.command {
        None => all,
        Some(name) => match all.find_subcommand(name) {
            Some(command) => command.clone().display_name(format!("spinneb-{name}")),
            None => {
                let known: Vec<&str> = all.get_subcommands().map(clap::Command::get_name).collect();
                note(&format!("error: unknown command {name:?} (known commands: {})", known.join(", ")));
                return Ok(USAGE);
            }
        },
    };
    let mut text = Vec::new();
    clap_mangen::Man::new(page).render(&mut text)?;
    print(&text)
}

fn print(bytes: &[u8]) -> Result<u8> {
    let mut out = io::stdout().lock();
    out.write_all(bytes)?;
    out.flush()?;
    Ok(0)
}
