//! `spinneb`, the program.

use std::env::{args_os, current_exe};
use std::process::ExitCode;

/// A long chain's arrays are made and given back by the dozen; to have each from the system anew, a page at a time, took a tenth
/// of a run of 100,000 spins. In small pages (`no_thp`): huge ones, cleared whole when first touched, took a quarter of a film's run.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let program: Vec<_> = current_exe().into_iter().map(Into::into).collect();
    ExitCode::from(spinneb::cli::main(&program, args_os().skip(1)))
}
