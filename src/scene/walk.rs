//! Goes through the tree, holds every key against the table, and fills in the defaults.
//!
//! In: the tree of a scene with its `--set` arguments, the table of all processes and that of the scene's own, which
//! says what holds by default. Out: checked values, and a problem for every key or section that is unknown, missing,
//! given beside its rival, of the wrong type or out of range.

use super::check::check;
use super::errors::MOST_PROBLEMS;
use super::keys::{self, Default, Group, Key, Role, join};
use super::overrides::default_name;
use super::problems::Problems;
use super::shop_words;
use super::sources::At;
use super::suggest::{display_path, nearest};
use super::table::{KeyTable, TableSection};
use super::tree::{KeyValue, Node, TomlValue};
use super::values::{Checked, Held, Values};
use crate::material::Kienzle;

/// Checks the whole scene; `own` is the table of its process, if its tool chooses one.
pub(super) fn walk(root: &Node, table: &KeyTable, own: Option<&KeyTable>, problems: &mut Problems<'_>) -> Values {
    let mut walk = Walk { table, own, values: Values::default(), problems };
    if let Some(section) = table.section("") {
        walk.table(section, "", root, &At::Implied);
    }
    walk.derive();
    walk.values
}

struct Walk<'a, 'b> {
    table: &'a KeyTable,
    own: Option<&'a KeyTable>,
    values: Values,
    problems: &'a mut Problems<'b>,
}

