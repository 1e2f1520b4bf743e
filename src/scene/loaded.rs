//! Loading a scene, and finding its keys again afterwards.

use std::path::{Path, PathBuf};

use super::errors::{Problem, SceneErrors, SourcePlace};
use super::files::WayToFiles;
use super::keys::join;
use super::parameters::key_of;
use super::points::{read_points, read_text};
use super::problems::{Found, Problems};
use super::process::{FINISH_ALONE, SceneProcess};
use super::sources::{At, Sources};
use super::table::KeyTable;
use super::tree::{KeyValue, Node, TomlValue, parse_document};
use super::values::Values;
use super::walk::walk;
use super::{Scene, build, checks, foreign, overrides, write};
use crate::number_text::number_meant;
use gearcut_core::error::Refusal;

/// A scene without problems, with the memory of where each value was written.
#[derive(Debug, Clone)]
pub struct LoadedScene {
    /// The checked scene.
    pub scene: Scene,
    pub(super) values: Values,
    sources: Sources,
    /// Folder of the files that it refers to.
    base_dir: PathBuf,
}

/// Where a key's value was written, and how.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Located {
    /// File, line and column, or the `--set` argument.
    pub place: SourcePlace,
    /// The value as written.
    pub written: String,
}

/// Loads the scene file at `path`, with the `--set` arguments `overrides` put in, against the keys of `table`.
///
/// # Errors
/// All problems of the scene, each with its place and a way out.
pub fn load(path: &Path, overrides: &[String], table: &KeyTable) -> Result<LoadedScene, SceneErrors> {
    let file = path.display().to_string();
    let first = table.processes().first().map_or("", |process| process.name);
    let text = read_text(path).map_err(|why| {
        SceneErrors::new(vec![Problem {
            place: SourcePlace::File { file: file.clone() },
            message: format!("cannot read the scene: {why}"),
            way_out: if path.is_file() {
                "a scene is text in UTF-8: save it as that".to_owned()
            } else {
                format!("give the path of a scene file; `gearcut new {first}` writes one to start from")
            },
        }])
    })?;
    parse(&text, &file, path.parent().unwrap_or(Path::new("")), overrides, table)
}

/// The number that a line may mean whose value cannot be read.
fn way_out(text: &str, at: usize) -> Option<String> {
    let start = text.get(..at)?.rfind('\n').map_or(0, |newline| newline + 1);
    let (name, value) = text[start..].lines().next()?.split_once('=')?;
    let number = number_meant(value.split('#').next()?)?;
    Some(format!("write {} = {number}: a decimal point, and no unit, which the name has", name.trim()))
}

/// Reads a scene from text; `file_name` is printed in messages and names the scene, `base_dir` holds the files it
/// refers to.
///
/// # Errors
/// All problems of the scene, each with its place and a way out.
pub fn parse(
    text: &str,
    file_name: &str,
    base_dir: &Path,
    overrides: &[String],
    table: &KeyTable,
) -> Result<LoadedScene, SceneErrors> {
    let sources = Sources { file: file_name.to_owned(), text: text.to_owned(), overrides: overrides.to_vec() };
    let mut problems = Problems { sources: &sources, list: Vec::new() };
    let mut root = match parse_document(text) {
        Ok(root) => root,
        Err(errors) => {
            // A table or a program instead of a scene is wrong in every line.
            let others = if errors.len() > MOST_SYNTAX_ERRORS { errors.len() - 1 } else { 0 };
            let shown = errors.len() - others;
            let where_else = if others > 0 { format!(", nor are {others} more places") } else { String::new() };
            for (span, message) in errors.into_iter().take(shown) {
                let way_out = way_out(text, span.start).unwrap_or_else(|| {
                    "a scene is TOML: [section] lines and name = value lines, each name once".to_owned()
                });
                problems.add(&At::Scene(span), format!("not TOML{where_else}: {message}"), way_out);
            }
            return Err(SceneErrors::new(problems.list));
        }
    };
    let operations = implied_process(&root, table, overrides).map_or(FINISH_ALONE, |process| process.operations);
    imply(&mut root, "operation", operations.iter().map(|operation| vec![("name", operation.name)]));
    // Texture windows that are not listed are chosen when the gear is known.
    imply(&mut root, "texture", []);
    imply(&mut root, "picture", PICTURES.map(|(name, view)| vec![("name", name), ("view", view)]));
    for (index, argument) in overrides.iter().enumerate() {
        if let Err(problem) = overrides::apply(&mut root, table, index, argument) {
            problems.list.push(problem);
        }
    }
    let process = chosen(&root, table);
    let own = process.map(|process| KeyTable::new(&[process]));
    let mut values = walk(&root, table, own.as_ref(), &mut problems);
    if let (Some(process), Some(own)) = (process, &own) {
        foreign::refuse_foreign(&mut values, process, own, table, &mut problems);
        for section in process.on_demand {
            if !values.has_section(section) {
                values.leave_out(section);
            }
        }
        (process.derive)(&mut values);
    }
    read_points(&mut values, table, base_dir, &mut problems);
    let mut found = Found { values: &values, problems: &mut problems };
    checks::cross_check(&mut found);
    if let Some(process) = process {
        (process.check)(&mut found);
    }
    let list = problems.list;
    let stem = Path::new(file_name).file_stem().and_then(|stem| stem.to_str()).unwrap_or("scene");
    match process.and_then(|process| build::build(stem, process, base_dir, &values)) {
        Some(scene) if list.is_empty() => Ok(LoadedScene { scene, values, sources, base_dir: base_dir.to_owned() }),
        _ => Err(SceneErrors::new(list)),
    }
}

