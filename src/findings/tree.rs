//! The tree: what a run found, from the headline down to the last detail.

use super::column::TableCells;
use super::entry::Entry;
use super::notice::{Notice, ranked};
use super::quantity::Quantity;
use super::row::{QuantityGroup, QuantityRow};
use super::table::{Columns, Table};
use gearcut_core::terms::Side;

/// Everything that a run found.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// Version of the program.
    pub program_version: String,
    /// Name of the process.
    pub process: String,
    /// Name of the scene.
    pub scene: String,
    /// Whether all flanks were cut; false after Ctrl-C, when the numbers cover the finished flanks only.
    pub complete: bool,
    /// What to look at first: numbers of the whole gear.
    pub headline: Vec<Entry>,
    /// What a reader must know before trusting the numbers, [`super::notice::ranked`].
    pub warnings: Vec<Notice>,
    /// Everything else.
    pub sections: Vec<Section>,
}

/// A part of the tree.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Key among its neighbours: letters, digits, `_` and `-`.
    pub key: String,
    /// What it is about.
    pub title: String,
    /// Quantities.
    pub entries: Vec<Entry>,
    /// Tables.
    pub tables: Vec<Table>,
    /// Parts.
    pub sections: Vec<Section>,
}

impl Findings {
    /// Without the entries of the headline and the sections whose paths are not to be kept.
    pub fn retain(&mut self, keep: &dyn Fn(&str) -> bool) {
        fn within(before: &str, sections: &mut Vec<Section>, keep: &dyn Fn(&str) -> bool) {
            sections.retain_mut(|section| {
                let path = format!("{before}{}", section.key);
                within(&format!("{path}."), &mut section.sections, keep);
                keep(&path)
            });
        }
        self.headline.retain(|entry| keep(&entry.key));
        within("", &mut self.sections, keep);
    }
}

impl Section {
    /// An empty section.
    pub fn new(key: impl Into<String>, title: impl Into<String>) -> Self {
        Self { key: key.into(), title: title.into(), ..Self::default() }
    }

    fn add(mut self, entry: Entry) -> Self {
        debug_assert!(self.is_free(&entry.key), "{}.{} is there twice", self.key, entry.key);
        self.entries.push(entry);
        self
    }

    /// With these entries.
    #[must_use]
    pub fn entries(self, entries: impl IntoIterator<Item = Entry>) -> Self {
        entries.into_iter().fold(self, Self::add)
    }

    /// With a table.
    #[must_use]
    pub fn table(mut self, table: impl Into<Table>) -> Self {
        let table = table.into();
        debug_assert!(self.is_free(&table.key), "{}.{} is there twice", self.key, table.key);
        self.tables.push(table);
        self
    }

    /// With a part.
    #[must_use]
    pub fn part(mut self, section: Section) -> Self {
        debug_assert!(self.is_free(&section.key), "{}.{} is there twice", self.key, section.key);
        self.sections.push(section);
        self
    }

    /// With parts.
    #[must_use]
    pub fn parts(self, sections: impl IntoIterator<Item = Section>) -> Self {
        sections.into_iter().fold(self, Self::part)
    }

    /// The same where nothing of it holds, with the reason: entries but those of the rows in `keep` lose their values,
    /// words and numbers alike, and tables their rows.
    #[must_use]
    pub fn without_values(mut self, why: &str, keep: &[&QuantityRow]) -> Self {
        for entry in self.entries.iter_mut().filter(|entry| keep.iter().all(|row| row.key != entry.key)) {
            *entry = entry.clone().unless(Some(why));
        }
        for table in &mut self.tables {
            table.cells.iter_mut().for_each(TableCells::clear);
        }
        self.sections = self.sections.into_iter().map(|part| part.without_values(why, keep)).collect();
        self
    }

    /// Whether nothing of this key is in it.
    pub fn is_free(&self, key: &str) -> bool {
        self.entries.iter().all(|entry| entry.key != key)
            && self.tables.iter().all(|table| table.key != key)
            && self.sections.iter().all(|section| section.key != key)
    }

    /// The part at a path of keys joined by dots, such as a user writes; who knows it takes [`Self::group`].
    pub fn at_path(&self, path: &str) -> Option<&Section> {
        at_path(&self.sections, path)
    }

    /// The entry at a path.
    pub fn entry(&self, path: &str) -> Option<&Entry> {
        let (section, key) = match path.rsplit_once('.') {
            Some((parts, key)) => (self.at_path(parts)?, key),
            None => (self, path),
        };
        section.entries.iter().find(|entry| entry.key == key)
    }

