//! A commented scene to start from: every key with its unit, its range and its default.
//!
//! Printed from the table of the process's keys. Keys that must be written and those with a fixed default stand ready;
//! the others, and all variants but the default ones, stand behind a `#` without a blank.

use std::fmt::Write as _;

use super::keys::{self, Default, Key, Role};
use super::process::StandardOperation;
use super::table::{KeyTable, TableSection};

/// Width of a comment line.
const COMMENT_CHARS: usize = 100;

/// The list whose elements the process has by itself.
const OPERATIONS: &str = "operation[]";

/// The scene for the process of this name, or `None` if the table has none.
pub fn template(table: &KeyTable, process: &str) -> Option<String> {
    let process = table.process(process)?;
    let own = KeyTable::new(&[process]);
    let (tool, needed) = (process.tool_words, process.needed);
    let mut out = format!(
        "# Scene for cutting a gear with {tool}.\n\
         #\n\
         # Remove what you do not need: every key but {needed} has a default.\n\
         # Lines that begin with # and no blank are keys and sections to switch on.\n\
         # `gearcut check` says what the scene means; `gearcut cut` cuts it.\n",
    );
    let (first, others) = process.operations.split_first()?;
    let mut sections = own.sections().iter().filter(|section| !section.path.is_empty()).peekable();
    while let Some(section) = sections.next() {
        let on = if section.path == OPERATIONS { first.template } else { &[] };
        write_section(&mut out, &own, section, on);
        let inside = |section: &&TableSection| section.path.starts_with(OPERATIONS);
        if inside(&section) && !sections.peek().is_some_and(inside) {
            for operation in others {
                write_operation(&mut out, operation);
            }
        }
    }
    Some(out)
}

/// A further operation, in short: its keys are those of the first.
fn write_operation(out: &mut String, operation: &StandardOperation) {
    let _ = write!(out, "\n# The next operation; it may have all keys of the one before.\n[[operation]]\n");
    for (name, value) in operation.template {
        let _ = writeln!(out, "{name} = {value}");
    }
}

/// One section with all its keys; those in `on` are switched on, with these values.
fn write_section(out: &mut String, own: &KeyTable, section: &TableSection, on: &[(&str, &str)]) {
    if section.role == Role::Plain && section.keys.is_empty() {
        return;
    }
    out.push('\n');
    write_comment(out, &section.teach);
    if let Role::Choice { default, what } = section.role {
        let names = keys::either(own.children(section).map(|child| child.name().to_owned()));
        let default = default.map_or(String::new(), |name| format!("; default {name}"));
        write_comment(out, &format!("The {what} is one of: {names}{default}."));
        return;
    }
    let active = is_active(own, section);
    let mark = if active { "" } else { "#" };
    let _ = writeln!(out, "{mark}{}", section.header());
    let mut grouped: Vec<&str> = Vec::new();
    for key in &section.keys {
        // Of a group that must be written, the first stands ready.
        let group = section.group_of(key.name).filter(|group| group.required);
        let first = group.is_some_and(|group| !grouped.iter().any(|name| group.names.contains(name)));
        grouped.extend(group.map(|_| key.name));
        let value = on.iter().find(|(name, _)| *name == key.name).map(|(_, value)| *value);
        let rival_on = |name: &&str| on.iter().any(|(on, _)| on == name);
        let rival = section.group_of(key.name).is_some_and(|group| group.names.iter().any(rival_on));
        let ready = value.is_some() || first || (stands_ready(key) && !rival);
        write_key(out, key, value, active && ready);
    }
}

/// Whether a section stands ready: it holds by default, or there is nothing else to choose, and so do all that hold it.
fn is_active(own: &KeyTable, section: &TableSection) -> bool {
    if section.path.is_empty() {
        return true;
    }
    let Some(holder) = own.section(section.parent_path()) else { return true };
    let ready = match (section.role, holder.role) {
        (Role::List { fewest }, _) => fewest > 0,
        (Role::Variant, Role::Choice { default, .. }) => default.is_none_or(|name| name == section.name()),
        _ => true,
    };
    ready && is_active(own, holder)
}

/// Whether a key stands ready, with the value that holds without it, or with its example if it must be written.
fn stands_ready(key: &Key) -> bool {
    !matches!(key.default, Default::LeftOut(_) | Default::OneOfGroup | Default::Derived(_))
}

fn write_key(out: &mut String, key: &Key, value: Option<&str>, active: bool) {
    let mark = if active { "" } else { "#" };
    let value = match (value, key.default) {
        (Some(value), _) => value.to_owned(),
        (None, Default::Number(number)) => format!("{number:?}"),
        (None, Default::EmptyList) if active => key.default_text(),
        (None, Default::Whole(_) | Default::Boolean(_) | Default::Word(_)) => key.default_text(),
        _ => key.example.to_owned(),
    };
    write_comment(out, key.teach);
    let default = match key.default {
        Default::Required => "required".to_owned(),
        Default::OneOfGroup => "one of the two".to_owned(),
        _ => format!("default {}", key.default_text()),
    };
    let unit = if key.unit.is_empty() { String::new() } else { format!("{}, ", key.unit) };
    let _ = writeln!(out, "{mark}{} = {value}  # {unit}{}; {default}", key.name, key.allowed());
}

/// `text` in comment lines.
fn write_comment(out: &mut String, text: &str) {
    let mut line = String::from("#");
    for word in text.split(' ') {
        if line.len() > 1 && line.len() + 1 + word.len() > COMMENT_CHARS {
            let _ = writeln!(out, "{line}");
            "#".clone_into(&mut line);
        }
        line.push(' ');
        line.push_str(word);
    }
    let _ = writeln!(out, "{line}");
}
