//! The key reference in Markdown, printed from the table of keys behind a hand-written introduction.

use std::fmt::Write as _;

use super::keys::{self, Key, Role};
use super::table::{KeyTable, TableSection};

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
    let _ = write!(out, "\n{level} `{}`\n\n{}\n", section.header(), section.teach);
    if let Role::Choice { default, what } = section.role {
        let variants = keys::either(table.children(section).map(|child| format!("`{}`", child.name())));
        let default = default.map_or_else(|| "required".to_owned(), |name| format!("default `{name}`"));
        let _ = write!(out, "\nThe {what} is one of the tables {variants} ({default}).\n");
    }
    for group in &section.groups {
        let names = keys::either(group.names.iter().map(|name| format!("`{name}`")));
        let count = if group.required { "Exactly one" } else { "At most one" };
        let _ = write!(out, "\n{count} of {names}.\n");
    }
    if !section.keys.is_empty() {
        out.push_str("\n| key | unit | allowed | default | meaning |\n| --- | --- | --- | --- | --- |\n");
        for key in &section.keys {
            write_row(out, key);
        }
    }
}

fn write_row(out: &mut String, key: &Key) {
    let unit = if key.unit.is_empty() { "-" } else { key.unit };
    let cells = [key.name, unit, &key.allowed(), &key.default_text(), key.teach].map(|cell| cell.replace('|', "\\|"));
    let [name, unit, allowed, default, teach] = cells;
    let _ = writeln!(out, "| `{name}` | {unit} | {allowed} | {default} | {teach} |");
}
