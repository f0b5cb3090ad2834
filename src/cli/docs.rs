//! `docs`: the reference of a key of a config.

use super::{USAGE, note};
use crate::config::reference::{self, Found, Section};
use crate::words::quoted;
use anyhow::Result;
use clap::Args;
use std::io::{self, Write};

/// The arguments of `docs`.
#[derive(Debug, Args)]
#[command(after_help = "\
A name may be a key, the end of its path, or all of it. Several keys of one name are all told of.

Examples:
  spinneb docs anisotropy.K
  spinneb docs 'energy[0].exchange.J'
  spinneb docs skyrmion
  spinneb docs center")]
pub(crate) struct Arguments {
    /// A key, or a part of a config; all keys if left out
    pub key: Option<String>,

    /// All keys as a page in Markdown, that of the book
    #[arg(long, conflicts_with = "key")]
    pub page: bool,
}

/// Prints the reference of a key.
pub fn docs(arguments: &Arguments) -> Result<u8> {
    let mut out = io::stdout().lock();
    if arguments.page {
        out.write_all(reference::page().as_bytes())?;
        return Ok(0);
    }
    let Some(name) = &arguments.key else {
        for section in reference::sections() {
            keys(&mut out, &section)?;
        }
        return Ok(0);
    };
    match reference::find(name) {
        Ok(found) => tell(&mut out, &found)?,
        Err(near) => {
            let hint = match near {
                Some(near) => format!("did you mean {}?", quoted(&near)),
                None => "`spinneb docs` prints all of them".into(),
            };
            note(&format!("error: there is no key {}: {hint}", quoted(name)));
            return Ok(USAGE);
        }
    }
    out.flush()?;
    Ok(0)
}

fn tell(out: &mut impl Write, found: &Found) -> io::Result<()> {
    for (path, key, example) in &found.keys {
        let dot = if path.is_empty() { "" } else { "." };
        writeln!(out, "{path}{dot}{} ({})", key.name, reference::left_out(key))?;
        writeln!(out, "  {}", key.meaning.replace('\n', " "))?;
        writeln!(out, "  value    {}", key.value)?;
        writeln!(out, "  example  \"{}\": {example}", key.name)?;
    }
    for section in &found.parts {
        writeln!(out, "{}: {}", section.path, section.summary.replace('\n', " "))?;
        writeln!(out, "  example  {}", section.example)?;
        keys(out, section)?;
    }
    Ok(())
}

/// A line for each key of a part.
fn keys(out: &mut impl Write, section: &Section) -> io::Result<()> {
    let dot = if section.path.is_empty() { "" } else { "." };
    for (key, _) in &section.keys {
        let meaning = key.meaning.replace('\n', " ");
        writeln!(out, "  {}{dot}{} ({}): {meaning}", section.path, key.name, reference::left_out(key))?;
    }
    Ok(())
}
