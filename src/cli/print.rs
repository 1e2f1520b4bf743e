//! Standard output and warnings.

use std::io::{self, ErrorKind, Write};

use gearcut::{Error, Result};

/// Prints a text. A reader that has heard enough (`gearcut schema | head`) is no failure.
pub fn to_stdout(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(failed) if failed.kind() != ErrorKind::BrokenPipe => Err(Error::writing("standard output")(failed)),
        _ => Ok(()),
    }
}

/// Prints warnings on standard error, where they are seen when the report goes into a file.
pub fn warnings(warnings: &[String]) {
    for warning in warnings {
        let _closed = writeln!(io::stderr(), "warning: {warning}");
    }
}