impl<'a> Walk<'a, '_> {
    /// Checks `table`, which stands for `section` under the concrete `path` and was named at `at`.
    fn table(&mut self, section: &'a TableSection, path: &str, table: &Node, at: &At) {
        if !matches!(table.value, TomlValue::Table(_)) {
            let written = self.problems.sources.written(&table.at);
            let headers = match section.role {
                Role::Choice { .. } => keys::either(self.table.children(section).map(TableSection::header)),
                _ => section.header(),
            };
            self.problems.add(
                &table.at,
                format!("`{}` is a section, not a value: {written}", section.path.replace("[]", "")),
                format!("write {headers} on a line of its own, and its keys below"),
            );
            return;
        }
        if *at != At::Implied {
            self.values.sections.insert(path.to_owned(), at.clone());
        }
        for entry in table.entries() {
            if let Some(key) = section.key(&entry.name) {
                self.key(section, self.of_own(section, key), path, entry);
            } else if !self.table.children(section).any(|child| child.name() == entry.name) {
                self.unknown(section, entry);
            }
        }
        self.groups(section, path, table);
        for key in section.keys.iter().copied() {
            if table.entry(key.name).is_none() {
                self.not_written(section, self.of_own(section, key), path, table, at);
            }
        }
        if let Role::Choice { what, .. } = section.role {
            self.choice(section, path, table, at, what);
        } else {
            let implied = Node::implied_table();
            for child in self.table.children(section) {
                let child_path = join(path, child.name());
                let entry = table.entry(child.name());
                let node = entry.map_or(&implied, |entry| &entry.node);
                let at = entry.map_or(&At::Implied, |entry| &entry.name_at);
                if let Role::List { fewest } = child.role {
                    self.list(child, fewest, &child_path, node, at);
                } else {
                    self.table(child, &child_path, node, at);
                }
            }
        }
    }

    /// The key as the scene's own process has it; one that is another's stays as it is.
    fn of_own(&self, section: &TableSection, key: &'static Key) -> &'static Key {
        self.own.and_then(|own| own.section(section.path)?.key(key.name)).unwrap_or(key)
    }

    /// Whether the scene's own process has a key; without one, whether all processes have it.
    fn asks_for(&self, section: &TableSection, key: &Key) -> bool {
        let path = join(section.path, key.name);
        match self.own {
            Some(own) => own.knows(&path),
            None => self.table.processes().iter().all(|process| KeyTable::new(&[process]).knows(&path)),
        }
    }

    /// Whether it has a group of keys.
    fn asks_for_group(&self, section: &TableSection, group: &Group) -> bool {
        group.names.iter().filter_map(|name| section.key(name)).any(|key| self.asks_for(section, key))
    }

    /// Checks the elements of a list of tables.
    fn list(&mut self, section: &'a TableSection, fewest: usize, path: &str, list: &Node, at: &At) {
        let name = section.name();
        match &list.value {
            TomlValue::List(items) if items.len() < fewest => self.problems.add(
                at,
                format!("`{name}` is an empty list: nothing would be cut"),
                format!(
                    "write at least one [[{name}]], or leave the list out for those that the process has by itself"
                ),
            ),
            TomlValue::List(items) => {
                for (index, item) in items.iter().enumerate() {
                    let item_at = if item.at == At::Implied { at } else { &item.at };
                    self.table(section, &format!("{path}.{index}"), item, item_at);
                }
                self.values.counts.insert(name, items.len());
            }
            _ => self.problems.add(
                at,
                format!("`{name}` is a list of tables, not {}", list.kind()),
                format!("write [[{name}]] with two brackets"),
            ),
        }
    }

    /// Takes the one variant of a choice.
    fn choice(&mut self, section: &'a TableSection, path: &str, table: &Node, at: &At, what: &str) {
        let default = self.own.and_then(|own| own.section(section.path)).unwrap_or(section).default();
        let written: Vec<(&TableSection, &KeyValue)> = table
            .entries()
            .iter()
            .filter_map(|entry| {
                self.table.children(section).find(|child| child.name() == entry.name).map(|child| (child, entry))
            })
            .collect();
        if let [(first, _), (second, entry), ..] = written.as_slice() {
            self.problems.add(
                &entry.name_at,
                format!("two kinds of {what} are given: `{}` and `{}`", first.name(), second.name()),
                format!("keep one of {} and {}", first.header(), second.header()),
            );
        }
        if let Some((child, entry)) = written.first() {
            self.values.variants.insert(path.to_owned(), child.name());
            self.table(child, &join(path, child.name()), &entry.node, &entry.name_at);
        } else if !table.entries().is_empty() {
            // An unknown variant, reported already.
        } else if let Some(child) =
            default.and_then(|name| self.table.children(section).find(|child| child.name() == name))
        {
            self.values.variants.insert(path.to_owned(), child.name());
            self.table(child, &join(path, child.name()), &Node::implied_table(), &At::Implied);
        } else {
            self.problems.add(
                at,
                format!("the {what} is missing"),
                format!("write {}", keys::either(self.table.children(section).map(TableSection::header))),
            );
        }
    }

    /// Checks one key that was written.
    fn key(&mut self, section: &'a TableSection, key: &'static Key, path: &str, entry: &KeyValue) {
        let full = join(path, key.name);
        self.values.written.insert(full.clone());
        match check(&display_path(section, key), key, &entry.node, self.problems.sources) {
            Ok(value) => {
                let at = (entry.node.at != At::Implied).then(|| entry.node.at.clone());
                self.values.held.insert(full, Held { value, at });
            }
            Err(fault) => {
                let way_out = format!("for example {} = {}. {}", key.name, key.example, key.teach);
                self.problems.add(&fault.at, fault.message, way_out);
            }
        }
    }

    /// Puts in a static default, or asks for a required key.
    fn not_written(&mut self, section: &'a TableSection, key: &'static Key, path: &str, table: &Node, at: &At) {
        let rival_written =
            section.group_of(key.name).is_some_and(|group| group.names.iter().any(|name| table.entry(name).is_some()));
        let misspelt = || {
            let unknown = table.entries().iter().filter(|entry| section.key(&entry.name).is_none());
            unknown
                .take(MOST_PROBLEMS)
                .filter_map(|entry| nearest(self.table, section, &entry.name))
                .any(|found| found.is_key(section, key))
        };
        if rival_written {
            return;
        }
        let value = match key.default {
            // Written under a wrong name: one problem is enough.
            Default::Required if misspelt() || !self.asks_for(section, key) => return,
            Default::Required => {
                let header = section.header();
                self.problems.add(
                    at,
                    format!("`{}` is missing {}", display_path(section, key), key.brackets()),
                    format!("write {} = {} under {header}, for example. {}", key.name, key.example, key.teach),
                );
                return;
            }
            Default::OneOfGroup | Default::Derived(_) | Default::LeftOut(_) => return,
            Default::Number(number) => Checked::Number(number),
            Default::Whole(number) => Checked::Whole(number),
            Default::Boolean(on) => Checked::Boolean(on),
            Default::Word(word) => Checked::Text(word.to_owned()),
            Default::EmptyList => Checked::Numbers(Vec::new()),
        };
        self.values.held.insert(join(path, key.name), Held { value, at: None });
    }

    /// Rivals: at most one written, or exactly one.
    fn groups(&mut self, section: &'a TableSection, path: &str, table: &Node) {
        for group in &section.groups {
            let written: Vec<&KeyValue> =
                table.entries().iter().filter(|entry| group.names.contains(&entry.name.as_str())).collect();
            let names = || keys::either(group.names.iter().map(|name| format!("`{name}`")));
            if let [first, second, ..] = written.as_slice() {
                self.problems.add(
                    &second.name_at,
                    format!("`{}` and `{}` say the same thing twice", first.name, second.name),
                    format!("keep one and remove the other: {}", names()),
                );
            } else if written.is_empty() && group.required && self.asks_for_group(section, group) {
                let at = self.values.place_of(&join(path, ""));
                self.problems.add(
                    &at,
                    format!("{} is missing one of {}", section.header(), names()),
                    "write one of them".to_owned(),
                );
            }
        }
    }

    fn unknown(&mut self, section: &'a TableSection, entry: &KeyValue) {
        if self.problems.full() {
            return; // the search for the nearest name is the slowest thing here
        }
        let name = join(section.path, &entry.name).replace("[]", "");
        let what = match (&entry.node.value, section.role) {
            (_, Role::Choice { what, .. }) => what,
            (TomlValue::Table(_), _) => "section",
            _ => "key",
        };
        let article = if what.starts_with(['a', 'e', 'i', 'o']) { "an" } else { "a" };
        let nearest = || match nearest(self.table, section, &entry.name) {
            Some(found) => (format!(" Did you mean {}?", found.words()), found.way_out(section)),
            None => (String::new(), format!("correct or remove it; {}", self.contents(section))),
        };
        let shop_word = shop_words::way_out(section, &entry.name, &entry.node);
        let (hint, way_out) = shop_word.map_or_else(nearest, |way_out| (String::new(), way_out));
        self.problems.add(&entry.name_at, format!("`{name}` is not {article} {what}.{hint}"), way_out);
    }

    /// Defaults that follow from other keys, whatever the process.
    fn derive(&mut self) {
        if let Some(module_mm) = self.values.view("gear").number("module_mm") {
            self.values.put_default("gear", "face_width_mm", Checked::Number((10.0 * module_mm).min(1000.0)));
            if self.values.view("gear").text("kind") == Some("internal") {
                self.values.put_default("gear", "rim_mm", Checked::Number(5.0 * module_mm));
            }
        }
        if let Some(material) = self.values.view("material").text("name").and_then(Kienzle::named) {
            let force = material.edge_force();
            for (name, value) in [
                ("cutting_force_n_per_mm2", force.cutting_n_per_mm2),
                ("cutting_edge_force_n_per_mm", force.cutting_edge_n_per_mm),
                ("normal_force_n_per_mm2", force.normal_n_per_mm2),
                ("normal_edge_force_n_per_mm", force.normal_edge_n_per_mm),
            ] {
                self.values.put_default("material", name, Checked::Number(value));
            }
        }
        for (list, count) in self.values.counts.clone() {
            let section = self.table.section(&format!("{list}[]"));
            let is_named = section.is_some_and(|section| section.key("name").is_some());
            for index in (0..count).filter(|_| is_named) {
                let name = Checked::Text(default_name(list, index));
                self.values.put_default(&format!("{list}.{index}"), "name", name);
            }
        }
    }

    /// What a section takes, in words.
    fn contents(&self, section: &TableSection) -> String {
        let holder = if section.path.is_empty() { "a scene".to_owned() } else { section.header() };
        let keys = section.keys.iter().map(|key| key.name);
        let names: Vec<&str> = keys.chain(self.table.children(section).map(TableSection::name)).collect();
        let names = if names.is_empty() { "no keys".to_owned() } else { names.join(", ") };
        format!("{holder} takes {names}")
    }
}
