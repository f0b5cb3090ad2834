//! How many threads a command may have.

use crate::error::Error;
use anyhow::{Context, Result};
use std::num::NonZeroUsize;
use std::thread::available_parallelism;

/// Most threads a core: beyond, they only wait for each other.
const MOST_THREADS: usize = 16;

/// Refuses more threads, so many at a time in each of so many processes, than the machine's cores can be of use to.
pub fn check_threads(jobs: usize, threads: usize) -> Result<(), Error> {
    let cores = available_parallelism().map_or(1, NonZeroUsize::get);
    let most = MOST_THREADS * cores;
    if jobs.saturating_mul(threads) <= most {
        return Ok(());
    }
    let found = if jobs == 1 { format!("{threads}") } else { format!("{threads} for each of {jobs} points at a time") };
    let words = format!(
        "found {found}, but this machine has {cores} cores: at most {MOST_THREADS} threads a core, {most} in all, are started; \
         leave it out for one thread a core"
    );
    Err(Error::invalid("--threads", words))
}

/// As many threads as asked for, else one for each core. This one is among them: it does not wait for the others to begin.
pub(super) fn start_threads(count: Option<NonZeroUsize>) -> Result<()> {
    let count = count.map_or(0, NonZeroUsize::get);
    check_threads(1, count)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count).use_current_thread();
    pool.build_global().context("the threads cannot be started")
}
