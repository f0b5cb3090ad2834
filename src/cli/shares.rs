//! A landscape whose search is shared by several processes: one share, or some, and the results of all of them.

use super::collect::Collect;
use super::landscape::{Arguments, folder_of, print, write};
use super::messages::Messages;
use super::points::ShareOf;
use super::progress::Progress;
use super::signals::Signals;
use super::threads::start_threads;
use super::{UNFINISHED, USAGE, note};
use crate::config::{Loaded, VERSION, discard_leftovers, load_landscape};
use crate::drive::survey::{survey, take_part};
use crate::error::Error;
use crate::record::{Identity, ShareHead, Shares};
use crate::words::counted;
use anyhow::Result;
use serde_json::{Value, json};
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Makes shares of a search.
pub(super) fn take(arguments: &Arguments, of: ShareOf) -> Result<u8> {
    start_threads(arguments.threads)?;
    let set = arguments.set();
    let loaded = load_landscape(&arguments.config, &set)?;
    let (name, directory) = (&loaded.name, folder_of(&loaded.name, arguments.out.as_deref()));
    let messages = Messages { name, quiet: arguments.quiet };
    let mut asked = loaded.survey()?;
    asked.shares = of.shares;
    let signals = Signals::watch()?;
    asked.problem.control.obey(signals.switch());
    if loaded.is_finished(&directory, &loaded.survey_file_names(), false)? {
        messages.line(format_args!("{} holds the finished result of this config already", directory.display()));
        return print(arguments.json, name, &directory);
    }
    let mut progress = Progress::new(name, arguments.quiet);
    let head = head(&loaded, of.shares, &arguments.config, set);
    let shares = Shares::join(&directory, &head, Some(of.part.first..=of.part.last), progress.speaker())?;
    asked.problem.control.record(Box::new(shares));
    let searched = match (take_part(&asked, &mut progress), signals.caught()) {
        (Ok(searched), _) => searched,
        (Err(Error::Stopped), Some((code, word))) => {
            let stage = progress.stage_now().to_string();
            drop(progress);
            messages.line(format_args!("{word} while {stage}; the same command goes on from there"));
            return Ok(code);
        }
        (Err(error), _) => return Err(error.into()),
    };
    drop(progress);
    Shares::end(&directory)?;
    let code = if searched.spent { UNFINISHED } else { 0 };
    let line = match arguments.json {
        true => json!({
            "name": name,
            "shares": of.shares,
            "searches": searched.searches,
            "finished": !searched.spent,
            "exit_code": code,
            "directory": directory.to_string_lossy(),
        })
        .to_string(),
        false => format!(
            "{name}: all {} shares are at their end after {}; `spinneb collect {}` makes the results of them",
            of.shares,
            counted(searched.searches, "search", "searches"),
            directory.display()
        ),
    };
    writeln!(io::stdout(), "{line}")?;
    Ok(code)
}

/// Who may take part.
fn head(loaded: &Loaded, shares: usize, config: &Path, set: Vec<String>) -> ShareHead {
    let config = fs::canonicalize(config).unwrap_or_else(|_| config.into());
    ShareHead { identity: Identity::of(VERSION, &loaded.sha256), shares, config, set }
}

/// Whether what is to be collected is a landscape: its config, or a folder with shares of one.
pub(super) fn is_landscape(target: &Path) -> Result<bool> {
    if target.is_dir() {
        return Ok(ShareHead::read(target)?.is_some());
    }
    let value: Option<Value> = fs::read(target).ok().and_then(|bytes| serde_json::from_slice(&bytes).ok());
    Ok(value.is_some_and(|value| value.get("lattice").is_some() && value.get("config").is_none()))
}

/// Makes the results of a search that was shared.
pub(super) fn collect(arguments: &Collect) -> Result<u8> {
    let given = (!arguments.target.is_dir()).then(|| load_landscape(&arguments.target, &[])).transpose()?;
    let directory: PathBuf = match &given {
        Some(config) => folder_of(&config.name, arguments.out.as_deref()),
        None => arguments.target.clone(),
    };
    let place = directory.display();
    let (head, loaded) = match (ShareHead::read(&directory)?, given) {
        (Some(head), given) => {
            let config = given.map_or(&head.config, |_| &arguments.target);
            let loaded = load_landscape(config, &head.set)?;
            (head, loaded)
        }
        (None, Some(config)) if config.is_finished(&directory, &config.survey_file_names(), false)? => {
            return print(arguments.json, &config.name, &directory);
        }
        _ => {
            let config = arguments.target.display();
            note(&format!(
                "error: {place} has no shares; `spinneb landscape {config} --index 0/8` makes the first of eight"
            ));
            return Ok(USAGE);
        }
    };
    if !Shares::are_done(&directory) {
        let (config, last) = (head.config.display(), head.shares - 1);
        note(&format!(
            "error: the search in {place} is not at its end: wait for its shares, or go on with `spinneb landscape {config} --out \
             {place} --index 0-{last}/{}`",
            head.shares
        ));
        return Ok(UNFINISHED);
    }
    finish(arguments, &loaded, &head, &directory)
}

/// Writes the results of shares that are at their end.
fn finish(arguments: &Collect, loaded: &Loaded, there: &ShareHead, directory: &Path) -> Result<u8> {
    let name = &loaded.name;
    let Some(_lock) = loaded.reserve(directory, &loaded.survey_file_names(), false)? else {
        Shares::discard(directory)?;
        return print(arguments.json, name, directory);
    };
    let mut asked = loaded.survey()?;
    asked.shares = there.shares;
    let signals = Signals::watch()?;
    asked.problem.control.obey(signals.switch());
    let mut progress = Progress::new(name, arguments.quiet);
    let own = ShareHead { identity: Identity::of(VERSION, &loaded.sha256), ..there.clone() };
    let shares = Shares::join(directory, &own, None, progress.speaker())?;
    asked.problem.control.record(Box::new(shares));
    let found = match (survey(&asked, &mut progress), signals.caught()) {
        (Err(Error::Stopped), Some((code, _))) => return Ok(code),
        (found, _) => found?,
    };
    drop(progress);
    write(loaded, &found, directory, false)?;
    drop(asked);
    discard_leftovers(directory)?;
    Shares::discard(directory)?;
    if !arguments.quiet {
        let warnings = loaded.survey_report(&found)?.warnings();
        warnings.iter().for_each(|warning| note(&format!("{name}: warning: {warning}")));
    }
    print(arguments.json, name, directory)
}
