//! The whole stock of a shaping job: its return strokes, and the target's section, with which the gear is compared.

use crate::job::ToothSection;
use crate::measure::target_outline::TargetOutline;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::linkage::CutterPose;
use crate::process::shaping::target::tip_relief::TipRelief;
use crate::process::shaping::target::{FlankEnd, TargetFlank};
use gearcut_core::cut::cpu::blank;
use gearcut_core::cut::{Backend, BlankCut, BlankOperation, CutBlank, Rub};
use gearcut_core::dexel::removal::RemovalWatch;
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::{Refusal, Result};
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::passes::StrokeSet;
use gearcut_core::passes::planar::strokes::StrokeLaw;
use gearcut_core::terms::Side;
use gearcut_core::units::TURN_RAD;
use glam::DVec2;
use rayon::prelude::*;

impl ShapingJob {
    /// Poses of the return strokes of an operation: the cutter drawn back out of the gear as its retraction says.
    /// `None` where the machine does not back off.
    ///
    /// An axis program moves the axes for the retraction itself, unless the machine's own relief does.
    pub fn return_strokes(&self, operation: usize) -> Option<StrokeSet> {
        self.return_strokes_at(operation, None)
    }

    /// The same in one section of a helical gear.
    fn return_strokes_at(&self, operation: usize, z_mm: Option<f64>) -> Option<StrokeSet> {
        let operation = &self.operations[operation];
        let back_off_mm = self.machine.back_off_mm;
        let out = self.blank.kind().tip_sign();
        let set = &operation.strokes;
        let (retraction, schedule) = (&operation.retraction, &operation.schedule);
        let resting = set.law.rests();
        let return_middle = self.ram_times().return_middle;
        let crank = self.machine.crank(self.scene.gear.face_width_mm);
        let pose = |lambda: f64, z_mm: f64| {
            let at_rest = if resting { crank.return_share(crank.tau(z_mm)) } else { 0.0 };
            let pose = operation.pose_at_rest(lambda, at_rest);
            let pose = if !retraction.is_in_axes() {
                let back = pose.center_mm.normalize_or_zero() * (out * back_off_mm);
                CutterPose { center_mm: pose.center_mm + back, ..pose }
            } else if operation.program.is_some() {
                // The axes draw back while the ram is outside the face.
                let (later, at_rest) = if resting { (return_middle, at_rest - return_middle) } else { (0.0, 0.0) };
                operation.pose_at_rest(lambda + later, at_rest)
            } else {
                retraction.retracted(schedule.linkage(), &pose, schedule.phi_rad(lambda))
            };
            operation.actual.placed(schedule, lambda, &pose, z_mm)
        };
        (back_off_mm > 0.0).then(|| match (&self.helix, z_mm) {
            (Some(helix), Some(z_mm)) => {
                let share = if resting { 0.0 } else { crank.return_share(crank.tau(z_mm)) };
                StrokeSet::new(set.first_pass, &self.cutter, StrokeLaw::Frozen, set.count(), |stroke| {
                    helix.guided(&pose(stroke + share, z_mm), z_mm)
                })
            }
            _ => StrokeSet::returning(set.first_pass, &self.cutter, set.law, set.count(), pose),
        })
    }

