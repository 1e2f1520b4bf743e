//! The blank field's part of a run: cut, report, results, table.

use crate::cut::Backend;
use crate::cut::CutBlank;
use crate::cut::cpu::blank;
use crate::error::Result;
use crate::interrupt::Interrupt;
use crate::measure::damage::Damage;
use crate::output::folder::OutputFolder;
use crate::output::progress::Progress;
use crate::output::table::{Cell, write_table};
use crate::process::shaping::Job;
use crate::process::shaping::measure::blank_report;
use crate::process::shaping::measure::blank_report::BlankReport;
use crate::steps::damage_table::{damage_cells, damage_columns};
use crate::terms::Side;

/// Distance of the target outline's points: chords of a fillet then miss about 60 nm, a fifteenth of the least depth
/// that is reported.
const TARGET_SPACING_MM: f64 = 0.02;

/// The cut blank and what it says; nothing after Ctrl-C.
///
/// # Errors
/// A field that does not fit in memory; the backend's.
pub(super) fn cut(
    job: &Job,
    backend: &dyn Backend,
    progress: &Progress,
    interrupt: &Interrupt,
) -> Result<Option<(CutBlank, BlankReport)>> {
    let field = job.blank_field()?;
    let step = progress.step("cut the whole blank", blank::steps(&field) * job.operations.len() as u64, "tiles");
    let advance = || {
        step.advance(1);
        !interrupt.is_raised()
    };
    let Some(cut) = job.cut_blank(backend, field, &advance)? else { return Ok(None) };
    step.finish();
    let target = job.target_outline(TARGET_SPACING_MM).ok();
    let report = blank_report::measure(job, &cut, target.as_ref());
    Ok(Some((cut, report)))
}

/// `tables/damage.csv`: every place of damage, rubbing and every fault of a stroke.
///
/// # Errors
/// A table that cannot be written.
pub(super) fn write_table_of_damage(job: &Job, report: &BlankReport, folder: &OutputFolder) -> Result<()> {
    let row = |kind: &'static str, d: &Damage| -> Vec<Cell> {
        let mut cells = damage_cells(kind, &job.operations[d.operation].spec.name, d);
        cells.extend([(d.stroke as u32).into(), d.blade.into()]);
        cells
    };
    let gouges = report.gouges.iter().map(|d| row("gouge", d));
    let interference = report.interference.iter().map(|d| row("interference", d));
    let rubbing =
        report.rubbing.iter().map(|r| row(if r.stays { "rubbing_on_gear" } else { "rubbing_on_stock" }, &r.damage));
    let strokes = report.stroke_faults.iter().map(|f| {
        let none = || Cell::from(None::<f64>);
        let mut cells: Vec<Cell> = vec![
            f.fault.kind.name().into(),
            job.operations[f.operation].spec.name.as_str().into(),
            f.space.into(),
            Side::Left.name().into(),
            "space behind the tooth".into(),
        ];
        cells.extend((0..6).map(|_| none()));
        cells.push((f.fault.stroke as u32).into());
        cells.push(none());
        cells
    });
    let rows: Vec<Vec<Cell>> = gouges.chain(interference).chain(rubbing).chain(strokes).collect();
    write_table(&folder.path("tables/damage.csv")?, &damage_columns(["stroke", "cutter_tooth"]), rows)
}
