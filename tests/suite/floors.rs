//! The floors of the house: a module uses only those that its crate lists above it, processes do not use each other,
//! and no files or folders import each other in a circle.

mod circles;
mod columns;
mod imports;

use circles::circles;
use imports::{Imports, ModulePath, Sources, imports, sources};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// Sources of the crates, each with a list of its modules at the head of its `lib.rs`.
const CRATES: [&str; 4] = ["src", "crates/core/src", "crates/gpu/src", "crates/texture/src"];

fn read(source: &str) -> Sources {
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join(source))
}

/// Names of the crate's own modules in the order of its list, from the ground up.
fn floors(lib: &str) -> Vec<String> {
    let declared = |line: &str| {
        let name =
            ["pub mod ", "pub(crate) mod ", "mod "].iter().find_map(|start| line.trim_start().strip_prefix(start))?;
        let name = name.strip_suffix(';')?;
        (name != "tests").then(|| name.to_owned())
    };
    // A module may be declared twice, closed and open to tests.
    let own: BTreeSet<String> = lib.lines().filter_map(declared).collect();
    let listed: Vec<String> = lib
        .lines()
        .filter_map(|line| {
            Some(line.strip_prefix("//! - ")?.trim_start_matches('[').strip_prefix('`')?.split_once('`')?.0)
        })
        .filter(|name| own.contains(*name))
        .map(str::to_owned)
        .collect();
    assert_eq!(listed.len(), own.len(), "the list at the head of lib.rs and its modules differ: {listed:?}, {own:?}");
    listed
}

/// Arrows that point up, as "module -> module". The crate's root is the roof: what it passes on from other crates is
/// for programs outside.
fn arrows_up(imports: &Imports, floors: &[String]) -> Vec<String> {
    let floor: BTreeMap<&str, usize> = floors.iter().enumerate().map(|(i, name)| (name.as_str(), i)).collect();
    let of = |module: &ModulePath| match module.first() {
        Some(first) => floor.get(first.as_str()).copied(),
        None => Some(floors.len()),
    };
    let arrows = imports.iter().flat_map(|(from, others)| others.iter().map(move |to| (from, to)));
    arrows
        .filter(|(from, to)| of(from).zip(of(to)).is_some_and(|(here, there)| there > here))
        .map(|(from, to)| format!("{} -> {}", from.join("::"), to.join("::")))
        .collect()
}

/// Processes do not know each other: what two of them need stands on a lower floor.
fn arrows_between_processes(imports: &Imports) -> Vec<String> {
    let process = |module: &ModulePath| match module.as_slice() {
        [process, name, ..] if process == "process" => Some(name.clone()),
        _ => None,
    };
    let arrows = imports.iter().flat_map(|(from, others)| others.iter().map(move |to| (from, to)));
    arrows
        .filter(|(from, to)| process(from).zip(process(to)).is_some_and(|(here, there)| here != there))
        .map(|(from, to)| format!("{} -> {}", from.join("::"), to.join("::")))
        .collect()
}

/// Imports among the children of a folder, as if it were a crate.
fn inside(imports: &Imports, folder: &[String]) -> Imports {
    let child = |module: &ModulePath| Some(module.strip_prefix(folder)?.to_vec()).filter(|rest| !rest.is_empty());
    let children = imports.iter().filter_map(|(from, others)| Some((child(from)?, others)));
    children.map(|(from, others)| (from, others.iter().filter_map(child).collect())).collect()
}

#[test]
fn no_arrow_points_up() {
    for source in CRATES {
        let sources = read(source);
        let up = arrows_up(&imports(&sources), &floors(&sources[&Vec::new()]));
        assert!(up.is_empty(), "{source}: arrows that point up:\n{}", up.join("\n"));
    }
    let across = arrows_between_processes(&imports(&read("src")));
    assert!(across.is_empty(), "processes that use each other:\n{}", across.join("\n"));
}

/// Shaping, the largest of the folders, lists its modules from the scene to the page.
#[test]
fn shaping_follows_the_path_of_its_data() {
    let sources = read("src");
    let folder: ModulePath = ["process", "shaping"].map(str::to_owned).to_vec();
    let order = floors(&sources[&folder]);
    let up = arrows_up(&inside(&imports(&sources), &folder), &order);
    assert!(up.is_empty(), "arrows that point up:\n{}", up.join("\n"));
    let planted = planted(&sources, "process::shaping::linkage", "use crate::process::shaping::cut::chips;");
    let up = arrows_up(&inside(&imports(&planted), &folder), &order);
    assert!(up.len() == 1 && up[0].starts_with("linkage -> cut"), "{up:?}");
}

