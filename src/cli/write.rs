//! Writes the files of a result.

use crate::config::Loaded;
use crate::drive::Outcome;
use crate::output::folder::{self, Kept, NewResult};
use std::path::Path;

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
) -> crate::error::Result<Option<Kept>> {
    let files = loaded.files(outcome)?;
    let (Earlier::IsKept(source) | Earlier::GivesWay(source)) = earlier;
    let keep_earlier = matches!(earlier, Earlier::IsKept(_));
    folder::write_result(directory, &NewResult { files: &files, source, keep_earlier, force })
}
