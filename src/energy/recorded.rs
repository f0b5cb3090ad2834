//! Computations whose results are recorded, or taken from the record of an interrupted run.

use super::Evaluator;
use crate::control::Call;
use crate::error::Result;
use crate::record::Fingerprint;
use serde::Serialize;
use serde::de::DeserializeOwned;

/// A result that can be stored.
pub trait Stored: Serialize + DeserializeOwned {
    /// It as it was when it was stored; nothing where it cannot be a result for this energy.
    fn restored(self, h: Evaluator) -> Option<Self>;
}

/// The result of `compute`, or what an interrupted run had as its result of this kind for this input.
pub fn recorded<T: Stored>(
    h: Evaluator,
    kind: &str,
    input: &[&[f64]],
    compute: impl FnOnce() -> Result<T>,
) -> Result<T> {
    through(h, &h.call(kind, |print| rows(print, input)), compute)
}

/// What tells an input from another.
pub(super) fn rows(print: Fingerprint, input: &[&[f64]]) -> Fingerprint {
    input.iter().fold(print, |print, row| print.row(row))
}

/// The result of a call.
pub(super) fn through<T: Stored>(h: Evaluator, call: &Call, compute: impl FnOnce() -> Result<T>) -> Result<T> {
    call.obey(|| None::<T>)?;
    if let Some(found) = call.answer(|found: T| found.restored(h)) {
        return Ok(found);
    }
    let found = compute();
    // what a stopped computation returns is no result
    call.obey(|| None::<T>)?;
    let found = found?;
    call.finish(|| &found);
    Ok(found)
}

impl<T: Stored> Stored for Option<T> {
    fn restored(self, h: Evaluator) -> Option<Self> {
        self.map_or(Some(None), |one| one.restored(h).map(Some))
    }
}

impl<T: Stored> Stored for Vec<T> {
    fn restored(self, h: Evaluator) -> Option<Self> {
        self.into_iter().map(|one| one.restored(h)).collect()
    }
}
