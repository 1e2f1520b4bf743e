//! `results.json` of a hobbed gear as comparisons read it: headline and operations by key, the hob's load tooth by tooth.
//!
//! What is compared line by line stays a JSON value, so that every number that joins the file joins the comparison.

use serde::Deserialize;
use serde_json::Value;

use super::{HobLoadResults, TextureResults};

/// A hobbed gear's results.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HobbedResults {
    /// Whether all flanks were cut; false after Ctrl-C.
    pub complete: bool,
    /// What to look at first, quantities by key.
    pub headline: Value,
    /// What each operation did, in order.
    pub operations: Vec<HobbedOperationResults>,
    /// Errors of points on five curves.
    pub offset_curves: Value,
    /// Lattices of cutting marks, one for each flank with a texture window.
    pub marks: Vec<MarkResults>,
    /// Surface texture of windows, after every operation.
    pub texture: Vec<TextureResults>,
    /// The whole gear: volumes and damage; absent after Ctrl-C.
    #[serde(default)]
    pub blank: Value,
    /// Load of the hob; absent after Ctrl-C.
    pub hob_load: Option<HobLoadResults>,
}

/// One operation: its name, and quantities by key.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct HobbedOperationResults {
    /// Name in the scene.
    pub name: String,
    /// Everything else.
    #[serde(flatten)]
    pub rest: serde_json::Map<String, Value>,
}

/// Marks of one flank.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct MarkResults {
    /// Tooth, from 1.
    pub tooth: u32,
    /// Flank: `left` or `right`.
    pub flank: String,
    /// The shortest two steps from mark to mark.
    pub steps: Vec<Value>,
}
