//! Passes of the head's blades over all slots of all operations.
//!
//! In: operations with their motion through a slot, the head, the pose of the head in the gear. Out: one set of passes
//! for every slot, with ids that grow in the order of cutting: operation by operation, slot 0, 1, 2 and so on.
//!
//! The head turns on while the machine withdraws, rolls back and indexes, so that each slot begins with the blades at
//! another angle: tau0(j) = start + omega j T, T the time from slot to slot. The time in a slot is (tau - tau0) /
//! omega. Every blade passes that points to the work within that time, those of the turns that the slot begins or ends
//! in the middle of among them.

use super::axis_program::BevelKnot;
use super::operation::PreparedBevel;
use gearcut_core::bevel::face_mill::FaceMill;
use gearcut_core::error::Refusal;
use gearcut_core::frame::Rigid3;
use gearcut_core::passes::{MotionTable, TurningPasses};
use gearcut_core::units::TURN_RAD;
use rayon::prelude::*;
use std::ops::Range;

/// Passes of all operations and slots.
#[derive(Debug)]
pub struct Slots {
    /// One set for every slot, operation by operation.
    sets: Vec<TurningPasses>,
    slots: usize,
}

/// Pose of the head in the gear for an operation (by its place), a slot, a time from its beginning, s, and the angle
/// that the head has turned, rad; the head's x axis looks at the slot.
pub type HeadPose<'a> = &'a (dyn Fn(usize, u32, f64, f64) -> Rigid3 + Sync);

impl Slots {
    /// Passes of operations over so many slots, with a head whose first blade stands at `start_rad` when slot 0 of each
    /// begins.
    ///
    /// # Errors
    /// A head that cannot be made; more passes than can be numbered.
    pub fn new(
        operations: &[PreparedBevel],
        head: &FaceMill,
        (start_rad, slots): (f64, u32),
        gear_from_head: HeadPose,
    ) -> Result<Self, Refusal> {
        let tool = head.tool()?;
        let numbered: Vec<(usize, u32)> =
            (0..operations.len()).flat_map(|operation| (0..slots).map(move |slot| (operation, slot))).collect();
        let sets: Vec<TurningPasses> = numbered
            .into_par_iter()
            .map(|(number, slot)| {
                let operation = &operations[number];
                let speed = operation.spec.head_speed_rad_per_s;
                let turned = start_rad + speed * operation.cycle_s() * f64::from(slot);
                let from = turned.rem_euclid(TURN_RAD);
                let to = from + speed * operation.course.slot_s();
                let beyond = head.half_window_rad;
                let start_s = operation.cycle_s() * f64::from(slot);
                let at = |knot: &BevelKnot| from + speed * (knot.time_s - start_s);
                let of_program = operation.program.iter().flat_map(|program| &program.knots).map(at);
                let of_course = operation.course.pieces_s().into_iter().skip(1).map(|piece| from + speed * piece[0]);
                let corners: Vec<f64> = of_program.chain(of_course).collect();
                let motion = MotionTable::new([from - beyond, to + beyond], &corners, |tool_rad| {
                    gear_from_head(number, slot, (tool_rad - from) / speed, tool_rad).inverse()
                });
                Ok(TurningPasses::new(0, &tool, 1.0, motion)?.with_parts_of_turns())
            })
            .collect::<Result<_, Refusal>>()?;
        let passes: u64 = sets.iter().map(|set| u64::from(set.count())).sum();
        if passes >= u64::from(u32::MAX) {
            let key = operations[0].spec.feed.key();
            return Err(Refusal::new(
                &format!("operation.{key}"),
                format!("{passes} passes are more than can be numbered"),
                format!("use a larger {key} or fewer blades"),
            ));
        }
        let mut first_pass = 0;
        let sets = sets
            .into_iter()
            .map(|mut set| {
                set.first_pass = first_pass;
                first_pass = set.end_pass();
                set
            })
            .collect();
        Ok(Self { sets, slots: slots as usize })
    }

    /// Passes of a slot in an operation.
    pub fn of(&self, operation: usize, slot: u32) -> &TurningPasses {
        &self.sets[operation * self.slots + slot as usize]
    }

    /// Ids of an operation's passes.
    pub fn ids(&self, operation: usize) -> Range<u32> {
        let sets = &self.sets[operation * self.slots..(operation + 1) * self.slots];
        sets[0].first_pass..sets[self.slots - 1].end_pass()
    }

    /// Passes of all operations.
    pub fn count(&self) -> u32 {
        self.sets.last().map_or(0, TurningPasses::end_pass)
    }

    /// Blade behind a pass.
    pub fn blade_of(&self, pass: u32) -> u32 {
        let [operation, slot] = self.operation_and_slot(pass);
        self.of(operation, slot as u32).blade_of(pass).1
    }

    /// Operation and slot of a pass.
    pub fn operation_and_slot(&self, pass: u32) -> [usize; 2] {
        let at = self.sets.partition_point(|set| set.end_pass() <= pass);
        [at / self.slots, at % self.slots]
    }

    /// Angle by which the head has turned since a slot began when the blade of a pass points to the work, rad.
    pub fn turned_in_slot_rad(&self, operation: usize, slot: u32, pass: u32) -> f64 {
        let set = self.of(operation, slot);
        let begins_rad = set.motion.range_rad()[0] + set.half_window_rad;
        set.pass(pass - set.first_pass).tool_angle_rad - begins_rad
    }
}
