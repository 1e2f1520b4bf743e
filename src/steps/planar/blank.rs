//! Rays through the whole blank of a planar gear: uncut, and cut by all operations.

use super::PlanarGear;
use crate::steps::whole_blank;
use gearcut_core::cut::{Backend, BlankOperation, CutBlank};
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::GearKind;
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::passes::StrokeSet;
use gearcut_core::tool::closed_tooth::ClosedTooth;
use glam::DVec2;

impl PlanarGear<'_> {
    /// The uncut blank at the scene's spacing; see [`Self::blank_grid`].
    ///
    /// # Errors
    /// A field that does not fit in memory.
    pub fn blank_field(&self) -> Result<BlankField, Refusal> {
        whole_blank::field(self.scene, self.blank, self.one_slice())
    }

    /// Where its rays stand: in one slice, the middle of the face, where all sections are alike, and where the axes
    /// rest and slices may lie twice the face apart.
    ///
    /// # Errors
    /// A field that does not fit in memory.
    pub fn blank_grid(&self) -> Result<BlankGrid, Refusal> {
        whole_blank::grid(self.scene, self.blank, self.one_slice())
    }

    fn one_slice(&self) -> bool {
        let reaches_both_ends = self.scene.fields.blank_slice_spacing_mm >= 2.0 * self.scene.gear.face_width_mm;
        let is_straight = self.scene.gear.helix_angle_rad == 0.0;
        self.rows_are_alike() || self.rests() && reaches_both_ends && is_straight
    }

    /// The tool's teeth, one for each of its edges, closed through its body down to where no stroke of an operation
    /// brings the blank.
    pub fn closed_teeth(&self, strokes: &StrokeSet, blank_reach_mm: f64) -> Vec<ClosedTooth> {
        let mount_mm = self.tool.tool_from_blade(0).translation_mm;
        let axes_mm = (0..strokes.count()).flat_map(|stroke| strokes.poses(stroke)).map(|pose| pose.point(mount_mm));
        let smallest = |distances_mm: &mut dyn Iterator<Item = f64>| distances_mm.fold(f64::INFINITY, f64::min);
        let nearest_mm = match self.blank.kind() {
            GearKind::External => smallest(&mut axes_mm.map(DVec2::length)) - blank_reach_mm,
            GearKind::Internal => {
                let outline = BlankOutline::new(self.blank);
                smallest(&mut axes_mm.map(|axis_mm| outline.clearance_mm(axis_mm)))
            }
        };
        // Between the nodes of a moving stroke the tool comes no nearer than this by far.
        let closing_radius_mm = (nearest_mm - 1.0).max(0.0);
        self.tool.edges().edges().iter().map(|edge| ClosedTooth::new(edge, closing_radius_mm)).collect()
    }

    /// Runs all operations over the uncut blank; `returns` gives the poses of an operation's return strokes where they
    /// are to be checked. `advance` is called after every tile and says whether to go on. `None`: stopped.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_blank(
        &self,
        backend: &dyn Backend,
        field: BlankField,
        returns: impl Fn(usize) -> Option<StrokeSet>,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<CutBlank>> {
        let mut cut = CutBlank { blank_mm3: field.volumes_mm3(), field, left_mm3: Vec::new(), cuts: Vec::new() };
        let reach_mm = BlankOutline::new(self.blank).reach_mm();
        for (index, operation) in self.operations.iter().enumerate() {
            let teeth = self.closed_teeth(operation.strokes, reach_mm);
            let returns = returns(index);
            let operation = BlankOperation {
                strokes: operation.strokes,
                returns: returns.as_ref(),
                tool: self.tool,
                teeth: &teeth,
                blank_reach_mm: reach_mm,
                cull: true,
            };
            let Some(done) = backend.cut_blank(&mut cut.field, &operation, advance)? else { return Ok(None) };
            cut.cuts.push(done);
            cut.left_mm3.push(cut.field.volumes_mm3());
        }
        Ok(Some(cut))
    }
}
