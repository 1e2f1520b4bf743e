//! Chips and cutting forces of one operation in `results.json`.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// The stroke at which something is largest.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChipPeak {
    /// How large.
    pub value: Quantity,
    /// Stroke of the operation, from 0.
    pub stroke: Quantity,
    /// Time from the operation's first stroke.
    pub time: Quantity,
    /// Work angle psi_c.
    pub work_angle: Quantity,
    /// Tooth space of the stroke's largest chip; space j lies after tooth j.
    pub space: Quantity,
    /// Cutter tooth of that chip, from 0.
    pub cutter_tooth: Quantity,
}

/// What an operation takes away, and with what forces.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChipResults {
    /// Largest section of all chips of a stroke.
    pub largest_section: ChipPeak,
    /// Largest uncut chip thickness.
    pub largest_thickness: ChipPeak,
    /// Largest cutting force along the stroke.
    pub largest_force: ChipPeak,
    /// Section of a first stroke at full depth, which the largest values leave out.
    pub entry_section: Quantity,
    /// Its cutting force.
    pub entry_force: Quantity,
    /// Largest torque on the work spindle.
    pub largest_work_torque: ChipPeak,
    /// Largest torque on the cutter spindle.
    pub largest_cutter_torque: ChipPeak,
    /// Section of the middle stroke in order of size, idle ones left out.
    pub median_section: Quantity,
    /// Cutting force of the middle stroke.
    pub median_force: Quantity,
    /// Power of the largest cutting force at the fastest place of the ram.
    pub largest_power: Quantity,
    /// Volume taken away.
    pub removed_volume: Quantity,
    /// That volume over the operation's time.
    pub removal_rate: Quantity,
    /// Strokes that cut nothing.
    pub idle_strokes: Quantity,
    /// Chips that form on two sides of the edge at once.
    pub two_flank_chips: Quantity,
    /// Chips that form on tip and both flanks at once.
    pub three_flank_chips: Quantity,
}
