//! What the blank field says about a hobbed gear: volumes counted twice, sections against the target's, damage to the
//! target.
//!
//! In: the job and its cut blank. Out: [`HobbedBlankReport`]. As in [`crate::steps::planar::blank_report`]; where the
//! teeth wind, the target's section differs from slice to slice and is made anew for each.
//!
//! A hob that cuts where it should not, the far side of a lobe or a neighbouring tooth, is found here. The rays of the
//! flanks end before they get there.

use crate::measure::damage::{self, Damage, EndFace, OperationVolume};
use crate::measure::gear_place::GearPlace;
use crate::measure::target_outline::TargetOutline;
use crate::process::hobbing::HobCutter;
use gearcut_core::cut::BlankStats;
use gearcut_core::cut::CutBlank;
use gearcut_core::math::planar_rays::FAMILIES;
use rayon::prelude::*;
use std::borrow::Cow;
use std::f64::consts::PI;

/// Distance of the target outline's points, mm: chords of a fillet of 0.8 mm then miss 0.25 um, a quarter of the least
/// damage that is reported.
const TARGET_SPACING_MM: f64 = 0.04;

/// Everything that the blank field says about a hobbed gear.
#[derive(Debug, Clone, PartialEq)]
pub struct HobbedBlankReport {
    /// Volume of the uncut blank, mm3, by both families.
    pub blank_mm3: [f64; 2],
    /// Volume that is left, mm3, by both families.
    pub left_mm3: [f64; 2],
    /// Operations in order.
    pub operations: Vec<OperationVolume>,
    /// Sections against the target's, means over the face.
    pub section: EndFace,
    /// Target material that the last operation took; `stroke` is the turn of the hob.
    pub gouges: Vec<Damage>,
    /// Target material that an earlier operation took.
    pub interference: Vec<Damage>,
    /// Work done.
    pub stats: BlankStats,
}

/// Report on a cut blank.
pub fn measure(cutter: &HobCutter, cut: &CutBlank) -> HobbedBlankReport {
    let job = cutter.job;
    let gear = &job.scene.gear;
    let grid = &cut.field.grid;
    let operation_of = |pass: u32| cutter.operations.iter().position(|o| (o.first_pass..o.end_pass()).contains(&pass));
    // One section stands for all of a spur gear.
    let straight = job.target.is_straight().then(|| job.target_outline(0.0, TARGET_SPACING_MM));
    let slices: Vec<_> = (0..cut.field.slices.len())
        .into_par_iter()
        .map(|slice| {
            let own = || Cow::Owned(job.target_outline(grid.slices_z_mm[slice], TARGET_SPACING_MM));
            let target: Cow<TargetOutline> = straight.as_ref().map_or_else(own, Cow::Borrowed);
            let bounds_mm2 = FAMILIES.map(|f| target.area_bound_mm2(f, grid.spacing_mm()));
            (target.area_mm2(), bounds_mm2, damage::missing_in_slice(&cut.field, slice, &target, gear, operation_of))
        })
        .collect();
    let width_mm = gear.face_width_mm;
    let (mut target_mm2, mut bound_mm2) = (0.0, [0.0; 2]);
    for ((area_mm2, bounds_mm2, _), slice_mm) in slices.iter().zip(grid.slice_widths_mm()) {
        target_mm2 += area_mm2 * slice_mm / width_mm;
        bound_mm2 = [0, 1].map(|f| bound_mm2[f] + bounds_mm2[f] * slice_mm / width_mm);
    }
    let bore_radius_mm = 0.5 * gear.bore_diameter_mm;
    let left_mm3 = cut.left_mm3.last().copied().unwrap_or(cut.blank_mm3);
    let section = EndFace {
        cut_mm2: left_mm3.map(|volume| volume / width_mm),
        target_mm2: target_mm2 - PI * bore_radius_mm * bore_radius_mm,
        bound_mm2: bound_mm2.map(|bound| bound + 2.0 * bore_radius_mm * grid.spacing_mm()),
    };
    let damage = damage::collect(
        gear,
        slices.into_iter().flat_map(|(_, _, findings)| findings),
        |finding| {
            let turned_mm = job.target.space_arc_mm(0, finding.z_mm);
            GearPlace::in_section(&job.blank, gear, finding.point_mm, turned_mm)
        },
        |operation, pass| {
            let (turn, blade) = cutter.operations[operation].blade_of(pass);
            (turn.max(0) as usize, blade)
        },
    );
    let last = job.operations.len() - 1;
    let (gouges, interference) = damage.into_iter().map(|(damage, _)| damage).partition(|d| d.operation == last);
    let mut stats = BlankStats::default();
    for done in &cut.cuts {
        stats += done.stats;
    }
    HobbedBlankReport {
        blank_mm3: cut.blank_mm3,
        left_mm3,
        operations: damage::volumes(cut),
        section,
        gouges,
        interference,
        stats,
    }
}
