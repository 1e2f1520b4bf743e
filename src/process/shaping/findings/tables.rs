//! Flanks and teeth side by side: `tables/flanks.csv`, `tables/teeth.csv`.
//!
//! The rows are in the files alone, since `results.json` has their numbers in the sections of teeth and flanks.

use crate::findings::quantities::flanks::{PROFILE_LENGTH, START_OF_FLANK};
use crate::findings::quantities::teeth::{
    CUMULATIVE_PITCH, FLANK_PITCH, PROBE_PLACE, THICKNESS_ARC, THICKNESS_CHORD, TOOTH,
};
use crate::findings::{Section, Table};
use crate::process::shaping::gear::measure::FlankReport;
use crate::process::shaping::quantities::{SCALLOP, TIP_HEIGHT, TIP_LAND};
use crate::steps::inspection::teeth::flank_table;
use gearcut_core::terms::Side;

/// All flanks that were cut: the stock of `earlier` operations on them, and how they are finished.
pub fn flanks<'a>(cut: &'a [FlankReport], earlier: impl IntoIterator<Item = &'a str>, teeth: &[Section]) -> Table {
    let finished = |of: &FlankReport| teeth[of.tooth as usize - 1].side(of.side);
    let own = [&START_OF_FLANK, &TIP_HEIGHT, &PROFILE_LENGTH, &SCALLOP];
    let table = own.into_iter().fold(flank_table(cut, earlier), |table, row| {
        table.column(row, |of| finished(of).and_then(|flank| flank.value(row)))
    });
    table.rows_in_file("flanks")
}

/// All teeth.
pub fn teeth(teeth: &[Section]) -> Table {
    let table = Table::over("all_teeth", "Finished teeth", (1_u32..).zip(teeth)).column(&TOOTH, |(number, _)| *number);
    let of_tooth = [&THICKNESS_ARC, &THICKNESS_CHORD, &TIP_LAND, &PROBE_PLACE];
    let table = of_tooth.into_iter().fold(table, |table, row| table.column(row, |(_, tooth)| tooth.value(row)));
    let sides =
        [Side::Left, Side::Right].into_iter().flat_map(|side| [(side, &FLANK_PITCH), (side, &CUMULATIVE_PITCH)]);
    let table = sides.fold(table, |table, (side, row)| {
        let column = row.as_column().keyed(format!("{}_{}", side.name(), row.key));
        table.column(column, |(_, tooth)| tooth.side(side).and_then(|flank| flank.value(row)))
    });
    table.rows_in_file("teeth")
}
