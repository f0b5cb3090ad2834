//! What a command says of one of its configs while it works, in lines that begin with the name of that.

use super::note;
use crate::record::{Checkpoint, Lock};
use std::fmt::Display;
use std::path::Path;

/// Says it, or keeps quiet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Messages<'a> {
    pub name: &'a str,
    pub quiet: bool,
}

impl Messages<'_> {
    /// A line.
    pub fn line(&self, words: impl Display) {
        if !self.quiet {
            note(&format!("{}: {words}", self.name));
        }
    }

    /// A line for each.
    pub fn warnings(&self, warnings: &[String]) {
        warnings.iter().for_each(|warning| self.line(format_args!("warning: {warning}")));
    }

    /// That a folder holds what is asked for, and how to have it anew.
    pub fn is_done(&self, directory: &Path, again: &str) {
        self.line(format_args!(
            "{} holds the finished result of this config already; --force {again} it again",
            directory.display()
        ));
    }

    /// Where a lock cannot be relied on.
    pub fn lock(&self, lock: &Lock, directory: &Path, who: &str) {
        if !lock.is_sure() {
            self.line(format_args!(
                "the file system of {} has no locks: see to it that {who} writes there",
                directory.display()
            ));
        }
    }
}

/// How what was stopped goes on.
pub(super) fn how_it_goes_on(directory: &Path, resumes: bool) -> &'static str {
    match (Checkpoint::exists(directory), resumes) {
        (true, true) => "the same command goes on from there",
        (true, false) => "--resume goes on from there",
        (false, _) => "there is no checkpoint to go on from",
    }
}
