//! What the strokes of an infeed trim off a ring's teeth.
//!
//! In: the operations' strokes while they go to depth, the rounds at the cutter's tip, the target's outline. Out:
//! [`Trimming`], the deepest place. Law: a corner of the cutter that a stroke of the infeed has inside the target takes
//! what no later stroke gives back. Before depth the cutter stands nearer to the ring's middle than its path of rolling
//! has it, and its corners pass the tips of the teeth beside their space on the way out: with few teeth between cutter
//! and ring they do not come clear.

use super::corners::tip_rounds;
use crate::measure::target_outline::TargetOutline;
use crate::process::shaping::ShapingJob;
use glam::DVec2;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Deepest place of a corner in the ring's teeth while the cutter goes in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Trimming {
    /// Depth, mm; 0 where the corners come clear.
    pub depth_mm: f64,
    /// Tooth of the ring, from 1.
    pub tooth: u32,
    /// Index of the operation.
    pub operation: usize,
    /// The stroke.
    pub stroke: usize,
}

/// The deepest place of all operations.
pub(super) fn deepest(job: &ShapingJob, target: &TargetOutline) -> Trimming {
    let none = Trimming { depth_mm: 0.0, tooth: 1, operation: 0, stroke: 0 };
    let deeper = |a: Trimming, b: Trimming| if b.depth_mm > a.depth_mm { b } else { a };
    let of_operation = |operation: usize| {
        let [plunged, fed] = job.operations[operation].schedule.corners();
        let strokes = (plunged.max(fed).ceil() as usize).min(job.operations[operation].schedule.count());
        let of_stroke = |stroke| of_stroke(job, target, operation, stroke).unwrap_or(none);
        (0..strokes).into_par_iter().map(of_stroke).reduce(|| none, deeper)
    };
    (0..job.operations.len()).map(of_operation).fold(none, deeper)
}

/// The deepest corner of one stroke; `None` where none is inside the target.
fn of_stroke(job: &ShapingJob, target: &TargetOutline, operation: usize, stroke: usize) -> Option<Trimming> {
    let pose = job.operations[operation].schedule.state(stroke as f64).pose;
    let module_mm = job.transverse.module_mm;
    let bore_mm = job.curve.facts().smallest_radius_mm - job.blank.addendum_mm;
    let blades = job.cutter.teeth;
    let corners = (0..blades).flat_map(|blade| {
        let turn = DVec2::from_angle(pose.angle_rad + TAU * f64::from(blade) / f64::from(blades));
        tip_rounds(job).into_iter().map(move |(at_mm, radius_mm)| (pose.center_mm + turn.rotate(at_mm), radius_mm))
    });
    let inside =
        corners.filter(|(at_mm, radius_mm)| at_mm.length() + radius_mm > bore_mm).filter_map(|(at_mm, radius_mm)| {
            let depth_mm = radius_mm - target.distance_mm(at_mm, module_mm)?;
            (depth_mm > 0.0).then_some((depth_mm, at_mm))
        });
    let (depth_mm, at_mm) = inside.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let teeth = job.scene.gear.teeth;
    let pitches = job.curve.arc_mm(at_mm.to_angle().rem_euclid(TAU)) / (PI * module_mm);
    Some(Trimming { depth_mm, tooth: (pitches as u32).min(teeth - 1) + 1, operation, stroke })
}
