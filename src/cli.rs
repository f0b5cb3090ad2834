//! The command line: what can be said, and the help about it. [`main`] is the whole program, for whoever starts it.

mod check;
mod collect;
mod docs;
mod drawing;
mod import;
mod jobs;
mod landscape;
mod list;
mod messages;
mod plot;
mod points;
mod progress;
mod rate;
mod relax;
mod run;
mod shares;
mod signals;
mod start;
mod sweep;
mod threads;
mod usage;
mod write;

pub use check::report_of;
pub use threads::check_threads;

use crate::config::{Keeping, rates};
use crate::error::Error;
use crate::files::disk::Kind;
use crate::output::Picture;
use crate::output::canvas::Style;
use crate::rates::Theory;
use crate::units::{Temperature, Time};
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

/// Exit code of a command line or config that is wrong.
pub(crate) const USAGE: u8 = 2;
/// Exit code of a run that finished without a converged result.
pub(crate) const UNFINISHED: u8 = 3;

/// Arguments → configs → runs → results: does what a command line asks for, without the name of the program, and returns its exit
/// code. `program` is the command, with the arguments that come first, that starts this program again.
pub fn main(program: &[OsString], arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let name = OsString::from("spinneb");
    let command = match Cli::try_parse_from([name].into_iter().chain(arguments)) {
        Ok(line) => line.command,
        Err(words) => return usage::say(words),
    };
    let done = match command {
        Command::Run(arguments) => run::run(&arguments),
        Command::Relax(arguments) => relax::relax(&arguments),
        Command::Landscape(arguments) => match arguments.index {
            Some(index) => shares::take(&arguments, index),
            None => landscape::landscape(&arguments),
        },
        Command::Sweep(arguments) => sweep::sweep(&arguments, program),
        Command::Collect(arguments) => match shares::is_landscape(&arguments.target) {
            Ok(true) => shares::collect(&arguments),
            Ok(false) => collect::collect(&arguments),
            Err(error) => Err(error),
        },
        Command::Check(arguments) => check::check(&arguments),
        Command::List(arguments) => list::list(&arguments),
        Command::Docs(arguments) => docs::docs(&arguments),
        Command::Rate(arguments) => rate::rate(&arguments),
        Command::Plot(arguments) => plot::plot(&arguments),
        Command::Import(arguments) => import::import(&arguments),
        Command::Init(arguments) => start::init(&arguments),
        Command::Schema(arguments) => start::print_schema(&arguments),
        Command::Completions(arguments) => start::completions(&arguments),
        Command::Man(arguments) => start::man(&arguments),
    };
    done.unwrap_or_else(|error| report(&error))
}

/// Minimum-energy paths, barriers and saddles of spins on a lattice
#[derive(Debug, Parser)]
#[command(name = "spinneb", version, arg_required_else_help = true, after_help = EXAMPLES)]
pub(crate) struct Cli {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

const EXAMPLES: &str = "\
Examples:
  spinneb init                          a config to start from: chain.json
  spinneb check configs/wall_depinning.json     what would run, and whether the config is right
  spinneb run configs/wall_depinning.json       find the path; results in results/wall_depinning/
  spinneb list terms                    what can be written in a config
  spinneb rate results/wall_depinning --temperature 300K     how long the states live
  spinneb plot results/a results/b      the energy paths of two results in one figure

Exit codes:
  0    converged and certified
  3    finished without that: results are written and say why
  2    the command line or a config is wrong, or its results cannot go where they are to
  130  interrupted (143 terminated)
  1    anything else, such as a disk that is full";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Find the minimum-energy path of each config and write its results
    Run(Run),
    /// Relax the states of configs: energy, torque, minimum or not, lowest modes, zero modes
    Relax(relax::Relax),
    /// Find all minima and saddles below an energy: their graph, and how long states live
    Landscape(landscape::Arguments),
    /// Run a config at many values of its keys
    Sweep(sweep::Arguments),
    /// Put the results of a sweep into one table and one figure, or the shares of a landscape into its results
    Collect(collect::Collect),
    /// Validate configs and print what would run: sites, energy scales, wall width, images, memory
    Check(Check),
    /// List what a config can ask for, with a line about each
    List(List),
    /// Print what a key of a config means, what it takes, and what holds if it is left out
    Docs(docs::Arguments),
    /// Rates and lifetimes over the saddles of results that are there already
    Rate(Rate),
    /// Draw the figures of results that are there already, or several energy paths over each other
    Plot(Plot),
    /// Make a config of the files of another code: UppASD, VAMPIRE, TB2J, Spirit
    Import(import::Arguments),
    /// Write a starter config with explanations, and the schema beside it
    Init(Init),
    /// Print the JSON Schema of a config, a sweep or a landscape, for editors that complete and check it
    Schema(SchemaOf),
    /// Print the completions of this command line for a shell
    Completions(Completions),
    /// Print a man page
    Man(Man),
}

