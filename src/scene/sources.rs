//! The texts a scene is made of, the file and the `--set` arguments, and the way from a byte span to a place.
//!
//! In: byte spans as the parser gives them. Out: places with line, column and source line, made only when something is
//! to be printed. Columns count characters, as editors do.

use std::ops::Range;

use super::errors::{SourcePlace, shorten};

/// Longest value repeated in a message.
const ECHOED_CHARS: usize = 40;

/// Where a node of the tree comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum At {
    /// Bytes of the scene text.
    Scene(Range<usize>),
    /// Bytes of the `--set` argument with this index.
    Set(usize, Range<usize>),
    /// Nobody wrote it; the scene as a whole is to blame.
    Implied,
}

/// Scene text and `--set` arguments.
#[derive(Debug, Clone)]
pub(super) struct Sources {
    /// The file's name as the user gave it.
    pub file: String,
    /// Its text.
    pub text: String,
    /// The `--set` arguments.
    pub overrides: Vec<String>,
}

impl Sources {
    /// Place to print.
    pub fn place(&self, at: &At) -> SourcePlace {
        match at {
            At::Scene(span) => line_place(&self.file, &self.text, span.clone()),
            At::Set(index, _) => SourcePlace::Set { argument: self.overrides.get(*index).cloned().unwrap_or_default() },
            At::Implied => line_place(&self.file, &self.text, 0..0).without_excerpt(),
        }
    }

    /// The text as written, first line only, shortened.
    pub fn written(&self, at: &At) -> String {
        let text = match at {
            At::Scene(span) => self.text.get(span.clone()),
            At::Set(index, span) => self.overrides.get(*index).and_then(|argument| argument.get(span.clone())),
            At::Implied => None,
        };
        let mut lines = text.unwrap_or_default().lines();
        let first = lines.next().unwrap_or_default();
        if lines.next().is_some() {
            format!("{} ...", shorten(first, ECHOED_CHARS))
        } else {
            shorten(first, ECHOED_CHARS)
        }
    }
}

/// Line and column of a byte span of `text`; spans outside the text or inside a character are moved to its nearest
/// start.
pub(super) fn line_place(file: &str, text: &str, span: Range<usize>) -> SourcePlace {
    let start = floor_boundary(text, span.start);
    let end = floor_boundary(text, span.end).max(start);
    let line_start = text[..start].rfind('\n').map_or(0, |newline| newline + 1);
    let line_end = text[start..].find('\n').map_or(text.len(), |newline| start + newline);
    let source = text[line_start..line_end].trim_end_matches('\r');
    let underlined = &text[start..end.clamp(start, line_end)];
    SourcePlace::Line {
        file: file.to_owned(),
        line: text[..start].matches('\n').count() + 1,
        column: text[line_start..start].chars().count() + 1,
        source: source.to_owned(),
        width: underlined.trim_end().chars().count().max(1),
    }
}

/// Largest character boundary not beyond `index`.
fn floor_boundary(text: &str, index: usize) -> usize {
    (0..=index.min(text.len())).rev().find(|&i| text.is_char_boundary(i)).unwrap_or(0)
}