/// The process that the first known tool is for.
fn chosen(root: &Node, table: &KeyTable) -> Option<&'static SceneProcess> {
    let tools = root.entry("tool")?.node.entries();
    tools.iter().find_map(|tool| table.processes().iter().copied().find(|process| process.tool == tool.name))
}

/// The process of a text before its `--set` arguments are put in: they may name operations that it implies, and one of
/// them may be the tool that chooses it.
fn implied_process(root: &Node, table: &KeyTable, overrides: &[String]) -> Option<&'static SceneProcess> {
    let mut root = root.clone();
    for (index, argument) in overrides.iter().enumerate() {
        // Problems are told when the arguments are put in for good.
        let _: Result<(), Problem> = overrides::apply(&mut root, table, index, argument);
    }
    chosen(&root, table)
}

/// With more places that are none of TOML only the first is shown.
const MOST_SYNTAX_ERRORS: usize = 10;
/// Name and view of the pictures of a scene that lists none.
const PICTURES: [(&str, &str); 3] = [("gear", "gear"), ("tooth", "tooth"), ("flank", "flank")];

/// Puts in a list that is not written: elements with these texts and all other defaults.
fn imply<'a>(root: &mut Node, list: &str, elements: impl IntoIterator<Item = Vec<(&'a str, &'a str)>>) {
    if root.entry(list).is_some() {
        return;
    }
    let implied = |value: TomlValue| Node { value, at: At::Implied };
    let entry =
        |name: &str, value: TomlValue| KeyValue { name: name.to_owned(), name_at: At::Implied, node: implied(value) };
    let element = |texts: Vec<(&str, &str)>| {
        let entries = texts.into_iter().map(|(name, text)| entry(name, TomlValue::Text(text.to_owned())));
        implied(TomlValue::Table(entries.collect()))
    };
    let elements = elements.into_iter().map(element).collect();
    if let Some(entries) = root.entries_mut() {
        entries.push(entry(list, TomlValue::List(elements)));
    }
}

impl LoadedScene {
    /// Folder of the files that it refers to.
    pub fn base_dir(&self) -> &Path {
        &self.base_dir
    }

    /// The same text with more `--set` arguments behind those that it was read with, against the keys of `table`.
    ///
    /// # Errors
    /// All problems of the scene, each with its place and a way out.
    pub fn with_settings(&self, settings: &[String], table: &KeyTable) -> Result<Self, SceneErrors> {
        let Sources { file, text, overrides } = &self.sources;
        parse(text, file, &self.base_dir, &[overrides, settings].concat(), table)
    }

    /// Folder of the files that it names, seen from a folder of results that need not be there yet; none where it
    /// names no file.
    ///
    /// # Errors
    /// A folder that no record can name.
    pub fn folder_of_files(&self, results: &Path) -> Result<Option<String>, Refusal> {
        if self.scene.process.files_read().is_empty() {
            return Ok(None);
        }
        let beside = results.parent().unwrap_or(Path::new(""));
        let way = WayToFiles::new(beside, &self.base_dir).path_of(".", "scene")?;
        let way = way.trim_end_matches("/.");
        Ok(Some(if Path::new(way).is_absolute() { way.to_owned() } else { format!("../{way}") }))
    }

    /// Where `key` was written; `None` for a default, a derived value or an unknown key.
    ///
    /// Operations are named by their name or by their number from 0 (`operation.rough.offset_mm`,
    /// `operation[0].offset_mm`); without either, the first operation that writes the key is meant.
    pub fn locate(&self, key: &str) -> Option<Located> {
        let at = self.paths(key).iter().find_map(|path| self.values.held.get(path)?.at.clone())?;
        Some(Located { place: self.sources.place(&at), written: self.sources.written(&at) })
    }

    /// A refusal by geometry, printed as the problems of the text are: with file, line, column, value and a way out.
    ///
    /// A key that was not written is shown by the section that would hold it, and the message says that its default
    /// holds.
    pub fn explain(&self, refusal: &Refusal) -> SceneErrors {
        let key = &key_of(&refusal.key);
        let (place, message) = if let Some(Located { place, written }) = self.locate(key) {
            (place, format!("`{key}` = {written}: {}", refusal.problem))
        } else {
            let path = self.paths(key).into_iter().next().unwrap_or_else(|| key.clone());
            let place = self.sources.place(&self.values.place_of(&path));
            let default = self.values.held.get(&path).map(|held| write::value_text(&held.value));
            let holds = default.map_or(String::new(), |default| format!(" (not written, {default} by default)"));
            (place, format!("`{key}`{holds}: {}", refusal.problem))
        };
        SceneErrors::new(vec![Problem { place, message, way_out: refusal.way_out.clone() }])
    }

    /// The scene as TOML with every default filled in; it reads back to an equal scene under the same file name.
    pub fn resolved_toml(&self) -> String {
        write::resolved(&self.scene.name, &KeyTable::new(&[self.scene.process.process()]), &self.values)
    }

    /// Paths among the values that `key` may mean, the likeliest first.
    fn paths(&self, key: &str) -> Vec<String> {
        let plain = key.replace('[', ".").replace([']', '`'], "").replace("..", ".");
        let Some(rest) = plain.strip_prefix("operation.") else { return vec![plain] };
        let (first, deeper) = rest.split_once('.').unwrap_or((rest, ""));
        let by_number = first.parse::<usize>().ok();
        let by_name = || self.scene.process.operation_names().iter().position(|name| *name == first);
        match by_number.or_else(by_name) {
            Some(index) => vec![join(&format!("operation.{index}"), deeper)],
            None => (0..self.values.count("operation")).map(|index| format!("operation.{index}.{rest}")).collect(),
        }
    }
}
