//! The cutter stroke by stroke, for the page's 3D view: where it stands, and what each stroke takes.
//!
//! The cutter is drawn over the gear's upper face, at the upper end of its stroke, where it hides no flank and its
//! teeth stand over the spaces that they cut; its height is a drawing's, not the tool's.

use crate::output::report::viewer::{ViewerStroke, ViewerStrokes};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::cut::section::{CutSection, cutter_solid};
use crate::surface::triangles::Triangles;
use gearcut_core::frame::Rigid2;
use gearcut_core::units::UM_PER_MM;
use glam::DVec2;

/// More strokes than this are thinned by a whole factor: they take some half a megabyte of the page.
const MOST_STROKES: usize = 20_000;
/// Room between the gear's face and the drawn cutter, and the cutter's height, as shares of the face width.
const ABOVE_FACE: [f64; 2] = [0.02, 0.22];

/// The strokes of a job with their chips.
pub fn strokes(job: &ShapingJob, chips: &ChipLedger) -> ViewerStrokes {
    let count = CutSection::strokes(job);
    let every = count.div_ceil(MOST_STROKES).max(1);
    let stroke = |stroke: usize| {
        let pose = CutSection::work_from_tool(job, stroke);
        let (operation, own) = CutSection::operation_and_stroke(job, stroke);
        let of: &StrokeChips = &chips.operations[operation].strokes[own];
        ViewerStroke {
            pose: [pose.translation_mm.x, pose.translation_mm.y, pose.rotation.to_angle()].map(|value| value as f32),
            section_mm2: of.area_mm2 as f32,
            thickness_um: (UM_PER_MM * of.thickest_anywhere_mm()) as f32,
            force_n: of.cutting_n as f32,
            space: of.space,
        }
    };
    let operations = job.operations.iter().map(|operation| (operation.spec.name.clone(), operation.strokes.count()));
    ViewerStrokes {
        cutter: cutter(job),
        operations: operations.collect(),
        every,
        strokes: (0..count).step_by(every).map(stroke).collect(),
    }
}

fn cutter(job: &ShapingJob) -> Triangles {
    let face_mm = job.scene.gear.face_width_mm;
    let mesh = cutter_solid(job, ABOVE_FACE.map(|share| (0.5 + share) * face_mm), &Rigid2::new(0.0, DVec2::ZERO));
    Triangles {
        normals: vec![[0.0, 0.0, 1.0]; mesh.positions_mm.len()],
        positions_mm: mesh.positions_mm.iter().map(|p| p.to_array().map(|value| value as f32)).collect(),
        indices: mesh.triangles.concat(),
        ..Triangles::default()
    }
}
