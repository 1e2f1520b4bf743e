//! What the blank field says about the whole gear: volumes counted twice, damage to the target, return strokes that
//! rub, strokes that are missing.
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
//! * **Strokes.** See [`super::stroke_faults`].

use super::PlanarGear;
use super::stroke_faults::{LEAST_CELLS, StrokeFault, stroke_faults};
use crate::measure::damage::{self, Damage, EndFace, Finding, OperationVolume};
use crate::measure::gear_place::GearPlace;
use crate::measure::target_outline::TargetOutline;
use gearcut_core::cut::BlankStats;
use gearcut_core::cut::CutBlank;
use gearcut_core::dexel::BlankGrid;
use gearcut_core::dexel::intervals;
use gearcut_core::math::planar_rays::FAMILIES;
use gearcut_core::passes::StrokeSet;
use gearcut_core::terms::Side;
use glam::DVec2;

/// Strokes beside a gouging one that are not called faulty: it stands out, and the next ones find their chips gone.
const GOUGE_SHADOW: usize = 4;

/// Rubbing of return strokes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rubbing {
    /// Where and how much.
    pub damage: Damage,
    /// On a surface that stays; otherwise on stock that is still to be removed.
    pub stays: bool,
}

/// A fault of a stroke with its tooth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedStrokeFault {
    /// Index of the operation.
    pub operation: usize,
    /// The fault.
    pub fault: StrokeFault,
    /// Tooth space in which most of the chip was: the one behind this tooth.
    pub space: u32,
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
    /// Strokes that are missing, did not cut or were made twice.
    pub stroke_faults: Vec<PlacedStrokeFault>,
    /// Whether each operation's strokes could be judged: its chips are large enough for the rays' distance.
    pub strokes_judged: Vec<bool>,
    /// Work done.
    pub stats: BlankStats,
}

/// Report on a cut blank; `target` is the target's transverse section, where it is known in closed form.
pub fn measure(gear: &PlanarGear, cut: &CutBlank, target: Option<&TargetOutline>) -> BlankReport {
    let operations = damage::volumes(cut);
    let left_mm3 = cut.left_mm3.last().copied().unwrap_or(cut.blank_mm3);
    let last = gear.operations.len() - 1;
    let damage = target.map(|target| damage_to(gear, cut, target)).unwrap_or_default();
    let (gouges, interference): (Vec<Damage>, Vec<Damage>) = damage.into_iter().partition(|d| d.operation == last);
    let mut stats = BlankStats::default();
    for done in &cut.cuts {
        stats += done.stats;
    }
    BlankReport {
        blank_mm3: cut.blank_mm3,
        left_mm3,
        operations,
        end_face: target.map(|target| end_face(gear, cut, left_mm3, target)),
        strokes_judged: (0..gear.operations.len()).map(|operation| is_judged(gear, cut, operation)).collect(),
        stroke_faults: faults(gear, cut, &gouges, &interference),
        gouges,
        interference,
        rubbing: rubbing(gear, cut),
        stats,
    }
}

fn end_face(gear: &PlanarGear, cut: &CutBlank, left_mm3: [f64; 2], target: &TargetOutline) -> EndFace {
    let spacing_mm = cut.field.grid.spacing_mm();
    EndFace {
        cut_mm2: left_mm3.map(|v| v / gear.scene.gear.face_width_mm),
        target_mm2: target.section_mm2(),
        bound_mm2: FAMILIES.map(|f| target.section_bound_mm2(f, spacing_mm)),
    }
}

/// Findings side by side of the teeth, deepest place and volume each; only those at least
/// [`crate::measure::damage::LEAST_DEPTH_MM`] deep.
fn collect(gear: &PlanarGear, findings: impl Iterator<Item = Finding>) -> Vec<(Damage, bool)> {
    let place = |finding: &Finding| place_of(gear, finding.point_mm);
    damage::collect(findings, place, |operation, pass| gear.operations[operation].strokes.stroke_and_blade(pass))
}

fn damage_to(gear: &PlanarGear, cut: &CutBlank, target: &TargetOutline) -> Vec<Damage> {
    let slices = 0..cut.field.slices.len();
    let findings = slices.flat_map(|slice| {
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

/// Whether the mean stroke of an operation removes enough cells of the grid from a section.
fn is_judged(gear: &PlanarGear, cut: &CutBlank, operation: usize) -> bool {
    let strokes = gear.operations[operation].strokes.count() as f64;
    let removed_mm3 = &cut.cuts[operation].removed_mm3;
    let volume_mm3: f64 = removed_mm3.iter().map(|pass| 0.5 * (pass[0] + pass[1])).sum();
    let cell_mm2 = cut.field.grid.spacing_mm().powi(2);
    volume_mm3 / (strokes * gear.scene.gear.face_width_mm * cell_mm2) >= LEAST_CELLS
}

/// Faults of strokes, less those that a gouge explains: a stroke that cut too deep stands alone as well.
fn faults(gear: &PlanarGear, cut: &CutBlank, gouges: &[Damage], interference: &[Damage]) -> Vec<PlacedStrokeFault> {
    let gouged = |operation: usize, stroke: usize| {
        gouges.iter().chain(interference).any(|d| d.operation == operation && d.stroke.abs_diff(stroke) <= GOUGE_SHADOW)
    };
    let mut placed = Vec::new();
    for (operation, (prepared, done)) in gear.operations.iter().zip(&cut.cuts).enumerate() {
        let set = prepared.strokes;
        if !is_judged(gear, cut, operation) {
            continue;
        }
        for fault in stroke_faults(&done.removed_mm3, set.blades) {
            if !gouged(operation, fault.stroke) {
                let space = busiest_space(gear, set, &done.removed_mm3, fault.stroke);
                placed.push(PlacedStrokeFault { operation, fault, space });
            }
        }
    }
    placed
}

/// Tooth space (behind the tooth of this number) in which the strokes round this one took most.
fn busiest_space(gear: &PlanarGear, set: &StrokeSet, removed_mm3: &[[f64; 2]], stroke: usize) -> u32 {
    let blades = set.blades as usize;
    let near = stroke.saturating_sub(1)..(stroke + 2).min(set.count());
    let taken = |blade: usize| near.clone().map(|s| removed_mm3[s * blades + blade].iter().sum::<f64>()).sum::<f64>();
    let busiest = (0..blades).max_by(|&a, &b| taken(a).total_cmp(&taken(b))).unwrap_or(0);
    let work_from_blade = set.poses(stroke)[0].after(&gear.tool.tool_from_blade(busiest as u32));
    let place = place_of(gear, work_from_blade.point(gear.tool.edge_of(busiest as u32).center_mm));
    // The middle of a cutter tooth stands in a space: behind a tooth on its left side, else behind the tooth before.
    match place.side {
        Side::Left => place.tooth,
        Side::Right => (place.tooth + gear.scene.gear.teeth - 2) % gear.scene.gear.teeth + 1,
    }
}

/// Place of a point of the gear frame; the teeth stand alike in all sections.
fn place_of(gear: &PlanarGear, point_mm: DVec2) -> GearPlace {
    GearPlace::in_section(gear.blank, &gear.scene.gear, point_mm, 0.0)
}
