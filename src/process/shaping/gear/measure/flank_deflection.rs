//! What the deflection of a stroke does to the flanks that it finishes.
//!
//! In: the job of a machine that yields. Out: how far the cutter's edge is moved out of the material at the pitch point
//! of the stroke, along the normals of left and right flanks there: by so much a flank that gets its surface from this
//! stroke stands too high. On a round gear that is `a sin(alpha) + s t cos(alpha)` for a shift a outwards and t
//! counter-clockwise, s = 1 on left and -1 on right flanks.

use crate::machine_errors::Deflection;
use crate::process::shaping::ShapingJob;
use glam::{DVec2, DVec4};

/// Material left on left and right flanks at the pitch point of a stroke, mm; negative where more is taken.
pub fn at_pitch_point_mm(job: &ShapingJob, operation: usize, stroke: usize) -> [f64; 2] {
    let deflections = &job.operations[operation].deflections;
    deflections.get(stroke).map_or([0.0; 2], |of| moved_mm(job, operation, stroke, of.coordinates()))
}

/// How far coordinates of a deflection move the edge out of left and right flanks at the pitch point of a stroke, mm.
pub fn moved_mm(job: &ShapingJob, operation: usize, stroke: usize, coordinates: DVec4) -> [f64; 2] {
    let operation = &job.operations[operation];
    let frame = job.curve.frame(operation.schedule.phi_rad(stroke as f64));
    let to_tip = job.blank.towards_tip(&frame);
    let (sin, cos) = job.scene.gear.pressure_angle_rad.sin_cos();
    let work_axis_mm = -job.eccentricity_mm();
    let tool_axis_mm = operation.pose(stroke as f64).center_mm + work_axis_mm;
    let along = |normal: DVec2| Deflection::moves(frame.point_mm, normal, work_axis_mm, tool_axis_mm).dot(coordinates);
    [1.0, -1.0].map(|side| along(sin * to_tip + side * cos * frame.tangent))
}
