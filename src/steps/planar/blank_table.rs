//! The table of damage of a planar gear.

use super::PlanarGear;
use super::blank_report::BlankReport;
use crate::error::Result;
use crate::measure::damage::Damage;
use crate::output::folder::OutputFolder;
use crate::output::table::{Cell, write_table};
use crate::steps::damage_table::{damage_cells, damage_columns};
use crate::terms::Side;

/// `tables/damage.csv`: every place of damage, rubbing and every fault of a stroke.
///
/// # Errors
/// A table that cannot be written.
pub fn write(gear: &PlanarGear, report: &BlankReport, folder: &OutputFolder) -> Result<()> {
    let row = |kind: &'static str, d: &Damage| -> Vec<Cell> {
        let mut cells = damage_cells(kind, gear.operations[d.operation].name, d);
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
            gear.operations[f.operation].name.into(),
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
