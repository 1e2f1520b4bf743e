//! Measured surfaces over what was cut, on the page: alignment, maps, curves and parameters side by side.
//!
//! In: the section of a window's measured surface and the folder with its maps. Out: blocks of their own, after those
//! of the windows.

use super::digits::digits;
use crate::findings::quantities::surfaces::{
    CORRELATION, CURVE_OF_FIRST, CURVE_OF_SECOND, CURVES, DIFFERENCE_HIGHEST, DIFFERENCE_LOWEST, DIFFERENCE_RMS,
    MIRROR, OF_DIFFERENCE, OF_FIRST, OF_SECOND, OVERLAP, OVERLAY, PARAMETER, PARAMETER_UNIT, PARAMETERS, RATIO, SECOND,
    SHIFT_X, SHIFT_Y,
};
use crate::findings::{QuantityRow, Section, Table, unit};
use crate::output::folder::OutputFolder;
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::report::{Block, PageTable};
use crate::texture::quantities::FILES;
use gearcut_core::error::{Error, Result};

/// Facts of the alignment.
static FACTS: [&QuantityRow; 9] = [
    &SECOND,
    &MIRROR,
    &SHIFT_X,
    &SHIFT_Y,
    &CORRELATION,
    &OVERLAP,
    &DIFFERENCE_RMS,
    &DIFFERENCE_LOWEST,
    &DIFFERENCE_HIGHEST,
];

/// Blocks of a window whose surface was measured as well; none of others.
///
/// # Errors
/// A map cannot be read back.
pub(super) fn blocks(window: &Section, folder: &OutputFolder) -> Result<Vec<Block>> {
    let Some(section) = window.group(&OVERLAY) else { return Ok(Vec::new()) };
    let mut blocks = vec![Block::Heading(format!("Measured over cut: {}", window.title))];
    if let Some(why) = section.entries.iter().find_map(|entry| entry.quantity.why()) {
        blocks.push(Block::Note(format!("The measured surface is not laid over the window: {why}.")));
        return Ok(blocks);
    }
    blocks.push(Block::Table(PageTable {
        caption: "How the measured surface lies on the window".to_owned(),
        columns: ["What", "Value", "Definition"].map(str::to_owned).to_vec(),
        rows: FACTS.iter().filter_map(|row| fact(section, row)).collect(),
    }));
    let stem = window.text(&FILES);
    for (name, title) in [("first", "Cut"), ("second", "Measured"), ("difference", "Measured less cut, levelled")] {
        let path = folder.path(format!("{stem}_{name}.png"))?;
        match std::fs::read(&path) {
            Ok(png) => blocks.push(Block::Picture(format!("{title}: {}", window.title), png)),
            // Files of texture may be left out.
            Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => {}
            Err(reason) => return Err(Error::reading(&path)(reason)),
        }
    }
    blocks.extend(section.table_of(&CURVES).map(|table| Block::Lines(curves(table))));
    blocks.extend(section.table_of(&PARAMETERS).map(|table| Block::Table(parameters(table))));
    Ok(blocks)
}

fn fact(section: &Section, row: &QuantityRow) -> Option<Vec<String>> {
    let entry = section.entry_of(row)?;
    let quantity = &entry.quantity;
    let value = match quantity.value() {
        Some(value) => unit::with_signs(&digits(value, 4), quantity.unit().unwrap_or("1")),
        None => quantity.words()?.to_owned(),
    };
    let title = if row.key == SECOND.key { "Measured".to_owned() } else { entry.heading() };
    Some(vec![title, value, quantity.definition().to_owned()])
}

/// Both material ratio curves.
fn curves(table: &Table) -> LineChart {
    let series = [(&CURVE_OF_FIRST, "cut"), (&CURVE_OF_SECOND, "measured")].map(|(row, name)| LineSeries {
        name: name.to_owned(),
        points: table.values(&RATIO).zip(table.values(row)).filter_map(|(p, z)| Some((p?, z?))).collect(),
    });
    LineChart {
        title: "Material ratio curves on the points that both have".to_owned(),
        x_name: "areal material ratio".to_owned(),
        x_unit: "%".to_owned(),
        panels: vec![Panel {
            value_name: "height over the mean".to_owned(),
            unit: "µm".to_owned(),
            series: series.to_vec(),
            limits: Vec::new(),
            least_division: 0.0,
        }],
    }
}

/// Parameters of both.
fn parameters(table: &Table) -> PageTable {
    let number = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| digits(value, 4));
    let words = |row| table.words(row).map(Option::unwrap_or_default);
    let numbers = [&OF_FIRST, &OF_SECOND, &OF_DIFFERENCE].map(|row| table.values(row).map(number).collect::<Vec<_>>());
    let [cut, measured, difference] = numbers;
    let rows = words(&PARAMETER).zip(words(&PARAMETER_UNIT)).enumerate().map(|(i, (symbol, of))| {
        vec![symbol.to_owned(), cut[i].clone(), measured[i].clone(), difference[i].clone(), unit::signs(of)]
    });
    PageTable {
        caption: "Parameters (ISO 25178-2) on the points that both have, through the window's chain".to_owned(),
        columns: ["Parameter", "Cut", "Measured", "Difference", "Unit"].map(str::to_owned).to_vec(),
        rows: rows.collect(),
    }
}
