//! What the reader must know of a process, and what a scene holds of it.
//!
//! The folders of the processes fill [`SceneProcess`] and implement [`ProcessPart`]. The reader asks through them and
//! knows no process by name.
//!
//! Road not taken: an enum of all processes. Every new one would have to be written into it and into each `match` over
//! it.

use super::error_sources::ErrorSource;
use super::keys::{Addition, KeySection};
use super::problems::Found;
use super::values::Values;
use crate::machine::AxisKind;
use crate::machine_errors::{AxisErrors, ErrorLayer};
use std::any::Any;
use std::fmt::Debug;
use std::ops::Deref;
use std::path::Path;

/// What scenes of a process may say, and what becomes of it.
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
    /// Its scenes in `scenes/`, as lines of the table in the reference.
    pub scenes: &'static str,
    /// Lists of its own sections. One that several processes list must be the same in all but the default of a choice.
    pub sections: &'static [&'static [KeySection]],
    /// Its keys in shared sections.
    pub added: &'static [&'static Addition],
    /// Operations of a scene that lists none, in order; at least one.
    pub operations: &'static [StandardOperation],
    /// Its keys that count per turn of the work: a mate with twice the teeth gets twice as many.
    pub per_revolution: &'static [&'static str],
    /// Its keys that belong to one gear and do not pass to its mate: windows.
    pub of_one_gear: &'static [&'static str],
    /// Shared sections that hold only where they are written: no default stands in for them.
    pub on_demand: &'static [&'static str],
    /// What else a draft makes wrong, as the end of a sentence on it.
    pub draft: &'static str,
    /// Whether its tool comes into a ring: `gear.kind = "internal"`.
    pub cuts_rings: bool,
    /// Keys and sections that have no sense here, and why: those of others that readers may well look for, and shared
    /// ones, which its scenes then do not have.
    pub senseless: &'static [Senseless],
    /// Axes with sections of errors, by the last names of those sections.
    pub axes: &'static [(&'static str, AxisKind)],
    /// Its other errors: of tool, guide, clamping.
    pub errors: &'static [&'static [ErrorSource]],
    /// Puts in defaults that follow from other keys.
    pub(crate) derive: fn(&mut Values),
    /// Holds its values against each other.
    pub(crate) check: fn(&mut Found<'_, '_, '_>),
    /// From checked values to the model; the path is the folder of the files that they name. `None` where a value is
    /// missing.
    pub(crate) build: fn(&Values, &Path) -> Option<ScenePart>,
}

/// An operation that stands in for those that a scene does not list. What else holds of it, the process derives.
#[derive(Debug)]
pub struct StandardOperation {
    /// Its name.
    pub name: &'static str,
    /// Keys that the template switches on in it, with values for the template's gear.
    pub template: &'static [(&'static str, &'static str)],
}

/// A single cut to depth, where a process asks for nothing before it.
pub const FINISH_ALONE: &[StandardOperation] = &[StandardOperation { name: "finish", template: &[] }];

/// A key or section that has no sense in a process.
#[derive(Debug)]
pub struct Senseless {
    /// Its path, `[]` after the name of a list.
    pub path: &'static str,
    /// Why: what this process does, as the rest of a sentence.
    pub why: &'static str,
    /// What to do instead.
    pub instead: &'static str,
}

impl Senseless {
    /// Whether a path, `[]` after the name of a list, is this key or section, or inside of it.
    pub(super) fn holds(&self, path: &str) -> bool {
        path.strip_prefix(self.path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
    }
}

impl SceneProcess {
    /// Header of the tool that chooses it: `[tool.hob]`.
    pub fn tool_header(&self) -> String {
        format!("[tool.{}]", self.tool)
    }
}

/// What a scene holds of its process alone: tool, machine, operations.
pub trait ProcessPart: Copied + Any + Debug + Send + Sync {
    /// The process.
    fn process(&self) -> &'static SceneProcess;

    /// Names of the operations in order; at least one.
    fn operation_names(&self) -> Vec<&str>;

    /// Layers of errors that the scene has, in the order of [`ErrorLayer::ALL`].
    fn error_layers(&self) -> Vec<ErrorLayer>;

    /// Switches all layers of errors off but these.
    fn keep_layers(&mut self, kept: &[ErrorLayer]);

    /// What is wrong with each axis of the machine, in the order of [`SceneProcess::axes`].
    fn axis_errors_mut(&mut self) -> &mut [AxisErrors];

    /// Distances of rays that only this process has: path of the key, distance and the largest one allowed, mm.
    fn ray_spacings(&self) -> Vec<(&'static str, [f64; 2])> {
        Vec::new()
    }

    /// Key by which the tool cuts teeth that are no involutes, if it does.
    fn other_teeth_key(&self) -> Option<&'static str> {
        None
    }

    /// Files that are read when the scene is made ready: what they hold belongs to the scene.
    fn files_read(&self) -> Vec<&Path> {
        Vec::new()
    }
}

/// Such a part whose type only its process knows.
#[derive(Debug)]
pub struct ScenePart(Box<dyn ProcessPart>);

impl ScenePart {
    /// Of the process whose type it is.
    pub fn new(part: impl ProcessPart) -> Self {
        Self(Box::new(part))
    }

    /// Key by which the tool cuts teeth that are no involutes, if it does.
    pub fn other_teeth_key(&self) -> Option<&'static str> {
        self.0.other_teeth_key()
    }

    /// The part, if it is of this type.
    pub fn get<T: ProcessPart>(&self) -> Option<&T> {
        let part: &dyn Any = self.0.as_ref();
        part.downcast_ref()
    }

    /// Switches all layers of errors off but these.
    pub fn keep_layers(&mut self, kept: &[ErrorLayer]) {
        self.0.keep_layers(kept);
    }

    /// What is wrong with each axis of the machine.
    pub fn axis_errors_mut(&mut self) -> &mut [AxisErrors] {
        self.0.axis_errors_mut()
    }

    /// The part if it is of this type, to try other values.
    pub fn get_mut<T: ProcessPart>(&mut self) -> Option<&mut T> {
        let part: &mut dyn Any = self.0.as_mut();
        part.downcast_mut()
    }
}

impl Deref for ScenePart {
    type Target = dyn ProcessPart;

    fn deref(&self) -> &Self::Target {
        self.0.as_ref()
    }
}

impl Clone for ScenePart {
    fn clone(&self) -> Self {
        self.0.copied()
    }
}

impl PartialEq for ScenePart {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(other)
    }
}

/// Copying and comparing of parts whose type is not known; every part has it by itself.
pub trait Copied {
    /// A copy.
    fn copied(&self) -> ScenePart;

    /// Whether `other` is of the same type and equal.
    fn equals(&self, other: &ScenePart) -> bool;
}

impl<T: ProcessPart + Clone + PartialEq> Copied for T {
    fn copied(&self) -> ScenePart {
        ScenePart::new(self.clone())
    }

    fn equals(&self, other: &ScenePart) -> bool {
        other.get() == Some(self)
    }
}
