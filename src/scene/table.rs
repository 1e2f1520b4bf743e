//! The one table of scene keys: the shared sections, those of every process, and the keys that these add.
//!
//! In: the processes. Out: [`KeyTable`], against which files are checked and from which schema, reference and template
//! are printed. The order is that of a scene file: by [`ORDER`], in it the shared sections first, then process by
//! process. The table of a single process has what its scenes may say, and so tells which keys are another's; shared
//! keys that have no sense in it are left out.

use super::keys::{self, Addition, Group, Key, KeySection, Role, join};
use super::process::SceneProcess;

/// Order of the outermost tables in a scene file; a process's own ones that are not listed stand at the end.
const ORDER: [&str; 13] = [
    "",
    "gear",
    "material",
    "tool",
    "machine",
    "mounting",
    "operation[]",
    "texture[]",
    "fields",
    "measure",
    "output",
    "report",
    "picture[]",
];

/// All sections that scenes of some processes may have.
#[derive(Debug, Clone)]
pub struct KeyTable {
    processes: Vec<&'static SceneProcess>,
    sections: Vec<TableSection>,
}

/// A section with all keys that are listed for it.
#[derive(Debug, Clone)]
pub struct TableSection {
    /// Path with `[]` after the name of a list: `operation[].infeed.plunge`; the whole file is the empty path.
    pub path: &'static str,
    /// How it stands in the file.
    pub role: Role,
    /// Its keys, in the order in which they are printed.
    pub keys: Vec<&'static Key>,
    /// Keys that exclude each other.
    pub groups: Vec<&'static Group>,
    /// What the section is about.
    pub teach: String,
}

impl KeyTable {
    /// The table of these processes; where a choice has different defaults, that of the first one is the table's.
    ///
    /// # Panics
    /// A process adds keys to a section that is in no list, or a key of another kind that the section has already.
    pub fn new(processes: &[&'static SceneProcess]) -> Self {
        let mut sections: Vec<TableSection> = keys::shared().map(TableSection::new).collect();
        for process in processes {
            for section in process.sections.iter().copied().flatten() {
                match sections.iter_mut().find(|known| known.path == section.path) {
                    Some(known) => known.tell_default(process, section),
                    None => sections.push(TableSection::new(section)),
                }
            }
        }
        for addition in processes.iter().flat_map(|process| process.added) {
            let section = sections.iter_mut().find(|section| section.path == addition.path);
            section.unwrap_or_else(|| panic!("keys are added to {}, which is no section", addition.path)).add(addition);
        }
        // What has no sense in any of them is not there.
        let senseless = |path: &str| {
            let in_one = |process: &&SceneProcess| process.senseless.iter().any(|senseless| senseless.holds(path));
            !processes.is_empty() && processes.iter().all(in_one)
        };
        sections.retain(|section| !senseless(section.path));
        for section in &mut sections {
            section.keys.retain(|key| !senseless(&join(section.path, key.name)));
        }
        sections.sort_by_key(|section| place(section.path));
        Self { processes: processes.to_vec(), sections }
    }

    /// The processes, in order.
    pub fn processes(&self) -> &[&'static SceneProcess] {
        &self.processes
    }

    /// The process of this name.
    pub fn process(&self, name: &str) -> Option<&'static SceneProcess> {
        self.processes.iter().copied().find(|process| process.name == name)
    }

    /// All sections in the order of a scene file; a section stands after the one that holds it.
    pub fn sections(&self) -> &[TableSection] {
        &self.sections
    }

    /// The section of this path, `[]` included.
    pub fn section(&self, path: &str) -> Option<&TableSection> {
        self.sections.iter().find(|section| section.path == path)
    }

    /// Sections directly inside `section`.
    pub fn children(&self, section: &TableSection) -> impl Iterator<Item = &TableSection> {
        let path = section.path;
        self.sections.iter().filter(move |child| !child.path.is_empty() && child.parent_path() == path)
    }

    /// All keys with their full paths, in file order.
    pub fn keys(&self) -> impl Iterator<Item = (String, &'static Key)> {
        self.sections.iter().flat_map(|section| section.keys.iter().map(|key| (join(section.path, key.name), *key)))
    }

    /// The key that messages call so: its path without the `[]` of lists.
    pub fn displayed(&self, path: &str) -> Option<&'static Key> {
        self.keys().find(|(full, _)| full.replace("[]", "") == path).map(|(_, key)| key)
    }

    /// The key that a setting of this path sets, the name of an operation left out: `operation.finish.offset_mm`.
    pub fn of_setting(&self, path: &str) -> Option<&'static Key> {
        let named = || {
            let (list, rest) = path.split_once('.')?;
            self.displayed(&format!("{list}.{}", rest.split_once('.')?.1))
        };
        self.displayed(path).or_else(named)
    }

    /// Whether there is a section or key of this path, `[]` after the name of a list.
    pub(super) fn knows(&self, path: &str) -> bool {
        let (holder, name) = path.rsplit_once('.').unwrap_or(("", path));
        self.section(path).is_some() || self.section(holder).is_some_and(|section| section.key(name).is_some())
    }
}

impl TableSection {
    fn new(section: &'static KeySection) -> Self {
        Self {
            path: section.path,
            role: section.role,
            keys: section.keys.iter().collect(),
            groups: section.groups.iter().collect(),
            teach: section.teach.to_owned(),
        }
    }

    /// Takes in that a further process lists the section.
    fn tell_default(&mut self, process: &SceneProcess, section: &KeySection) {
        if let Role::Choice { default: Some(default), .. } = section.role
            && self.default() != Some(default)
        {
            let told = self.teach.trim_end_matches('.');
            self.teach = format!("{told}; with {} the default is {default}.", process.tool_header());
        }
    }

    fn add(&mut self, addition: &'static Addition) {
        for key in addition.keys {
            match self.keys.iter_mut().find(|known| known.name == key.name) {
                // One addition of several processes.
                Some(known) if std::ptr::eq(*known, key) => {}
                Some(known) => {
                    assert!(key.widens(known), "the key {} of {} is listed twice", key.name, self.path);
                    *known = key;
                }
                None => self.keys.push(key),
            }
        }
        for group in addition.groups {
            if !self.groups.iter().any(|known| std::ptr::eq(*known, group)) {
                self.groups.push(group);
            }
        }
    }

    /// The key of this name.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().copied().find(|key| key.name == name)
    }

    /// Variant of a choice that holds when none is written.
    pub fn default(&self) -> Option<&'static str> {
        if let Role::Choice { default, .. } = self.role { default } else { None }
    }

    /// Last name of the path, without `[]`: `ellipse`, `operation`.
    pub fn name(&self) -> &'static str {
        self.path.rsplit('.').next().unwrap_or_default().trim_end_matches("[]")
    }

    /// Path of the section that holds this one.
    pub fn parent_path(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(parent, _)| parent)
    }

    /// The group of exclusive keys that `name` belongs to.
    pub fn group_of(&self, name: &str) -> Option<&'static Group> {
        self.groups.iter().copied().find(|group| group.names.contains(&name))
    }

    /// How the section's header is written: `[gear]`, `[[operation]]`, `[operation.linkage.shaping_normal]`.
    pub fn header(&self) -> String {
        let path = self.path.replace("[]", "");
        if matches!(self.role, Role::List { .. }) { format!("[[{path}]]") } else { format!("[{path}]") }
    }
}

/// Place of a section's outermost table in a file.
fn place(path: &str) -> usize {
    let outermost = path.split('.').next().unwrap_or_default();
    ORDER.iter().position(|known| *known == outermost).unwrap_or(ORDER.len())
}
