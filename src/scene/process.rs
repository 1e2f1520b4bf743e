//! Which process a scene is for, and which keys only one process knows.
//!
//! The tool chooses the process. Keys of another one are refused when they are written and left out of the resolved scene when they are not: a
//! key that does nothing would be read as one that does.

use super::keys::{self, Section, join};
use super::sources::At;
use super::tree::{Entry, Node, Value};
use super::values::Values;
use super::walk::Problems;

/// A process that scenes can be written for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProcessName {
    /// Shaping with a pinion cutter.
    Shaping,
    /// Hobbing.
    Hobbing,
}

/// Sections (with all inside them) and keys that only one process knows, `[]` after the name of a list.
const OWN: &[(ProcessName, &[&str])] = &[
    (
        ProcessName::Shaping,
        &[
            "tool.shaper_cutter",
            "machine.double_strokes_per_minute",
            "machine.approach_mm",
            "machine.overrun_mm",
            "machine.back_off_mm",
            "machine.work_eccentricity_um",
            "machine.work_eccentricity_angle_deg",
            "machine.limits",
            "operation[].strokes_per_revolution",
            "operation[].circular_feed_mm_per_stroke",
            "operation[].stroke_spacing",
            "operation[].window_deg",
            "operation[].revolutions",
            "operation[].overlap_deg",
            "operation[].feed_during_stroke",
            "operation[].infeed",
            "operation[].linkage.shaping_traditional",
            "operation[].linkage.shaping_normal",
        ],
    ),
    (
        ProcessName::Hobbing,
        &[
            "tool.hob",
            "machine.hobbing_limits",
            "operation[].hob_speed_per_minute",
            "operation[].axial_feed_mm_per_revolution",
            "operation[].feed_direction",
            "operation[].approach",
            "operation[].radial_feed_mm_per_revolution",
            "operation[].approach_mm",
            "operation[].overrun_mm",
            "operation[].head_angle_deg",
            "operation[].shift_start_mm",
            "operation[].ridge_tolerance_um",
            "operation[].linkage.hobbing",
            "operation[].linkage.hobbing_diagonal",
        ],
    ),
];

impl ProcessName {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::Shaping, Self::Hobbing];

    /// As the command line has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Shaping => "shaping",
            Self::Hobbing => "hobbing",
        }
    }

    /// Header of the tool that chooses it.
    fn tool_header(self) -> &'static str {
        match self {
            Self::Shaping => "[tool.shaper_cutter]",
            Self::Hobbing => "[tool.hob]",
        }
    }

    /// Linkage of operations that write none.
    pub(super) fn default_linkage(self) -> &'static str {
        match self {
            Self::Shaping => "shaping_normal",
            Self::Hobbing => "hobbing",
        }
    }

    /// The process that this tool is for.
    fn of_tool(tool: &str) -> Option<Self> {
        match tool {
            "shaper_cutter" => Some(Self::Shaping),
            "hob" => Some(Self::Hobbing),
            _ => None,
        }
    }

    /// The process of checked values.
    pub(super) fn of(values: &Values) -> Option<Self> {
        values.variants.get("tool").and_then(|tool| Self::of_tool(tool))
    }

    /// Whether a section or key (`[]` after the name of a list) means something to this process.
    pub fn knows(self, path: &str) -> bool {
        let inside = |own: &str| path.strip_prefix(own).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        OWN.iter().all(|(process, paths)| *process == self || !paths.iter().any(|own| inside(own)))
    }
}

/// Gives operations without a linkage the default one of the scene's tool, where that is not the table's own default.
pub(super) fn imply_linkages(root: &mut Node) {
    let tool =
        root.entry("tool").and_then(|tool| tool.node.entries().iter().find_map(|e| ProcessName::of_tool(&e.name)));
    let Some(process) = tool.filter(|process| *process != ProcessName::Shaping) else { return };
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
                keys.push(implied("linkage", vec![implied(process.default_linkage(), Vec::new())]));
            }
        }
    }
}

/// Reports written keys of other processes and drops what was filled in for them.
pub(super) fn keep_own(values: &mut Values, problems: &mut Problems<'_>) {
    let Some(process) = ProcessName::of(values) else { return };
    let foreign = |path: &str| !process.knows(&general(path));
    let mut sections: Vec<&String> = values.sections.keys().filter(|path| foreign(path)).collect();
    // A foreign section is reported once, not with everything inside it.
    let all = sections.clone();
    sections.retain(|path| !all.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let keys = values.written.iter().filter(|path| foreign(path));
    let keys = keys.filter(|path| !sections.iter().any(|outer| path.starts_with(&format!("{outer}."))));
    let blamed: Vec<String> = sections.iter().copied().chain(keys).cloned().collect();
    for path in blamed {
        let owner = ProcessName::ALL.into_iter().find(|other| other.knows(&general(&path)) && *other != process);
        let owner = owner.unwrap_or(process);
        problems.add(
            &values.place_of(&path),
            format!(
                "`{}` belongs to {}; this scene is for {}",
                general(&path).replace("[]", ""),
                owner.name(),
                process.name()
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
pub(super) fn sections_of(process: ProcessName) -> impl Iterator<Item = &'static Section> {
    keys::sections().filter(move |section| process.knows(section.path))
}
