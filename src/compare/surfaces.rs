//! Two surfaces of one place as a folder of their own: files, page and words.
//!
//! In: a [`SurfaceComparison`]. Out:
//!
//! | file | what |
//! | --- | --- |
//! | `report.html` | all of it on one page |
//! | `comparison.csv` | every parameter of both, their difference and ratio, with unit and definition |
//! | `first.png`, `second.png` | heights on the points that both have, to one scale |
//! | `difference.png`, `.x3p` | second less first, levelled |
//! | `abbott.svg` | both material ratio curves |
//! | `profiles.svg` | both along the middle row and the middle column |

mod page;

use super::quantities::{COMPARISON, LESS, OVER};
use crate::findings::Table;
use crate::findings::quantities::surfaces::{OF_FIRST, OF_SECOND, PARAMETER, PARAMETER_UNIT, WHAT_IT_IS};
use crate::findings::table::table_file;
use crate::output::folder::OutputFolder;
use crate::output::report::REPORT_FILE;
use crate::output::table::write_table;
use crate::output::text::Sheet;
use crate::overlay::{ComparedRow, SurfaceComparison};
use gearcut_core::error::Result;

/// Writes files and page.
///
/// # Errors
/// Files that cannot be written.
pub fn write(of: &SurfaceComparison, folder: &OutputFolder) -> Result<()> {
    let ratio = |[a, b]: [Option<f64>; 2]| a.zip(b).filter(|(a, _)| *a != 0.0).map(|(a, b)| b / a);
    let table = Table::over("surfaces", "Surfaces", of.rows())
        .column(&PARAMETER, |row| row.symbol.clone())
        .column(&PARAMETER_UNIT, |row| row.unit)
        .column(&OF_FIRST, |row| row.values[0])
        .column(&OF_SECOND, |row| row.values[1])
        .column(&LESS, ComparedRow::difference)
        .column(&OVER, |row| ratio(row.values))
        .column(&WHAT_IT_IS, |row| row.definition.clone());
    write_table(&folder.path(table_file(COMPARISON.key))?, &table.into())?;
    let pictures = of.write_maps(folder, "")?;
    let (abbott, profiles) = (of.abbott(), of.profiles());
    abbott.write_svg(&folder.path("abbott.svg")?)?;
    profiles.write_svg(&folder.path("profiles.svg")?)?;
    page::page(of, pictures, abbott, profiles).write(&folder.path(REPORT_FILE)?)
}

/// Prints alignment, marks and parameters.
pub fn print(of: &SurfaceComparison, sheet: &mut Sheet) {
    sheet.heading(&of.names.join(" and "));
    for [name, value] in of.facts() {
        sheet.line(&name, value);
    }
    for doubt in of.doubts("") {
        sheet.line("doubt", doubt.text);
    }
    sheet.heading("Parameters on the points that both have");
    sheet.table(&of.table());
}
