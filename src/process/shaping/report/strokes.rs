//! The cutter stroke by stroke, for the page's 3D view: where it is, what each stroke takes, and the work after it.
//!
//! The cutter is drawn over the gear's upper face, at the upper end of its stroke, where it hides no flank and its
//! teeth stand over the spaces that they cut; its height is a drawing's, not the tool's.

use crate::output::report::viewer::{ViewerStroke, ViewerStrokes};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::chips::{ChipLedger, StrokeChips};
use crate::process::shaping::cut::section::{CutSection, cutter_solid};
use crate::steps::report::work;
use crate::surface::triangles::Triangles;
use gearcut_core::error::Result;
use gearcut_core::frame::{Rigid2, Rigid3};
use gearcut_core::tool::CuttingTool as _;
use gearcut_core::units::UM_PER_MM;
use glam::{DMat3, DVec2};

/// More strokes than this are thinned by a whole factor: they take some half a megabyte of the page.
const MOST_STROKES: usize = 20_000;
/// Room between the gear's face and the drawn cutter, and the cutter's height, as shares of the face width.
const ABOVE_FACE: [f64; 2] = [0.02, 0.22];

/// The strokes of a job with their chips.
///
/// # Errors
/// A field that does not fit in memory.
pub fn strokes(job: &ShapingJob, chips: &ChipLedger) -> Result<ViewerStrokes> {
    let count = CutSection::strokes(job);
    let every = count.div_ceil(MOST_STROKES).max(1);
    let stroke = |stroke: usize| {
        let pose = CutSection::work_from_tool(job, stroke);
        let (operation, own) = CutSection::operation_and_stroke(job, stroke);
        let of: &StrokeChips = &chips.operations[operation].strokes[own];
        let gear_from_tool = Rigid3 {
            rotation: DMat3::from_rotation_z(pose.rotation.to_angle()),
            translation_mm: pose.translation_mm.extend(0.0),
        };
        // A stroke of no space takes nothing.
        let area_mm2 = if of.space == 0 { 0.0 } else { of.area_mm2 };
        ViewerStroke {
            place: [operation, own],
            gear_from_tool,
            taken: [area_mm2, UM_PER_MM * of.thickest_anywhere_mm(), of.cutting_n, f64::from(of.space)],
        }
    };
    let operations = job.operations.iter().map(|operation| (operation.spec.name.clone(), operation.strokes.count()));
    let shown = || (0..count).step_by(every);
    // Pass ids count teeth of the cutter, stroke by stroke.
    let last_passes: Vec<u32> = shown().map(|stroke| (stroke as u32 + 1) * job.cutter.blade_count() - 1).collect();
    // The feed during a stroke makes less of a difference between sections than a pixel.
    let uncut = work::field(&job.scene, &job.blank, job.helix.is_none())?;
    Ok(ViewerStrokes {
        tool: cutter(job),
        noun: "stroke",
        operations: operations.collect(),
        words: "chip {0} mm², {1} µm thick, {2} N, space {3}",
        parts: Vec::new(),
        names: Vec::new(),
        strokes: shown().map(stroke).collect(),
        work: work::watched(uncut, &last_passes, |field, watch| {
            job.cut_blank_watched(field, watch);
            Ok(())
        })?,
    })
}

fn cutter(job: &ShapingJob) -> Triangles {
    let face_mm = job.scene.gear.face_width_mm;
    let mesh = cutter_solid(job, ABOVE_FACE.map(|share| (0.5 + share) * face_mm), &Rigid2::new(0.0, DVec2::ZERO));
    let mut triangles = Triangles::default();
    triangles.add_mesh(&mesh);
    triangles
}
