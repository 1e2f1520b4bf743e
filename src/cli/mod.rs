//! The command line: one file per command.
//!
//! Results and reports go to standard output and into files, messages go to standard error.

#![allow(rustdoc::invalid_html_tags)] // help is written for terminals: `<scene>` is a value there

pub mod args;
mod axes;
mod backend;
mod budget;
mod calibrate;
mod check;
mod compare;
mod contact;
mod cut;
mod deviations;
mod devices;
mod diagnose;
mod drivers;
mod export;
mod failure;
mod folder;
mod mate;
mod new;
mod pair;
mod print;
mod scatter;
mod study;
mod texture;
mod threads;

use std::process::ExitCode;

use args::{Command, CommandLine};
use failure::Failure;

/// Runs the command and reports what went wrong.
pub fn run(arguments: CommandLine) -> ExitCode {
    let computes = match &arguments.command {
        Command::Schema | Command::New(_) => false,
        Command::Devices(arguments) => arguments.bench,
        _ => true,
    };
    if let Err(failure) = if computes { threads::start() } else { Ok(()) } {
        return failure.report().into();
    }
    let done = match arguments.command {
        Command::Cut(arguments) => cut::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Axes(arguments) => axes::run(&arguments),
        Command::Compare(arguments) => compare::run(&arguments),
        Command::Texture(arguments) => texture::run(&arguments),
        Command::Devices(arguments) => devices::run(&arguments),
        Command::Schema => {
            print::to_stdout(&crate::scene::schema::json_schema(crate::process::table())).map_err(Failure::from)
        }
        Command::New(arguments) => new::run(&arguments),
        Command::Mate(arguments) => mate::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Pair(arguments) => pair::run(&arguments),
        Command::Contact(arguments) => contact::run(&arguments),
        Command::Scatter(arguments) => scatter::run(&arguments),
        Command::Study(arguments) => study::study(&arguments),
        Command::Sweep(arguments) => study::sweep(&arguments),
        Command::Budget(arguments) => budget::run(&arguments),
        Command::Deviations(arguments) => deviations::run(&arguments),
        Command::Diagnose(arguments) => diagnose::run(&arguments),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
    };
    let code = done.map_or_else(|failure| failure.report(), |()| 0);
    if crate::backend::drivers_asked() {
        crate::interrupt::end_now(code);
    }
    code.into()
}
