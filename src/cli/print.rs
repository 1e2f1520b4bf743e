//! Standard output and warnings.

use std::io::{self, ErrorKind, Write};

use gearcut::findings::Warning;
use gearcut::findings::warning::count_words;
use gearcut::{Error, Result};

/// Prints a text. A reader that has heard enough (`gearcut schema | head`) is no failure.
pub fn to_stdout(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(failed) if failed.kind() != ErrorKind::BrokenPipe => Err(Error::writing("standard output")(failed)),
        _ => Ok(()),
    }
}

/// Prints warnings and how many they are on standard error, where they are seen when the report goes into a file.
pub fn warnings(warnings: &[Warning]) {
    let lines = warnings.iter().map(Warning::line).chain([count_words(warnings)]);
    for line in lines {
        let _closed = writeln!(io::stderr(), "{line}");
    }
}
