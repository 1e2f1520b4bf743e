//! Heights as text, of any program: encoding, the lines above the table, its cells, and what the table is.
//!
//! In: the bytes of a file and what is known beside it. Out: a surface or a trace, with remarks on how it was read.
//! Lines that begin with `#` or `%` are comments, wherever they are; other lines above the table are titles, keys with
//! values, or names of columns. Neither a unit nor the shape of a table is guessed.

mod encoding;
mod header;
mod shape;
mod table;
mod written;

pub(super) use encoding::characters;
pub(super) use written::encode;

use super::content::{Given, MeasuredFile};
use crate::error::FileFault;
use crate::text::quoted;
use header::{TextHeader, Understood};
use table::TextLayout;

/// First words of text files that hold no heights in a unit of length, and what to do with them.
const OTHERS: [(&str, &str); 2] = [
    ("Wyko ASCII", "a Wyko ASCII file, whose heights are waves of light"),
    ("Zygo ASCII", "a Zygo ASCII file, whose heights are steps of a wave of light"),
];

/// What to do with files of others.
const CONVERT: &str = "save it as X3P where it was measured, or convert it (docs/howto.md)";

/// Reads a table of heights.
pub(super) fn decode(bytes: &[u8], given: &Given) -> Result<MeasuredFile, FileFault> {
    let (text, encoding) = characters(bytes)?;
    let text = table::without_quotes(text)?;
    if let Some((_, what)) = OTHERS.iter().find(|(start, _)| text.starts_with(start)) {
        return Err(format!("it is {what}: {CONVERT}").into());
    }
    let mut header = TextHeader::default();
    let mut lines: Vec<(usize, &str)> = Vec::new();
    let mut names = None;
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        if let Some(comment) = line.trim_start().strip_prefix(['#', '%']) {
            if header.line(comment, number)? == Understood::No && lines.is_empty() {
                names = Some((number, comment));
            }
        } else if line.trim().is_empty() {
        } else if !lines.is_empty() || table::begins(line) {
            lines.push((number, line));
        } else if header.own || header.line(line, number)? == Understood::No {
            let first = line.split(['=', ':', '\t', ';', ',']).next().unwrap_or_default();
            let words = first.chars().filter(char::is_ascii_alphabetic).count() >= 3;
            if table::has_number(line) && !words {
                return Err(format!("line {number}: `{}` is no row of heights", quoted(line.trim())).into());
            }
            names = Some((number, line));
        }
    }
    header.finish();
    let layout = TextLayout::of(&lines, header.own)?;
    let mut table = layout.table(&lines)?;
    if let Some((number, line)) = names {
        let cells: Vec<String> = if layout.is_blank() {
            with_brackets(line)
        } else {
            layout.cells(line).filter(|cell| !cell.is_empty()).map(str::to_owned).collect()
        };
        if cells.len() == table.columns {
            header.names(&cells, number);
        }
    }
    table.remarks.extend(encoding.map(|encoding| format!("encoding: {encoding}")));
    shape::measured(table, header, given)
}

/// Words between blanks, what is in brackets with the word before it.
fn with_brackets(line: &str) -> Vec<String> {
    let mut cells: Vec<String> = Vec::new();
    for word in line.split_whitespace() {
        match cells.last_mut() {
            Some(cell) if word.starts_with(['[', '(']) => *cell += word,
            _ => cells.push(word.to_owned()),
        }
    }
    cells
}

#[cfg(test)]
mod tests;
