//! Straight lines in five axes that follow a slot's motion, slot after slot.
//!
//! In: the motion and the contour error. Out: [`BevelProgram`]: the longest blocks that keep the tips of the blades
//! within that error, repeated for every slot with the work indexed, and the way back between slots.

use crate::gcode::{Digits, longest_lines};
use crate::process::bevel::axis_program::{BevelKnot, BevelProgram};
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::motion::{AXES, SlotMotion};
use gearcut_core::bevel::face_mill::BladeKind;
use gearcut_core::bevel::five_axis::SixAxes;
use gearcut_core::frame::Rigid3;
use gearcut_core::units::TURN_RAD;
use glam::DVec3;

/// Shortest block, s: what block buffers of older controls keep up with.
const SHORTEST_S: f64 = 1e-3;
/// Most blocks that a piece of a slot's motion is tried with.
const MOST_BLOCKS: f64 = 4096.0;
/// Places within the shortest block at which a program is compared with the motion.
const SAMPLES: usize = 4;
/// Share of the contour error that the samples may show, so that what lies between them stays below all of it.
const SAMPLED_SHARE: f64 = 0.95;
/// Parts of the idle time: withdraw, back and index, come in.
const IDLE_PARTS: [f64; 3] = [0.2, 0.6, 0.2];

/// Digits of lengths and angles: angles count at the gear's outer end.
pub(super) fn digits(job: &BevelJob, contour_error_mm: f64) -> Digits {
    job.scene.output.post.digits(contour_error_mm, job.blank.outer_cone_distance_mm)
}

/// How many of the shortest blocks a piece of a slot's motion is tried with.
fn most_blocks(job: &BevelJob, piece_s: f64) -> u32 {
    let shortest_s = SHORTEST_S.max(job.scene.output.post.shortest_block_s());
    (piece_s / shortest_s).clamp(1.0, MOST_BLOCKS) as u32
}

/// Tips of blades that look at the work, head's frame of the machine.
fn tips(motion: &SlotMotion, cradle_rad: f64) -> Vec<DVec3> {
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
    /// Longest straight lines that keep the tips of the blades within `contour_error_mm` of the motion, as far as the
    /// shortest blocks can, slot after slot.
    pub fn fit(motion: &SlotMotion, contour_error_mm: f64) -> Self {
        let digits = digits(motion.job, contour_error_mm);
        let mut slot = Vec::new();
        for [from_s, to_s] in motion.operation.course.pieces_s() {
            let blocks = most_blocks(motion.job, to_s - from_s) as usize;
            let knot = |sample: usize| {
                let time_s = from_s + (to_s - from_s) * sample as f64 / (blocks * SAMPLES) as f64;
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
            if slot.is_empty() {
                slot.push(written(0));
            }
            slot.extend(longest_lines(blocks, fits).into_iter().map(written));
        }
        Self { knots: over_all_slots(motion, &slot, digits) }
    }

    /// Largest displacement of the tips from the first slot's motion, mm, and when, s.
    pub fn contour_error_mm(&self, motion: &SlotMotion) -> (f64, f64) {
        let slot_s = motion.operation.course.slot_s();
        let count = most_blocks(motion.job, slot_s) * SAMPLES as u32;
        (0..count)
            .map(|i| {
                let time_s = slot_s * f64::from(i) / f64::from(count);
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
pub(super) fn displacement_mm(motion: &SlotMotion, exact: &BevelKnot, other: &[f64; 5]) -> f64 {
    let [a, b] = [exact.axes, *other].map(|axes| pose(motion.job, axes));
    let tips = tips(motion, motion.cradle_rad(exact.time_s));
    tips.into_iter().map(|tip| a.point(tip).distance(b.point(tip))).fold(0.0, f64::max)
}

/// A slot's motion for all slots, the work indexed by the pitch from one to the next.
fn over_all_slots(motion: &SlotMotion, of_slot: &[BevelKnot], digits: Digits) -> Vec<BevelKnot> {
    let (job, operation) = (motion.job, motion.operation);
    let pitch_rad = TURN_RAD / f64::from(job.blank.teeth);
    let clear_mm = withdrawn_mm(job);
    let indexed = |axes: [f64; 5], slot: u32| {
        let mut axes = axes;
        // The work turns about its x axis by -A: from slot to slot the gear's z axis, which is -x, turns by the pitch.
        axes[3] = digits.rounded(AXES[3].kind, axes[3] + pitch_rad * f64::from(slot));
        axes
    };
    let mut knots = Vec::new();
    for slot in 0..job.blank.teeth {
        let start_s = operation.cycle_s() * f64::from(slot);
        if slot > 0 {
            let (before, first) = (of_slot[of_slot.len() - 1], of_slot[0]);
            let [out_s, back_s, _] = IDLE_PARTS.map(|part| part * operation.spec.idle_s);
            let end_s = start_s - operation.spec.idle_s;
            let withdrawn = |knot: BevelKnot| {
                let mut axes = knot.axes;
                axes[2] = digits.rounded(AXES[2].kind, before.axes[2] - clear_mm);
                axes
            };
            knots.push(BevelKnot { time_s: end_s + out_s, axes: indexed(withdrawn(before), slot - 1) });
            knots.push(BevelKnot { time_s: end_s + out_s + back_s, axes: indexed(withdrawn(first), slot) });
        }
        knots.extend(
            of_slot.iter().map(|knot| BevelKnot { time_s: start_s + knot.time_s, axes: indexed(knot.axes, slot) }),
        );
    }
    knots
}
