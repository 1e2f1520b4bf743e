//! Straight lines in five axes that follow the roll, slot after slot.
//!
//! In: a roll and the contour error. Out: [`BevelProgram`]: the longest blocks that keep the tips of the blades within
//! that error, repeated for every slot with the work indexed, and the way back between slots.

use crate::gcode::{Digits, longest_lines};
use crate::process::bevel::axis_program::{BevelKnot, BevelProgram};
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::motion::{AXES, RollMotion};
use gearcut_core::bevel::face_mill::BladeKind;
use gearcut_core::bevel::five_axis::SixAxes;
use gearcut_core::frame::Rigid3;
use gearcut_core::units::TURN_RAD;
use glam::DVec3;

/// Shortest block, s: what block buffers of older controls keep up with.
const SHORTEST_S: f64 = 1e-3;
/// Most blocks that a roll is tried with.
const MOST_BLOCKS: f64 = 4096.0;
/// Places within the shortest block at which a program is compared with the roll.
const SAMPLES: usize = 4;
/// Share of the contour error that the samples may show, so that what lies between them stays below all of it.
const SAMPLED_SHARE: f64 = 0.95;
/// Parts of the idle time: withdraw, back and index, come in.
const IDLE_PARTS: [f64; 3] = [0.2, 0.6, 0.2];

/// Digits of lengths and angles: angles count at the gear's outer end.
pub(super) fn digits(job: &BevelJob, contour_error_mm: f64) -> Digits {
    job.scene.output.post.digits(contour_error_mm, job.blank.outer_cone_distance_mm)
}

/// How many of the shortest blocks a roll is tried with.
fn most_blocks(job: &BevelJob, roll_s: f64) -> u32 {
    let shortest_s = SHORTEST_S.max(job.scene.output.post.shortest_block_s());
    (roll_s / shortest_s).clamp(1.0, MOST_BLOCKS) as u32
}

/// Tips of blades that look at the work, head's frame of the machine.
fn tips(motion: &RollMotion, cradle_rad: f64) -> Vec<DVec3> {
    let job = motion.job;
    BladeKind::BOTH
        .into_iter()
        .flat_map(|kind| {
            let surface = job.head.surface(kind);
            [-1.0, 0.0, 1.0]
                .map(|side| surface.point_mm(cradle_rad + job.middle_rad + side * job.head.half_window_rad, 0.0))
        })
        .collect()
}

/// Pose of the head in the work; the head's own turn is left out, for tips are given in the machine's directions.
fn pose(job: &BevelJob, [x, y, z, work_rad, swing_rad]: [f64; 5]) -> Rigid3 {
    job.machine.work_from_tool(&SixAxes { slides_mm: DVec3::new(x, y, z), work_rad, swing_rad, head_rad: 0.0 })
}

impl BevelProgram {
    /// Longest straight lines that keep the tips of the blades within `contour_error_mm` of the roll, as far as the
    /// shortest blocks can, slot after slot.
    pub fn fit(motion: &RollMotion, contour_error_mm: f64) -> Self {
        let job = motion.job;
        let digits = digits(job, contour_error_mm);
        let roll_s = motion.operation.roll_s();
        let blocks = most_blocks(job, roll_s) as usize;
        let knot = |sample: usize| {
            let time_s = roll_s * sample as f64 / (blocks * SAMPLES) as f64;
            BevelKnot { time_s, axes: motion.positions(time_s) }
        };
        let samples: Vec<BevelKnot> = (0..=blocks * SAMPLES).map(knot).collect();
        let written = |block: usize| {
            let knot = samples[block * SAMPLES];
            BevelKnot { axes: std::array::from_fn(|i| digits.rounded(AXES[i].kind, knot.axes[i])), ..knot }
        };
        let fits = |from: usize, to: usize| {
            let (a, b) = (written(from), written(to));
            // Places of long lines are thinned out: a chord's error is a smooth hump.
            let step = ((to - from) * SAMPLES / 64).max(1);
            samples[from * SAMPLES..=to * SAMPLES].iter().step_by(step).all(|knot| {
                displacement_mm(motion, knot, &a.between(&b, knot.time_s)) <= SAMPLED_SHARE * contour_error_mm
            })
        };
        let mut roll = vec![written(0)];
        roll.extend(longest_lines(blocks, fits).into_iter().map(written));
        Self { knots: over_all_slots(motion, &roll, digits) }
    }

