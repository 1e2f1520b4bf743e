//! Measured numbers of a gear.

use crate::influence::measured_table::MeasuredTable;
use gearcut_core::error::Result;
use std::path::Path;

/// A measured number.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredNumber {
    /// Path in `results.json`.
    pub quantity: String,
    /// Its value, in the unit that it has there.
    pub value: f64,
    /// Standard uncertainty, above 0.
    pub uncertainty: f64,
}

/// Reads a CSV file with the columns `quantity`, `value` and `uncertainty`, in any order, others beside them.
///
/// # Errors
/// A file that cannot be read; columns that are missing; cells that are no numbers; uncertainties that are not above 0;
/// no rows.
pub fn read_numbers(path: &Path) -> Result<Vec<MeasuredNumber>> {
    let table = MeasuredTable::read(path, ["quantity", "value", "uncertainty"])?;
    let rows = table.rows.iter().map(|row| {
        let uncertainty = row.number(2)?;
        if uncertainty <= 0.0 {
            return Err(row.wrong(2, "above 0"));
        }
        Ok(MeasuredNumber { quantity: row.cell(0).to_owned(), value: row.number(1)?, uncertainty })
    });
    rows.collect()
}
