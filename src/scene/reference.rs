//! The key reference in Markdown, printed from the table of keys behind a hand-written introduction.

use std::fmt::Write as _;

use super::keys::{self, Default, Key, Role};
use super::table::{KeyTable, TableSection};
use crate::wrap::wrapped;

/// Longest line.
const WIDTH: usize = 120;

/// What stands before the tables, ending with the head of the list of scenes.
const INTRODUCTION: &str = include_str!("reference_introduction.md");

/// The reference as text: the content of `scenes/README.md`.
pub fn markdown(table: &KeyTable) -> String {
    let mut out = INTRODUCTION.to_owned();
    for process in table.processes() {
        out.push_str(process.scenes);
    }
    out.push_str("\n## Keys\n");
    for section in table.sections().iter().filter(|section| !section.path.is_empty()) {
        write_section(&mut out, table, section);
    }
    out
}

fn write_section(out: &mut String, table: &KeyTable, section: &TableSection) {
    let level = if section.path.contains('.') { "####" } else { "###" };
    let _ = write!(out, "\n{level} `{}`\n", section.header());
    write_paragraph(out, &section.teach);
    if let Role::Choice { default, what } = section.role {
        let variants = keys::either(table.children(section).map(|child| format!("`{}`", child.name())));
        let default = default.map_or_else(|| "required".to_owned(), |name| format!("default `{name}`"));
        write_paragraph(out, &format!("The {what} is one of the tables {variants} ({default})."));
    }
    for group in &section.groups {
        let names = keys::either(group.names.iter().map(|name| format!("`{name}`")));
        let count = if group.required { "Exactly one" } else { "At most one" };
        write_paragraph(out, &format!("{count} of {names}."));
    }
    if !section.keys.is_empty() {
        out.push('\n');
        for key in &section.keys {
            write_key(out, key);
        }
    }
}

fn write_paragraph(out: &mut String, text: &str) {
    let _ = write!(out, "\n{}\n", wrapped(text, WIDTH).join("\n"));
}

/// A key as an item of a list: name, unit and what is allowed, what holds without it, meaning.
fn write_key(out: &mut String, key: &Key) {
    let unit = if key.unit.is_empty() { String::new() } else { format!("{}, ", key.unit) };
    let default = match key.default {
        Default::Required | Default::OneOfGroup => key.default_text(),
        _ => format!("default: {}", key.default_text()),
    };
    let text = format!("`{}` ({unit}{}; {default}): {}", key.name, key.allowed(), key.teach);
    let _ = writeln!(out, "- {}", wrapped(&text, WIDTH - 2).join("\n  "));
}
