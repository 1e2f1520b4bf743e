//! Surfaces of a shaped gear, as meshes, pictures and texture ask for them.
//!
//! Roots and tips are coarse fields of their own: roots along the normals of the target's fillet, tips along the
//! normals of the pitch curve.

use crate::findings::Notice;
use crate::job::{
    CylindricalGear, GearJob, ToolSection, ToothFrame, ToothSection, TrialBlank, rows_z_mm, teeth_of_extreme_radius,
};
use crate::measure::round_gear::{RoundGear, ToothEnds, is_round};
use crate::measure::thickness::Thickness;
use crate::process::shaping::cut::section::{CutSection, cutter_outline};
use crate::process::shaping::cut::stroke_noise;
use crate::process::shaping::gear::measure::flank_report;
use crate::process::shaping::job::{PreparedOperation, ShapingJob};
use crate::process::shaping::sections::GearPart;
use crate::scene::Scene;
use crate::surface::SurfaceGrid;
use crate::surface::flanks::points_of_sections;
use crate::surface::triangles::SectionProfile;
use gearcut_core::cut::Backend;
use gearcut_core::dexel::{BlankField, Layer, Ray};
use gearcut_core::error::Result;
use gearcut_core::frame::Rigid2;
use gearcut_core::gear::PitchCurve;
use gearcut_core::gear::blank::Blank;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Distance of the sections that show a helical gear's shape, mm: chords a micrometre off a helix of 20 deg on a radius
/// of 60 mm.
const VIEW_SECTION_MM: f64 = 5.0;

/// Strokes over the blank in a trial.
const TRIAL_STROKES: usize = 256;

impl GearJob for ShapingJob {
    fn scene(&self) -> &Scene {
        &self.scene
    }

    fn operations(&self) -> Vec<(&str, f64)> {
        self.operations.iter().map(|o| (o.spec.name.as_str(), o.spec.offset_mm)).collect()
    }

    fn passes(&self) -> u32 {
        self.operations.last().map_or(0, |operation| operation.strokes.end_pass())
    }

    fn pass_time_s(&self, pass: u32) -> f64 {
        let at = self.operations.partition_point(|operation| operation.strokes.end_pass() <= pass);
        let PreparedOperation { strokes, schedule, actual, .. } = &self.operations[at];
        let (stroke, _) = strokes.stroke_and_blade(pass);
        actual.start_s() + schedule.time_s(stroke as f64)
    }

    fn unfollowed_errors(&self) -> Vec<Notice> {
        stroke_noise::warnings(self)
    }

    fn marks_follow(&self, operation: usize) -> [bool; 2] {
        [self.operations[operation].spec.feed_during_stroke || self.helix.is_some(), true]
    }

    /// Strokes in the middle of the last operation; of a helical gear in the middle of the face.
    fn trial_blank(&self) -> Result<Option<TrialBlank<'_>>> {
        let Some(last) = self.operations.last() else { return Ok(None) };
        let strokes = if self.helix.is_some() { self.strokes_in_section(last, 0.0) } else { last.strokes.clone() };
        let first = strokes.count().saturating_sub(TRIAL_STROKES) / 2;
        let some = vec![strokes.some(first..strokes.count().min(first + TRIAL_STROKES))];
        let mut uncut = self.planar().blank_field()?;
        if self.helix.is_some() {
            // One slice is cut in place of all.
            uncut.slices.truncate(1);
            uncut.grid.slices_z_mm = vec![0.0];
        }
        let cut = move |backend: &dyn Backend, blank: BlankField| {
            self.planar_of(&some).cut_blank(backend, blank, |_| None, &|| true).map(drop)
        };
        Ok(Some(TrialBlank { uncut, cut: Box::new(cut) }))
    }

    fn profile_length_mm(&self, tooth: u32, side: Side) -> Result<f64> {
        Ok(self.target_flank(tooth, side).length_mm())
    }

    fn evaluated_profile_mm(&self, tooth: u32, side: Side) -> Result<[f64; 2]> {
        Ok(flank_report::evaluated_profile_mm(self, self.target_flank(tooth, side)))
    }

    fn rolls_mm(&self, tooth: u32, side: Side, arcs_mm: &[f64]) -> Result<Vec<f64>> {
        Ok(self.target_flank(tooth, side).rolls_mm(&self.blank, arcs_mm))
    }

    fn teeth_that_differ_most(&self) -> Vec<u32> {
        teeth_of_extreme_radius(&self.curve, self.scene.gear.teeth)
    }

    fn tooth_frame(&self, tooth: u32) -> ToothFrame {
        ToothFrame::of_cylinder(&self.blank, &self.scene.gear, tooth)
    }

    fn target_points(&self, tooth: u32, side: Side, arcs_mm: &[f64], rows_mm: &[f64]) -> Result<Vec<Vec<Ray>>> {
        self.target_in_space(tooth, side, arcs_mm, rows_mm)
    }

    fn cut_flank(
        &self,
        backend: &dyn Backend,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<Layer>> {
        let field = self.field_over(self.target_flank(tooth, side), arcs_mm.iter().copied(), rows_z_mm.to_vec());
        Ok(self.cut_on(backend, GearPart::Flank(tooth, side), field)?.layers)
    }

    fn cylindrical(&self) -> Option<&dyn CylindricalGear> {
        Some(self)
    }
}

impl CylindricalGear for ShapingJob {
    fn curve(&self) -> &PitchCurve {
        &self.curve
    }

    fn blank(&self) -> &Blank {
        &self.blank
    }

