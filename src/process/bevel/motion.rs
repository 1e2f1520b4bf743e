//! The six-axis machine over time: X, Y, Z, A and B while a slot is rolled.
//!
//! In: an operation and the machine. Out: the five linked axes as a [`Motion`] in time from the beginning of the roll.
//! They follow from the cradle's settings in closed form (Chen, Yan, Ming and Xie 2008, Eqs. 9 to 14), so that speeds
//! and accelerations are those of a circle and of the roll's polynomial. The way back and the indexing between slots
//! are left to the control.

use super::job::BevelJob;
use super::operation::PreparedBevel;
pub use super::rolled_axes::AXES;
use super::rolled_axes::rolled_axes;
use crate::machine::{Axis, AxisMotion, Limits, Motion, MotionPiece};

/// Cells of the search for peaks: the roll is a tenth of a turn.
const CELLS: usize = 256;

/// One slot's roll.
#[derive(Debug, Clone, Copy)]
pub struct RollMotion<'a> {
    /// The job.
    pub job: &'a BevelJob,
    /// The operation.
    pub operation: &'a PreparedBevel,
}

impl RollMotion<'_> {
    /// Cradle angle at a time from the beginning of the roll, rad.
    pub fn cradle_rad(&self, time_s: f64) -> f64 {
        self.operation.roll_rad[0] + self.operation.cradle_rad_per_s() * time_s
    }

    /// Positions of the axes for slot 0, mm and rad.
    pub fn positions(&self, time_s: f64) -> [f64; 5] {
        let axes = self.job.machine.axes_of_cradle(&self.operation.settings, self.cradle_rad(time_s));
        let [x, y, z] = axes.slides_mm.to_array();
        [x, y, z, axes.work_rad, axes.swing_rad]
    }
}

impl Motion<5> for RollMotion<'_> {
    const AXES: &'static [Axis; 5] = &AXES;

    fn at(&self, time_s: f64) -> [AxisMotion; 5] {
        let series = rolled_axes(self.job.machine, &self.operation.settings, self.cradle_rad(time_s));
        series.map(|series| AxisMotion::along(series, self.operation.cradle_rad_per_s()))
    }

    fn pieces(&self) -> Vec<MotionPiece> {
        vec![MotionPiece { from: 0.0, to: self.operation.roll_s(), cells: CELLS }]
    }
}

/// The scene's limits of the linked axes.
pub fn limits(job: &BevelJob) -> [Limits; 5] {
    std::array::from_fn(|axis| Limits {
        speed: job.spec.speed_limits[axis],
        acceleration: job.spec.acceleration_limits[axis],
    })
}
