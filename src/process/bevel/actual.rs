//! Where the head really stands in the gear: the commanded axes with the errors of machine, clamping and head.
//!
//! In: an operation's settings and motion, or the program that is cut instead, and the machine's errors. Out: the pose
//! of the head in the gear's spindle at any time of any slot. What is commanded stays in tables, charts and programs.
//!
//! Errors that depend on where the work spindle stands see it with its indexing from slot to slot; drives have settled
//! when a slot begins.

use super::operation::PreparedBevel;
use crate::machine_errors::{
    ActualMotion, Course, MachineErrors, MachineMoment, ToolMounting, WorkMounting, noise_knots_s,
};
use gearcut_core::bevel::five_axis::{FiveAxisMachine, SixAxes};
use gearcut_core::frame::Rigid3;
use gearcut_core::units::TURN_RAD;
use glam::{DMat3, DVec3};

/// Cells over a slot: a roll is a tenth of a turn.
const CELLS: usize = 512;
/// Place of the work spindle among the axes, and of those that move the head as a cradle does.
const WORK: usize = 3;
const CRADLE: [usize; 2] = [0, 1];

/// Errors over the slots of an operation.
#[derive(Debug, Clone)]
pub struct ActualSlot<'a> {
    machine: FiveAxisMachine,
    operation: &'a PreparedBevel,
    motion: Option<ActualMotion<5>>,
    mounting: WorkMounting,
    head: ToolMounting,
    /// Middle of the face along the gear's axis, mm.
    middle_z_mm: f64,
    /// Turn of the work that its zero makes up for, rad.
    turn_rad: f64,
}

/// A slot at one moment.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlotMoment {
    /// Number of the slot.
    pub slot: u32,
    /// Angle by which the work has been indexed to it, rad.
    pub indexed_rad: f64,
    /// Time from the beginning of the slot, s.
    pub time_s: f64,
    /// Angle that the head has turned, rad.
    pub tool_rad: f64,
}

impl<'a> ActualSlot<'a> {
    /// Errors over an operation's slots, by its settings or by its program, on a gear whose face has its middle at
    /// `middle_z_mm`.
    pub fn new(
        errors: &MachineErrors<5>,
        head: ToolMounting,
        machine: FiveAxisMachine,
        operation: &'a PreparedBevel,
        middle_z_mm: f64,
    ) -> Self {
        let course = operation.course;
        // Blades are in the work a little before and after the slot's time.
        let beyond_s = 0.5 * course.slot_s();
        let corners_s = course.pieces_s().iter().skip(1).map(|piece| piece[0]).collect();
        let of_slot = Course {
            from_s: -beyond_s,
            to_s: course.slot_s() + beyond_s,
            corners_s,
            cells: CELLS,
            noise_knots_s: Some(noise_knots_s(operation.spec.head_speed_rad_per_s / TURN_RAD)),
        };
        let motion =
            ActualMotion::new(&errors.axes, &of_slot, |time_s| course.axes(machine, &operation.as_set, time_s));
        Self { machine, operation, motion, mounting: errors.mounting, head, middle_z_mm, turn_rad: 0.0 }
    }

    /// How far work and head are turned against each other for good in the middle of the roll, rad
    /// ([`ActualMotion::turn_rad`]): X and Y are what the cradle is here.
    pub fn turn_rad(&self) -> f64 {
        let PreparedBevel { course, as_set, .. } = self.operation;
        if as_set.plunges() {
            return 0.0;
        }
        let middle_s = ((as_set.cradle_angle_rad - course.range[0]) / course.per_s).clamp(0.0, course.slot_s());
        let at = |time_s: f64| course.axes(self.machine, as_set, time_s);
        self.motion.as_ref().map_or(0.0, |motion| motion.turn_rad(WORK, &CRADLE, middle_s, at))
    }

    /// The zero of the work spindle makes up for a turn.
    pub fn make_up_for(&mut self, turn_rad: f64) {
        self.turn_rad = turn_rad;
    }

    /// Pose of the head in the gear; `gear_from_work` is that of the work frame in the gear for slot 0, `index` turns
    /// the gear to a slot, `head_from_tool` turns the tool frame so that its x axis looks at the work.
    pub fn gear_from_head(&self, at: &SlotMoment, gear_from_work: &Rigid3, index: &Rigid3, head: &Rigid3) -> Rigid3 {
        let PreparedBevel { course, as_set, start_s, program, .. } = self.operation;
        let [moment, _] = course.at(at.time_s);
        let pose = match (&self.motion, program) {
            (None, None) => as_set.work_from_tool(moment),
            (motion, program) => {
                let slot_start_s = f64::from(at.slot) * self.operation.cycle_s();
                let commanded = |time_s: f64| match program {
                    // The errors see the work where it has been indexed to, by the moment.
                    Some(program) => {
                        let mut axes = program.at(slot_start_s + time_s);
                        axes[WORK] -= at.indexed_rad;
                        axes
                    }
                    None => course.axes(self.machine, as_set, time_s).map(|axis| axis.position),
                };
                let now = MachineMoment {
                    time_s: at.time_s,
                    since_start_s: start_s + slot_start_s + at.time_s,
                    at_rest_s: 0.0,
                    passage: 0,
                    indexed: [0.0, 0.0, 0.0, at.indexed_rad, 0.0],
                };
                let [x, y, z, work_rad, swing_rad] = match motion {
                    Some(motion) => {
                        let mut axes = motion.positions(&now, commanded);
                        axes[WORK] -= at.indexed_rad + self.turn_rad;
                        axes
                    }
                    None => commanded(at.time_s),
                };
                self.machine.work_from_tool(&SixAxes {
                    slides_mm: DVec3::new(x, y, z),
                    work_rad,
                    swing_rad,
                    head_rad: self.machine.axes_of_cradle(as_set, moment).head_rad,
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
