//! The blank field's part of a hobbing run: cut, report, findings.

use crate::findings::damage::{DamagePlace, damage, damage_table, kind, pairs};
use crate::findings::quantities::blank::{AREA_BOUND, GOUGE_FROM, SECTION_AREA, TARGET_AREA};
use crate::findings::{Section, Table};
use crate::measure::damage::{Damage, gouge_mm};
use crate::process::hobbing::quantities::{HOB_TOOTH, HOB_TURN};
use crate::process::hobbing::{HobCutter, HobbedBlank};
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;

use crate::interrupt::Interrupt;
use crate::process::hobbing::measure::blank_report;
use crate::process::hobbing::measure::blank_report::HobbedBlankReport;
use crate::progress::Progress;
use crate::steps::whole_blank::{self, mean};

/// The cut blank and what it says.
#[derive(Debug)]
pub struct WholeBlank {
    /// Rays and chips.
    pub blank: HobbedBlank,
    /// Volumes, sections, damage.
    pub report: HobbedBlankReport,
}

/// Cuts the blank; nothing after Ctrl-C.
///
/// # Errors
/// A field that does not fit in memory; the backend's.
pub fn cut(
    cutter: &HobCutter,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<WholeBlank>> {
    let field = cutter.job.blank_field()?;
    let steps = (field.slices.len() * cutter.operations.len()) as u64;
    let step = progress.step("cut the whole blank", steps, "slices");
    let advance = || {
        step.advance(1);
        !interrupt.is_raised()
    };
    let Some(blank) = cutter.cut_blank(backend, field, &advance)? else { return Ok(None) };
    step.finish();
    let report = blank_report::measure(cutter, &blank.cut);
    Ok(Some(WholeBlank { blank, report }))
}

/// Every place of damage.
fn all_damage(cutter: &HobCutter, report: &HobbedBlankReport) -> Table {
    let place = |kind, damage: &Damage| DamagePlace {
        kind,
        operation: &cutter.job.operations[damage.operation].spec.name,
        damage: *damage,
    };
    let gouge_mm = gouge_mm(cutter.job.scene.gear.module_mm);
    let gouges = report.gouges.iter().map(|d| place(kind(d, gouge_mm, "gouge"), d));
    let interference = report.interference.iter().map(|d| place(kind(d, gouge_mm, "interference"), d));
    damage_table(gouges.chain(interference))
        .column(&HOB_TURN, |of| of.damage.stroke)
        .column(&HOB_TOOTH, |of| hob_tooth(cutter, &of.damage))
        .in_file("damage")
}

fn hob_tooth(cutter: &HobCutter, damage: &Damage) -> String {
    let hob = &cutter.job.hob;
    hob.teeth[damage.blade as usize].label(hob.starts)
}

/// The whole gear.
pub fn findings(cutter: &HobCutter, whole: &WholeBlank) -> Section {
    let report = &whole.report;
    let grid = &whole.blank.cut.field.grid;
    let section = &report.section;
    let damage = |key, title, places: &[Damage]| {
        damage(key, title, places, |place, d| {
            place.and("hob_turn", d.stroke as u64).and("hob_tooth", hob_tooth(cutter, d))
        })
    };
    let names = cutter.job.operations.iter().map(|operation| operation.spec.name.as_str());
    let volumes = [report.blank_mm3, report.left_mm3];
    whole_blank::findings(grid.spacing_mm(), grid.slices_z_mm.len(), volumes, &report.operations)
        .entries([
            SECTION_AREA.of(mean(section.cut_mm2)),
            TARGET_AREA.of(section.target_mm2),
            AREA_BOUND.of(section.bound_mm2[0].max(section.bound_mm2[1])),
            GOUGE_FROM.of(gouge_mm(cutter.job.scene.gear.module_mm)),
        ])
        .entries(pairs([report.stats.visited, report.stats.removing]))
        .table(all_damage(cutter, report))
        .part(whole_blank::removed(names, &report.operations))
        .part(damage("gouges", "target material that the last operation took", &report.gouges))
        .part(damage("interference", "target material that an earlier operation took", &report.interference))
}
