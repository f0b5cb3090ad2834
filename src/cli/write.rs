//! Writes the files of a result.

use crate::config::Loaded;
use crate::drive::Outcome;
use crate::output::folder::{self, NewResult};
use crate::output::{Group, INPUTS, Kind, file_names, render_files};
use std::path::{Path, PathBuf};

/// What happens with an earlier result, and the source of the new one.
#[derive(Clone, Copy, Debug)]
pub(super) enum Earlier<'a> {
    /// It is kept beside the new one.
    IsKept(Option<&'a str>),
    /// The new one takes its place.
    GivesWay(Option<&'a str>),
}

/// Writes the files of a result; where an earlier one is kept.
pub(super) fn write(
    loaded: &Loaded,
    outcome: &Outcome,
    directory: &Path,
    earlier: Earlier,
    force: bool,
) -> crate::error::Result<Option<PathBuf>> {
    let files = render_files(&loaded.report(outcome)?, wanted(loaded))?;
    let (Earlier::IsKept(source) | Earlier::GivesWay(source)) = earlier;
    let keep_earlier = matches!(earlier, Earlier::IsKept(_));
    folder::write_result(directory, &NewResult { files: &files, source, keep_earlier, force })
}

/// Which kinds of files the config asks for.
fn wanted(loaded: &Loaded) -> impl Fn(&Kind) -> bool {
    let output = &loaded.config.output;
    let named = |list: &[String], kind: &Kind| list.iter().any(|name| name == kind.name);
    move |kind| match kind.group {
        Group::Always => true,
        Group::Formats | Group::OnRequest => named(&output.formats, kind),
        Group::Plots => named(&output.plots, kind),
    }
}

/// Names of all files that the config's result may have.
pub(super) fn names(loaded: &Loaded) -> Vec<String> {
    let folder = format!("{INPUTS}/");
    let names = file_names(wanted(loaded)).into_iter().filter(|name| *name != folder);
    names.chain(loaded.inputs.iter().map(|file| file.name.clone())).collect()
}
