//! A program under test against the motion of its operation, slot after slot.
//!
//! In: a prepared operation with its program. Out: a [`ProgramUnderTest`]. Law: in every slot the program is compared
//! at even moments of the slot and at its own knots, the work indexed back to slot 0. The head turns on beside the
//! program, so that its time is the scene's: a program that is slower or faster lies off.

use super::program::displacement_mm;
use crate::gcode::TimedKnot;
use crate::gcode::beyond_limits;
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::motion::{AXES, SlotMotion, limits};
use crate::process::bevel::operation::PreparedBevel;
use crate::steps::program_under_test::ProgramUnderTest;
use gearcut_core::units::TURN_RAD;
use rayon::prelude::*;

/// Even moments of each slot, beside the knots.
const MOMENTS: u32 = 128;
/// Slots whose motion ends within this share of their time are made: the digits of F.
const SAME_MOMENT: f64 = 1e-6;

/// The program of an operation against its own motion, if one is cut.
pub fn judged(job: &BevelJob, operation: &PreparedBevel) -> Option<ProgramUnderTest> {
    let program = operation.program.as_ref()?;
    let motion = SlotMotion { job, operation };
    let (teeth, slot_s, cycle_s) = (job.blank.teeth, operation.course.slot_s(), operation.cycle_s());
    let starts = (0..teeth).map(|slot| (slot, f64::from(slot) * cycle_s));
    let made: Vec<(u32, f64)> =
        starts.filter(|(_, start_s)| start_s + slot_s <= program.end_s() * (1.0 + SAME_MOMENT)).collect();
    let (distance_mm, at_s) = made
        .par_iter()
        .flat_map_iter(|&(slot, start_s)| {
            let even = (0..=MOMENTS).map(move |i| slot_s * f64::from(i) / f64::from(MOMENTS));
            let knots =
                program.knots_between([start_s, start_s + slot_s]).iter().map(move |knot| knot.time_s - start_s);
            even.chain(knots).map(move |time_s| {
                let mut axes = program.at(start_s + time_s);
                axes[3] -= TURN_RAD * f64::from(slot) / f64::from(teeth);
                let exact = TimedKnot { time_s, axes: motion.positions(time_s) };
                (displacement_mm(&motion, &exact, &axes), start_s + time_s)
            })
        })
        .reduce(|| (0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst });
    let end_s = f64::from(teeth - 1) * cycle_s + slot_s;
    Some(ProgramUnderTest {
        distance_mm,
        at_s,
        missing: 1.0 - made.len() as f64 / f64::from(teeth),
        beyond: (program.end_s() / end_s - 1.0).max(0.0),
        time_s: [end_s; 2],
        exceeded: exceeded(job, operation, &made),
    })
}

/// Speeds within blocks, and steps of speed between them, beyond the limits while slots are cut; what the axes do
/// between slots is left to the control.
fn exceeded(job: &BevelJob, operation: &PreparedBevel, slots: &[(u32, f64)]) -> Vec<String> {
    let Some(program) = &operation.program else { return Vec::new() };
    let slot_s = operation.course.slot_s();
    let mut largest = [[0.0_f64; 2]; 5];
    for &(_, start_s) in slots {
        let knots = program.knots_between([start_s, start_s + slot_s]);
        for (axis, [speed, step]) in largest.iter_mut().enumerate() {
            let speed_of =
                |pair: &[TimedKnot<5>]| (pair[1].axes[axis] - pair[0].axes[axis]) / (pair[1].time_s - pair[0].time_s);
            *speed = knots.windows(2).map(|pair| speed_of(pair).abs()).fold(*speed, f64::max);
            let steps = knots.windows(3).map(|three| {
                2.0 * (speed_of(&three[1..]) - speed_of(&three[..2])).abs() / (three[2].time_s - three[0].time_s)
            });
            *step = steps.fold(*step, f64::max);
        }
    }
    let of = AXES.iter().zip(limits(job)).zip(largest);
    of.flat_map(|((axis, limits), largest)| beyond_limits(axis, &limits, largest)).collect()
}
