//! The blank field's part of a hobbing run: cut, report, findings.

use crate::findings::damage::{damage, damage_row, damage_table, gouge_from, kind, pairs};
use crate::findings::{Datum, Quantity, Section, Table, TableColumn};
use crate::measure::damage::{Damage, gouge_mm};
use crate::process::hobbing::{HobCutter, HobbedBlank};
use gearcut_core::cut::Backend;
use gearcut_core::error::Result;
use gearcut_core::gear::GearKind;

use crate::interrupt::Interrupt;
use crate::output::progress::Progress;
use crate::process::hobbing::measure::blank_report;
use crate::process::hobbing::measure::blank_report::HobbedBlankReport;
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
    let row = |kind: &str, d: &Damage| {
        let mut row = damage_row(kind, &cutter.job.operations[d.operation].spec.name, d);
        row.extend([Datum::from(d.stroke as u64), hob_tooth(cutter, d).as_str().into()]);
        row
    };
    let gouge_mm = gouge_mm(cutter.job.scene.gear.module_mm);
    let gouges = report.gouges.iter().map(|d| row(kind(d, gouge_mm, "gouge"), d));
    let interference = report.interference.iter().map(|d| row(kind(d, gouge_mm, "interference"), d));
    let pass = [TableColumn::new("hob_turn", "1", "turn of the hob"), TableColumn::words("hob_tooth", "hob tooth")];
    damage_table(pass, gouges.chain(interference))
}

fn hob_tooth(cutter: &HobCutter, damage: &Damage) -> String {
    let hob = &cutter.job.hob;
    hob.teeth[damage.blade as usize].label(hob.starts)
}

/// The whole gear.
pub fn findings(cutter: &HobCutter, whole: &WholeBlank) -> Section {
    let report = &whole.report;
    let grid = &whole.blank.cut.field.grid;
    let number = |of: f64, unit: &'static str, definition: &'static str| Quantity::number(of, unit, definition);
    let section = &report.section;
    let damage = |key, title, places: &[Damage], what| {
        damage(key, title, places, what, |place, d| {
            place.and("hob_turn", d.stroke as u64).and("hob_tooth", hob_tooth(cutter, d))
        })
    };
    let slices = (grid.slices_z_mm.len(), "transverse sections, both end faces among them");
    let names = cutter.job.operations.iter().map(|operation| operation.spec.name.as_str());
    whole_blank::findings(
        GearKind::External,
        grid.spacing_mm(),
        slices,
        [report.blank_mm3, report.left_mm3],
        &report.operations,
    )
    .with("section_area", number(mean(section.cut_mm2), "mm^2", "transverse section that is left, mean over the face"))
    .with(
        "target_section_area",
        number(
            section.target_mm2,
            "mm^2",
            "area of the target's section less the bore, from the rack's meshing condition, mean over the slices",
        ),
    )
    .with(
        "section_area_bound",
        number(
            section.bound_mm2[0].max(section.bound_mm2[1]),
            "mm^2",
            "how far the section may be off because of the rays' distance: half of it times the travel of the \
                 outline along the rays",
        ),
    )
    .with("gouge_from", gouge_from(cutter.job.scene.gear.module_mm))
    .with(
        "ray_passes_visited",
        pairs(report.stats.visited, "pairs of ray and pass in which the ray crosses the sweep of the hob tooth"),
    )
    .with("ray_passes_removing", pairs(report.stats.removing, "those of them that removed material"))
    .table(all_damage(cutter, report))
    .part(whole_blank::removed(names, &report.operations))
    .part(damage(
        "gouges",
        "below the target, last operation",
        &report.gouges,
        "target material that the last operation took",
    ))
    .part(damage(
        "interference",
        "below the target, earlier operations",
        &report.interference,
        "target material that an earlier operation took",
    ))
}