/// Parts of a process that show what the others have found.
const SHOWING: [&str; 8] = ["axes_report", "check", "findings", "foreseen", "pair", "prepared", "report", "run"];

/// What a scene says is known before any step; and physics (tools, linkages, targets, cuts, measures) before any file,
/// page or terminal shows it.
#[test]
fn scenes_stay_below_steps_and_physics_below_output() {
    let all = imports(&read("src"));
    let arrows = all.iter().flat_map(|(from, others)| others.iter().map(move |to| [from.join("::"), to.join("::")]));
    let up = arrows.filter(|[from, to]| {
        let scene = from.starts_with("process::") && from.split("::").nth(2) == Some("scene");
        let process = from.strip_prefix("process::").and_then(|of| of.split("::").nth(1));
        let physics = process.is_some_and(|part| !SHOWING.contains(&part)) || from.starts_with("pair::");
        scene && to.starts_with("steps") || physics && to.starts_with("output")
    });
    let up: Vec<String> = up.map(|[from, to]| format!("{from} -> {to}")).collect();
    assert!(up.is_empty(), "arrows that point up:\n{}", up.join("\n"));
}

/// Outside `findings` quantities, sections and tables are taken by their rows and groups, so that a missing one does
/// not compile. Paths come from users and files alone: what a study keeps, what a comparison has found in its results.
#[test]
fn results_are_looked_up_by_row() {
    let by_name = [".at_path(", ".table_at(", ".headline(", ".quantity(", ".entry(\"", ".number(\""];
    let looked_up = |module: &ModulePath, text: &str| {
        let place = module.join("::");
        let known = ["findings", "study::kept", "compare::charts"].iter().any(|home| place.starts_with(home))
            || place.split("::").any(|name| name == "scene" || name.ends_with("tests"));
        let lines = text.lines().take_while(|line| !line.starts_with("#[cfg(test)]")).filter(|_| !known);
        lines.filter(|line| by_name.iter().any(|of| line.contains(of))).map(str::to_owned).collect::<Vec<_>>()
    };
    let sources = read("src");
    let all: Vec<String> = sources.iter().flat_map(|(module, text)| looked_up(module, text)).collect();
    assert!(all.is_empty(), "looked up by name:\n{}", all.join("\n"));
    let planted = planted(&sources, "scatter::page", "fn f() { found.at_path(\"layers\"); }");
    let page = ["scatter", "page"].map(str::to_owned).to_vec();
    assert_eq!(looked_up(&page, &planted[&page]).len(), 1);
}

#[test]
fn nothing_is_imported_in_a_circle() {
    for source in CRATES {
        let found = circles(&imports(&read(source)));
        assert!(found.is_empty(), "{source}: circles:\n{}", found.join("\n"));
    }
}

/// Adds a line to the text of a module.
fn planted(sources: &Sources, module: &str, line: &str) -> Sources {
    let path: ModulePath = module.split("::").map(str::to_owned).collect();
    let mut sources = sources.clone();
    let text = sources.get_mut(&path).expect("a module of the crate");
    *text = format!("{line}\n{text}");
    sources
}

/// The same test must notice an arrow that is planted, however it is written.
#[test]
fn planted_arrows_are_noticed() {
    let sources = read("crates/core/src");
    let floors = floors(&sources[&Vec::new()]);
    for line in [
        "use crate::cut::Backend;",
        "use crate::{error::{self, NotConverged}, cut};",
        "use super::super::{cut::cpu as native};",
        "fn planted() -> crate::cut::CutStats { /* \" */ unimplemented!() }",
    ] {
        let up = arrows_up(&imports(&planted(&sources, "math::roots", line)), &floors);
        let [only] = up.as_slice() else { panic!("{} arrows by {line}: {up:?}", up.len()) };
        assert!(only.starts_with("math::roots -> cut"), "{only}");
    }
    for line in ["// use crate::cut::Backend;", "const TEXT: &str = \"use crate::cut::Backend; \\\" crate::cut\";"] {
        assert_eq!(arrows_up(&imports(&planted(&sources, "math::roots", line)), &floors), [""; 0], "{line}");
    }
    let program = read("src");
    let through_the_roof = planted(&program, "measure::stock", "use crate::{dexel::Layer};");
    let listed = self::floors(&program[&Vec::new()]);
    assert_eq!(arrows_up(&imports(&through_the_roof), &listed), ["measure::stock -> "]);
    let across = planted(&program, "process::hobbing::job", "use super::super::{shaping::ShaperCutter as Other};");
    assert_eq!(
        arrows_between_processes(&imports(&across)),
        ["process::hobbing::job -> process::shaping::tool::cutter"]
    );
}

