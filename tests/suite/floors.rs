//! The floors of the house: a module uses only those that its crate lists above it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Names of the crate's own modules in the order of its list, from the ground up.
fn floors(lib: &str) -> Vec<String> {
    let own: Vec<&str> = lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect();
    let listed: Vec<String> = lib
        .lines()
        .filter_map(|line| Some(line.strip_prefix("//! - [`")?.split_once('`')?.0.to_owned()))
        .filter(|name| own.contains(&name.as_str()))
        .collect();
    assert_eq!(listed.len(), own.len(), "the list at the head of lib.rs and its modules differ: {listed:?}, {own:?}");
    listed
}

/// Rust files under a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("a folder of the project") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            found.push(path);
        }
    }
}

/// Every path into the crate that code of a file names, `crate::a::b` as `["a", "b"]`; tests inside the file look
/// wherever they like.
fn named(text: &str) -> Vec<Vec<String>> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let mut found = Vec::new();
    for line in code.lines().filter(|line| !line.trim_start().starts_with("//")) {
        for (at, _) in line.match_indices("crate::") {
            let path: String =
                line[at..].chars().take_while(|c| c.is_alphanumeric() || matches!(c, '_' | ':')).collect();
            found.push(path.split("::").skip(1).map(str::to_owned).collect());
        }
    }
    found
}

/// Arrows that point up, as "file -> module".
fn arrows_up(src: &Path, lib: &str) -> Vec<String> {
    let floors = floors(lib);
    let floor: BTreeMap<&str, usize> = floors.iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
    let mut paths = Vec::new();
    files(src, &mut paths);
    let mut up = Vec::new();
    for path in paths {
        let inside = path.strip_prefix(src).expect("under the folder");
        let first = inside.iter().next().and_then(|name| name.to_str()).expect("a name").trim_end_matches(".rs");
        let Some(&here) = floor.get(first) else { continue };
        let text = fs::read_to_string(&path).expect("a source file");
        for named in named(&text) {
            let there = named.first().and_then(|name| floor.get(name.as_str()));
            if there.is_some_and(|&there| there > here) {
                up.push(format!("{} -> {}", inside.display(), named[0]));
            }
        }
    }
    up
}

/// Processes do not know each other: what two of them need stands on a lower floor.
fn arrows_between_processes(src: &Path) -> Vec<String> {
    let mut across = Vec::new();
    for entry in fs::read_dir(src.join("process")).expect("the folder of processes") {
        let folder = entry.expect("an entry").path();
        if !folder.is_dir() {
            continue;
        }
        let own = folder.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
        let mut paths = Vec::new();
        files(&folder, &mut paths);
        for path in paths {
            let text = fs::read_to_string(&path).expect("a source file");
            for named in named(&text).iter().filter(|named| named.first().is_some_and(|name| name == "process")) {
                if named.get(1).is_some_and(|other| *other != own && src.join("process").join(other).is_dir()) {
                    across.push(format!("{} -> {}", path.display(), named.join("::")));
                }
            }
        }
    }
    across
}

const SOURCES: [&str; 3] = ["src", "crates/core/src", "crates/gpu/src"];

#[test]
fn no_arrow_points_up() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for source in SOURCES {
        let src = root.join(source);
        let lib = fs::read_to_string(src.join("lib.rs")).expect("lib.rs");
        if source != "crates/gpu/src" {
            let up = arrows_up(&src, &lib);
            assert!(up.is_empty(), "{source}: arrows that point up:\n{}", up.join("\n"));
        }
    }
    let across = arrows_between_processes(&root.join("src"));
    assert!(across.is_empty(), "processes that use each other:\n{}", across.join("\n"));
}

/// The same test must notice an arrow that is planted: with the list turned upside down nearly every arrow points up.
#[test]
fn planted_arrows_are_noticed() {
    let src = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/core/src");
    let lib = fs::read_to_string(src.join("lib.rs")).expect("lib.rs");
    let mut lines: Vec<&str> = lib.lines().filter(|line| line.starts_with("//! - [`")).collect();
    lines.reverse();
    let modules: Vec<&str> = lib.lines().filter(|line| line.starts_with("pub mod ")).collect();
    let turned = [lines, modules].concat().join("\n");
    assert!(arrows_up(&src, &turned).len() > 50);
}
