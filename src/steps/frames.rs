//! The cut as it happens: frames of the work and the tool, evenly spread over all steps of all operations.
//!
//! In: a cut that can be followed step by step ([`CutByStep`]): strokes of a shaper cutter, passes of hob teeth or of
//! the blades of a head. Out: pictures, and an animation of all of them.
//!
//! Every frame shows the work after exactly the steps before it, none left out. Cylindrical gears are followed in the
//! transverse section in the middle of the face ([`section`]).

pub mod section;

use super::Tools;
use crate::output::apng::{AnimationFrame, write_apng};
use crate::output::render_png::{RenderPicture, draw_frame, write_frame};
use crate::surface::mesh::Mesh;
use crate::surface::render::{Bodies, CLAY, Camera, Lights, STEEL, Shape, render};
use gearcut_core::error::{Error, Result};

/// Size of a frame without its title.
pub const SIZE_PX: (u32, u32) = (720, 540);
/// Time that a frame stays, and the last one, ms.
const FRAME_MS: u16 = 100;
const HOLD_MS: u16 = 2000;

/// A cut that can be followed step by step.
pub trait CutByStep {
    /// Steps of all operations together.
    fn steps(&self) -> usize;

    /// Cuts all steps before step `until`, which never goes back.
    ///
    /// # Errors
    /// The cut's.
    fn advance(&mut self, until: usize) -> Result<()>;

    /// The work after the steps so far, as it lies at a step.
    ///
    /// # Errors
    /// Geometry.
    fn work(&self, step: usize) -> Result<Mesh>;

    /// The tool at a step, part by part.
    ///
    /// # Errors
    /// A tool without sections.
    fn tool(&self, step: usize) -> Result<Vec<Mesh>>;

    /// A camera that holds all of the cut, for pictures of [`SIZE_PX`].
    ///
    /// # Errors
    /// As of work and tool.
    fn camera(&self) -> Result<Camera>;

    /// Operation and number of the last step before `until`.
    fn title(&self, until: usize) -> String;

    /// What is seen.
    fn note(&self) -> &'static str;
}

/// Operation and place among its own of a step that is counted over all operations, of so many steps each; the last one
/// where there are no more.
pub fn place(steps: impl Iterator<Item = usize>, step: usize) -> (usize, usize) {
    let (mut rest, mut last) = (step, (0, 0));
    for (operation, steps) in steps.enumerate() {
        if rest < steps {
            return (operation, rest);
        }
        (rest, last) = (rest - steps, (operation, steps.saturating_sub(1)));
    }
    last
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
    let camera = cut.camera()?;
    let mut frames: Vec<AnimationFrame> = Vec::new();
    for index in 0..count {
        // The first frame is the blank, the last one the finished gear.
        let until = (steps as u64 * u64::from(index) / u64::from(count.max(2) - 1)) as usize;
        cut.advance(until)?;
        let now = until.min(steps - 1);
        let (work, tool) = (cut.work(now)?, cut.tool(now)?);
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
            note: cut.note(),
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
