//! One run of the head over all slots: settings, the motion through a slot, times.

use super::axis_program::BevelProgram;
use super::course::SlotCourse;
use super::scene::model::BevelOperation;
use gearcut_core::bevel::cradle::CradleSettings;

/// One operation with its motion.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedBevel {
    /// What the scene says.
    pub spec: BevelOperation,
    /// Settings, the head held back by the offset.
    pub settings: CradleSettings,
    /// The same as the machine is: with its errors.
    pub as_set: CradleSettings,
    /// A slot's motion.
    pub course: SlotCourse,
    /// Time from the beginning of the first operation to that of this one, s.
    pub start_s: f64,
    /// The program that is cut in place of the settings, if the scene names one.
    pub program: Option<BevelProgram>,
}

impl PreparedBevel {
    /// Time from one slot to the next, s.
    pub fn cycle_s(&self) -> f64 {
        self.course.slot_s() + self.spec.idle_s
    }
}
