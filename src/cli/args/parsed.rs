//! The command line as typed. A negative number is a value of every option, which the option's own range refuses or
//! takes; a number with a decimal comma or with a unit behind it gets a way out.

use std::num::ParseFloatError;

use clap::error::{ContextKind, ContextValue};
use clap::{Command, CommandFactory, Error, FromArgMatches};

use super::CommandLine;
use crate::number_text::number_meant;

/// Reads the command line; ends the program after help and after wrong usage.
pub fn parsed() -> CommandLine {
    let mut command = with_signs(CommandLine::command());
    let read = command.try_get_matches_from_mut(std::env::args_os());
    let read = read.and_then(|mut found| CommandLine::from_arg_matches_mut(&mut found));
    read.unwrap_or_else(|error| with_way_out(error).format(&mut command).exit())
}

fn with_signs(command: Command) -> Command {
    let signed = command.mut_args(|arg| if takes_values(&arg) { arg.allow_negative_numbers(true) } else { arg });
    signed.mut_subcommands(with_signs)
}

fn takes_values(arg: &clap::Arg) -> bool {
    arg.get_action().takes_values()
}

fn with_way_out(mut error: Error) -> Error {
    let is_number = std::error::Error::source(&error).is_some_and(<dyn std::error::Error>::is::<ParseFloatError>);
    let number = match error.get(ContextKind::InvalidValue) {
        Some(ContextValue::String(typed)) if is_number => number_meant(typed),
        _ => None,
    };
    if let Some(number) = number {
        let words = format!("write {number}: a decimal point, and no unit, which the option's name has");
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![words.into()]));
    }
    error
}
