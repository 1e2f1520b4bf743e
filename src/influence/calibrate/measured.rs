//! What was measured of a gear, from files: numbers, surfaces, lines of inspection charts.
//!
//! In: files by their names. Out: [`Measured`]. What a file is follows from its ending and its columns; every table and
//! surface that gearcut writes of an inspection or a texture window is read back as it is.

use super::surface;
use crate::influence::charts::{MeasuredLine, read_lines};
use crate::influence::measured_table::{MeasuredTable, heads};
use crate::job::GearJob;
use gearcut_core::error::{Refusal, Result};
use std::collections::BTreeSet;
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

/// How sure measured values are that carry no uncertainty, and what is taken from surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredWish {
    /// Standard uncertainty of every value on a chart and of every figure of an inspection, um.
    pub noise_um: Option<f64>,
    /// Standard uncertainty of numbers of surfaces, per cent of their values; of heights at least of Sa.
    pub surface_percent: Option<f64>,
    /// Parameters that are taken from surfaces, by symbol.
    pub symbols: Vec<String>,
}

/// Everything that was measured.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measured {
    /// Numbers, those of surfaces among them.
    pub numbers: Vec<MeasuredNumber>,
    /// Lines of charts.
    pub lines: Vec<MeasuredLine>,
    /// Standard uncertainty of every value on them, um.
    pub noise_um: f64,
    /// What a reader must know of files that are not quite what the scene cuts.
    pub notes: Vec<String>,
}

impl Measured {
    /// Numbers alone.
    pub fn of_numbers(numbers: Vec<MeasuredNumber>) -> Self {
        Self { numbers, ..Self::default() }
    }

    /// Reads files, each by its name; behind a surface's name `@` and its window may stand.
    ///
    /// # Errors
    /// Files that cannot be read or are none of these; uncertainties that nobody gives; windows that the scene does not
    /// have; a number that is given twice.
    pub fn read(gear: &dyn GearJob, files: &[String], wish: &MeasuredWish) -> Result<Self> {
        let mut all = Self { noise_um: wish.noise_um.unwrap_or_default(), ..Self::default() };
        for file in files {
            let path = Path::new(file);
            match Kind::of(path) {
                Kind::Numbers => all.numbers.extend(read_numbers(path)?),
                Kind::Figures => all.numbers.extend(read_figures(path, noise_um(wish, file)?)?),
                Kind::Lines => {
                    noise_um(wish, file)?;
                    all.lines.extend(read_lines(path)?);
                }
                Kind::Surface => {
                    let (numbers, note) = surface::read(gear, file, wish)?;
                    all.numbers.extend(numbers);
                    all.notes.extend(note);
                }
            }
        }
        let mut names = BTreeSet::new();
        if let Some(twice) = all.numbers.iter().find(|number| !names.insert(&number.quantity)) {
            let problem = format!("`{}` is given twice", twice.quantity);
            return Err(
                Refusal::new("--measured", problem, "give one value for each number, the mean of several").into()
            );
        }
        Ok(all)
    }
}

/// What a file holds.
enum Kind {
    Numbers,
    Figures,
    Lines,
    Surface,
}

impl Kind {
    fn of(path: &Path) -> Self {
        let heads = if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            heads(path).unwrap_or_default()
        } else {
            Vec::new()
        };
        let has = |name: &str| heads.iter().any(|head| head == name);
        if has("quantity") {
            Self::Numbers
        } else if has("figure") {
            Self::Figures
        } else if has("deviation_um") {
            Self::Lines
        } else {
            Self::Surface
        }
    }
}

fn noise_um(wish: &MeasuredWish, file: &str) -> Result<f64, Refusal> {
    wish.noise_um.ok_or_else(|| {
        let problem = format!("{file} says no uncertainty of its deviations");
        Refusal::new("--noise-um", problem, "give the standard uncertainty of a measured deviation, um")
    })
}

/// Reads a CSV file with the columns `quantity`, `value` and `uncertainty`, in any order, others beside them.
///
/// # Errors
/// A file that cannot be read; columns that are missing; cells that are no numbers; uncertainties that are not above 0;
/// no rows.
pub fn read_numbers(path: &Path) -> Result<Vec<MeasuredNumber>> {
    let table = MeasuredTable::read(path, ["quantity", "value", "uncertainty"], &[])?;
    let rows = table.rows.iter().map(|row| {
        let uncertainty = row.number(2)?;
        if uncertainty <= 0.0 {
            return Err(row.wrong(2, "above 0"));
        }
        Ok(MeasuredNumber { quantity: row.cell(0).to_owned(), value: row.number(1)?, uncertainty })
    });
    rows.collect()
}

/// Reads the figures of an inspection, `tables/inspection.csv` of a result.
fn read_figures(path: &Path, uncertainty: f64) -> Result<Vec<MeasuredNumber>> {
    let table = MeasuredTable::read(path, ["figure", "left_um", "right_um"], &["left_um", "right_um"])?;
    let mut found = Vec::new();
    for row in &table.rows {
        for (column, side) in [(1, "left"), (2, "right")] {
            // What was not measured, and the right of figures of both sides together, has no value.
            if !row.cell(column).is_empty() {
                let quantity = format!("inspection.figures.{}.{side}", row.cell(0));
                found.push(MeasuredNumber { quantity, value: row.number(column)?, uncertainty });
            }
        }
    }
    Ok(found)
}
