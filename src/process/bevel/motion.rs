//! The six-axis machine over time: X, Y, Z, A and B while a slot is cut.
//!
//! In: an operation and the machine. Out: the five linked axes as a [`Motion`] in time from the beginning of the slot.
//! They follow from the cradle's settings in closed form (Chen, Yan, Ming and Xie 2008, Eqs. 9 to 14), so that speeds
//! and accelerations are exact. The way back and the indexing between slots are left to the control.

pub use super::course::AXES;
use super::job::BevelJob;
use super::operation::PreparedBevel;
use crate::machine::{Axis, AxisMotion, Limits, Motion, MotionPiece};

/// Cells of the search for peaks: a roll is a tenth of a turn.
const CELLS: usize = 256;

/// One slot's motion.
#[derive(Debug, Clone, Copy)]
pub struct SlotMotion<'a> {
    /// The job.
    pub job: &'a BevelJob,
    /// The operation.
    pub operation: &'a PreparedBevel,
}

impl SlotMotion<'_> {
    /// Cradle angle at a time from the beginning of the slot, rad.
    pub fn cradle_rad(&self, time_s: f64) -> f64 {
        self.operation.settings.at(self.operation.course.at(time_s)[0]).cradle_rad
    }

    /// Positions of the axes for slot 0, mm and rad.
    pub fn positions(&self, time_s: f64) -> [f64; 5] {
        self.at(time_s).map(|axis| axis.position)
    }
}

impl Motion<5> for SlotMotion<'_> {
    const AXES: &'static [Axis; 5] = &AXES;

    fn at(&self, time_s: f64) -> [AxisMotion; 5] {
        self.operation.course.axes(self.job.machine, &self.operation.settings, time_s)
    }

    fn pieces(&self) -> Vec<MotionPiece> {
        let pieces = self.operation.course.pieces_s().into_iter();
        pieces.map(|[from, to]| MotionPiece { from, to, cells: CELLS }).collect()
    }
}

/// The scene's limits of the linked axes.
pub fn limits(job: &BevelJob) -> [Limits; 5] {
    std::array::from_fn(|axis| Limits {
        speed: job.spec.speed_limits[axis],
        acceleration: job.spec.acceleration_limits[axis],
    })
}
