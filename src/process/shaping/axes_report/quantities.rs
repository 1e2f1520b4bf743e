//! Axis peaks and relief as findings.

use super::{OperationAxes, in_order};
use crate::findings::{Place, Quantity, Section};
use crate::process::shaping::linkage::relief::ReliefFlank;
use crate::units::UM_PER_MM;

/// Key, title and unit of each peak, what it is a peak of, and the key of its limit, in the peaks' order.
const PEAKS: [[&str; 5]; 6] = [
    ["work_speed", "Work spindle, speed", "deg/s", "speed of the work spindle", "work_speed_deg_per_s"],
    [
        "work_acceleration",
        "Work spindle, acceleration",
        "deg/s^2",
        "acceleration of the work spindle",
        "work_acceleration_deg_per_s2",
    ],
    ["cutter_speed", "Cutter spindle, speed", "deg/s", "speed of the cutter spindle", "cutter_speed_deg_per_s"],
    [
        "cutter_acceleration",
        "Cutter spindle, acceleration",
        "deg/s^2",
        "acceleration of the cutter spindle",
        "cutter_acceleration_deg_per_s2",
    ],
    [
        "center_distance_speed",
        "Centre distance, speed",
        "mm/s",
        "speed of the centre distance",
        "center_distance_speed_mm_per_s",
    ],
    [
        "center_distance_acceleration",
        "Centre distance, acceleration",
        "mm/s^2",
        "acceleration of the centre distance",
        "center_distance_acceleration_mm_per_s2",
    ],
];

impl OperationAxes {
    /// Peaks against limits.
    pub fn axes_findings(&self) -> Section {
        let peaks = in_order(&self.peaks).into_iter().zip(self.peaks_at_rad).zip(PEAKS);
        Section::new("axes", "Peaks of the axes").parts(peaks.map(
            |((peak, at_rad), [key, title, unit, what, limit])| {
                let shown = |value: f64| if unit.starts_with("deg") { value.to_degrees() } else { value };
                let unlimited = format!("machine.limits.{limit} is not given");
                let at = Place::default().and("work_angle_deg", at_rad.to_degrees());
                Section::new(key, title)
                    .with(
                        "peak",
                        Quantity::number(shown(peak.value), unit, format!("largest {what} during the operation"))
                            .at(at),
                    )
                    .with(
                        "limit",
                        Quantity::number_or(
                            peak.limit.map(shown),
                            unit,
                            format!("largest {what} that the machine allows"),
                            unlimited.clone(),
                        ),
                    )
                    .with("margin", Quantity::number_or(peak.margin(), "1", "1 - peak / limit", unlimited))
            },
        ))
    }

    /// Clearance on the return stroke.
    pub fn relief_findings(&self) -> Section {
        let flank = match self.relief.flank {
            ReliefFlank::Left => "left",
            ReliefFlank::Right => "right",
        };
        let at = Place::default().and("flank", flank).and("polar_angle_deg", self.relief.phi_rad.to_degrees());
        let ratio =
            "smallest relief clearance of a flank divided by that of a circular gear, back-off times sin(alpha)";
        let clearance_um = UM_PER_MM * self.relief.clearance_mm(self.back_off_mm);
        let clearance = "smallest clearance of a flank on the return stroke, along its normal";
        let beta = "largest angle between the line of centres and the normal of the pitch curve";
        let beta_at = Place::default().and("polar_angle_deg", self.largest_beta_phi_rad.to_degrees());
        Section::new("relief", "Clearance on the return stroke")
            .with("smallest_ratio", Quantity::number(self.relief.ratio, "1", ratio).at(at.clone()))
            .with("smallest_clearance", Quantity::number(clearance_um, "um", clearance).at(at))
            .with("largest_beta", Quantity::number(self.largest_beta_rad.to_degrees(), "deg", beta).at(beta_at))
    }
}
