//! Checked values by path, written ones and defaults alike, still in the units of the file.
//!
//! The model is built from them, keys are located in them, and the resolved scene is written from them: that
//! the file's own numbers are kept makes the resolved scene read back to exactly the same model.

use std::collections::{BTreeMap, BTreeSet};

use super::keys::{self, join};
use super::sources::At;
use gearcut_core::terms::Hand;
use gearcut_core::units::UM_PER_MM;

/// A value that fits its key.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Checked {
    Number(f64),
    Whole(u32),
    Boolean(bool),
    Text(String),
    Numbers(Vec<f64>),
    Points(Vec<[f64; 2]>),
}

impl Checked {
    /// Whether a key with this default has the value without anybody writing it, whatever the other keys say.
    pub(super) fn holds_by_itself(&self, default: keys::Default) -> bool {
        match (default, self) {
            (keys::Default::Number(default), Self::Number(value)) => default == *value,
            (keys::Default::Whole(default), Self::Whole(value)) => default == *value,
            (keys::Default::Boolean(default), Self::Boolean(value)) => default == *value,
            (keys::Default::Word(default), Self::Text(value)) => default == value,
            (keys::Default::EmptyList, Self::Numbers(value)) => value.is_empty(),
            _ => false,
        }
    }
}

/// A value with its place.
#[derive(Debug, Clone)]
pub(super) struct Held {
    pub value: Checked,
    /// Where it was written; `None` for a default.
    pub at: Option<At>,
}

impl Held {
    /// Whether somebody wrote it, in the file or as `--set`.
    pub fn is_written(&self) -> bool {
        self.at.as_ref().is_some_and(|at| *at != At::Implied)
    }
}

/// All values of a scene.
#[derive(Debug, Clone, Default)]
pub(crate) struct Values {
    /// By path with the number of the operation: `operation.0.offset_mm`.
    pub(super) held: BTreeMap<String, Held>,
    /// Paths of all keys that were written, right or wrong.
    pub(super) written: BTreeSet<String>,
    /// Variant of each choice: `gear.pitch_curve` -> `ellipse`.
    pub(super) variants: BTreeMap<String, &'static str>,
    /// Where each section that was written begins.
    pub(super) sections: BTreeMap<String, At>,
    /// How many elements each list has: `operation` -> 2.
    pub(super) counts: BTreeMap<&'static str, usize>,
}

/// The values of one section.
#[derive(Clone, Copy)]
pub(crate) struct View<'a> {
    values: &'a Values,
    path: &'a str,
}

impl Values {
    /// The values under `path`.
    pub fn view<'a>(&'a self, path: &'a str) -> View<'a> {
        View { values: self, path }
    }

    /// How many elements a list has.
    pub fn count(&self, list: &str) -> usize {
        self.counts.get(list).copied().unwrap_or(0)
    }

    /// Puts in a default that follows from other keys, unless the key is written, right or wrong.
    pub fn put_default(&mut self, path: &str, name: &str, value: Checked) {
        let full = join(path, name);
        if !self.written.contains(&full) {
            self.held.insert(full, Held { value, at: None });
        }
    }

    /// Puts in a default unless another one holds already.
    pub fn put_if_missing(&mut self, path: &str, name: &str, value: Checked) {
        if !self.held.contains_key(&join(path, name)) {
            self.put_default(path, name, value);
        }
    }

    /// Takes another variant of a choice that nobody wrote.
    pub fn put_default_variant(&mut self, choice: &str, variant: &'static str) {
        if !self.has_section(choice) {
            self.variants.insert(choice.to_owned(), variant);
        }
    }

    /// Whether a section is written.
    pub fn has_section(&self, path: &str) -> bool {
        self.sections.contains_key(path)
    }

    /// Whether a value below a path is written.
    pub(super) fn is_any_set(&self, beginning: &str) -> bool {
        self.held.iter().any(|(path, held)| path.starts_with(beginning) && held.is_written())
    }

    /// Takes the defaults of a section away.
    pub(super) fn leave_out(&mut self, section: &str) {
        self.held.retain(|path, _| path.rsplit_once('.').is_none_or(|(holder, _)| holder != section));
    }

    /// Whether a key is written, right or wrong.
    pub fn is_written(&self, path: &str, name: &str) -> bool {
        self.written.contains(&join(path, name))
    }

    /// Place of a value or section, or of the nearest section around it that was written.
    pub(super) fn place_of(&self, path: &str) -> At {
        if let Some(at) = self.held.get(path).and_then(|held| held.at.clone()) {
            return at;
        }
        let mut around = Some(path);
        while let Some(path) = around {
            if let Some(at) = self.sections.get(path) {
                return at.clone();
            }
            around = path.rsplit_once('.').map(|(outer, _)| outer);
        }
        At::Implied
    }
}

impl<'a> View<'a> {
    fn get(self, name: &str) -> Option<&'a Checked> {
        self.values.held.get(&join(self.path, name)).map(|held| &held.value)
    }

    /// A number; `None` where the key has no value or a wrong one.
    pub fn number(self, name: &str) -> Option<f64> {
        if let Some(Checked::Number(number)) = self.get(name) { Some(*number) } else { None }
    }

    /// An angle in radians; the key's unit is degrees.
    pub fn rad(self, name: &str) -> Option<f64> {
        self.number(name).map(f64::to_radians)
    }

    /// A length in mm; the key's unit is um.
    pub fn mm_from_um(self, name: &str) -> Option<f64> {
        self.number(name).map(|um| um / UM_PER_MM)
    }

    /// A whole number.
    pub fn whole(self, name: &str) -> Option<u32> {
        if let Some(Checked::Whole(number)) = self.get(name) { Some(*number) } else { None }
    }

    /// A switch.
    pub fn boolean(self, name: &str) -> Option<bool> {
        if let Some(Checked::Boolean(on)) = self.get(name) { Some(*on) } else { None }
    }

    /// A word, name or path.
    pub fn text(self, name: &str) -> Option<&'a str> {
        if let Some(Checked::Text(text)) = self.get(name) { Some(text) } else { None }
    }

    /// A hand.
    pub fn hand(self, name: &str) -> Option<Hand> {
        match self.text(name)? {
            "right" => Some(Hand::Right),
            "left" => Some(Hand::Left),
            _ => None,
        }
    }

    /// A list of numbers.
    pub fn numbers(self, name: &str) -> Option<&'a [f64]> {
        if let Some(Checked::Numbers(numbers)) = self.get(name) { Some(numbers) } else { None }
    }

    /// A list of points.
    pub fn points(self, name: &str) -> Option<&'a [[f64; 2]]> {
        if let Some(Checked::Points(points)) = self.get(name) { Some(points) } else { None }
    }

    /// The variant of the choice `name`.
    pub fn variant(self, name: &str) -> Option<&'static str> {
        self.values.variants.get(&join(self.path, name)).copied()
    }
}
