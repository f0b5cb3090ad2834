//! `spinneb`: arguments → configs → runs → results.

mod cli;

use clap::Parser;
use cli::{Cli, Command};
use std::process::ExitCode;

/// A long chain's arrays are made and given back by the dozen; to have each from the system anew, a page at a time, took a tenth
/// of a run of 100,000 spins.
#[cfg(feature = "mimalloc")]
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> ExitCode {
    let done = match Cli::parse().command {
        Command::Run(arguments) => cli::run::run(&arguments),
        Command::Relax(arguments) => cli::relax::relax(&arguments),
        Command::Landscape(arguments) => cli::landscape::landscape(&arguments),
        Command::Sweep(arguments) => cli::sweep::sweep(&arguments),
        Command::Collect(arguments) => cli::collect::collect(&arguments),
        Command::Check(arguments) => cli::check::check(&arguments),
        Command::List(arguments) => cli::list::list(&arguments),
        Command::Rate(arguments) => cli::rate::rate(&arguments),
        Command::Plot(arguments) => cli::plot::plot(&arguments),
        Command::Init(arguments) => cli::start::init(&arguments),
        Command::Schema => cli::start::print_schema(),
        Command::Completions(arguments) => cli::start::completions(&arguments),
        Command::Man(arguments) => cli::start::man(&arguments),
    };
    ExitCode::from(done.unwrap_or_else(|error| cli::report(&error)))
}
