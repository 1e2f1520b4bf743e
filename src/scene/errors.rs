//! Everything wrong with a scene at once, each problem with its place, what is allowed and a way out.
//!
//! Comes from the reader and the checks; goes to the terminal as plain text without colours, so that the same
//! scene always prints the same bytes. Stopping at the first problem was not an option: a gear engineer who
//! fills in a scene makes several mistakes at once and wants them all in one go.

use std::fmt;

/// Longest part of a source line that is shown; long tables are cut around the place.
const SHOWN_CHARS: usize = 100;

/// Most problems reported: beyond that the file is no scene, and the list helps nobody.
pub(super) const MOST_PROBLEMS: usize = 100;

/// Where something was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SourcePlace {
    /// In a file.
    Line {
        /// The file, as the user named it.
        file: String,
        /// Line, from 1.
        line: usize,
        /// Column in characters, from 1.
        column: usize,
        /// The whole line, without its end.
        source: String,
        /// How many characters the thing takes on this line; 0: nothing was written there, so the line is not shown.
        width: usize,
    },
    /// In a `--set` argument of the command line.
    Set {
        /// The argument: `gear.module_mm=2.5`.
        argument: String,
    },
    /// A file as a whole, such as one that cannot be read.
    File {
        /// The file.
        file: String,
    },
}

/// One thing wrong with a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// Where.
    pub place: SourcePlace,
    /// What, with the value and what is allowed.
    pub message: String,
    /// What to do about it.
    pub way_out: String,
}

/// All problems found in one scene, in the order of the file; those of `--set` arguments come last.
///
/// Its text is complete: every problem begins with `error: FILE:LINE:COLUMN:`.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub struct SceneErrors {
    /// The problems; never empty.
    pub problems: Vec<Problem>,
}

impl Problem {
    /// The key or section that the message names first, as it is displayed; none where it names none.
    pub fn key(&self) -> Option<&str> {
        let (_, named) = self.message.split_once('`')?;
        named.split_once('`').map(|(key, _)| key)
    }
}

impl SourcePlace {
    /// The same place with nothing to underline.
    pub(super) fn without_excerpt(mut self) -> Self {
        if let Self::Line { width, .. } = &mut self {
            *width = 0;
        }
        self
    }

    /// Sorting key: whole files, then lines, then `--set` arguments.
    fn order(&self) -> (u8, &str, usize, usize) {
        match self {
            Self::File { file } => (0, file, 0, 0),
            Self::Line { file, line, column, .. } => (1, file, *line, *column),
            Self::Set { argument } => (2, argument, 0, 0),
        }
    }
}

impl fmt::Display for SourcePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Line { file, line, column, .. } => write!(f, "{}:{line}:{column}", printable(file)),
            Self::Set { argument } => write!(f, "--set {}", printable(&shorten(argument, SHOWN_CHARS))),
            Self::File { file } => write!(f, "{}", printable(file)),
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "error: {}: {}", self.place, printable(&self.message))?;
        if let SourcePlace::Line { line, column, source, width, .. } = &self.place
            && *width > 0
        {
            let (shown, before, width) = excerpt(source, column.saturating_sub(1), *width);
            let number = line.to_string();
            let margin = " ".repeat(number.len());
            writeln!(f, "  {number} | {shown}")?;
            writeln!(f, "  {margin} | {before}{}", "^".repeat(width))?;
        }
        write!(f, "  way out: {}", printable(&self.way_out))
    }
}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, problem) in self.problems.iter().enumerate() {
            if index > 0 {
                f.write_str("\n\n")?;
            }
            problem.fmt(f)?;
        }
        if self.problems.len() >= MOST_PROBLEMS {
            write!(f, "\n\nthere may be more: only {MOST_PROBLEMS} problems are listed")?;
        }
        Ok(())
    }
}

impl SceneErrors {
    /// Sorts the problems by place and drops repetitions.
    pub(super) fn new(mut problems: Vec<Problem>) -> Self {
        problems.sort_by(|a, b| a.place.order().cmp(&b.place.order()));
        problems.dedup();
        Self { problems }
    }
}

/// The part of `source` to show, the blanks that stand under what precedes the place, and the width left to underline.
///
/// Tabs are kept under the line, so that the carets stand right whatever the terminal makes of them.
fn excerpt(source: &str, before: usize, width: usize) -> (String, String, usize) {
    let chars: Vec<char> = source.chars().collect();
    let before = before.min(chars.len());
    let first = if chars.len() <= SHOWN_CHARS { 0 } else { before.saturating_sub(SHOWN_CHARS / 2) };
    let last = chars.len().min(first + SHOWN_CHARS);
    let lead = if first > 0 { "..." } else { "" };
    let tail = if last < chars.len() { "..." } else { "" };
    let shown: String = chars[first..last].iter().collect();
    let blanks: String = chars[first..before].iter().map(|&c| if c == '\t' { '\t' } else { ' ' }).collect();
    let width = width.clamp(1, (last - before).max(1));
    (printable(&format!("{lead}{shown}{tail}")), format!("{}{blanks}", " ".repeat(lead.len())), width)
}

/// `text` on one line and with control characters replaced, so that a scene cannot steer the terminal.
fn printable(text: &str) -> String {
    let plain = |c: char| match c {
        '\n' => ' ',
        c if c.is_control() && c != '\t' => '\u{fffd}',
        c => c,
    };
    text.chars().map(plain).collect()
}

/// `text` cut to `most` characters.
pub(super) fn shorten(text: &str, most: usize) -> String {
    if text.chars().count() <= most {
        return text.to_owned();
    }
    let mut short: String = text.chars().take(most.saturating_sub(3)).collect();
    short.push_str("...");
    short
}

impl From<SceneErrors> for gearcut_core::Error {
    fn from(errors: SceneErrors) -> Self {
        Self::Scene(Box::new(errors))
    }
}
