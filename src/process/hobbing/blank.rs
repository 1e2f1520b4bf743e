//! The blank field of a hobbing job: rays through the whole stock, cut by the sweeps of all operations; the target's
//! section at any height.

use super::{HobCutter, HobbingJob};
use crate::job::ToothSection;
use crate::measure::target_outline::TargetOutline;
use crate::process::hobbing::rack_generation::FormPoint;
use crate::steps::whole_blank;
use gearcut_core::cut::Backend;
use gearcut_core::cut::CutBlank;
use gearcut_core::cut::cpu::blank_sweeps;
use gearcut_core::cut::sweep_chips::PassChip;
use gearcut_core::dexel::removal::RemovalWatch;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::math::roots::halve;
use gearcut_core::passes::sections::swept_sections::SweptSections;
use gearcut_core::passes::spatial::turning_passes::BladePass;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;

/// The whole gear after all operations, and every chip.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbedBlank {
    /// What is left.
    pub cut: CutBlank,
    /// What the passes of each operation took.
    pub chips: Vec<Vec<PassChip>>,
    /// The same slice by slice; empty where the scene names neither material nor wear, which alone take it.
    pub in_slices: Vec<Vec<PassChip>>,
}

impl HobbingJob {
    /// Where the rays stand.
    ///
    /// # Errors
    /// A field that does not fit in memory.
    pub fn blank_grid(&self) -> Result<BlankGrid, Refusal> {
        whole_blank::grid(&self.scene, &self.stock, false)
    }

    /// The uncut blank at the scene's spacing.
    ///
    /// # Errors
    /// A field that does not fit in memory.
    pub fn blank_field(&self) -> Result<BlankField, Refusal> {
        whole_blank::field(&self.scene, &self.stock, false)
    }

    /// The target's section at `z_mm` as a polygon with points `spacing_mm` apart; its error is the arrow height of so
    /// long a chord.
    pub fn target_outline(&self, z_mm: f64, spacing_mm: f64) -> TargetOutline {
        let teeth = i64::from(self.scene.gear.teeth);
        if let Some(rack) = &self.drawn {
            let sections: Vec<ToothSection> =
                (1..=teeth).into_par_iter().map(|tooth| rack.tooth_section(tooth, z_mm, spacing_mm)).collect();
            return TargetOutline::new(sections.iter().flat_map(ToothSection::outline_mm).collect(), self.blank.back);
        }
        // Right flanks of a space belong to the root of one tooth and to the flank of the next.
        let right_forms: Vec<FormPoint> =
            (0..=teeth).into_par_iter().map(|space| self.right_form(space, z_mm)).collect();
        let teeth: Vec<ToothSection> = (1..=teeth)
            .into_par_iter()
            .map(|tooth| {
                let right_forms = [tooth - 1, tooth].map(|space| &right_forms[space as usize]);
                self.tooth_outline(tooth, right_forms, z_mm, spacing_mm)
            })
            .collect();
        let points_mm = teeth.iter().flat_map(ToothSection::outline_mm).collect();
        TargetOutline::new(points_mm, self.blank.back)
    }

    /// The target round a tooth at `z_mm`, points about `spacing_mm` apart.
    pub fn tooth_section(&self, tooth: u32, z_mm: f64, spacing_mm: f64) -> ToothSection {
        let tooth = i64::from(tooth);
        if let Some(rack) = &self.drawn {
            return rack.tooth_section(tooth, z_mm, spacing_mm);
        }
        let [before, behind] = [tooth - 1, tooth].map(|space| self.right_form(space, z_mm));
        self.tooth_outline(tooth, [&before, &behind], z_mm, spacing_mm)
    }

    fn right_form(&self, space: i64, z_mm: f64) -> FormPoint {
        self.target.form_point(&self.blank, space, Side::Right, z_mm)
    }

    /// Right flank, tip land, left flank and the root behind a tooth, counter-clockwise. Flanks begin where the fillet
    /// meets them, undercut or not; `right_forms` are those of the right flanks in the spaces before and behind the
    /// tooth.
    fn tooth_outline(&self, tooth: i64, right_forms: [&FormPoint; 2], z_mm: f64, spacing_mm: f64) -> ToothSection {
        let target = &self.target;
        let steps = |length_mm: f64| (length_mm.abs() / spacing_mm).ceil().max(1.0) as usize;
        let between =
            |from: f64, to: f64, count: usize| (0..=count).map(move |i| from + (to - from) * i as f64 / count as f64);
        // From the tip corner to the blank's outline, as rolls.
        let flank = |space: i64, side: Side, form: &FormPoint| -> Vec<DVec2> {
            let at = |roll_mm: f64| target.flank_contact(space, side, roll_mm, z_mm);
            let stands_out = |roll_mm: f64| {
                let contact = at(roll_mm);
                self.blank.height(contact.point_mm.truncate(), contact.phi_rad).0 - self.blank.addendum_mm
            };
            let root_mm = form.roll_mm;
            let beyond = target.roll_beyond_mm(side, |roll| stands_out(roll) >= 0.0);
            let [_, outside] = halve(|roll| stands_out(roll) < 0.0, 0.0, beyond, 60);
            between(root_mm, outside, steps(outside - root_mm)).map(|roll| at(roll).point_mm.truncate()).collect()
        };
        let corner = |space: i64, side: Side, form: &FormPoint| -> Vec<DVec2> {
            let top = form.corner_lean;
            // A sharp corner's path bends most where it begins at the bottom.
            let count = 2 * steps(target.corner_length_mm(top));
            between(0.0, top, count).map(|lean| target.corner_contact(space, side, lean, z_mm).point_mm).collect()
        };
        let left_form = target.form_point(&self.blank, tooth, Side::Left, z_mm);
        let mut points = flank(tooth - 1, Side::Right, right_forms[0]);
        let left = flank(tooth, Side::Left, &left_form);
        let foot = |p: DVec2| self.blank.height(p, p.to_angle()).1;
        let from = foot(points[points.len() - 1]);
        let to = from + (foot(left[left.len() - 1]) - from).rem_euclid(TURN_RAD);
        let land_mm = points[points.len() - 1].distance(left[left.len() - 1]);
        let count = steps(land_mm);
        points.extend(between(from, to, count).skip(1).take(count - 1).map(|phi| self.blank.outline_mm(phi)));
        points.extend(left.into_iter().rev());
        let mut root_mm = corner(tooth, Side::Left, &left_form);
        root_mm.reverse();
        // The bottom: the rack's tip line rolls along under the pitch curve.
        let ends = [Side::Left, Side::Right].map(|side| target.corner_bottom_arc_mm(tooth, side, z_mm));
        let count = steps(ends[1] - ends[0]);
        root_mm.extend(between(ends[0], ends[1], count).skip(1).take(count - 1).map(|arc| {
            let frame = self.curve.frame(self.curve.phi_at_arc(arc));
            frame.point_mm - target.rack.tip_height_mm * frame.normal
        }));
        root_mm.extend(corner(tooth, Side::Right, right_forms[1]));
        ToothSection { tooth_mm: points, root_mm }
    }
}

