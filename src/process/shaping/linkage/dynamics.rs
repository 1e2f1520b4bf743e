//! A gear shaper's axes over the strokes of an operation: work spindle, cutter spindle, centre distance.
//!
//! In: a stroke schedule and the axis limits. Out: the schedule as a [`Motion`] of three axes along the stroke
//! coordinate. Law: the axes are series in that coordinate (chain rule, no differences), and d lambda/dt = double
//! strokes per minute / 60. The rotary feed is taken as continuous; a machine that stands still while the cutter is in
//! the work has to make the same travel in the return stroke alone.
//!
//! Speeds jump where an infeed begins or ends. The infinite acceleration there is left out, because every control
//! rounds such a corner; both sides of it are counted in the peaks.

use super::axes::Axes;
use super::schedule::StrokeSchedule;
use crate::machine::{Axis, AxisKind, AxisMotion, Limits, Motion, MotionPiece};
use crate::process::shaping::scene::model::AxisLimits;

/// The axes: work angle psi_c, cutter angle psi_b, centre distance l.
pub const AXES: [Axis; 3] = [WORK, CUTTER, CENTER_DISTANCE];
/// Work angle psi_c.
pub const WORK: Axis = Axis::new("work spindle", "work", 'C', AxisKind::Rotary).at("psi_c");
/// Cutter angle psi_b.
pub const CUTTER: Axis = Axis::new("cutter spindle", "cutter", 'B', AxisKind::Rotary).at("psi_b");
/// Centre distance l.
pub const CENTER_DISTANCE: Axis = Axis::new("centre distance", "center_distance", 'X', AxisKind::Linear);

/// A scene's limits in the order of [`AXES`].
pub fn limits(of: &AxisLimits) -> [Limits; 3] {
    [
        Limits { speed: of.work_speed_rad_per_s, acceleration: of.work_acceleration_rad_per_s2 },
        Limits { speed: of.cutter_speed_rad_per_s, acceleration: of.cutter_acceleration_rad_per_s2 },
        Limits { speed: of.center_distance_speed_mm_per_s, acceleration: of.center_distance_acceleration_mm_per_s2 },
    ]
}

/// Over the stroke coordinate, any real; the pieces reach from the first to the last stroke.
impl Motion<3> for StrokeSchedule {
    const AXES: &'static [Axis; 3] = &AXES;

    fn at(&self, stroke: f64) -> [AxisMotion; 3] {
        let strokes_per_s = 1.0 / self.seconds_per_stroke();
        let Axes { psi_c_rad, psi_b_rad, center_distance_mm } = self.axes_by_stroke(stroke);
        [psi_c_rad, psi_b_rad, center_distance_mm].map(|series| AxisMotion::along(series, strokes_per_s))
    }

    /// Between the corners of the infeed, in cells enough to see every lobe of the pitch curve.
    fn pieces(&self) -> Vec<MotionPiece> {
        let last = (self.count() - 1) as f64;
        let piece = |from: f64, to: f64| {
            let per_turn = self.linkage().curve().samples_per_turn() as f64;
            let turns = (to - from) / f64::from(self.strokes_per_revolution());
            MotionPiece { from, to, cells: (per_turn * turns).ceil().max(16.0) as usize }
        };
        let mut pieces = Vec::new();
        let mut from = 0.0;
        for corner in self.corners() {
            if corner > from && corner < last {
                pieces.push(piece(from, corner * (1.0 - 1e-12)));
                from = corner;
            }
        }
        pieces.push(piece(from, last));
        pieces
    }
}
