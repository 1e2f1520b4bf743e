//! `docs/notices.md` against the table of notices; every table of the sources is in it.

use crate::fixtures::printed::stale;
use gearcut::notices;
use std::fs;
use std::path::Path;

#[test]
fn the_page_is_up_to_date() {
    stale("docs/notices.md", &notices::markdown(), "GEARCUT_BLESS=1 cargo test --test suite notices");
}

/// Ids behind the types of every `notices!` below a folder.
fn written(folder: &Path, found: &mut Vec<String>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            written(&entry, found);
        } else if entry.file_name().is_some_and(|name| name == "notices.rs") {
            let text = fs::read_to_string(&entry).expect("a source");
            let rows =
                text.lines().filter(|line| [": Note ", ": Warning ", ": Fault "].iter().any(|of| line.contains(of)));
            found.extend(rows.filter(|line| line.starts_with("    ") && line.contains(".md\"")).map(str::to_owned));
        }
    }
}

/// A table that `notices::rows` forgets is found.
#[test]
fn every_row_in_the_sources_is_in_the_table() {
    let mut found = Vec::new();
    written(Path::new("src"), &mut found);
    assert_eq!(found.len(), notices::rows().count(), "{found:#?}");
    assert!(found.iter().all(|line| notices::rows().any(|row| line.contains(&format!("\"{}\"", row.id)))));
}
