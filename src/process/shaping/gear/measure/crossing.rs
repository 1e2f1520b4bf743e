//! Where the envelope of an operation, and what its strokes leave, cross the pitch curve.
//!
//! In: the job, an operation, a flank. Out: a [`Crossing`]. The **envelope** is the limit of infinitely many strokes;
//! its crossing follows from the meshing condition. What the **strokes** leave is found by a dexel bent along the pitch
//! curve: a ray along the curve's tangent is cut by all passes near it, moved to the foot of the hit, and cut again
//! until it stays, which takes three or four rounds.

use crate::measure::crossing::Crossing;
use crate::process::shaping::ShapingJob;
use gearcut_core::error::NotConverged;
use gearcut_core::math::convergence::{Step, iterate};
use gearcut_core::passes::planar::near::{lowest_entry, near_passes};
use gearcut_core::terms::Side;
use gearcut_core::tool::CuttingTool;
use std::ops::{ControlFlow, Range};

/// Rays along the pitch curve's tangent towards what the strokes leave, at most: each starts where the one before
/// ended, and misses the curve by the square of its length. The last one moves the crossing by less than this, mm.
const MOST_RAYS: u32 = 12;
const LAST_MOVE_MM: f64 = 1e-10;

/// Crossing of the envelope of one operation with the pitch curve on one flank; `None` where its involute does not
/// reach the curve.
pub fn envelope_crossing(job: &ShapingJob, operation: usize, tooth: u32, side: Side) -> Option<Crossing> {
    if operation + 1 == job.operations.len() {
        return job.target(tooth).pitch_crossing(side);
    }
    job.envelope_flank(operation, tooth, side)?.pitch_crossing(&job.blank)
}

/// Crossing of what the strokes of some operations leave in the middle of the face, on one flank; `start` is a crossing
/// near it (the target's).
///
/// `None` where no pass comes within reach: half a pitch into the space, half a module into the tooth.
///
/// # Errors
/// The rays go on moving along the pitch curve: the surface jumps where they meet it.
pub fn stroke_crossing(
    job: &ShapingJob,
    operations: Range<usize>,
    side: Side,
    start: Crossing,
) -> Result<Option<Crossing>, NotConverged> {
    let module_mm = job.scene.gear.module_mm;
    let reach_mm = 0.5 * std::f64::consts::PI * module_mm;
    let passes: Vec<_> = job.operations[operations]
        .iter()
        .map(|operation| near_passes(&operation.strokes, &job.cutter, start.point_mm, reach_mm))
        .collect();
    let phi = iterate("the crossing of the strokes with the pitch curve", start.phi_rad, MOST_RAYS, |phi| {
        let frame = job.curve.frame(phi);
        // Out of the tooth: towards larger arcs on the left flank.
        let direction = side.sign() * frame.tangent;
        let height_mm = passes
            .iter()
            .filter_map(|near| lowest_entry(near, job.cutter.edges(), frame.point_mm, direction, -0.5 * module_mm))
            .fold(reach_mm, f64::min);
        if height_mm >= reach_mm {
            return ControlFlow::Break(None);
        }
        let point = frame.point_mm + height_mm * direction;
        let foot = job.blank.height(point, phi).1;
        let moved_mm = (foot - phi).abs() * frame.arc_rate_mm_per_rad;
        if moved_mm < LAST_MOVE_MM {
            return ControlFlow::Break(Some(foot));
        }
        ControlFlow::Continue(Step { to: foot, residual: moved_mm })
    })?;
    Ok(phi.map(|phi| Crossing { point_mm: job.curve.frame(phi).point_mm, phi_rad: phi, arc_mm: job.curve.arc_mm(phi) }))
}
