//! The table of quantities: a quantity is said once, its page is fresh, and no table is left out of it.

use crate::fixtures::printed::stale;
use gearcut::quantities::{groups, markdown, parameters};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

#[test]
fn no_definition_is_said_twice() {
    let mut keys: BTreeMap<String, Vec<String>> = BTreeMap::new();
    let rows = groups().into_iter().flat_map(|group| group.rows);
    let rows = rows.map(|row| (row.key.to_owned(), row.definition.to_owned()));
    let lists = parameters().map(|(.., list)| list);
    assert!(lists[0].len() > 30 && lists[1].len() > 15, "the sets of ISO 25178-2 and ISO 21920-2");
    let of_texture = lists.into_iter().flatten().map(|of| (of.symbol, of.definition));
    for (key, definition) in rows.chain(of_texture) {
        assert!(!key.is_empty() && !definition.is_empty(), "{key}: {definition}");
        keys.entry(definition).or_default().push(key);
    }
    let twice: Vec<_> = keys.iter().filter(|(_, keys)| keys.len() > 1).collect();
    assert!(twice.is_empty(), "said twice: {twice:?}");
}

#[test]
fn a_group_has_a_key_once() {
    for group in groups() {
        let keys: BTreeSet<&str> = group.rows.iter().map(|row| row.key).collect();
        assert_eq!(keys.len(), group.rows.len(), "{}", group.key);
    }
}

/// Tables in the source are all in the list that the page is printed from.
#[test]
fn no_table_is_left_out() {
    fn count(folder: &Path) -> usize {
        let entries =
            fs::read_dir(folder).expect("a folder of the source").map(|entry| entry.expect("an entry").path());
        let tables = |path: &Path| {
            let text = fs::read_to_string(path).expect("a source");
            text.lines().filter(|line| *line == "rows! {").count()
        };
        entries.map(|path| if path.is_dir() { count(&path) } else { tables(&path) }).sum()
    }
    assert_eq!(count(Path::new("src")), groups().len());
}

#[test]
fn the_page_is_up_to_date() {
    stale("docs/quantities.md", &markdown(), "GEARCUT_BLESS=1 cargo test --test suite program::quantities");
}
