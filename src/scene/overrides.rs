//! `--set KEY=VALUE` arguments put into the tree of the scene, before anything is checked.
//!
//! They pass the same checks as the file; a value carries the argument it came from. What an argument sets
//! takes the place of what the file says otherwise about the same choice (another linkage, strokes instead of
//! feed), so that a comparison needs no second file. Two arguments that exclude each other stay an error.
//! Operations are named by their name or by their number from 0: `operation.rough.offset_mm=2`.

use super::errors::{Problem, SourcePlace};
use super::keys::{self, Role, join};
use super::sources::At;
use super::table::{KeyTable, TableSection};
use super::tree::{KeyValue, Node, TomlValue, parse_value};
use crate::number_text::number_meant;

/// Puts argument number `index` into `root`.
pub(super) fn apply(root: &mut Node, table: &KeyTable, index: usize, argument: &str) -> Result<(), Problem> {
    let refuse = |message: String, way_out: &str| Problem {
        place: SourcePlace::Set { argument: argument.to_owned() },
        message,
        way_out: way_out.to_owned(),
    };
    let Some((key, written)) = argument.split_once('=') else {
        return Err(refuse("a setting is KEY=VALUE".to_owned(), "write for example --set gear.module_mm=2.5"));
    };
    let value = parse_value(index, argument, key.len() + 1).map_err(|reason| {
        let number = number_meant(written).map(|number| format!("write {number}: a decimal point, and no unit"));
        refuse(
            format!("the value cannot be read: {reason}"),
            number.as_deref().unwrap_or("write the value as in the scene file"),
        )
    })?;
    let path = key.trim().replace('[', ".").replace(']', "");
    let names: Vec<&str> = path.split('.').map(str::trim).collect();
    if names.iter().any(|name| name.is_empty()) {
        return Err(refuse(
            format!("`{}` is not the path of a key", key.trim()),
            "write names with dots between them, for example gear.module_mm",
        ));
    }
    put(root, table, &names, value, At::Set(index, 0..key.len())).map_err(|message| {
        refuse(message, "name an operation by its name or by its number from 0, and set keys one by one")
    })
}

/// Goes down `names` from `root`, makes the tables that are missing, and sets `value` at the end.
fn put(root: &mut Node, table: &KeyTable, names: &[&str], value: Node, name_at: At) -> Result<(), String> {
    let mut node = root;
    let mut pattern = String::new();
    let mut rest = names;
    while let Some((&name, deeper)) = rest.split_first() {
        let section = table.section(&pattern);
        let child = section.and_then(|section| table.children(section).find(|child| child.name() == name));
        let Some(entries) = node.entries_mut() else {
            return Err(format!("`{pattern}` is not a section that could hold `{name}`"));
        };
        if let Some(section) = section {
            displace(entries, table, section, name);
        }
        let place = entries.iter().position(|entry| entry.name == name).unwrap_or_else(|| {
            let new = Node { value: TomlValue::Table(Vec::new()), at: name_at.clone() };
            entries.push(KeyValue { name: name.to_owned(), name_at: name_at.clone(), node: new });
            entries.len() - 1
        });
        let entry = &mut entries[place];
        if deeper.is_empty() {
            entry.name_at = name_at;
            entry.node = value;
            return Ok(());
        }
        pattern = child.map_or_else(|| join(&pattern, name), |child| child.path.to_owned());
        node = &mut entry.node;
        rest = deeper;
        if child.is_some_and(|child| matches!(child.role, Role::List { .. }))
            && let Some((&which, deeper)) = rest.split_first()
        {
            node = element(node, name, which)?;
            rest = deeper;
            if rest.is_empty() {
                *node = value;
                return Ok(());
            }
        }
    }
    Ok(())
}

/// Takes out of a table what the file says otherwise about the same choice as `name`.
fn displace(entries: &mut Vec<KeyValue>, table: &KeyTable, section: &TableSection, name: &str) {
    let is_choice = matches!(section.role, Role::Choice { .. });
    entries.retain(|entry| {
        let rival = if is_choice {
            table.children(section).any(|child| child.name() == entry.name)
        } else {
            section.groups.iter().any(|group| [name, &entry.name].iter().all(|key| group.names.contains(key)))
        };
        entry.name == name || !rival || matches!(entry.name_at, At::Set(..))
    });
}

/// The element of a list with this number or name.
fn element<'a>(list: &'a mut Node, list_name: &str, which: &str) -> Result<&'a mut Node, String> {
    let TomlValue::List(items) = &mut list.value else {
        return Err(format!("`{list_name}` is not a list in this scene"));
    };
    let names: Vec<String> =
        items.iter().enumerate().map(|(index, item)| element_name(item, list_name, index)).collect();
    let found = which.parse::<usize>().ok().or_else(|| names.iter().position(|name| name == which));
    found
        .and_then(|index| items.get_mut(index))
        .ok_or_else(|| format!("there is no {list_name} `{which}`; this scene has {}", keys::either(names.into_iter())))
}

/// Name of an element: as written, or by its place.
fn element_name(item: &Node, list_name: &str, index: usize) -> String {
    match item.entry("name").map(|entry| &entry.node.value) {
        Some(TomlValue::Text(name)) => name.clone(),
        _ => default_name(list_name, index),
    }
}

/// Name of an element that has none: `operation_1` for the first operation.
pub(super) fn default_name(list_name: &str, index: usize) -> String {
    format!("{list_name}_{}", index + 1)
}
