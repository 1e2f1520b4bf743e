//! Tables of a cut bevel gear: flanks, points of inspection, the slot, blades.

use crate::findings::quantities::flanks::{MEAN_DEVIATION, PROFILE_LENGTH, SQ};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Section, Table};
use crate::process::bevel::gear::BevelGear;
use crate::process::bevel::job::BevelJob;
use crate::process::bevel::quantities::{
    ALONG, BLADE, BLADE_KIND, BLADES, BLANK_DEPTH, CUT_BY, DEPTH, DEVIATION, GRID, GRID_COLUMN, GRID_ROW, NOMINAL_X,
    NOMINAL_Y, NOMINAL_Z, NORMAL_X, NORMAL_Y, NORMAL_Z, RUNOUT, SHARE, SLOT, WIDTH,
};
use crate::steps::inspection::teeth::flank_table;
use gearcut_core::bevel::face_mill::FaceMill;
use gearcut_core::units::UM_PER_MM;

/// Every flank: the stock of rough cuts, deviations, traces.
pub(super) fn flanks(job: &BevelJob, gear: &BevelGear) -> Table {
    let um = |mm: f64| mm * UM_PER_MM;
    let earlier = job.operations[..job.operations.len() - 1].iter().map(|operation| operation.spec.name.as_str());
    flank_table(&gear.flanks, earlier)
        .column(&CUT_BY, |of| job.kind_of(of.side).name())
        .column(&PROFILE_LENGTH, |of| of.length_mm)
        .column(&MEAN_DEVIATION, |of| of.own.finished.map(|of| um(of.mean_mm)))
        .column(&SQ, |of| of.own.finished.map(|of| um(of.rms_mm)))
        .in_file("flanks")
}

/// Points, normals and deviations as coordinate measuring machines take them.
pub(super) fn grid(job: &BevelJob, gear: &BevelGear) -> Table {
    let points = gear.flanks.iter().flat_map(|flank| flank.own.grid.iter().map(move |point| (flank, point)));
    let [along_profile, along_tooth] = job.spec.grid;
    let title = format!("Points of inspection, {along_profile} by {along_tooth} on every flank");
    Table::over(GRID.key, &title, points)
        .column(&TOOTH, |(flank, _)| flank.tooth)
        .column(&FLANK, |(flank, _)| flank.side.name())
        .column(&GRID_COLUMN, |(_, point)| point.place[0])
        .column(&GRID_ROW, |(_, point)| point.place[1])
        .column(&NOMINAL_X, |(_, point)| point.target.origin_mm.x)
        .column(&NOMINAL_Y, |(_, point)| point.target.origin_mm.y)
        .column(&NOMINAL_Z, |(_, point)| point.target.origin_mm.z)
        .column(&NORMAL_X, |(_, point)| point.target.normal.x)
        .column(&NORMAL_Y, |(_, point)| point.target.normal.y)
        .column(&NORMAL_Z, |(_, point)| point.target.normal.z)
        .column(&DEVIATION, |(_, point)| point.deviation_mm.map(|mm| mm * UM_PER_MM))
        .rows_in_file("grid")
}

/// The slot behind tooth 1 along the face.
pub(super) fn slot(gear: &BevelGear) -> Section {
    let table = Table::over("along_the_face", "Slot behind tooth 1 along the face", &gear.slot)
        .column(&ALONG, |row| row.along_mm)
        .column(&WIDTH, |row| row.width_mm)
        .column(&DEPTH, |row| row.depth_mm)
        .column(&BLANK_DEPTH, |row| row.whole_depth_mm);
    SLOT.section([]).table(table.in_file("slot"))
}

/// Share of the flanks on which each blade cut last.
pub(super) fn blades(job: &BevelJob, gear: &BevelGear) -> Section {
    let all: u64 = gear.flanks.iter().flat_map(|flank| &flank.own.left_by_blade).sum();
    let own = |blade: u32| gear.flanks.iter().map(|flank| flank.own.left_by_blade[blade as usize]).sum::<u64>();
    let table = Table::over("blades", "Flanks by blade", 0..job.head.blades())
        .column(&BLADE, |&blade| blade)
        .column(&BLADE_KIND, |&blade| FaceMill::kind_of(blade).name())
        .column(&RUNOUT, |&blade| job.head.runouts_mm[blade as usize] * UM_PER_MM)
        .column(&SHARE, |&blade| 100.0 * own(blade) as f64 / all.max(1) as f64);
    BLADES.section([]).table(table.in_file("blades"))
}