    /// The quantity at a path.
    pub fn quantity(&self, path: &str) -> Option<&Quantity> {
        self.entry(path).map(|entry| &entry.quantity)
    }

    /// The number at a path; none where there is no such quantity or it is undefined.
    pub fn number(&self, path: &str) -> Option<f64> {
        self.quantity(path)?.value()
    }

    /// The words at a path; empty where there are none.
    pub fn words(&self, path: &str) -> &str {
        self.quantity(path).and_then(Quantity::words).unwrap_or_default()
    }

    /// The quantity of this row.
    pub fn of(&self, row: &QuantityRow) -> Option<&Quantity> {
        self.quantity(row.key)
    }

    /// The entry of this row.
    pub fn entry_of(&self, row: &QuantityRow) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == row.key)
    }

    /// The number of this row; none where there is no such quantity or it is undefined.
    pub fn value(&self, row: &QuantityRow) -> Option<f64> {
        self.of(row)?.value()
    }

    /// The words of this row; empty where there are none.
    pub fn text(&self, row: &QuantityRow) -> &str {
        self.words(row.key)
    }

    /// The part of this group.
    pub fn group(&self, group: &QuantityGroup) -> Option<&Section> {
        at_path(&self.sections, group.key)
    }

    /// The part of the flanks of this side.
    pub fn side(&self, side: Side) -> Option<&Section> {
        at_path(&self.sections, side.name())
    }

    /// The table of this group.
    pub fn table_of(&self, group: &QuantityGroup) -> Option<&Table> {
        self.table_at(group.key)
    }

    /// The table of this key, such as a file names.
    pub fn table_at(&self, key: &str) -> Option<&Table> {
        self.tables.iter().find(|table| table.key == key)
    }

    /// The section and all its parts with their paths, in order.
    pub fn walk<'a>(&'a self, path: &str, visit: &mut impl FnMut(&str, &'a Section)) {
        visit(path, self);
        for part in &self.sections {
            part.walk(&format!("{path}.{}", part.key), visit);
        }
    }
}

impl QuantityGroup {
    /// A section with these entries.
    pub fn section(&self, entries: impl IntoIterator<Item = Entry>) -> Section {
        Section::new(self.key, self.title).entries(entries)
    }

    /// A table with a row for each of these, whose columns follow.
    pub fn table<T>(&self, of: impl IntoIterator<Item = T>) -> Columns<T> {
        Table::over(self.key, self.title, of)
    }
}

fn at_path<'a>(sections: &'a [Section], path: &str) -> Option<&'a Section> {
    let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
    let section = sections.iter().find(|section| section.key == first)?;
    match rest {
        Some(rest) => at_path(&section.sections, rest),
        None => Some(section),
    }
}

impl Findings {
    /// What a run of a process found; warnings are ranked here.
    pub fn new(
        process: &str,
        scene: &str,
        complete: bool,
        headline: impl IntoIterator<Item = Entry>,
        warnings: impl IntoIterator<Item = Notice>,
        sections: Vec<Section>,
    ) -> Self {
        Self {
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            process: process.to_owned(),
            scene: scene.to_owned(),
            complete,
            headline: headline.into_iter().map(Entry::first_of_all).collect(),
            warnings: ranked(warnings),
            sections,
        }
    }

    /// The section at a path of keys joined by dots, such as a user writes; who knows it takes [`Self::group`].
    pub fn at_path(&self, path: &str) -> Option<&Section> {
        at_path(&self.sections, path)
    }

    /// The section of this group.
    pub fn group(&self, group: &QuantityGroup) -> Option<&Section> {
        at_path(&self.sections, group.key)
    }

    /// The parts of the section of this group; none where it is missing.
    pub fn parts(&self, group: &QuantityGroup) -> &[Section] {
        self.group(group).map_or(&[], |section| &section.sections)
    }

    /// The quantity of this row in the headline.
    pub fn first(&self, row: &QuantityRow) -> Option<&Quantity> {
        self.headline(row.key)
    }

    /// A number of the headline.
    pub fn headline(&self, key: &str) -> Option<&Quantity> {
        self.headline.iter().find(|entry| entry.key == key).map(|entry| &entry.quantity)
    }

    /// All sections with their paths, in order.
    pub fn walk<'a>(&'a self, visit: &mut impl FnMut(&str, &'a Section)) {
        for section in &self.sections {
            section.walk(&section.key, visit);
        }
    }
}