impl HobCutter<'_> {
    /// Passes of an operation as sections; all of them if not `cull`.
    ///
    /// # Errors
    /// None for hobs: their teeth look away from their axis.
    pub fn sections(&self, operation: usize, cull: bool) -> Result<SweptSections, Refusal> {
        self.some_sections(operation, cull, |_| true)
    }

    /// The same of so many passes in the middle of the operation.
    ///
    /// # Errors
    /// As [`Self::sections`].
    pub(super) fn middle_sections(&self, operation: usize, count: u32) -> Result<SweptSections, Refusal> {
        let passes = &self.operations[operation];
        let first = passes.first_pass + passes.count().saturating_sub(count) / 2;
        self.some_sections(operation, true, |pass| (first..first + count).contains(&pass.pass))
    }

    /// The same of the passes that go through tooth spaces of these numbers, counted as the teeth before them.
    ///
    /// # Errors
    /// As [`Self::sections`].
    pub fn sections_in_spaces(&self, operation: usize, spaces: &[i64]) -> Result<SweptSections, Refusal> {
        let hob = &self.job.hob;
        let passes = &self.operations[operation];
        let [teeth, starts, gashes] = [self.job.scene.gear.teeth, hob.starts, hob.gashes].map(f64::from);
        self.some_sections(operation, true, |pass| {
            let tooth = &hob.teeth[passes.places[pass.rank as usize].blade as usize];
            // Whole turns since the tooth's own passage: each carries its thread one start further.
            let turns = (pass.tool_angle_rad / TURN_RAD - tooth.passage as f64 / gashes).round();
            let space = f64::from(tooth.start) + starts * turns;
            spaces.iter().any(|&of| (space - of as f64).rem_euclid(teeth) == 0.0)
        })
    }

    fn some_sections(
        &self,
        operation: usize,
        cull: bool,
        wanted: impl Fn(&BladePass) -> bool + Sync,
    ) -> Result<SweptSections, Refusal> {
        let reach_mm = BlankOutline::new(&self.job.stock).reach_mm();
        let face_width_mm = self.job.scene.gear.face_width_mm;
        SweptSections::new(wanted, &self.operations[operation], reach_mm, face_width_mm, cull)
    }

    /// Runs all operations over the uncut blank; `advance` is called as often as there are slices, in every operation,
    /// and says whether to go on. `None`: stopped.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_blank(
        &self,
        backend: &dyn Backend,
        field: BlankField,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<HobbedBlank>> {
        let mut cut = CutBlank { blank_mm3: field.volumes_mm3(), field, left_mm3: Vec::new(), cuts: Vec::new() };
        let (mut chips, mut in_slices) = (Vec::new(), Vec::new());
        for (index, passes) in self.operations.iter().enumerate() {
            let sections = self.sections(index, true)?;
            let ids = passes.first_pass..passes.end_pass();
            let Some(done) = backend.cut_blank_sweeps(&mut cut.field, &sections, ids, advance)? else {
                return Ok(None);
            };
            cut.cuts.push(done.cut);
            chips.push(done.chips);
            if self.job.material.is_some() || self.job.wear.is_some() {
                in_slices.push(done.in_slices);
            }
            cut.left_mm3.push(cut.field.volumes_mm3());
        }
        Ok(Some(HobbedBlank { cut, chips, in_slices }))
    }

    /// The same natively, every cut shown to `watch`.
    ///
    /// # Errors
    /// As of [`Self::sections`].
    pub fn cut_blank_watched(&self, mut field: BlankField, watch: &RemovalWatch) -> Result<(), Refusal> {
        let note = |slice, family, ray, ends| watch.note(slice, family, ray, ends);
        for (index, passes) in self.operations.iter().enumerate() {
            let sections = self.sections(index, true)?;
            let ids = passes.first_pass..passes.end_pass();
            // Nothing stops this, and the chips of so few slices are not asked for.
            let _chips = blank_sweeps::cut_watched(&mut field, &sections, ids, &|| true, &note);
        }
        Ok(())
    }
}
