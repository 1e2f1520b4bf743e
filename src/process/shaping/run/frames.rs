//! Shaping as frames show it: the section stroke by stroke, the cutter at the upper end of its stroke, above the face,
//! where it hides nothing.

use crate::process::shaping::ShapingJob;
use crate::process::shaping::cut::section::{CutSection, cutter_contours};
use crate::steps::frames::section::SectionByStep;
use gearcut_core::dexel::BlankField;
use gearcut_core::error::Result;
use glam::DVec2;

/// Height of the drawn cutter, in half face widths.
const HEIGHT: f64 = 0.6;

/// A job and its section.
pub struct ShapedFrames<'a>(pub &'a ShapingJob, pub CutSection<'a>);

impl SectionByStep for ShapedFrames<'_> {
    fn steps(&self) -> usize {
        CutSection::strokes(self.0)
    }

    fn advance(&mut self, until: usize) -> Result<()> {
        self.1.advance(until);
        Ok(())
    }

    fn field(&self) -> &BlankField {
        self.1.field()
    }

    fn axis_mm(&self, step: usize) -> DVec2 {
        CutSection::work_from_tool(self.0, step).translation_mm
    }

    fn tool_mm(&self, step: usize) -> Result<Vec<Vec<Vec<DVec2>>>> {
        Ok(vec![cutter_contours(self.0, &CutSection::work_from_tool(self.0, step))])
    }

    fn tool_z_mm(&self) -> [f64; 2] {
        let half_mm = 0.5 * self.0.scene.gear.face_width_mm;
        let above_mm = half_mm + self.0.machine.approach_mm;
        [above_mm, above_mm + HEIGHT * half_mm]
    }

    fn title(&self, until: usize) -> String {
        let (operation, stroke) = CutSection::operation_and_stroke(self.0, until.saturating_sub(1));
        let operation = &self.0.operations[operation];
        let after = if until == 0 { 0 } else { stroke + 1 };
        format!("{}: stroke {after} of {}", operation.spec.name, operation.strokes.count())
    }
}
