//! The thickest chips that are known before a hobbing cut.
//!
//! In: the passes of all operations. Out: for each the thickest chip in some tooth spaces, in the slice of the blank's
//! rays that stands in the middle of the face, with the hob tooth that takes it.
//!
//! A part of the cut itself: that slice, with material in those spaces alone, from the middle of a tooth to the middle
//! of the next, and the passes that go through them, on the rays and by the law of [`super::measure::hob_load`]. What
//! a slice is left with depends on no other, and what a space is left with on no other while the hob leaves the middle
//! of the teeth alone. The cut so finds these chips as well, and in the other spaces and slices perhaps thicker ones:
//! what is foreseen is a least value. `tests/suite/hobbing/foreseen_chips.rs` compares it with the cut of the whole
//! blank.
//!
//! Road not taken: the largest chip thickness of Hoffmeister's formula, from module, gashes, starts, feed and depth. It
//! is fitted to standard racks on round gears, another number than the cut's, and says nothing of a gear that is not
//! round.

use super::kept::ForeseenChip;
use super::measure::hob_load::OperationLoad;
use super::{HobCutter, HobbingJob};
use gearcut_core::cut::Backend as _;
use gearcut_core::cut::cpu::Cpu;
use gearcut_core::dexel::blank_field::RayMaterial;
use gearcut_core::dexel::intervals::{End, subtract};
use gearcut_core::dexel::{BlankField, BlankGrid};
use gearcut_core::error::Result;
use gearcut_core::gear::blank_outline::BlankOutline;
use gearcut_core::math::planar_rays::{FAMILIES, Family};
use glam::DVec2;

/// Tooth spaces that are looked at, evenly round the gear.
const SPACES: u32 = 6;

/// The thickest chip of every operation in the spaces that are looked at; none where it takes nothing there, where the
/// hob cuts the tips as well, and under a linkage as printed, which leaves no teeth. They are found once for a job.
///
/// # Errors
/// A blank field that does not fit in memory.
pub fn of<'a>(cutter: &HobCutter<'a>) -> Result<&'a [Option<ForeseenChip>]> {
    cutter.foreseen_chips(|| find(cutter))
}

/// Share of a slice that some spaces are, where they can be cut without the others: passes of others cut there as well
/// where the hob cuts the tips, and under a linkage as printed.
pub fn share_of_slice(job: &HobbingJob) -> Option<f64> {
    let as_printed = job.operations.iter().any(|operation| operation.linkage.law().is_as_printed());
    let teeth = job.scene.gear.teeth;
    (!as_printed && !job.tops_the_gear()).then(|| f64::from(SPACES.min(teeth)) / f64::from(teeth))
}

fn find(cutter: &HobCutter) -> Result<Vec<Option<ForeseenChip>>> {
    if share_of_slice(cutter.job).is_none() {
        return Ok(vec![None; cutter.operations.len()]);
    }
    cut_spaces(cutter)
}

/// Cuts the spaces that are looked at.
///
/// # Errors
/// A blank field that does not fit in memory.
pub fn cut_spaces(cutter: &HobCutter) -> Result<Vec<Option<ForeseenChip>>> {
    let spaces: Vec<i64> = spaces(cutter.job.scene.gear.teeth).collect();
    let mut field = field(cutter, &spaces)?;
    let mut found = Vec::new();
    for (index, passes) in cutter.operations.iter().enumerate() {
        let sections = cutter.sections_in_spaces(index, &spaces)?;
        let ids = passes.first_pass..passes.end_pass();
        let Some(cut) = Cpu::default().cut_blank_sweeps(&mut field, &sections, ids, &|| true)? else { break };
        let load = OperationLoad::of_blank(passes, &cut.chips);
        let chip = load.peak(|load| load.thickness_mm).map(|tooth| ForeseenChip {
            tooth,
            thickness_mm: load.teeth[tooth].thickness_mm,
            missed_end: load.end_that_is_missed(&cutter.job.hob, tooth),
        });
        found.push(chip.filter(|chip| chip.thickness_mm > 0.0));
    }
    Ok(found)
}

/// Place of the slice along the tooth, mm.
fn slice_z_mm(grid: &BlankGrid) -> f64 {
    grid.slices_z_mm[grid.slices_z_mm.len() / 2]
}

/// Spaces that are looked at, after teeth of these numbers.
fn spaces(teeth: u32) -> impl Iterator<Item = i64> {
    let count = SPACES.min(teeth);
    (0..count).map(move |i| 1 + i64::from(i * teeth / count))
}

/// One slice with material in some spaces alone.
fn field(cutter: &HobCutter, spaces: &[i64]) -> Result<BlankField> {
    let job = cutter.job;
    let grid = job.blank_grid()?;
    let z_mm = slice_z_mm(&grid);
    let mut field = BlankField::new(BlankGrid { slices_z_mm: vec![z_mm], ..grid }, &BlankOutline::new(&job.stock));
    let half_pitch_mm = 0.5 * std::f64::consts::PI * job.target.rack.transverse_module_mm;
    let wedges: Vec<[DVec2; 2]> = spaces
        .iter()
        .map(|&space| {
            let middle_mm = job.target.space_arc_mm(space, z_mm);
            [middle_mm - half_pitch_mm, middle_mm + half_pitch_mm]
                .map(|arc_mm| job.curve.frame(job.curve.phi_at_arc(arc_mm)).point_mm.normalize())
        })
        .collect();
    for (f, family) in FAMILIES.into_iter().enumerate() {
        let row = &field.grid.rows[f];
        for (ray, material) in field.slices[0].rays[f].iter_mut().enumerate() {
            let at_mm = row.at_mm(ray);
            let mut kept: RayMaterial =
                wedges.iter().flat_map(|wedge| within(material, family, at_mm, wedge)).collect();
            kept.sort_by(|a, b| a.low.at_mm.total_cmp(&b.low.at_mm));
            *material = kept;
        }
    }
    Ok(field)
}

/// Material of a ray between two directions from the axis, counter-clockwise from the first, less than half a turn.
fn within(material: &RayMaterial, family: Family, across_mm: f64, [from, to]: &[DVec2; 2]) -> RayMaterial {
    let mut kept = material.clone();
    // Outward normals of both borders; material has no part in front of them.
    for normal in [-from.perp(), to.perp()] {
        let (slope, at_zero) = (family.along(normal), family.point(0.0, across_mm).dot(normal));
        let end = |along_mm: f64| End::of_blank(along_mm, normal);
        let crossing_mm = -at_zero / slope;
        let (from_mm, to_mm) = if slope > 0.0 {
            (crossing_mm, f64::MAX)
        } else if slope < 0.0 {
            (-f64::MAX, crossing_mm)
        } else if at_zero > 0.0 {
            (-f64::MAX, f64::MAX)
        } else {
            continue;
        };
        subtract(&mut kept, end(from_mm), end(to_mm));
    }
    kept
}
