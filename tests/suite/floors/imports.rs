//! What the files of a crate import from each other.
//!
//! In: the sources below a crate's `src`. Out: every module with the modules of the same crate that it names, through
//! `use` (groups and renames included) or as a path in code, from `crate::`, `super::`, `self::` or a child's name. A
//! name that a module re-exports (`pub use`) counts as an import of the module that it comes from. Tests look wherever
//! they like: modules named `tests` are left out, as files and inside a file.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// A place in the tree of modules, from the crate's root; the root itself is empty.
pub type ModulePath = Vec<String>;

/// Texts of source files by the module that each is.
pub type Sources = BTreeMap<ModulePath, String>;

/// Modules of the same crate that each module names.
pub type Imports = BTreeMap<ModulePath, Vec<ModulePath>>;

/// Reads all sources below a folder.
pub fn sources(src: &Path) -> Sources {
    let mut found = Sources::new();
    read(src, &mut Vec::new(), &mut found);
    found
}

fn read(folder: &Path, inside: &mut ModulePath, found: &mut Sources) {
    for entry in fs::read_dir(folder).expect("a folder of the project") {
        let path = entry.expect("an entry").path();
        let name = path.file_stem().and_then(|name| name.to_str()).expect("a name").to_owned();
        if name == "tests" {
            continue;
        }
        let is_head = ["mod", "lib"].contains(&name.as_str());
        inside.push(name);
        if path.is_dir() {
            read(&path, inside, found);
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            let module = inside[..inside.len() - usize::from(is_head)].to_vec();
            found.insert(module, fs::read_to_string(&path).expect("a source file"));
        }
        inside.pop();
    }
}

/// What the modules of a crate import from each other.
pub fn imports(sources: &Sources) -> Imports {
    let named: BTreeMap<&ModulePath, Vec<Named>> =
        sources.iter().map(|(module, text)| (module, names(module, &words(text), sources))).collect();
    let of = |module: &ModulePath| {
        let mut found: Vec<ModulePath> = named[module].iter().map(|name| home(&name.path, &named)).collect();
        found.sort();
        found.dedup();
        found.retain(|other| other != module);
        found
    };
    sources.keys().map(|module| (module.clone(), of(module))).collect()
}

/// A path into the crate that a module names.
struct Named {
    /// From the crate's root: modules, then what they hold.
    path: Vec<String>,
    /// The name under which the module passes it on, if it does.
    passed_on: Option<String>,
}

/// The module that a path leads to, through re-exports.
fn home(path: &[String], named: &BTreeMap<&ModulePath, Vec<Named>>) -> ModulePath {
    let depth = (0..=path.len()).rev().find(|&depth| named.contains_key(&path[..depth].to_vec()));
    let module = path[..depth.expect("the root is a module")].to_vec();
    let Some(item) = path.get(module.len()) else { return module };
    let from = named[&module].iter().find(|name| name.passed_on.as_ref() == Some(item) && name.path != path);
    from.map_or(module, |name| home(&name.path, named))
}

/// Words and marks of a source text; comments, strings and the module `tests` are left out.
fn words(text: &str) -> Vec<String> {
    let code = text.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    let mut words: Vec<String> = Vec::new();
    let mut rest = code;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("//") {
            rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if let Some(end) = string_end(rest) {
            end
        } else if first.is_alphanumeric() || first == '_' {
            rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len())
        } else if rest.starts_with("::") {
            2
        } else {
            first.len_utf8()
        };
        let (word, after) = rest.split_at(length);
        if length == 2 && word == "::" || word.chars().count() == 1 && !first.is_whitespace() || is_name(word) {
            words.push(word.to_owned());
        }
        rest = after;
    }
    words
}

