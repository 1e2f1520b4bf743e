//! The command line: one file per command.
//!
//! Results and reports go to standard output and into files, messages go to standard error.

pub mod args;
mod axes;
mod check;
mod compare;
mod contact;
mod cut;
mod devices;
mod drivers;
mod failure;
mod folder;
mod mate;
mod new;
mod pair;
mod print;
mod texture;

use std::process::ExitCode;

use args::{Command, CommandLine};
use failure::Failure;

/// Runs the command and reports what went wrong.
pub fn run(arguments: CommandLine) -> ExitCode {
    let done = match arguments.command {
        Command::Cut(arguments) => cut::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Axes(arguments) => axes::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Texture(arguments) => texture::run(&arguments),
        Command::Devices => devices::run(),
        Command::Schema => {
            print::to_stdout(&gearcut::scene::schema::json_schema(gearcut::process::table())).map_err(Failure::from)
        }
        Command::New(arguments) => new::run(&arguments),
        Command::Mate(arguments) => mate::run(&arguments),
        Command::Pair(arguments) => pair::run(&arguments),
        Command::Contact(arguments) => contact::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
