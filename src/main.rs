//! The `gearcut` command: [`gearcut::command`].

use std::process::ExitCode;

fn main() -> ExitCode {
    gearcut::command()
}
