//! Standard output and warnings.

use std::io::{self, ErrorKind, IsTerminal, Write};

use crate::findings::Notice;
use crate::findings::notice::count_words;
use crate::progress::{Progress, ProgressMode};
use crate::wrap::{fitted, printable};
use gearcut_core::{Error, Result};

/// Characters in a line of a terminal.
const WIDTH: usize = 80;

/// Prints a text. A reader that has heard enough (`gearcut schema | head`) is no failure.
pub fn to_stdout(text: &str) -> Result<()> {
    write_to_stdout(&printable(text))
}

fn write_to_stdout(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(failed) if failed.kind() != ErrorKind::BrokenPipe => Err(Error::writing("standard output")(failed)),
        _ => Ok(()),
    }
}

/// Prints a sheet of facts, tables and warnings; on a terminal in lines of 80 characters, warnings with their first
/// word in colour, while what goes into a file keeps a line for each.
pub fn sheet(text: &str) -> Result<()> {
    let text = printable(text);
    match width() {
        Some(width) => write_to_stdout(&in_colour(fitted(&text, width))),
        None => write_to_stdout(&text),
    }
}

/// Characters in a line of standard output; none where it is no terminal.
pub fn width() -> Option<usize> {
    io::stdout().is_terminal().then_some(WIDTH)
}

/// Runs work on a scene or a surface that knows no steps: a terminal shows that it goes on, and for how long.
pub fn waiting<T>(what: &str, unit: &str, work: impl FnOnce() -> T) -> T {
    let progress = Progress::new(if io::stderr().is_terminal() { ProgressMode::Bar } else { ProgressMode::Quiet });
    // Dropped and not finished, it leaves no line behind.
    let _bar = progress.step(what, 1, unit);
    work()
}

/// Prints warnings and how many they are on standard error, where they are seen when the report goes into a file.
pub fn warnings(warnings: &[Notice]) {
    let lines = warnings.iter().map(Notice::line_with_id).chain([count_words(warnings)]);
    for line in lines {
        to_stderr(&line);
    }
}

/// The same of the gravest, no more than a terminal shows on so many lines.
pub fn warnings_within(all: &[Notice], most: usize) {
    let mut room = most;
    let fits = |warning: &&Notice| {
        let lines = lines_on_a_terminal(std::slice::from_ref(*warning));
        let fits = lines <= room;
        room = room.saturating_sub(lines);
        fits
    };
    let shown = all.iter().take_while(fits).count().max(1).min(all.len());
    for warning in &all[..shown] {
        to_stderr(&warning.line_with_id());
    }
    let more = all.len() - shown;
    let count = count_words(all);
    to_stderr(&if more == 0 { count } else { format!("{count}, {more} of them not shown: --verbose") });
}

/// How many lines of a terminal warnings take.
pub fn lines_on_a_terminal(warnings: &[Notice]) -> usize {
    warnings.iter().map(|warning| fitted(&warning.line_with_id(), WIDTH).lines().count()).sum()
}

/// A text cut to so many lines of a terminal before its last part; a line there says how much is left out.
pub fn at_most(text: &str, most: usize) -> String {
    let taken = |lines: &[&str]| lines.iter().map(|line| fitted(line, WIDTH).lines().count().max(1)).sum::<usize>();
    let lines: Vec<&str> = text.lines().collect();
    if taken(&lines) <= most {
        return text.to_owned();
    }
    let last = lines.iter().rposition(|line| line.is_empty()).unwrap_or(lines.len());
    let room = most.saturating_sub(taken(&lines[last..]) + 1);
    let mut kept = last;
    while kept > 0 && taken(&lines[..kept]) > room {
        kept -= 1;
    }
    let (before, end) = (lines[..kept].join("\n"), lines[last..].join("\n"));
    format!("{}\n{} more lines: --verbose\n{end}\n", before.trim_end(), last - kept)
}

/// Prints lines on standard error; on a terminal in lines of 80 characters, their first word in colour. Nobody is left
/// to be told when standard error is closed.
pub fn to_stderr(text: &str) {
    let text = printable(text);
    let text = if io::stderr().is_terminal() { in_colour(fitted(&text, WIDTH)) } else { text };
    let _closed = writeln!(io::stderr(), "{text}");
}

/// A text for a terminal, in colour where the user and the terminal want it.
fn in_colour(text: String) -> String {
    let wanted = std::env::var_os("NO_COLOR").is_none() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
    if wanted { painted(&text) } else { text }
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