    fn round_gear(&self) -> Result<Option<RoundGear>> {
        // Sizes of involute teeth: a drawn tooth cuts others.
        if self.cutter.involute().is_none() {
            return Ok(None);
        }
        let tooth = self.target(1);
        let [left, right] = [Side::Left, Side::Right].map(|side| tooth.pitch_crossing(side));
        let (Some(left), Some(right), true) = (left, right, is_round(&self.curve)) else { return Ok(None) };
        let flank = tooth.flank(Side::Left);
        let involute_mm = [0.0, flank.length_mm()].map(|arc_mm| 2.0 * flank.at_arc(arc_mm).point_mm.length());
        let finishing = self.finishing();
        let center_mm = finishing.linkage.pose(0.0, finishing.spec.offset_mm).center_mm.length();
        let root_mm = 2.0 * (center_mm - self.blank.kind().tip_sign() * self.cutter.tip_radius_mm);
        let thickness_mm = Thickness::between(left, right).arc_mm;
        Ok(Some(RoundGear::new(&self.scene.gear, ToothEnds { root_mm, involute_mm }, thickness_mm)))
    }

    fn view_rows_z_mm(&self) -> Vec<f64> {
        let spacing_mm = if self.helix.is_some() { VIEW_SECTION_MM } else { f64::INFINITY };
        rows_z_mm(self.scene.gear.face_width_mm, spacing_mm)
    }

    fn target_profiles(
        &self,
        tooth: u32,
        side: Side,
        arcs_mm: &[f64],
        rows_z_mm: &[f64],
    ) -> Result<Vec<SectionProfile>> {
        let profile = |z_mm: f64| -> Result<SectionProfile> {
            let target = self.flank_in_section(tooth, side, z_mm)?;
            let places = arcs_mm.iter().map(|&arc| target.at_arc(arc));
            let normal = |of: DVec2| self.helix.map_or(of.extend(0.0), |helix| helix.flank_normal(side, of));
            Ok(places.map(|place| (place.point_mm, normal(place.normal))).collect())
        };
        if self.helix.is_none() {
            return Ok(vec![profile(0.0)?; rows_z_mm.len()]);
        }
        rows_z_mm.iter().map(|&z_mm| profile(z_mm)).collect()
    }

    fn target_roots(&self, space: u32, spacing_mm: f64, rows_z_mm: &[f64]) -> Result<Vec<SectionProfile>> {
        if self.helix.is_some() {
            let in_section = |&z_mm: &f64| {
                let points = self.root_in_section(space, spacing_mm, z_mm)?;
                Ok(points.iter().map(|point| (point.point_mm, point.normal.extend(0.0))).collect())
            };
            return rows_z_mm.iter().map(in_section).collect();
        }
        let points = self.target_fillets(space).into_iter().map(|(fillet, ends)| fillet.points(ends, spacing_mm));
        let halves: Vec<SectionProfile> = points
            .map(|points| points.iter().map(|point| (point.point_mm, point.normal.extend(0.0))).collect())
            .collect();
        let dwell = self.dwell_mm(space, spacing_mm).into_iter().map(|[point, normal]| (point, normal.extend(0.0)));
        let profile: SectionProfile = halves.join(&dwell.collect::<Vec<_>>()[..]);
        Ok(vec![profile; rows_z_mm.len()])
    }

    fn cut_root(
        &self,
        backend: &dyn Backend,
        space: u32,
        spacing_mm: f64,
        rows_z_mm: &[f64],
    ) -> Result<Vec<Vec<DVec2>>> {
        let mut field = self.planar().root_field(&self.target_root(space, spacing_mm));
        field.rows_z_mm = rows_z_mm.to_vec();
        let cut = self.cut_on(backend, GearPart::Root(space, spacing_mm), field)?;
        let mut sections =
            points_of_sections(&self.in_space(GearPart::Root(space, spacing_mm), cut.field)?, &cut.layers);
        let dwell_mm: Vec<DVec2> = self.dwell_mm(space, spacing_mm).iter().map(|[point, _]| *point).collect();
        if let [(last, ends), _] = &self.target_fillets(space)[..] {
            let half = last.points(*ends, spacing_mm).len();
            for points in &mut sections {
                points.splice(half..half, dwell_mm.iter().copied());
            }
        }
        Ok(sections)
    }

    fn target_section(&self, tooth: u32, z_mm: f64, spacing_mm: f64) -> Result<ToothSection> {
        Ok(self.tooth_in_section(tooth, z_mm, spacing_mm)?)
    }

    fn tool_section(&self, chord_mm: f64) -> ToolSection {
        let words = format!(
            "shaper cutter of {} teeth, profile projected along the stroke, origin on its axis",
            self.cutter.teeth
        );
        ToolSection { points_mm: cutter_outline(self, chord_mm), is_closed: true, words }
    }

    fn tool_places(&self) -> Vec<Rigid2> {
        (0..CutSection::strokes(self)).map(|stroke| CutSection::work_from_tool(self, stroke)).collect()
    }

    fn errors_vary_along_tooth(&self) -> bool {
        // A feed that goes on during the stroke moves marks from section to section, and nothing else.
        let differ = |operation: &PreparedOperation| operation.actual.differs_along_tooth();
        self.operations.iter().any(differ) || self.vibrates() || self.cutter_spec.built_up_edge.is_some()
    }

    fn tip_surface(&self, backend: &dyn Backend, tooth: u32) -> Result<Option<SurfaceGrid>> {
        let Some(field) = self.planar().tip_field(self.tip_feet(tooth, 0.0)?) else { return Ok(None) };
        let cut = self.cut_on(backend, GearPart::Tip(tooth), field)?;
        let rays = self.in_space(GearPart::Tip(tooth), cut.field)?;
        Ok(Some(SurfaceGrid::new(&rays, &cut.layers, self.scene.output.mesh_spacing_mm)))
    }
}
