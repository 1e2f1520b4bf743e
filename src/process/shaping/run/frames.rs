//! The cut as it happens: frames of the work and the cutter, evenly spread over all strokes of all operations.
//!
//! Every frame shows the work after exactly the strokes before it, none left out: the section in the middle of the face
//! (see [`CutSection`]), drawn as a body over the whole face. Work and cutter stand as on the machine: the line of
//! centres stays, the gear and the cutter turn. The cutter is drawn at the upper end of its stroke, above the face,
//! where it hides nothing; its height is a drawing's, not the tool's.

use crate::interrupt::Interrupt;
use crate::output::apng::{AnimationFrame, write_apng};
use crate::output::folder::OutputFolder;
use crate::output::render_png::{RenderPicture, draw_frame, write_frame};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::section::{CutSection, cutter_solid};
use crate::progress::Progress;
use crate::surface::Mesh;
use crate::surface::render::{Bodies, CLAY, Camera, Lights, STEEL, Shape, render};
use gearcut_core::error::{Error, Result};
use gearcut_core::frame::Rigid2;
use glam::{DVec2, DVec3};

/// Size of a frame without its title.
const SIZE_PX: (u32, u32) = (720, 540);
/// Time that a frame stays, and the last one, ms.
const FRAME_MS: u16 = 100;
const HOLD_MS: u16 = 2000;

/// Draws `count` frames into `frames/frame_0001.png` and so on, and all of them into `frames/cut.apng`; how many were
/// finished before Ctrl-C.
///
/// # Errors
/// Files that cannot be written; a blank field that does not fit in memory.
pub fn draw(
    job: &ShapingJob,
    count: u32,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: &OutputFolder,
) -> Result<u32> {
    let step = progress.step("frames", u64::from(count), "frames");
    let strokes = CutSection::strokes(job);
    let camera = camera(job);
    let mut section = CutSection::new(job)?;
    let mut frames: Vec<AnimationFrame> = Vec::new();
    for index in 0..count {
        // The first frame is the blank, the last one the finished gear.
        let until = (strokes as u64 * u64::from(index) / u64::from(count.max(2) - 1)) as usize;
        section.advance(until);
        let work = work(job, &section, until.min(strokes - 1));
        let shape = Shape::new(vec![&work.0, &work.1]);
        let bodies = Bodies::new(&shape, vec![CLAY, STEEL]);
        let rendered = match render(&bodies, &camera, &Lights::studio(&camera), interrupt) {
            Ok(rendered) => rendered,
            Err(Error::Interrupted) => break,
            Err(other) => return Err(other),
        };
        let (operation, stroke) = CutSection::operation_and_stroke(job, until.saturating_sub(1));
        let operation = &job.operations[operation];
        let after = if until == 0 { 0 } else { stroke + 1 };
        let title =
            format!("{}, {}: stroke {after} of {}", job.scene.name, operation.spec.name, operation.strokes.count());
        let page = RenderPicture {
            title: &title,
            note: "section in the middle of the face",
            rendered: &rendered,
            pixel_mm: camera.pixel_mm(),
            legend: None,
        };
        let frame = draw_frame(&page)?;
        write_frame(&folder.path(format!("frames/frame_{:04}.png", index + 1))?, &frame)?;
        frames.push(frame);
        step.advance(1);
    }
    if !frames.is_empty() {
        write_apng(&folder.path("frames/cut.apng")?, &frames, FRAME_MS, HOLD_MS)?;
    }
    step.finish();
    Ok(frames.len() as u32)
}

/// Work and cutter before stroke `stroke`, in the machine: the gear's axis at the origin, the cutter's at positive x.
fn work(job: &ShapingJob, section: &CutSection, stroke: usize) -> (Mesh, Mesh) {
    let pose = CutSection::work_from_tool(job, stroke);
    let along = pose.translation_mm.normalize_or(DVec2::X);
    let machine_from_work = Rigid2 { rotation: DVec2::new(along.x, -along.y), translation_mm: DVec2::ZERO };
    let half_mm = 0.5 * job.scene.gear.face_width_mm;
    let above_mm = half_mm + job.machine.approach_mm;
    (
        section.solid(machine_from_work.rotation),
        cutter_solid(job, [above_mm, above_mm + 0.6 * half_mm], &machine_from_work.after(&pose)),
    )
}

/// A camera that holds work and cutter through all strokes.
fn camera(job: &ShapingJob) -> Camera {
    let half_mm = 0.5 * job.scene.gear.face_width_mm;
    let outline_mm = (0..360).map(|i| job.blank.outline_mm(f64::from(i).to_radians()).length());
    let radius_mm = outline_mm.fold(job.blank.back.radius_mm, f64::max);
    let strokes = CutSection::strokes(job);
    let far_mm = (0..=200)
        .map(|i| CutSection::work_from_tool(job, (strokes - 1) * i / 200).translation_mm.length())
        .fold(0.0, f64::max);
    let cutter_mm = job.cutter.tip_radius_mm;
    let top_mm = half_mm + job.machine.approach_mm + 0.6 * half_mm;
    let ring = |x: f64, radius: f64, z: f64| {
        (0..24).map(move |i| (DVec2::new(x, 0.0) + radius * DVec2::from_angle(f64::from(i) * 0.2618)).extend(z))
    };
    let points: Vec<DVec3> = ring(0.0, radius_mm, -half_mm)
        .chain(ring(0.0, radius_mm, half_mm))
        .chain(ring(far_mm, cutter_mm, top_mm))
        .chain(ring(far_mm, cutter_mm, half_mm))
        .collect();
    let towards = Camera::direction(DVec3::NEG_Y, DVec3::X, 0.0, 0.85);
    Camera::new(DVec3::ZERO, towards, DVec3::Z, 1.0, SIZE_PX).fitted(&points)
}
