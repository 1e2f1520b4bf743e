//! Circles among the files and folders of a crate.
//!
//! In: what modules import from each other. Out: a line for every circle among neighbours: files and folders that stand
//! in the same folder. `x.rs` or `x/mod.rs` and the folder `x/` are one neighbour, named `x`: it imports what any file
//! in it imports.
//!
//! A head (`mod.rs`, or `x.rs` beside `x/`) and the files of its own folder are not counted against each other: a head
//! declares and re-exports its children, and children use the types that it defines. What reaches a child through its
//! head's re-exports counts as an import of the child, so that no circle hides behind a head.
//!
//! A circle of files that are no heads of each other shows among the neighbours where their paths part.

use super::imports::Imports;
use std::collections::{BTreeMap, BTreeSet};

/// Neighbours that each neighbour imports, each with an example, file to file.
type Arrows = BTreeMap<String, BTreeMap<String, String>>;

/// One line for every circle.
pub fn circles(imports: &Imports) -> Vec<String> {
    let mut folders: BTreeMap<&[String], Arrows> = BTreeMap::new();
    for (from, others) in imports {
        for to in others {
            let depth = from.iter().zip(to).take_while(|(a, b)| a == b).count();
            // One of the two is the head of the other.
            let (Some(here), Some(there)) = (from.get(depth), to.get(depth)) else { continue };
            let example = || format!("{} -> {}", joined(from), joined(to));
            let arrows = folders.entry(&from[..depth]).or_default().entry(here.clone()).or_default();
            arrows.entry(there.clone()).or_insert_with(example);
        }
    }
    folders.iter().flat_map(|(folder, arrows)| in_folder(&joined(folder), arrows)).collect()
}

fn joined(module: &[String]) -> String {
    if module.is_empty() { "crate".to_owned() } else { module.join("::") }
}

fn in_folder(folder: &str, arrows: &Arrows) -> Vec<String> {
    let reached: BTreeMap<&str, BTreeSet<&str>> =
        arrows.keys().map(|from| (from.as_str(), reach(from, arrows))).collect();
    let both = |a: &str, b: &str| {
        let leads = |a: &str, b: &str| reached.get(a).is_some_and(|reached| reached.contains(b));
        leads(a, b) && leads(b, a)
    };
    let mut lines = Vec::new();
    let mut told = BTreeSet::new();
    for from in arrows.keys().filter(|from| both(from, from)) {
        let circle: Vec<&str> = arrows.keys().map(String::as_str).filter(|other| both(from, other)).collect();
        if !told.insert(circle.clone()) {
            continue;
        }
        let examples = circle.iter().flat_map(|from| {
            let within = arrows[*from].iter().filter(|(to, _)| circle.contains(&to.as_str()));
            within.map(|(_, example)| example.as_str()).collect::<Vec<_>>()
        });
        lines.push(format!("{folder}: {}: {}", circle.join(", "), examples.collect::<Vec<_>>().join(", ")));
    }
    lines
}

/// Neighbours that one leads to, directly or through others.
fn reach<'a>(from: &'a str, arrows: &'a Arrows) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from];
    while let Some(next) = open.pop() {
        let others = arrows.get(next).into_iter().flat_map(BTreeMap::keys);
        open.extend(others.map(String::as_str).filter(|other| reached.insert(*other)));
    }
    reached
}