/// The arguments of `init`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb init
  spinneb init nanowire --out wires/first.json")]
pub(crate) struct Init {
    /// Which config to start from
    #[arg(value_enum, default_value = "chain")]
    pub template: start::Template,

    /// The file to write [default: <template>.json]
    #[arg(short, long, value_name = "FILE")]
    pub out: Option<PathBuf>,

    /// Replace the file if it exists
    #[arg(long)]
    pub force: bool,
}

/// The arguments of `schema`.
#[derive(Debug, Args)]
pub(crate) struct SchemaOf {
    /// Of which file
    #[arg(value_enum, default_value = "config")]
    pub what: start::Described,
}

/// The arguments of `completions`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb completions bash > ~/.local/share/bash-completion/completions/spinneb
  spinneb completions fish > ~/.config/fish/completions/spinneb.fish
  spinneb completions zsh > ~/.zfunc/_spinneb")]
pub(crate) struct Completions {
    /// For which shell
    #[arg(value_enum)]
    pub shell: clap_complete::Shell,
}

/// The arguments of `man`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb man > ~/.local/share/man/man1/spinneb.1
  spinneb man run | man -l -")]
pub(crate) struct Man {
    /// The command to tell of; all of them in short if left out
    #[arg(value_name = "COMMAND")]
    pub command: Option<String>,
}

