//! Load of the hob in `results.json`: the run writes it, a comparison reads it back.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// What the hob's teeth did over the whole process.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct HobLoadResults {
    /// What the load rests on.
    pub assumption: String,
    /// Length of all teeth of the gear.
    pub length_of_teeth: Quantity,
    /// Operations in order.
    pub operations: Vec<OperationLoadResults>,
}

/// Load of one operation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct OperationLoadResults {
    /// Name in the scene.
    pub name: String,
    /// Volume that all teeth take.
    pub volume: Quantity,
    /// Volume of the tooth that takes the most.
    pub largest_volume: Quantity,
    /// Its number.
    pub hardest_working_tooth: Quantity,
    /// Teeth that take part.
    pub teeth_in_use: Quantity,
    /// Largest volume over the mean of all teeth of the hob.
    pub peak_to_mean: Quantity,
    /// Largest uncut chip thickness.
    pub largest_thickness: Quantity,
    /// Tooth that takes it.
    pub thickest_chip_of_tooth: Quantity,
    /// The same for a round gear by Hoffmeister's formula.
    pub thickness_after_hoffmeister: Quantity,
    /// Way of all tips through the work.
    pub way_cut: Quantity,
    /// Every tooth in blade order; empty in files of older programs.
    #[serde(default)]
    pub teeth: Vec<ToothLoadResults>,
}

/// Load of one hob tooth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ToothLoadResults {
    /// Its number along the thread, such as `7` or `B7`.
    pub tooth: String,
    /// Volume it takes.
    pub volume: Quantity,
    /// Its largest uncut chip thickness.
    pub thickness: Quantity,
    /// Way of its tip through the work.
    pub way: Quantity,
}
