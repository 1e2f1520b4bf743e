//! Which process a scene is for, and which keys only one process knows.
//!
//! The tool chooses the process. Keys of another one are refused when they are written and left out of the resolved
//! scene when they are not: a key that does nothing would be read as one that does.

mod hobbing;
mod shaping;

use super::keys::{self, Section, join};
use super::model::Process;
use super::sources::At;
use super::tree::{Entry, Node, Value};
use super::values::Values;
use super::walk::Problems;
use std::path::Path;

/// What the reader of scenes must know of a process.
#[derive(Debug)]
pub struct SceneProcess {
    /// As the command line has it.
    pub name: &'static str,
    /// Variant of `[tool]` that chooses it.
    pub tool: &'static str,
    /// The tool in words, with its article.
    pub tool_words: &'static str,
    /// Keys without a default, in words.
    pub needed: &'static str,
    /// Linkage of operations that write none.
    pub default_linkage: &'static str,
    /// Sections (with all inside them) and keys that only this process reads, `[]` after the name of a list.
    pub own: &'static [&'static str],
    /// From checked values to the model; `None` where a value is missing.
    pub(super) build: fn(&Values, &Path) -> Option<Process>,
}

/// All processes that scenes can be written for; a new one adds its line here.
pub static PROCESSES: [&SceneProcess; 2] = [&shaping::SHAPING, &hobbing::HOBBING];

impl SceneProcess {
    /// The process of this name.
    pub fn named(name: &str) -> Option<&'static Self> {
        PROCESSES.into_iter().find(|process| process.name == name)
    }

    /// Header of the tool that chooses it.
    fn tool_header(&self) -> String {
        format!("[tool.{}]", self.tool)
    }

    /// The process that this tool is for.
    fn of_tool(tool: &str) -> Option<&'static Self> {
        PROCESSES.into_iter().find(|process| process.tool == tool)
    }

    /// The process of checked values.
    pub(super) fn of(values: &Values) -> Option<&'static Self> {
        values.variants.get("tool").and_then(|tool| Self::of_tool(tool))
    }

    /// Whether a section or key (`[]` after the name of a list) means something to this process.
    pub fn knows(&self, path: &str) -> bool {
        let inside = |own: &str| path.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        let others = PROCESSES.into_iter().filter(|process| process.name != self.name);
        self.own.iter().any(|own| inside(own)) || !others.flat_map(|process| process.own).any(|own| inside(own))
    }
}

/// Gives operations without a linkage the default one of the scene's tool, where that is not the table's own default.
pub(super) fn imply_linkages(root: &mut Node) {
    let tool =
        root.entry("tool").and_then(|tool| tool.node.entries().iter().find_map(|e| SceneProcess::of_tool(&e.name)));
    let Some(process) = tool else { return };
    if keys::section("operation[].linkage").is_some_and(|linkage| linkage.default() == Some(process.default_linkage)) {
        return;
    }
    let implied = |name: &str, entries: Vec<Entry>| Entry {
        name: name.to_owned(),
        name_at: At::Implied,
        node: Node { value: Value::Table(entries), at: At::Implied },
    };
    let Some(entries) = root.entries_mut() else { return };
    for operation in entries.iter_mut().filter(|entry| entry.name == "operation") {
        let Value::List(items) = &mut operation.node.value else { continue };
        for item in items {
            if item.entry("linkage").is_none()
                && let Some(keys) = item.entries_mut()
            {
                keys.push(implied("linkage", vec![implied(process.default_linkage, Vec::new())]));
            }
        }
    }
}

/// Reports written keys of other processes and drops what was filled in for them.
pub(super) fn keep_own(values: &mut Values, problems: &mut Problems<'_>) {
    let Some(process) = SceneProcess::of(values) else { return };
    let foreign = |path: &str| !process.knows(&general(path));
    let mut sections: Vec<&String> = values.sections.keys().filter(|path| foreign(path)).collect();
    // A foreign section is reported once, not with everything inside it.
    let all = sections.clone();
    sections.retain(|path| !all.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let keys = values.written.iter().filter(|path| foreign(path));
    let keys = keys.filter(|path| !sections.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let blamed: Vec<String> = sections.iter().copied().chain(keys).cloned().collect();
    for path in blamed {
        let owner = PROCESSES.into_iter().find(|other| other.knows(&general(&path)) && other.name != process.name);
        let owner = owner.unwrap_or(process);
        problems.add(
            &values.place_of(&path),
            format!(
                "`{}` belongs to {}; this scene is for {}",
                general(&path).replace("[]", ""),
                owner.name,
                process.name
            ),
            format!("remove it, or write {} instead of {}", owner.tool_header(), process.tool_header()),
        );
    }
    values.held.retain(|path, _| !foreign(path));
    values.variants.retain(|path, _| !foreign(path));
}

/// `operation.0.infeed` as the table of keys has it: `operation[].infeed`.
fn general(path: &str) -> String {
    let Some(rest) = path.strip_prefix("operation.") else { return path.to_owned() };
    match rest.split_once('.') {
        Some((_, deeper)) => join("operation[]", deeper),
        None => "operation[]".to_owned(),
    }
}

/// Sections of the table that mean something to a process.
pub(super) fn sections_of(process: &SceneProcess) -> impl Iterator<Item = &'static Section> {
    keys::sections().filter(move |section| process.knows(section.path))
}