    /// Largest displacement of the tips from the first slot's roll, mm, and when, s.
    pub fn contour_error_mm(&self, motion: &RollMotion) -> (f64, f64) {
        let roll_s = motion.operation.roll_s();
        let count = most_blocks(motion.job, roll_s) * SAMPLES as u32;
        (0..count)
            .map(|i| {
                let time_s = roll_s * f64::from(i) / f64::from(count);
                let exact = BevelKnot { time_s, axes: motion.positions(time_s) };
                (displacement_mm(motion, &exact, &self.at(time_s)), time_s)
            })
            .fold((0.0, 0.0), |worst, next| if next.0 > worst.0 { next } else { worst })
    }
}

/// How far the head withdraws so that it is clear of the blank: twice the whole depth at the heel, mm.
fn withdrawn_mm(job: &BevelJob) -> f64 {
    2.0 * (job.blank.outer_addendum_mm + job.blank.outer_dedendum_mm)
}

/// Place of the head along its axis at which it is clear of the blank, mm.
pub(super) fn clear_mm(job: &BevelJob, program: &BevelProgram) -> f64 {
    let deepest_mm = program.knots.iter().map(|knot| knot.axes[2]).fold(f64::NEG_INFINITY, f64::max);
    (deepest_mm - withdrawn_mm(job)).floor()
}

/// Largest displacement in the work of the tips that look at it, mm.
pub(super) fn displacement_mm(motion: &RollMotion, exact: &BevelKnot, other: &[f64; 5]) -> f64 {
    let [a, b] = [exact.axes, *other].map(|axes| pose(motion.job, axes));
    let tips = tips(motion, motion.cradle_rad(exact.time_s));
    tips.into_iter().map(|tip| a.point(tip).distance(b.point(tip))).fold(0.0, f64::max)
}

/// A slot's roll for all slots, the work indexed by the pitch from one to the next.
fn over_all_slots(motion: &RollMotion, roll: &[BevelKnot], digits: Digits) -> Vec<BevelKnot> {
    let (job, operation) = (motion.job, motion.operation);
    let pitch_rad = TURN_RAD / f64::from(job.blank.teeth);
    let clear_mm = withdrawn_mm(job);
    let indexed = |axes: [f64; 5], slot: u32, back_mm: f64| {
        let mut axes = axes;
        axes[2] = digits.rounded(AXES[2].kind, axes[2] - back_mm);
        // The work turns about its x axis by -A: from slot to slot the gear's z axis, which is -x, turns by the pitch.
        axes[3] = digits.rounded(AXES[3].kind, axes[3] + pitch_rad * f64::from(slot));
        axes
    };
    let mut knots = Vec::new();
    for slot in 0..job.blank.teeth {
        let start_s = operation.cycle_s() * f64::from(slot);
        if slot > 0 {
            let (before, first) = (roll[roll.len() - 1], roll[0]);
            let [out_s, back_s, _] = IDLE_PARTS.map(|part| part * operation.spec.idle_s);
            let end_s = start_s - operation.spec.idle_s;
            knots.push(BevelKnot { time_s: end_s + out_s, axes: indexed(before.axes, slot - 1, clear_mm) });
            knots.push(BevelKnot { time_s: end_s + out_s + back_s, axes: indexed(first.axes, slot, clear_mm) });
        }
        knots.extend(
            roll.iter().map(|knot| BevelKnot { time_s: start_s + knot.time_s, axes: indexed(knot.axes, slot, 0.0) }),
        );
    }
    knots
}