/// The same test must notice circles that are planted: between files, between folders, and through the re-exports of a
/// head.
#[test]
fn planted_circles_are_noticed() {
    let sources = read("crates/core/src");
    for (module, line, folder, neighbours) in [
        ("passes::planar::near", "use super::candidates::CutPlan;", "passes::planar", ["candidates", "near"]),
        ("passes::planar::near", "use super::{candidates as up};", "passes::planar", ["candidates", "near"]),
        ("passes::planar::strokes", "use crate::{passes::{spatial::motion}, units};", "passes", ["planar", "spatial"]),
        ("passes::planar::strokes", "use crate::passes::SweepPlan;", "passes", ["planar", "spatial"]),
        ("tool::involute", "use super::edge::Edge;", "tool", ["edge", "involute"]),
    ] {
        let found = circles(&imports(&planted(&sources, module, line)));
        let [only] = found.as_slice() else { panic!("{} circles by {line}: {found:?}", found.len()) };
        let names =
            only.strip_prefix(&format!("{folder}: ")).and_then(|rest| rest.split_once(": ")).expect("its names").0;
        let names: Vec<&str> = names.split(", ").collect();
        assert!(neighbours.iter().all(|name| names.contains(name)), "{line} in {module}: {only}");
    }
    let children = planted(&sources, "tool::edge", "use super::CuttingTool;");
    assert_eq!(circles(&imports(&children)), [""; 0], "a head and its children are not counted");
}

/// Names that two types may share: every crate has its own error, and one of two modules stands for the GPU's devices.
const SHARED_NAMES: [&str; 2] = ["Error", "Devices"];

/// Names of types, open or private, with the files that declare them, where there are two. Tests name theirs as they
/// like.
fn names_of_two_types<'a>(files: impl IntoIterator<Item = (String, &'a str)>) -> Vec<String> {
    let mut homes: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (home, text) in files {
        let text = text.split_once("#[cfg(test)]\nmod tests {").map_or(text, |(before, _)| before);
        for line in text.lines() {
            let line = line.trim_start();
            let open = line.strip_prefix("pub").map_or(line, |after| {
                after.strip_prefix('(').map_or(after, |scope| scope.split_once(')').map_or("", |s| s.1)).trim_start()
            });
            let declared = ["struct ", "enum ", "trait "].iter().find_map(|kind| open.strip_prefix(kind));
            let Some(after) = declared else { continue };
            let name = after.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
            homes.entry(name).or_default().push(home.clone());
        }
    }
    let twice = homes.iter().filter(|(name, homes)| homes.len() > 1 && !SHARED_NAMES.contains(name));
    twice.map(|(name, homes)| format!("{name}: {}", homes.join(", "))).collect()
}

#[test]
fn no_two_types_have_one_name() {
    let all: Vec<(String, String)> = CRATES
        .iter()
        .flat_map(|source| read(source).into_iter().map(move |(module, text)| (source, module, text)))
        .filter(|(_, module, _)| !module.iter().any(|name| name.ends_with("tests")))
        .map(|(source, module, text)| (format!("{source} {module:?}"), text))
        .collect();
    let twice = names_of_two_types(all.iter().map(|(home, text)| (home.clone(), text.as_str())));
    assert!(twice.is_empty(), "one name, two types:\n{}", twice.join("\n"));
    let planted = ["struct Span {", "    pub(crate) enum Span;"].map(|text| ("planted".to_owned(), text));
    assert_eq!(names_of_two_types(planted), ["Span: planted, planted"]);
}
