//! One run of the head over all slots: settings, roll, times.

use super::actual::CommandedRoll;
use super::axis_program::BevelProgram;
use super::scene::model::BevelOperation;
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::units::TURN_RAD;

/// One operation with its roll.
#[derive(Debug, Clone, PartialEq)]
pub struct PreparedBevel {
    /// What the scene says.
    pub spec: BevelOperation,
    /// Settings, the head held back by the offset.
    pub settings: CradleSettings,
    /// The same as the machine is: with its errors.
    pub as_set: CradleSettings,
    /// Cradle angles at which a slot's roll begins and ends, rad.
    pub roll_rad: [f64; 2],
    /// Time from the beginning of the first operation to that of this one, s.
    pub start_s: f64,
    /// The program that is cut in place of the settings, if the scene names one.
    pub program: Option<BevelProgram>,
}

impl PreparedBevel {
    /// Time of a slot's roll, s.
    pub fn roll_s(&self) -> f64 {
        (self.roll_rad[1] - self.roll_rad[0]).abs() / self.spec.roll_speed_rad_per_s
    }

    /// Speed of the cradle with its sign, rad/s.
    pub fn cradle_rad_per_s(&self) -> f64 {
        self.spec.roll_speed_rad_per_s * (self.roll_rad[1] - self.roll_rad[0]).signum()
    }

    /// A slot's roll as the machine is set.
    pub fn commanded(&self) -> CommandedRoll {
        CommandedRoll {
            settings: self.as_set,
            from_rad: self.roll_rad[0],
            rad_per_s: self.cradle_rad_per_s(),
            roll_s: self.roll_s(),
            cycle_s: self.cycle_s(),
            start_s: self.start_s,
            head_turns_per_s: self.spec.head_speed_rad_per_s / TURN_RAD,
        }
    }

    /// Time from one slot to the next, s.
    pub fn cycle_s(&self) -> f64 {
        self.roll_s() + self.spec.idle_s
    }
}
