//! The resolved scene as TOML: every key with its value, defaults marked, so that a run can be repeated from its
//! record.
//!
//! Values are written as they stood in the file, in its units, with all digits: nothing is converted twice.

use std::fmt::Write as _;

use super::keys::{Default, Role, join};
use super::table::{KeyTable, TableSection};
use super::values::{Checked, Values};

/// The whole scene called `name`, with the keys of its process's `own` table.
pub(super) fn resolved(name: &str, own: &KeyTable, values: &Values) -> String {
    let version = env!("CARGO_PKG_VERSION");
    let mut out = format!("# Scene {name} with every default filled in, written by gearcut {version}.\n");
    // Empty lists are keys of the file itself, which come before its first table.
    for section in own.sections().iter().filter(|section| matches!(section.role, Role::List { .. })) {
        if values.count(section.name()) == 0 {
            let _ = writeln!(out, "{} = []", section.name());
        }
    }
    let on_demand = |path: &str| own.processes().iter().any(|process| process.on_demand.contains(&path));
    let stands = |section: &&TableSection| !on_demand(section.path) || values.has_section(section.path);
    walk_sections(own.sections().iter().filter(stands), values, |section, path| {
        write_section(&mut out, section, path, values);
    });
    out
}

/// Visits sections with their paths among the values, in the order of a file: a list's own sections, which follow each
/// other, element by element.
pub(super) fn walk_sections<'a>(
    sections: impl Iterator<Item = &'a TableSection>,
    values: &Values,
    mut visit: impl FnMut(&'a TableSection, &str),
) {
    let mut sections = sections.peekable();
    while let Some(section) = sections.next() {
        let Some((list, _)) = section.path.split_once("[]") else {
            visit(section, section.path);
            continue;
        };
        let mut inside = vec![section];
        while let Some(next) = sections.next_if(|next| next.path.split_once("[]").is_some_and(|(l, _)| l == list)) {
            inside.push(next);
        }
        for index in 0..values.count(list) {
            for section in &inside {
                visit(section, &section.path.replacen("[]", &format!(".{index}"), 1));
            }
        }
    }
}

/// One section, unless another variant of its choice holds.
fn write_section(out: &mut String, section: &TableSection, path: &str, values: &Values) {
    let is_header = match section.role {
        Role::Choice { .. } => false,
        Role::List { .. } => true,
        Role::Plain => !section.keys.is_empty(),
        Role::Variant => {
            let choice = path.rsplit_once('.').map_or("", |(choice, _)| choice);
            if values.variants.get(choice) != Some(&section.name()) {
                return;
            }
            true
        }
    };
    if is_header {
        let _ = write!(out, "\n{}\n", section.header());
    }
    for key in &section.keys {
        let rival_holds = section.group_of(key.name).is_some_and(|group| {
            let first = group.names.iter().find(|name| values.held.contains_key(&join(path, name)));
            first != Some(&key.name)
        });
        if rival_holds {
            continue;
        }
        match values.held.get(&join(path, key.name)) {
            Some(held) => {
                let note = if held.at.is_none() { "  # default" } else { "" };
                let _ = writeln!(out, "{} = {}{note}", key.name, value_text(&held.value));
            }
            None => {
                if let Default::LeftOut(words) = key.default {
                    let _ = writeln!(out, "# {}: {words}", key.name);
                }
            }
        }
    }
}

/// A value as TOML.
pub(super) fn value_text(value: &Checked) -> String {
    match value {
        Checked::Number(number) => number_text(*number),
        Checked::Whole(number) => number.to_string(),
        Checked::Boolean(on) => on.to_string(),
        Checked::Text(text) => quoted(text),
        Checked::Numbers(numbers) => {
            format!("[{}]", numbers.iter().map(|number| number_text(*number)).collect::<Vec<_>>().join(", "))
        }
        Checked::Points(points) => {
            let line = |point: &[f64; 2]| format!("  [{}, {}],\n", number_text(point[0]), number_text(point[1]));
            format!("[\n{}]", points.iter().map(line).collect::<String>())
        }
    }
}

/// The shortest digits that read back to the same number, with a point or exponent as TOML's floats need.
fn number_text(number: f64) -> String {
    format!("{number:?}")
}

/// A TOML string.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04X}", c as u32);
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}