    /// Runs all operations over the uncut blank, their return strokes checked; `advance` is called after every tile and
    /// says whether to go on. `None`: stopped.
    ///
    /// # Errors
    /// The backend's.
    pub fn cut_blank(
        &self,
        backend: &dyn Backend,
        field: BlankField,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<CutBlank>> {
        if self.helix.is_some() {
            return self.cut_blank_along_helix(backend, field, advance);
        }
        self.planar().cut_blank(backend, field, |operation| self.return_strokes(operation), advance)
    }

    /// The same natively, return strokes left alone, every cut shown to `watch`.
    pub fn cut_blank_watched(&self, field: BlankField, watch: &RemovalWatch) {
        let reach_mm = BlankOutline::new(&self.blank).reach_mm();
        let cut = |field: &mut BlankField, strokes: &StrokeSet, first_slice: usize| {
            let teeth = self.planar().closed_teeth(strokes, reach_mm);
            let operation = BlankOperation {
                strokes,
                returns: None,
                tool: &self.cutter,
                teeth: &teeth,
                blank_reach_mm: reach_mm,
                cull: true,
            };
            let note = |slice, family, ray, ends| watch.note(first_slice + slice, family, ray, ends);
            // Nothing stops this, and what each pass removed is not needed.
            let _removed = blank::cut_watched(field, &operation, &|| true, &note);
        };
        if self.helix.is_none() {
            let mut field = field;
            self.operations.iter().for_each(|operation| cut(&mut field, &operation.strokes, 0));
            return;
        }
        let BlankField { grid, slices } = field;
        for (index, (slice, &z_mm)) in slices.into_iter().zip(&grid.slices_z_mm).enumerate() {
            let grid = BlankGrid { slices_z_mm: vec![0.0], ..grid.clone() };
            let mut alone = BlankField { grid, slices: vec![slice] };
            for operation in &self.operations {
                cut(&mut alone, &self.strokes_in_section(operation, z_mm), index);
            }
        }
    }

    /// Slice by slice, each with the poses that the guide gives the cutter there.
    fn cut_blank_along_helix(
        &self,
        backend: &dyn Backend,
        field: BlankField,
        advance: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<CutBlank>> {
        let blank_mm3 = field.volumes_mm3();
        let BlankField { grid, slices } = field;
        let operations = self.operations.len();
        let mut left_mm3 = vec![[0.0; 2]; operations];
        let mut cuts = vec![BlankCut::default(); operations];
        let mut done = Vec::with_capacity(slices.len());
        for (index, (slice, face_width_mm)) in slices.into_iter().zip(grid.slice_widths_mm()).enumerate() {
            let z_mm = grid.slices_z_mm[index];
            // A slice alone stands for its share of the face.
            let grid = BlankGrid { slices_z_mm: vec![0.0], face_width_mm, ..grid.clone() };
            let alone = BlankField { grid, slices: vec![slice] };
            let strokes: Vec<StrokeSet> =
                self.operations.iter().map(|operation| self.strokes_in_section(operation, z_mm)).collect();
            let returns = |operation| self.return_strokes_at(operation, Some(z_mm));
            let Some(cut) = self.planar_of(&strokes).cut_blank(backend, alone, returns, advance)? else {
                return Ok(None);
            };
            done.extend(cut.field.slices);
            for (all_mm3, own_mm3) in left_mm3.iter_mut().zip(cut.left_mm3) {
                *all_mm3 = [0, 1].map(|family| all_mm3[family] + own_mm3[family]);
            }
            for (all, own) in cuts.iter_mut().zip(cut.cuts) {
                all.stats += own.stats;
                all.rubs.extend(own.rubs.into_iter().map(|rub| Rub { slice: index as u32, ..rub }));
                all.removed_mm3.resize(own.removed_mm3.len(), [0.0; 2]);
                for (all_mm3, own_mm3) in all.removed_mm3.iter_mut().zip(own.removed_mm3) {
                    *all_mm3 = [0, 1].map(|family| all_mm3[family] + own_mm3[family]);
                }
            }
        }
        Ok(Some(CutBlank { field: BlankField { grid, slices: done }, blank_mm3, left_mm3, cuts }))
    }

    /// The target's transverse section at a height as a polygon with points `spacing_mm` apart; its error is the arrow
    /// height of so long a chord.
    ///
    /// # Errors
    /// A tooth without a flank, or one whose tip the cutter's base shapes: its outline is not known in closed form.
    pub fn target_outline(&self, z_mm: f64, spacing_mm: f64) -> Result<TargetOutline, Refusal> {
        let teeth: Vec<ToothSection> = (1..=self.scene.gear.teeth)
            .into_par_iter()
            .map(|tooth| self.tooth_in_section(tooth, z_mm, spacing_mm))
            .collect::<Result<_, _>>()?;
        let points_mm = teeth.iter().flat_map(ToothSection::outline_mm).collect();
        Ok(TargetOutline::new(points_mm, self.blank.back))
    }

    /// The target round a tooth, points about `spacing_mm` apart.
    ///
    /// # Errors
    /// A tip that the cutter's base shapes: its outline is not known in closed form.
    pub fn tooth_section(&self, tooth: u32, spacing_mm: f64) -> Result<ToothSection, Refusal> {
        let flanks = [Side::Right, Side::Left].map(|side| self.target_flank(tooth, side));
        let fillets = self.target_fillets(tooth).into_iter();
        let chains: Vec<_> = fillets.map(|(fillet, ends)| fillet.chain_mm(ends, spacing_mm)).collect();
        self.section_of(flanks, &chains, tooth, spacing_mm)
    }

    /// The target round a tooth from its flanks, right and left, and the chains of the root behind it.
    pub(in crate::process::shaping) fn section_of(
        &self,
        [right, left]: [&TargetFlank; 2],
        root_mm: &[Vec<DVec2>],
        tooth: u32,
        spacing_mm: f64,
    ) -> Result<ToothSection, Refusal> {
        let reliefs = [right, left].map(|flank| TipRelief::new(flank, &self.blank));
        for (flank, relief) in [right, left].into_iter().zip(&reliefs) {
            let known = match flank.tip_end {
                FlankEnd::CutterBase => relief.is_some(),
                end => end != FlankEnd::Undercut,
            };
            if !known {
                return Err(Refusal::new(
                    "tool.shaper_cutter",
                    format!(
                        "the tip of tooth {tooth} is shaped by the cutter's base; its target is not known in closed \
                        form"
                    ),
                    "use a smaller gear.addendum_coefficient or a cutter with more teeth",
                ));
            }
        }
        let along = |flank: &TargetFlank| -> Vec<DVec2> {
            let count = (flank.length_mm() / spacing_mm).ceil().max(1.0) as usize;
            (0..=count).map(|i| flank.at_arc(flank.length_mm() * i as f64 / count as f64).point_mm).collect()
        };
        let relieved = |relief: &Option<TipRelief>| relief.as_ref().map_or(Vec::new(), |r| r.points_mm(spacing_mm));
        let [right_tip, left_tip] = reliefs.each_ref().map(relieved);
        let mut points = along(right);
        points.extend(&right_tip);
        if left.tip_end != FlankEnd::PointedTip && right.tip_end != FlankEnd::PointedTip {
            let foot = |flank: &TargetFlank, tip_mm: &[DVec2]| {
                let tip = flank.at_arc(flank.length_mm());
                self.blank.height(tip_mm.last().copied().unwrap_or(tip.point_mm), tip.phi_rad).1
            };
            let (from, to) = (foot(right, &right_tip), foot(left, &left_tip));
            // Tips lie within a tooth of each other, but contact angles may be a turn apart.
            let to = from + (to - from).rem_euclid(TURN_RAD);
            let land = |phi: f64| self.blank.outline_mm(phi);
            let count = (land(from).distance(land(to)) / spacing_mm).ceil().max(1.0) as usize;
            points.extend((1..count).map(|i| land(from + (to - from) * i as f64 / count as f64)));
        }
        points.extend(left_tip.into_iter().rev());
        points.extend(along(left).into_iter().rev());
        let dwell_mm: Vec<DVec2> = self.dwell_mm(tooth, spacing_mm).iter().map(|[point, _]| *point).collect();
        Ok(ToothSection { tooth_mm: points, root_mm: root_mm.join(&dwell_mm[..]) })
    }
}
