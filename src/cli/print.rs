//! Standard output and warnings.

use std::io::{self, ErrorKind, IsTerminal, Write};

use gearcut::findings::Warning;
use gearcut::findings::warning::count_words;
use gearcut::wrap::printable;
use gearcut::{Error, Result};

/// Prints a text. A reader that has heard enough (`gearcut schema | head`) is no failure.
pub fn to_stdout(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()) {
        Err(failed) if failed.kind() != ErrorKind::BrokenPipe => Err(Error::writing("standard output")(failed)),
        _ => Ok(()),
    }
}

/// Prints warnings and how many they are on standard error, where they are seen when the report goes into a file.
pub fn warnings(warnings: &[Warning]) {
    let lines = warnings.iter().map(Warning::line).chain([count_words(warnings)]);
    for line in lines {
        to_stderr(&line);
    }
}

/// Prints lines on standard error, their first word in colour where a terminal shows it. Nobody is left to be told when
/// standard error is closed.
pub fn to_stderr(text: &str) {
    let told = std::env::var_os("NO_COLOR").is_none() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
    let text = printable(text);
    let text = if told && io::stderr().is_terminal() { painted(&text) } else { text };
    let _closed = writeln!(io::stderr(), "{text}");
}

/// The text with the words that tell its weight in colour.
fn painted(text: &str) -> String {
    let colours = [("error:", "31"), ("fault:", "31"), ("verdict:", "31"), ("warning:", "33"), ("note:", "36")];
    let line = |line: &str| {
        let found = colours.iter().find(|(word, _)| line.starts_with(word));
        found.map_or_else(
            || line.to_owned(),
            |(word, colour)| format!("\u{1b}[1;{colour}m{word}\u{1b}[0m{}", &line[word.len()..]),
        )
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::painted;

    #[test]
    fn the_weight_of_a_line_is_in_colour_and_nothing_else() {
        assert_eq!(painted("warning: a note: b\nplain"), "\u{1b}[1;33mwarning:\u{1b}[0m a note: b\nplain");
    }
}
