//! The core and the crate of textures name parameters; keys of scenes are words of the program.

use gearcut::process::table;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// String literals of a source outside its comments and tests.
fn literals(source: &str) -> Vec<String> {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let lines = code.lines().filter(|line| !line.trim_start().starts_with("//"));
    let code: String = lines.collect::<Vec<_>>().join("\n").replace("'\"'", "");
    code.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

/// Words of a literal that only scenes have: paths of keys, and names of keys with a unit. Braces hold a
/// variable.
fn of_scenes(literal: &str, keys: &BTreeSet<String>) -> Vec<String> {
    let literal: String = literal.split('{').map(|part| part.split_once('}').map_or(part, |(_, rest)| rest)).collect();
    let words = literal.split(|c: char| !(c.is_ascii_alphanumeric() || "._".contains(c)));
    words.map(|word| word.trim_matches('.').to_owned()).filter(|word| keys.contains(word) || word == "scene").collect()
}

fn keys() -> BTreeSet<String> {
    let of = |path: String| {
        let name = path.rsplit('.').next().unwrap_or_default().to_owned();
        [Some(path.clone()), name.contains('_').then_some(name)].into_iter().flatten().collect::<Vec<_>>()
    };
    table().keys().flat_map(|(path, _)| of(path)).collect()
}

fn check(folder: &Path, keys: &BTreeSet<String>) {
    for entry in fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path()) {
        if entry.is_dir() {
            check(&entry, keys);
        } else if entry.file_name().is_some_and(|name| name != "tests.rs") {
            for literal in literals(&fs::read_to_string(&entry).expect("a source")) {
                let found = of_scenes(&literal, keys);
                assert!(found.is_empty(), "{}: {found:?} in {literal:?}", entry.display());
            }
        }
    }
}

#[test]
fn the_crates_below_have_no_word_of_scenes() {
    let mut keys = keys();
    check(Path::new("crates/core/src"), &keys);
    // The channel of EXR files has the name of a key of pictures.
    assert!(keys.remove("height_mm"));
    check(Path::new("crates/texture/src"), &keys);
}

#[test]
fn a_planted_key_is_found() {
    let planted = "Refusal::new(\"gear.module_mm\", \"too large\", \"use a smaller spacing_mm\") // \"gear.teeth\"";
    let found: Vec<String> = literals(planted).iter().flat_map(|literal| of_scenes(literal, &keys())).collect();
    assert_eq!(found[..2], ["gear.module_mm", "spacing_mm"]);
}
