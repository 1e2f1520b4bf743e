//! Problems as they are collected, and what the checks between keys add to them.

use super::errors::{MOST_PROBLEMS, Problem};
use super::sources::{At, Sources};
use super::values::{Values, View};

/// Collects problems.
pub(super) struct Problems<'a> {
    pub sources: &'a Sources,
    pub list: Vec<Problem>,
}

impl Problems<'_> {
    /// Whether no more problems are taken.
    pub fn full(&self) -> bool {
        self.list.len() >= MOST_PROBLEMS
    }

    /// Adds a problem.
    pub fn add(&mut self, at: &At, message: String, way_out: String) {
        if !self.full() {
            self.list.push(Problem { place: self.sources.place(at), message, way_out });
        }
    }
}

/// Checked values, some of which may be missing because they were wrong, and the contradictions between them.
///
/// A check asks only when all its values are there, so one wrong key never gives two problems.
pub(crate) struct Found<'a, 'b, 'c> {
    pub values: &'a Values,
    pub(super) problems: &'b mut Problems<'c>,
}

impl<'a> Found<'a, '_, '_> {
    /// The values under `path`.
    pub fn view<'p>(&self, path: &'p str) -> View<'p>
    where
        'a: 'p,
    {
        self.values.view(path)
    }

    /// Blames `path` when `wrong`.
    pub fn blame(&mut self, wrong: bool, path: &str, message: impl FnOnce() -> String, way_out: &str) {
        if wrong {
            self.problems.add(&self.values.place_of(path), message(), way_out.to_owned());
        }
    }
}
