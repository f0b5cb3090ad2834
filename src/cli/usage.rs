//! Help, and what is said of a command line that is wrong.

use super::{Cli, USAGE, report};
use crate::words::nearest;
use clap::error::ContextKind::{InvalidSubcommand, SuggestedSubcommand};
use clap::error::ContextValue;
use clap::{Command, CommandFactory, Error};

/// Prints it, and says with which code to exit.
pub(super) fn say(mut words: Error) -> u8 {
    if let Some(meant) = meant(&words) {
        words.insert(SuggestedSubcommand, ContextValue::Strings(vec![meant]));
    }
    match words.print() {
        // of what is wrong there is nowhere to say that it cannot be printed
        Err(error) if !words.use_stderr() => report(&error.into()),
        _ => u8::try_from(words.exit_code()).unwrap_or(USAGE),
    }
}

/// The command that was meant by one that there is not; clap sees no likeness between "rnu" and "run".
fn meant(words: &Error) -> Option<String> {
    let ContextValue::String(word) = words.get(InvalidSubcommand)? else { return None };
    let line = Cli::command();
    let known = nearest(word, line.get_subcommands().map(Command::get_name)).map(String::from);
    known.filter(|_| words.get(SuggestedSubcommand).is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[test]
    fn a_command_that_is_misspelt_is_told_the_one_that_was_meant() {
        for (word, told) in [("rnu", Some("run")), ("chek", Some("check")), ("nothing-like-it", None)] {
            let words = Cli::try_parse_from(["spinneb", word]).unwrap_err();
            let found = match words.get(SuggestedSubcommand) {
                Some(ContextValue::Strings(all)) => all.clone(),
                _ => meant(&words).into_iter().collect(),
            };
            assert_eq!(found.iter().find(|one| Some(one.as_str()) == told).map(String::as_str), told, "{found:?}");
            assert_eq!(found.is_empty(), told.is_none(), "{found:?}");
        }
    }
}
