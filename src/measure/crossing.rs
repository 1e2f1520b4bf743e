//! Where a surface crosses the pitch curve: the points A, B, C, D of Gao et al. (2017, Fig. 9).
//!
//! A and D lie on the surface that an operation leaves (left and right flank), B and C on the finished one. Two surfaces are asked: the **envelope**, the limit of infinitely many strokes, from
//! the meshing condition; and the surface that the **strokes** leave, by a dexel bent along the pitch curve: a ray along the curve's tangent is cut by all passes near it, moved to the
//! foot of the hit, and cut again until it stays, which takes three or four rounds.

use crate::gear::generation::{Generation, Side};
use crate::gear::target::TargetFlank;
use crate::job::Job;
use crate::passes::near::{lowest_entry, near_passes};
use crate::tool::CuttingTool;
use glam::DVec2;

/// A point of a surface on the pitch curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// Gear frame, mm.
    pub point_mm: DVec2,
    /// Polar angle, rad, unwrapped like the linkage's.
    pub phi_rad: f64,
    /// Arc of the pitch curve, mm.
    pub arc_mm: f64,
}

/// Crossing of the envelope of one operation with the pitch curve on one flank; `None` where its involute does not reach the curve.
pub fn envelope_crossing(job: &Job, generation: &Generation, tooth: u32, side: Side) -> Option<Crossing> {
    let flank = TargetFlank::new(generation, &job.blank, tooth, side, None).ok()?;
    let (_, contact) = flank.at_height(&job.blank, 0.0)?;
    let phi_rad = job.blank.height(contact.point_mm, contact.phi_rad).1;
    Some(Crossing { point_mm: contact.point_mm, phi_rad, arc_mm: job.curve.arc_mm(phi_rad) })
}

/// Crossing of what the strokes of operations 0 to `last_operation` leave in the middle of the face, on one flank; `start` is a crossing near it (the target's).
///
/// `None` where no pass comes within reach: half a pitch into the space, half a module into the tooth.
pub fn stroke_crossing(job: &Job, last_operation: usize, side: Side, start: Crossing) -> Option<Crossing> {
    let module_mm = job.scene.gear.module_mm;
    let reach_mm = 0.5 * std::f64::consts::PI * module_mm;
    let passes: Vec<_> = job.operations[..=last_operation]
        .iter()
        .map(|operation| near_passes(&operation.strokes, &job.cutter, start.point_mm, reach_mm))
        .collect();
    let mut phi = start.phi_rad;
    for _ in 0..12 {
        let frame = job.curve.frame(phi);
        // Out of the tooth: towards larger arcs on the left flank.
        let direction = side.sign() * frame.tangent;
        let height_mm = passes
            .iter()
            .filter_map(|near| lowest_entry(near, job.cutter.edge(), frame.point_mm, direction, -0.5 * module_mm))
            .fold(reach_mm, f64::min);
        if height_mm >= reach_mm {
            return None;
        }
        let point = frame.point_mm + height_mm * direction;
        let foot = job.blank.height(point, phi).1;
        let moved_mm = (foot - phi).abs() * frame.arc_rate_mm_per_rad;
        phi = foot;
        if moved_mm < 1e-10 {
            break;
        }
    }
    Some(Crossing { point_mm: job.curve.frame(phi).point_mm, phi_rad: phi, arc_mm: job.curve.arc_mm(phi) })
}
