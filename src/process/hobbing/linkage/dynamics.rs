//! A hobbing machine's six axes over time: hob, work, tangential (X), radial (Y with the infeed), slide, shift.
//!
//! In: a linkage and the axis limits. Out: the linkage as a [`Motion`] in time. Within a stretch of constant feeds the
//! rates repeat with every cycle along the pitch curve, so one cycle of each stretch shows all of it. Rates jump
//! between stretches; the infinite acceleration there is left to the control.

use super::{HobbingAxes, HobbingLinkage};
use crate::machine::{Axis, AxisKind, AxisMotion, Limits, Motion, MotionPiece};
use crate::math::Jet;
use crate::process::hobbing::scene::model::HobbingAxisLimits;

/// Stretches with the same feeds are searched once; so many different ones are looked at.
const MOST_STRETCHES: usize = 64;

/// The axes.
pub const AXES: [Axis; 6] = [
    Axis::new("hob spindle", "hob", 'B', AxisKind::Rotary),
    Axis::new("work spindle", "work", 'C', AxisKind::Rotary),
    Axis::new("X tangential", "x", 'X', AxisKind::Linear).called("tangential axis"),
    Axis::new("Y radial", "y", 'Y', AxisKind::Linear).called("radial axis"),
    Axis::new("Z slide", "slide", 'Z', AxisKind::Linear).called("slide").at_constant_feed(),
    Axis::new("shift", "shift", 'W', AxisKind::Linear).at_constant_feed(),
];

/// A scene's limits in the order of [`AXES`].
pub fn limits(of: &HobbingAxisLimits) -> [Limits; 6] {
    std::array::from_fn(|axis| Limits { speed: of.speeds[axis], acceleration: of.accelerations[axis] })
}

/// Axes in the order of [`AXES`].
pub fn in_order<const N: usize>(axes: &HobbingAxes<N>) -> [Jet<N>; 6] {
    [axes.hob_rad, axes.work_rad, axes.x_mm, axes.y_mm + axes.radial_mm, axes.slide_mm, axes.shift_mm]
}

/// All axes where their series are known.
pub fn motion(axes: &HobbingAxes<3>) -> [AxisMotion; 6] {
    in_order(axes).map(|series| AxisMotion::along(series, 1.0))
}

/// Over time, s.
impl Motion<6> for HobbingLinkage {
    const AXES: &'static [Axis; 6] = &AXES;

    fn at(&self, time_s: f64) -> [AxisMotion; 6] {
        motion(&self.axes(time_s))
    }

    fn pieces(&self) -> Vec<MotionPiece> {
        let cells = self.curve().samples_per_turn().clamp(256, 2048);
        let stretches = self.corners_s();
        let stretches = stretches.windows(2).take(MOST_STRETCHES);
        let cycle = |from: f64, to: f64| to.min(from + 1.1 * self.cycle_s()) * (1.0 - 1e-12);
        stretches.map(|s| MotionPiece { from: s[0], to: cycle(s[0], s[1]), cells }).collect()
    }
}