/// The arguments of `run`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb run wall.json
  spinneb run wall.json --set path.images=41 --set 'energy[0].anisotropy.K=\"-0.3 meV\"' --out results/strong
  spinneb run configs/*.json --json --quiet > summaries.jsonl
  spinneb run long.json --resume")]
pub(crate) struct Run {
    /// Configs to run, one after the other
    #[arg(required = true, value_name = "CONFIG")]
    pub configs: Vec<PathBuf>,

    /// Folder for the results; with several configs, each gets a folder of its name in it [default: results/<name>]
    #[arg(short, long, value_name = "DIR")]
    pub out: Option<PathBuf>,

    /// Number of threads; results do not depend on it [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub threads: Option<NonZeroUsize>,

    /// Change a value of the config; may be given several times
    ///
    /// The path is written as in messages (energy[0].anisotropy.K, or energy.0.anisotropy.K). The value is JSON, so a
    /// string needs its double quotes: --set 'energy[0].anisotropy.K="1 meV"'. Missing keys are added.
    #[arg(long, value_name = "KEY.PATH=JSON")]
    pub set: Vec<String>,

    /// How long passes below the best of the first paths are looked for, in place of the config's `search.effort`
    #[arg(long, value_enum)]
    pub effort: Option<Looking>,

    /// Replace results that are in the folder
    #[arg(long)]
    pub force: bool,

    /// No progress and no messages, only errors and results
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON for each result on stdout
    #[arg(long)]
    pub json: bool,

    /// Go on from the last checkpoint in the folder; without one, start anew
    #[arg(long)]
    pub resume: bool,

    /// How often a checkpoint is written; "off" writes none
    ///
    /// The first one is written after this time: shorter runs write none, unless they are interrupted.
    #[arg(long, value_name = "TIME", default_value_t, value_parser = interval)]
    pub checkpoint_every: Interval,
}

/// The arguments of `check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb check wall.json
  spinneb check configs/*.json
  spinneb check wall.json --set lattice.chain.sites=500")]
pub(crate) struct Check {
    /// Configs to check
    #[arg(required = true, value_name = "CONFIG")]
    pub configs: Vec<PathBuf>,

    /// Change a value of the config first, as in `run`; may be given several times
    #[arg(long, value_name = "KEY.PATH=JSON")]
    pub set: Vec<String>,
}

/// The arguments of `rate`.
#[derive(Debug, Args)]
#[command(after_help = "\
The saddles and minima are those of the result's path.npz, saddle.ovf and minima.ovf; where these are not there, or the result is
not certified, the path is found anew from its config.json. The files of the result are written again, with its rates.

Examples:
  spinneb rate results/wall --temperature \"300 K\"
  spinneb rate results/* --temperature \"4 K\" --temperature \"77 K\" --damping 0.05 --theory langer")]
pub(crate) struct Rate {
    /// Folders with finished results
    #[arg(required = true, value_name = "RESULT_DIR")]
    pub results: Vec<PathBuf>,

    /// A temperature with its unit; may be given several times
    #[arg(short = 'T', long, required = true, value_name = "QUANTITY", value_parser = temperature, allow_hyphen_values = true)]
    pub temperature: Vec<Temperature>,

    /// Gilbert damping [default: that of the result's config, else 0.1]
    #[arg(long, value_name = "ALPHA", value_parser = damping, allow_hyphen_values = true)]
    pub damping: Option<f64>,

    /// g factor [default: that of the result's config, else 2]
    #[arg(long, value_name = "G", value_parser = g_factor, allow_hyphen_values = true)]
    pub g_factor: Option<f64>,

    /// htst or langer; may be given twice [default: those of the result's config, else both]
    #[arg(long, value_name = "THEORY", value_parser = rates::theory)]
    pub theory: Vec<Theory>,

    /// Number of threads; results do not depend on it [default: all cores]
    #[arg(short, long, value_name = "N", value_parser = at_least_one)]
    pub threads: Option<NonZeroUsize>,

    /// No progress and no messages, only errors and results
    #[arg(short, long)]
    pub quiet: bool,

    /// Print one line of JSON for each result on stdout instead of the table
    #[arg(long)]
    pub json: bool,
}

/// The time between checkpoints; none where there are to be none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval(pub Option<Duration>);

impl Default for Interval {
    fn default() -> Interval {
        Interval(Keeping::default().every)
    }
}

impl fmt::Display for Interval {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self.0 {
            Some(every) => write!(f, "{} s", every.as_secs_f64()),
            None => f.write_str("off"),
        }
    }
}

fn interval(text: &str) -> Result<Interval, String> {
    if text == "off" {
        return Ok(Interval(None));
    }
    if text.parse::<f64>().is_ok() {
        return Err(format!("found {text} without a unit: give \"{text}s\", or \"off\""));
    }
    let time: Time = text.parse().map_err(|e: Error| e.to_string())?;
    let seconds = 1e-12 * time.0;
    match Duration::try_from_secs_f64(seconds) {
        Ok(duration) => Ok(Interval(Some(duration))),
        Err(_) => Err(format!("found {time}, but a checkpoint is written every 0 s or more, or \"off\"")),
    }
}

fn temperature(text: &str) -> Result<Temperature, String> {
    let t: Temperature = text.parse().map_err(|e: Error| e.to_string())?;
    crate::rates::checked_temperature(t)
}

fn damping(text: &str) -> Result<f64, String> {
    crate::rates::checked_damping(plain_number(text)?)
}

fn g_factor(text: &str) -> Result<f64, String> {
    crate::rates::checked_g_factor(plain_number(text)?)
}

/// How many of what there has to be one of.
fn at_least_one(text: &str) -> Result<NonZeroUsize, String> {
    text.parse().map_err(|_| format!("found {text:?}, expected a whole number, 1 or more"))
}

fn plain_number(text: &str) -> Result<f64, String> {
    text.parse().map_err(|_| format!("found {text:?}, expected a number"))
}

/// The arguments of `plot`.
#[derive(Debug, Args)]
#[command(after_help = "\
Nothing is run: the figures are drawn from the files of the results. Those of one result go where it is, unless --out names
another folder; several results make energy_paths.svg and .png in the current folder, or what --out names.
A file that is no figure of the same results is left as it is.

Examples:
  spinneb plot results/wall
  spinneb plot results/wall --style dark --width 120 --out talk
  spinneb plot results/weak results/strong --labels \"K = 0.2 meV,K = 0.5 meV\" --out comparison.svg")]
pub(crate) struct Plot {
    /// Folders with finished results
    #[arg(required = true, value_name = "RESULT_DIR")]
    pub results: Vec<PathBuf>,

    /// Names in the legend, one for each result [default: the names of the results]
    #[arg(long, value_name = "A,B", value_delimiter = ',')]
    pub labels: Vec<String>,

    /// Folder for the figures; with several results it may be the name of one, ending in .svg or .png
    #[arg(short, long, value_name = "PATH")]
    pub out: Option<PathBuf>,

    /// paper, slides (text and lines 1.7 times larger) or dark [default: as the result's config says, else paper]
    #[arg(long, value_name = "STYLE", value_parser = plot::style)]
    pub style: Option<Style>,

    /// Width of the figures in mm; text keeps its size [default: as the result's config says, else 85, for slides 144.5]
    #[arg(long, value_name = "MM", value_parser = plot::width_mm)]
    pub width: Option<f64>,

    /// svg or png [default: both]
    #[arg(long, value_name = "FORMAT", value_delimiter = ',', value_parser = plot::picture)]
    pub format: Vec<Picture>,

    /// Replace files of the figures' names whatever they are
    #[arg(long)]
    pub force: bool,

    /// No messages, only errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// The arguments of `list`.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  spinneb list
  spinneb list optimisers
  spinneb list states domain_wall
  spinneb list materials fept")]
pub(crate) struct List {
    /// What to list; everything if left out
    #[arg(value_enum)]
    pub what: Option<What>,

    /// One entry, with all its keys
    pub name: Option<String>,
}

/// How long is looked for lower passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Looking {
    /// Not at all
    None,
    /// Until 8 searches in a row brought no news
    Quick,
    /// Until 24 searches in a row brought no news for each direction of the lattice, and 16 more for each saddle found, up to 100, and to
    /// 100 more for each lower route
    Normal,
    /// Until 400 searches in a row brought no news, or as many as normal waits for
    Thorough,
}

impl Looking {
    /// As `--set` has it, in a block of the config.
    pub(crate) fn setting(self, block: &str) -> String {
        let word = self.to_possible_value().map(|value| value.get_name().to_string()).unwrap_or_default();
        format!("{block}.effort=\"{word}\"")
    }
}

/// What can be listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum What {
    /// Energy terms: exchange, anisotropy, fields
    Terms,
    /// Lattices of sites
    Lattices,
    /// States for the ends of a path
    States,
    /// First guesses of a path
    Guesses,
    /// Methods that move a path to its minimum
    Optimisers,
    /// Files that a run can write, and files that states and paths can be read from
    Formats,
    /// Materials that come with the program
    Materials,
}

/// Prints an error on stderr and says with which code to exit.
pub(crate) fn report(error: &anyhow::Error) -> u8 {
    // A reader that has seen enough (`spinneb list | head -1`) is no error.
    if error.downcast_ref::<io::Error>().is_some_and(|e| e.kind() == ErrorKind::BrokenPipe) {
        return 0;
    }
    let several = match error.downcast_ref::<Error>() {
        Some(Error::Several(errors)) => &errors[..],
        _ => &[],
    };
    several.iter().for_each(|error| note(&format!("error: {error}")));
    match error.downcast_ref::<io::Error>().filter(|e| e.raw_os_error().is_some()) {
        // that of a file would name it
        Some(error) => note(&format!("error: the standard output cannot be written: {error}")),
        None if several.is_empty() => note(&format!("error: {error}")),
        None => {}
    }
    match error.downcast_ref::<Error>() {
        Some(Error::Several(_) | Error::Config { .. } | Error::Invalid { .. }) => USAGE,
        Some(Error::Io { source, .. }) if is_of_the_place(source.kind()) => USAGE,
        _ => 1,
    }
}

/// Whether an error is that of a place which cannot take the files, and another would: of a wrong command line.
fn is_of_the_place(kind: ErrorKind) -> bool {
    use ErrorKind::{AlreadyExists, NotADirectory, PermissionDenied, ReadOnlyFilesystem};
    matches!(kind, AlreadyExists | NotADirectory | PermissionDenied | ReadOnlyFilesystem)
}

/// The worse of two exit codes: 0 is better than 3 (not converged), then 2 (usage), then 1 (anything else).
pub(crate) fn worse(a: u8, b: u8) -> u8 {
    let rank = |code: u8| [0, UNFINISHED, USAGE].iter().position(|c| *c == code).unwrap_or(3);
    if rank(b) > rank(a) { b } else { a }
}

/// Why a file may not be written in the place of what is there, if it may not; what would do is another `what`.
pub(crate) fn in_the_way(there: Kind, force: bool, what: &str) -> Option<String> {
    match there {
        Kind::Nothing => None,
        Kind::File if force => None,
        Kind::File => Some(format!("exists already; use --force to replace it, or another {what} with --out")),
        Kind::Link | Kind::Folder | Kind::Other => Some(format!(
            "is a symbolic link, a folder or a device, and is not replaced; give another {what} with --out"
        )),
    }
}

/// A line on stderr. There is nowhere to say that it cannot be written.
pub(crate) fn note(line: &str) {
    let _ = writeln!(io::stderr(), "{line}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn everything_that_can_be_said_is_understood() {
        let line = "spinneb run a.json b.json --out d --threads 2 --set a.b=1 --set c=2 --force --quiet --json --checkpoint-every 0.5s";
        let Command::Run(run) = Cli::try_parse_from(line.split(' ')).unwrap().command else { panic!("not run") };
        assert_eq!(run.configs, [PathBuf::from("a.json"), PathBuf::from("b.json")]);
        assert_eq!(run.out, Some(PathBuf::from("d")));
        assert_eq!(run.threads.map(NonZeroUsize::get), Some(2));
        assert_eq!(run.set, ["a.b=1", "c=2"]);
        assert!(run.force && run.quiet && run.json && !run.resume);
        assert_eq!(run.checkpoint_every, Interval(Some(Duration::from_millis(500))));
        for line in [
            "spinneb rate results/a b -T 300K -T 4K --damping 0.2 --theory htst --json",
            "spinneb plot results/a results/b --labels a,b --style dark --width 120 --format svg --out c.svg --force -q",
            "spinneb check a.json --set a=1",
            "spinneb list",
            "spinneb list terms",
            "spinneb list states domain_wall",
            "spinneb run a.json --resume",
            "spinneb run a.json --checkpoint-every off",
            "spinneb init",
            "spinneb init nanowire --out a.json --force",
            "spinneb schema",
            "spinneb schema sweep",
            "spinneb docs anisotropy.K",
            "spinneb docs --page",
            "spinneb completions fish",
            "spinneb man run",
            "spinneb relax a.json b.json --set a=1 --out d --force --modes 3 --json",
            "spinneb sweep a.json --list --json",
            "spinneb sweep a.json --index 3 --threads 2 --force",
            "spinneb sweep a.json --jobs 4 --threads 2 --out d --quiet",
            "spinneb collect results/a",
            "spinneb collect a.json --out d --json",
        ] {
            assert!(Cli::try_parse_from(line.split(' ')).is_ok(), "{line}");
        }
    }

    #[test]
    fn the_worst_exit_code_of_several_runs_is_the_code_of_all() {
        let all = |codes: &[u8]| codes.iter().fold(0, |a, b| worse(a, *b));
        assert_eq!((all(&[0, 0]), all(&[0, 3, 0]), all(&[3, 2, 0]), all(&[1, 2, 3])), (0, 3, 2, 1));
    }

    #[test]
    fn a_wrong_command_line_exits_with_2() {
        for line in [
            "spinneb",
            "spinneb run",
            "spinneb check",
            "spinneb list nothing",
            "spinneb run a.json --threads 0",
            "spinneb run a.json --checkpoint-every 10",
            "spinneb run a.json --checkpoint-every=-1s",
            "spinneb run a.json --checkpoint-every 3meV",
            "spinneb walk a.json",
            "spinneb relax",
            "spinneb relax a.json --force",
            "spinneb sweep",
            "spinneb sweep a.json --list --index 3",
            "spinneb sweep a.json --index=-1",
            "spinneb sweep a.json --jobs 0",
            "spinneb collect",
            "spinneb rate results/a",
            "spinneb rate results/a --temperature 300",
            "spinneb rate results/a --temperature 300meV",
            "spinneb rate results/a -T 3K --theory kramers",
            "spinneb plot",
            "spinneb plot results/a --style bright",
            "spinneb plot results/a --width 85nm",
            "spinneb plot results/a --format pdf",
            "spinneb rate results/a -T 3K --damping=-1",
        ] {
            assert_eq!(Cli::try_parse_from(line.split(' ')).unwrap_err().exit_code(), 2, "{line}");
        }
    }
}
