//! The `gearcut` command: reads the arguments, runs the command, says with the exit code how it went.
//!
//! 0: done. 1: the work was refused or failed, and standard error says why. 2: wrong usage. 130: stopped by Ctrl-C.

mod cli;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    cli::run(cli::args::CommandLine::parse())
}
