//! The points of a sweep, checked, where their results are, and how some of them are named.

use super::{note, report};
use crate::config::sweep::Sweep;
use crate::error::Error;
use crate::output::sweep::SweepIndex;
use anyhow::Result;
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// Most errors that are told one by one.
const TOLD: usize = 20;

/// Where the results of a sweep go.
pub(super) fn folder(out: Option<&Path>, sweep: &Sweep) -> PathBuf {
    out.map_or_else(|| Path::new("results").join(&sweep.name), Path::to_path_buf)
}

/// What the sweep consists of, with all points checked; nothing if one of them is wrong, which is said. The physics of each is
/// built too where it is about to run.
pub(super) fn checked(sweep: &Sweep, build: bool) -> Result<Option<SweepIndex>> {
    let hash = |point: usize| -> crate::error::Result<String> {
        let loaded = sweep.load_point(point)?;
        if build {
            sweep.problem(point, &loaded)?;
        }
        Ok(loaded.sha256)
    };
    let found: Vec<_> = (0..sweep.len()).into_par_iter().map(hash).collect();
    let mut hashes = Vec::new();
    let mut errors: Vec<Error> = Vec::new();
    for one in found {
        match one {
            Ok(hash) => hashes.push(hash),
            // points that share a value share what is wrong with it
            Err(error) if errors.iter().any(|e| e.to_string() == error.to_string()) => {}
            Err(error) => errors.push(error),
        }
    }
    let more = errors.len().saturating_sub(TOLD);
    let any = !errors.is_empty();
    errors.into_iter().take(TOLD).for_each(|error| _ = report(&error.into()));
    if more > 0 {
        note(&format!("error: and {more} more"));
    }
    Ok((!any).then(|| sweep.index(hashes)))
}

/// The points from one to another, both with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    /// The first.
    pub first: usize,
    /// The last.
    pub last: usize,
}

/// `17` or `20-39`.
pub(super) fn part(text: &str) -> std::result::Result<Part, String> {
    let number = |text: &str| {
        text.parse::<usize>().map_err(|_| format!("found {text:?}, expected a point's number, or two: 20-39"))
    };
    match text.split_once('-') {
        None => number(text).map(|k| Part { first: k, last: k }),
        Some((first, last)) => {
            let (first, last) = (number(first)?, number(last)?);
            let reversed = || format!("found {text}, expected the smaller number first");
            (first <= last).then_some(Part { first, last }).ok_or_else(reversed)
        }
    }
}

/// Most shares.
const MOST: usize = 1000;

/// Shares, and how many there are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShareOf {
    /// Which.
    pub part: Part,
    /// Of how many.
    pub shares: usize,
}

/// `3/8` or `0-3/8`.
pub(super) fn share(text: &str) -> std::result::Result<ShareOf, String> {
    let wrong = || format!("found {text:?}, expected a share and how many there are: 3/8, or 0-3/8");
    let (own, shares) = text.split_once('/').ok_or_else(wrong)?;
    let shares: usize = shares.parse().map_err(|_| wrong())?;
    let part = part(own).map_err(|_| wrong())?;
    match shares {
        1..=MOST if part.last < shares => Ok(ShareOf { part, shares }),
        1..=MOST => Err(format!("found {text}, but of {shares} shares the last is {}", shares - 1)),
        _ => Err(format!("found {text}, but shares are 1 to {MOST}")),
    }
}
