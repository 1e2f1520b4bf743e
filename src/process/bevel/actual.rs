//! Where the head really stands in the gear: the commanded axes with the errors of machine, clamping and head.
//!
//! In: an operation's settings and roll, or the program that is cut instead, and the machine's errors. Out: the pose of
//! the head in the gear's spindle at any cradle angle of any slot. What is commanded stays in tables, charts and
//! programs.
//!
//! Errors that depend on where the work spindle stands see it with its indexing from slot to slot; drives have settled
//! when a slot's roll begins.

use super::axis_program::BevelProgram;
use super::rolled_axes::rolled_axes;
use crate::machine::AxisMotion;
use crate::machine_errors::{
    ActualMotion, Course, MachineErrors, MachineMoment, ToolMounting, WorkMounting, noise_knots_s,
};
use gearcut_core::bevel::cradle::CradleSettings;
use gearcut_core::bevel::five_axis::{FiveAxisMachine, SixAxes};
use gearcut_core::frame::Rigid3;
use glam::{DMat3, DVec3};

/// Cells over a roll: it is a tenth of a turn.
const CELLS: usize = 512;
/// Place of the work spindle among the axes.
const WORK: usize = 3;

/// One slot's roll as the settings have it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CommandedRoll {
    /// Settings, errors of the settings themselves included.
    pub settings: CradleSettings,
    /// Cradle angle at which it begins, rad.
    pub from_rad: f64,
    /// Speed of the cradle with its sign, rad/s.
    pub rad_per_s: f64,
    /// How long it lasts, s.
    pub roll_s: f64,
    /// Time from one slot to the next, s.
    pub cycle_s: f64,
    /// Time from the beginning of the first operation to that of this one, s.
    pub start_s: f64,
    /// Speed of the head, turns/s.
    pub head_turns_per_s: f64,
}

/// Errors over the rolls of an operation.
#[derive(Debug, Clone)]
pub struct ActualRoll {
    machine: FiveAxisMachine,
    roll: CommandedRoll,
    program: Option<BevelProgram>,
    motion: Option<ActualMotion<5>>,
    mounting: WorkMounting,
    head: ToolMounting,
    /// Middle of the face along the gear's axis, mm.
    middle_z_mm: f64,
}

/// A slot at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotMoment {
    /// Number of the slot.
    pub slot: u32,
    /// Angle by which the work has been indexed to it, rad.
    pub indexed_rad: f64,
    /// Cradle angle, rad.
    pub cradle_rad: f64,
    /// Angle that the head has turned, rad.
    pub tool_rad: f64,
}

impl ActualRoll {
    /// Errors over an operation's rolls, by its settings or by a program, on a gear whose face has its middle at
    /// `middle_z_mm`.
    pub fn new(
        errors: &MachineErrors<5>,
        head: ToolMounting,
        machine: FiveAxisMachine,
        (roll, program): (CommandedRoll, Option<&BevelProgram>),
        middle_z_mm: f64,
    ) -> Self {
        // Blades are in the work a little before and after the roll.
        let beyond_s = 0.5 * roll.roll_s;
        let course = Course {
            from_s: -beyond_s,
            to_s: roll.roll_s + beyond_s,
            corners_s: Vec::new(),
            cells: CELLS,
            noise_knots_s: Some(noise_knots_s(roll.head_turns_per_s)),
        };
        let motion = ActualMotion::new(&errors.axes, &course, |time_s| {
            let axes = rolled_axes(machine, &roll.settings, roll.from_rad + time_s * roll.rad_per_s);
            axes.map(|series| AxisMotion::along(series, roll.rad_per_s))
        });
        Self { machine, roll, program: program.cloned(), motion, mounting: errors.mounting, head, middle_z_mm }
    }

    /// Pose of the head in the gear; `gear_from_work` is that of the work frame in the gear for slot 0, `index` turns
    /// the gear to a slot, `head_from_tool` turns the tool frame so that its x axis looks at the work.
    pub fn gear_from_head(&self, at: &SlotMoment, gear_from_work: &Rigid3, index: &Rigid3, head: &Rigid3) -> Rigid3 {
        let roll = &self.roll;
        let pose = match (&self.motion, &self.program) {
            (None, None) => roll.settings.work_from_tool(at.cradle_rad),
            (motion, program) => {
                let time_s = (at.cradle_rad - roll.from_rad) / roll.rad_per_s;
                let commanded = |time_s: f64| match program {
                    // The errors see the work where it has been indexed to, by the moment.
                    Some(program) => {
                        let mut axes = program.at(f64::from(at.slot) * roll.cycle_s + time_s);
                        axes[WORK] -= at.indexed_rad;
                        axes
                    }
                    None => {
                        let cradle_rad = roll.from_rad + time_s * roll.rad_per_s;
                        rolled_axes(self.machine, &roll.settings, cradle_rad).map(|axis| axis.value())
                    }
                };
                let moment = MachineMoment {
                    time_s,
                    since_start_s: roll.start_s + f64::from(at.slot) * roll.cycle_s + time_s,
                    at_rest_s: 0.0,
                    passage: 0,
                    indexed: [0.0, 0.0, 0.0, at.indexed_rad, 0.0],
                };
                let [x, y, z, work_rad, swing_rad] = match motion {
                    Some(motion) => {
                        let mut axes = motion.positions(&moment, commanded);
                        axes[WORK] -= at.indexed_rad;
                        axes
                    }
                    None => commanded(time_s),
                };
                self.machine.work_from_tool(&SixAxes {
                    slides_mm: DVec3::new(x, y, z),
                    work_rad,
                    swing_rad,
                    head_rad: at.cradle_rad,
                })
            }
        };
        let spindle = index.after(gear_from_work).after(&pose).after(head);
        let spindle = if self.head.is_none() { spindle } else { spindle.after(&self.head_wobble(at.tool_rad)) };
        if self.mounting.is_none() {
            return spindle;
        }
        self.mounting.gear_from_spindle(self.middle_z_mm).after(&spindle)
    }

    /// What the head's own axis does in the frame that does not turn with it.
    fn head_wobble(&self, tool_rad: f64) -> Rigid3 {
        let turned =
            |angle_rad: f64| Rigid3 { rotation: DMat3::from_rotation_z(angle_rad), translation_mm: DVec3::ZERO };
        turned(tool_rad).after(&self.head.spindle_from_tool()).after(&turned(-tool_rad))
    }
}
