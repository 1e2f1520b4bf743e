//! Axis peaks and relief of one operation in `results.json`.

use serde::{Deserialize, Serialize};

use crate::output::quantity::Quantity;

/// Largest speeds and accelerations of an operation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxesResults {
    /// Speed of the work spindle.
    pub work_speed: AxisPeak,
    /// Acceleration of the work spindle.
    pub work_acceleration: AxisPeak,
    /// Speed of the cutter spindle.
    pub cutter_speed: AxisPeak,
    /// Acceleration of the cutter spindle.
    pub cutter_acceleration: AxisPeak,
    /// Speed of the centre distance.
    pub center_distance_speed: AxisPeak,
    /// Acceleration of the centre distance.
    pub center_distance_acceleration: AxisPeak,
}

/// One peak against its limit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct AxisPeak {
    /// Largest magnitude.
    pub peak: Quantity,
    /// Work angle psi_c at which it is reached.
    pub work_angle: Quantity,
    /// What the machine allows; undefined when the scene gives no limit.
    pub limit: Quantity,
    /// 1 - peak / limit: negative when the limit is exceeded.
    pub margin: Quantity,
}

/// What the back-off along the line of centres leaves between cutter and flank on the return stroke.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ReliefResults {
    /// Smallest clearance as a share of a circular gear's, d sin(alpha); not positive: the return stroke rubs.
    pub smallest_ratio: Quantity,
    /// The same clearance for the scene's back-off.
    pub smallest_clearance: Quantity,
    /// Flank on which it is smallest, `left` or `right`.
    pub flank: Quantity,
    /// Polar angle of the pitch point at that moment.
    pub polar_angle: Quantity,
    /// Largest angle between the line of centres and the normal through the instantaneous centre.
    pub largest_beta: Quantity,
}
