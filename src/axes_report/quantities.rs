//! Axis peaks and relief as they stand in `results.json`.

use super::{OperationAxes, in_order};
use crate::linkage::relief::ReliefFlank;
use crate::output::quantity::Quantity;
use crate::output::results::{AxesResults, AxisPeak, ReliefResults};
use crate::units::UM_PER_MM;

impl OperationAxes {
    /// Peaks against limits.
    pub fn axes_results(&self) -> AxesResults {
        let peaks = in_order(&self.peaks);
        let one = |index: usize, unit: &'static str, what: &'static str, key: &str| {
            let shown = |value: f64| if unit.starts_with("deg") { value.to_degrees() } else { value };
            let (peak, unlimited) = (peaks[index], format!("machine.limits.{key} is not given"));
            AxisPeak {
                peak: Quantity::number(shown(peak.value), unit, format!("largest {what} during the operation")),
                work_angle: Quantity::number(
                    self.peaks_at_rad[index].to_degrees(),
                    "deg",
                    format!("work angle psi_c at the largest {what}"),
                ),
                limit: Quantity::number_or(
                    peak.limit.map(shown),
                    unit,
                    format!("largest {what} that the machine allows"),
                    unlimited.clone(),
                ),
                margin: Quantity::number_or(peak.margin(), "1", "1 - peak / limit", unlimited),
            }
        };

        AxesResults {
            work_speed: one(0, "deg/s", "speed of the work spindle", "work_speed_deg_per_s"),
            work_acceleration: one(1, "deg/s^2", "acceleration of the work spindle", "work_acceleration_deg_per_s2"),
            cutter_speed: one(2, "deg/s", "speed of the cutter spindle", "cutter_speed_deg_per_s"),
            cutter_acceleration: one(
                3,
                "deg/s^2",
                "acceleration of the cutter spindle",
                "cutter_acceleration_deg_per_s2",
            ),
            center_distance_speed: one(4, "mm/s", "speed of the centre distance", "center_distance_speed_mm_per_s"),
            center_distance_acceleration: one(
                5,
                "mm/s^2",
                "acceleration of the centre distance",
                "center_distance_acceleration_mm_per_s2",
            ),
        }
    }

    /// Clearance on the return stroke.
    pub fn relief_results(&self) -> ReliefResults {
        let flank = match self.relief.flank {
            ReliefFlank::Left => "left",
            ReliefFlank::Right => "right",
        };
        ReliefResults {
            smallest_ratio: Quantity::number(
                self.relief.ratio,
                "1",
                "smallest relief clearance of a flank divided by that of a circular gear, back-off times sin(alpha)",
            ),
            smallest_clearance: Quantity::number(
                UM_PER_MM * self.relief.clearance_mm(self.back_off_mm),
                "um",
                "smallest clearance of a flank on the return stroke, along its normal",
            ),
            flank: Quantity::text(flank, "flank with the smallest clearance"),
            polar_angle: Quantity::number(
                self.relief.phi_rad.to_degrees(),
                "deg",
                "polar angle of the pitch point at the smallest clearance",
            ),
            largest_beta: Quantity::number(
                self.largest_beta_rad.to_degrees(),
                "deg",
                "largest angle between the line of centres and the normal of the pitch curve",
            ),
        }
    }
}