fn is_name(word: &str) -> bool {
    word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Where a string or character that begins here ends.
fn string_end(text: &str) -> Option<usize> {
    let hashes = text.strip_prefix('r').map(|raw| raw.len() - raw.trim_start_matches('#').len());
    if let Some(hashes) = hashes.filter(|hashes| text[1 + hashes..].starts_with('"')) {
        let close = format!("\"{}", "#".repeat(hashes));
        let start = 2 + hashes;
        return text[start..].find(&close).map(|end| start + end + close.len());
    }
    if let Some(inside) = text.strip_prefix('"') {
        let mut escaped = false;
        return inside.char_indices().find_map(|(at, c)| {
            let ends = c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
            ends.then_some(at + 2)
        });
    }
    // A character, not a lifetime: closed after one character or an escape.
    let inside = text.strip_prefix('\'')?;
    let length = if inside.starts_with('\\') {
        2 + inside[2..].find('\'')?
    } else {
        inside.chars().next().map_or(0, char::len_utf8)
    };
    inside[length..].starts_with('\'').then_some(length + 2)
}

/// All paths into the crate that the words of a module name.
fn names(module: &ModulePath, words: &[String], sources: &Sources) -> Vec<Named> {
    let mut found = Vec::new();
    let mut at = 0;
    while at < words.len() {
        let word = words[at].as_str();
        let before = at.checked_sub(1).map_or("", |before| words[before].as_str());
        if word == "use" {
            let passed_on = ["pub", ")"].contains(&before);
            at += 1;
            tree(words, &mut at, &[], &mut |path, name| {
                if let Some(path) = absolute(module, path, sources) {
                    found.push(Named { path, passed_on: passed_on.then(|| name.to_owned()) });
                }
            });
        } else if ["crate", "super", "self"].contains(&word)
            && before != "::"
            && words.get(at + 1).is_some_and(|mark| mark == "::")
        {
            // Not the `crate` of a visibility.
            let mut path = vec![word.to_owned()];
            while words.get(at + 1).is_some_and(|mark| mark == "::") && words.get(at + 2).is_some_and(|w| is_name(w)) {
                path.push(words[at + 2].clone());
                at += 2;
            }
            found.extend(absolute(module, &path, sources).map(|path| Named { path, passed_on: None }));
            at += 1;
        } else {
            at += 1;
        }
    }
    found
}

/// Visits every leaf of a `use` tree: its path, and the name that it gets.
fn tree(words: &[String], at: &mut usize, before: &[String], visit: &mut impl FnMut(&[String], &str)) {
    let mut path = before.to_vec();
    loop {
        let Some(word) = words.get(*at) else { return };
        *at += 1;
        match word.as_str() {
            "::" => {}
            "{" => {
                while words.get(*at).is_some_and(|word| word != "}") {
                    tree(words, at, &path, visit);
                    if words.get(*at).is_some_and(|word| word == ",") {
                        *at += 1;
                    }
                }
                *at += 1;
                return;
            }
            "self" if !before.is_empty() && path.len() == before.len() => {}
            name => path.push(name.to_owned()),
        }
        if words.get(*at).is_none_or(|word| word != "::") && words.get(*at - 1).is_none_or(|word| word != "::") {
            break;
        }
    }
    let renamed = words.get(*at).is_some_and(|word| word == "as");
    if renamed {
        *at += 2;
    }
    let name = if renamed { words.get(*at - 1) } else { path.last() };
    visit(&path, name.map_or("", String::as_str));
}

/// A path as seen from a module, from the crate's root. `None`: it leads into another crate.
fn absolute(module: &ModulePath, path: &[String], sources: &Sources) -> Option<Vec<String>> {
    let first = path.first()?.as_str();
    let mut from = match first {
        "crate" => Vec::new(),
        "self" | "super" => module.clone(),
        child => {
            let below = [module.as_slice(), &[child.to_owned()]].concat();
            return sources.contains_key(&below).then(|| [module.as_slice(), path].concat());
        }
    };
    let ups = path.iter().take_while(|word| *word == "super").count();
    from.truncate(from.len().saturating_sub(ups));
    from.extend(path[ups.max(1)..].iter().cloned());
    Some(from)
}
