//! What the blank field says about the whole gear: volumes counted twice, damage to the target, return strokes that
//! rub.
//!
//! In: the gear and its cut blank. Out: [`BlankReport`].
//!
//! * **Balance.** The volume that the passes removed, summed pass by pass, against what is missing from the rays; the
//!   section that is left against the area of the target's outline, which comes from the meshing condition and knows
//!   neither rays nor strokes.
//! * **Gouges and interference.** Material of the target that is not there, deeper than
//!   [`crate::measure::damage::LEAST_DEPTH_MM`]: a gouge if the last operation took it, interference if an earlier one
//!   did. Strokes only approach the target from outside, so a clean cut shows none at any number of strokes.
//! * **Rubbing.** Material that the cutter enters on its way back; on surfaces that stay, or on stock that a later
//!   stroke takes away.

use super::PlanarGear;
use crate::measure::damage::{self, Damage, EndFace, Finding, OperationVolume};
use crate::measure::gear_place::GearPlace;
use crate::measure::target_outline::TargetOutline;
use gearcut_core::cut::BlankStats;
use gearcut_core::cut::CutBlank;
use gearcut_core::dexel::BlankGrid;
use gearcut_core::dexel::intervals;
use gearcut_core::math::planar_rays::FAMILIES;
use glam::DVec2;

/// Rubbing of return strokes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rubbing {
    /// Where and how much.
    pub damage: Damage,
    /// On a surface that stays; otherwise on stock that is still to be removed.
    pub stays: bool,
}

/// Everything that the blank field says.
#[derive(Debug, Clone, PartialEq)]
pub struct BlankReport {
    /// Volume of the uncut blank, mm3, by both families.
    pub blank_mm3: [f64; 2],
    /// Volume that is left, mm3, by both families.
    pub left_mm3: [f64; 2],
    /// Operations in order.
    pub operations: Vec<OperationVolume>,
    /// End face; nothing where the target's outline is not known in closed form.
    pub end_face: Option<EndFace>,
    /// Target material that the last operation took.
    pub gouges: Vec<Damage>,
    /// Target material that an earlier operation took.
    pub interference: Vec<Damage>,
    /// Return strokes that rub.
    pub rubbing: Vec<Rubbing>,
    /// Work done.
    pub stats: BlankStats,
}

/// Report on a cut blank; `targets` are the target's transverse sections in all slices, or one that stands for all, or
/// none where they are not known in closed form.
pub fn measure(gear: &PlanarGear, cut: &CutBlank, targets: &[TargetOutline]) -> BlankReport {
    let operations = damage::volumes(cut);
    let left_mm3 = cut.left_mm3.last().copied().unwrap_or(cut.blank_mm3);
    let last = gear.operations.len() - 1;
    let damage = if targets.is_empty() { Vec::new() } else { damage_to(gear, cut, targets) };
    let (gouges, interference): (Vec<Damage>, Vec<Damage>) = damage.into_iter().partition(|d| d.operation == last);
    let mut stats = BlankStats::default();
    for done in &cut.cuts {
        stats += done.stats;
    }
    BlankReport {
        blank_mm3: cut.blank_mm3,
        left_mm3,
        operations,
        end_face: targets.first().map(|_| end_face(gear, cut, left_mm3, targets)),
        gouges,
        interference,
        rubbing: rubbing(gear, cut),
        stats,
    }
}

fn end_face(gear: &PlanarGear, cut: &CutBlank, left_mm3: [f64; 2], targets: &[TargetOutline]) -> EndFace {
    let widths_mm = cut.field.grid.slice_widths_mm();
    let all_mm: f64 = widths_mm.iter().sum();
    let mean = |of: &dyn Fn(&TargetOutline) -> f64| match targets {
        [one] => of(one),
        each => each.iter().zip(&widths_mm).map(|(target, width_mm)| of(target) * width_mm).sum::<f64>() / all_mm,
    };
    let spacing_mm = cut.field.grid.spacing_mm();
    EndFace {
        cut_mm2: left_mm3.map(|v| v / gear.scene.gear.face_width_mm),
        target_mm2: mean(&TargetOutline::section_mm2),
        bound_mm2: FAMILIES.map(|f| mean(&|target| target.section_bound_mm2(f, spacing_mm))),
    }
}

/// Findings side by side of the teeth, deepest place and volume each; only those at least
/// [`crate::measure::damage::LEAST_DEPTH_MM`] deep.
fn collect(gear: &PlanarGear, findings: impl Iterator<Item = Finding>) -> Vec<(Damage, bool)> {
    let place = |finding: &Finding| place_of(gear, finding.point_mm, finding.z_mm);
    damage::collect(&gear.scene.gear, findings, place, |operation, pass| {
        gear.operations[operation].strokes.stroke_and_blade(pass)
    })
}

fn damage_to(gear: &PlanarGear, cut: &CutBlank, targets: &[TargetOutline]) -> Vec<Damage> {
    let slices = 0..cut.field.slices.len();
    let findings = slices.flat_map(|slice| {
        let target = &targets[slice.min(targets.len() - 1)];
        damage::missing_in_slice(&cut.field, slice, target, &gear.scene.gear, |pass| operation_of(gear, pass))
    });
    collect(gear, findings).into_iter().map(|(damage, _)| damage).collect()
}

fn operation_of(gear: &PlanarGear, pass: u32) -> Option<usize> {
    gear.operations.iter().position(|o| (o.strokes.first_pass..o.strokes.end_pass()).contains(&pass))
}

fn rubbing(gear: &PlanarGear, cut: &CutBlank) -> Vec<Rubbing> {
    let grid: &BlankGrid = &cut.field.grid;
    let findings = cut.cuts.iter().enumerate().flat_map(|(operation, done)| {
        done.rubs.iter().map(move |rub| {
            let row = &grid.rows[rub.family as usize];
            let ray = row.first_at_or_above(rub.family.across(rub.place_mm));
            let spans = &cut.field.slices[rub.slice as usize].rays[rub.family as usize][ray];
            Finding {
                operation,
                stays: intervals::contains(spans, rub.family.along(rub.place_mm)),
                point_mm: rub.place_mm,
                z_mm: grid.slices_z_mm[rub.slice as usize],
                depth_mm: rub.depth_mm,
                volume_mm3: 0.5 * rub.volume_mm3,
                pass: rub.pass,
            }
        })
    });
    collect(gear, findings).into_iter().map(|(damage, stays)| Rubbing { damage, stays }).collect()
}

/// Place of a point of the gear frame at a height.
fn place_of(gear: &PlanarGear, point_mm: DVec2, z_mm: f64) -> GearPlace {
    GearPlace::in_section(gear.blank, &gear.scene.gear, point_mm, gear.scene.gear.turned_mm(z_mm))
}
