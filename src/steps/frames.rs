//! The cut as it happens: frames of the work and the tool, evenly spread over all steps of all operations.
//!
//! In: a cut that can be followed step by step in the transverse section in the middle of the face ([`CutByStep`]):
//! strokes of a shaper cutter, passes of hob teeth. Out: pictures, and an animation of all of them.
//!
//! Every frame shows the work after exactly the steps before it, none left out: the section, drawn as a body over the
//! whole face. Work and tool lie as on the machine: the line of centres stays, the gear and the tool turn. The tool
//! is drawn above the face; its height is a drawing's, not the tool's.

use super::Tools;
use crate::output::apng::{AnimationFrame, write_apng};
use crate::output::render_png::{RenderPicture, draw_frame, write_frame};
use crate::surface::BlankMesh;
use crate::surface::mesh::Mesh;
use crate::surface::prism::prism;
use crate::surface::render::{Bodies, CLAY, Camera, Lights, STEEL, Shape, render};
use gearcut_core::dexel::BlankField;
use gearcut_core::error::{Error, Result};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Size of a frame without its title.
const SIZE_PX: (u32, u32) = (720, 540);
/// Time that a frame stays, and the last one, ms.
const FRAME_MS: u16 = 100;
const HOLD_MS: u16 = 2000;
/// Steps at which the tool is looked at so that the camera holds it through all of them.
const CAMERA_STEPS: usize = 40;

/// A cut that can be followed step by step in the middle of the face.
pub trait CutByStep {
    /// Steps of all operations together.
    fn steps(&self) -> usize;

    /// Cuts all steps before step `until`.
    ///
    /// # Errors
    /// The cut's.
    fn advance(&mut self, until: usize) -> Result<()>;

    /// What is left: one slice over the whole face.
    fn field(&self) -> &BlankField;

    /// The tool's axis at a step, where it goes through the section; gear frame, mm.
    fn axis_mm(&self, step: usize) -> DVec2;

    /// The tool in the section at a step, part by part: contours, counter-clockwise outside and clockwise round holes;
    /// gear frame, mm.
    ///
    /// # Errors
    /// A tool without sections.
    fn tool_mm(&self, step: usize) -> Result<Vec<Vec<Vec<DVec2>>>>;

    /// Heights between which the tool is drawn, from the middle of the face, mm.
    fn tool_z_mm(&self) -> [f64; 2];

    /// Operation and number of the last step before `until`.
    fn title(&self, until: usize) -> String;
}

/// Draws `count` frames into `frames/frame_0001.png` and so on, and all of them into `frames/cut.apng`; whether all of
/// them were finished before Ctrl-C.
///
/// # Errors
/// The cut's; files that cannot be written.
pub fn draw(cut: &mut dyn CutByStep, name: &str, count: u32, tools: &Tools) -> Result<bool> {
    let Tools { progress, interrupt, folder, .. } = *tools;
    let step = progress.step("frames", u64::from(count), "frames");
    let steps = cut.steps();
    let camera = camera(cut)?;
    let mut frames: Vec<AnimationFrame> = Vec::new();
    for index in 0..count {
        // The first frame is the blank, the last one the finished gear.
        let until = (steps as u64 * u64::from(index) / u64::from(count.max(2) - 1)) as usize;
        cut.advance(until)?;
        let now = until.min(steps - 1);
        let work = section_body(cut.field(), machine_from_gear(cut, now));
        let tool = tool(cut, now)?;
        let shape = Shape::new(std::iter::once(&work).chain(&tool).collect());
        let materials = std::iter::once(CLAY).chain(tool.iter().map(|_| STEEL)).collect();
        let bodies = Bodies::new(&shape, materials);
        let rendered = match render(&bodies, &camera, &Lights::studio(&camera), interrupt) {
            Ok(rendered) => rendered,
            Err(Error::Interrupted) => break,
            Err(other) => return Err(other),
        };
        let page = RenderPicture {
            title: &format!("{name}, {}", cut.title(until)),
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
    let drawn = frames.len() as u32;
    if drawn < count {
        progress.note(&format!("stopped: {drawn} of {count} frames are drawn"));
    }
    Ok(drawn == count)
}

/// A section as a body over the whole face, turned about the gear's axis.
pub fn section_body(field: &BlankField, turn: DVec2) -> Mesh {
    let mut body = BlankMesh::new(field, None).mesh;
    for position in &mut body.positions_mm {
        *position = turn.rotate(position.truncate()).extend(position.z);
    }
    body
}

/// The tool at a step, part by part, in the machine.
fn tool(cut: &dyn CutByStep, step: usize) -> Result<Vec<Mesh>> {
    let machine_from_gear = machine_from_gear(cut, step);
    let mut parts = cut.tool_mm(step)?;
    parts.iter_mut().flatten().flatten().for_each(|point| *point = machine_from_gear.rotate(*point));
    Ok(parts.iter().map(|contours| prism(contours, cut.tool_z_mm())).collect())
}

/// Turn from the gear frame into the machine, where the tool's axis lies at positive x, as a unit vector.
fn machine_from_gear(cut: &dyn CutByStep, step: usize) -> DVec2 {
    let along = cut.axis_mm(step).normalize_or(DVec2::X);
    DVec2::new(along.x, -along.y)
}

/// A camera that holds work and tool through all steps.
fn camera(cut: &dyn CutByStep) -> Result<Camera> {
    let mut points: Vec<DVec3> = Vec::new();
    for look in 0..=CAMERA_STEPS {
        let step = (cut.steps() - 1) * look / CAMERA_STEPS;
        points.extend(tool(cut, step)?.into_iter().flat_map(|part| part.positions_mm));
    }
    let work = section_body(cut.field(), DVec2::X);
    let radius_mm = work.positions_mm.iter().map(|at| at.truncate().length()).fold(0.0, f64::max);
    let ring = |z: f64| (0..24).map(move |i| (radius_mm * DVec2::from_angle(f64::from(i) * TAU / 24.0)).extend(z));
    for z_mm in work.positions_mm.iter().map(|at| at.z).fold([0.0_f64; 2], |[low, high], z| [low.min(z), high.max(z)]) {
        points.extend(ring(z_mm));
    }
    let towards = Camera::direction(DVec3::NEG_Y, DVec3::X, 0.0, 0.85);
    Ok(Camera::new(DVec3::ZERO, towards, DVec3::Z, 1.0, SIZE_PX).fitted(&points))
}
