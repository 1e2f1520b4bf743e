//! Files of what was measured: numbers, figures and charts of inspections, surfaces.
//!
//! In: files by their names. Out: [`MeasuredGear`]. What a file is follows from its ending and its columns; every table
//! and surface that gearcut writes of an inspection or a texture window is read back as it is.

use super::measured::{MeasuredGear, MeasuredNumber, MeasuredWish};
use super::surface;
use crate::influence::charts::read_lines;
use crate::influence::measured_table::{FirstLine, MeasuredTable};
use crate::job::GearJob;
use gearcut_core::error::{Refusal, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// Smaller uncertainties are none: squares of residuals over them would overflow.
const LEAST_UNCERTAINTY: f64 = 1e-12;

/// Reads files, each by its name; behind a surface's name `@` and its window may stand.
///
/// # Errors
/// Files that cannot be read or are none of these; uncertainties that nobody gives; windows that the scene does not
/// have; a number that is given twice.
pub fn read(gear: &dyn GearJob, files: &[String], wish: &MeasuredWish) -> Result<MeasuredGear> {
    let mut all = MeasuredGear { noise_um: wish.noise_um.unwrap_or_default(), ..MeasuredGear::default() };
    for file in files {
        let path = Path::new(file);
        match MeasuredKind::of(path)? {
            MeasuredKind::Numbers => all.numbers.extend(read_numbers(path)?),
            MeasuredKind::Figures => all.numbers.extend(read_figures(path, noise_um(wish, file)?)?),
            MeasuredKind::Lines => {
                noise_um(wish, file)?;
                all.lines.extend(read_lines(path)?);
            }
            MeasuredKind::Surface => {
                let (numbers, notes) = surface::read(gear, file, wish)?;
                all.numbers.extend(numbers);
                all.notes.extend(notes);
            }
        }
    }
    let mut names = BTreeSet::new();
    if let Some(twice) = all.numbers.iter().find(|number| !names.insert(&number.quantity)) {
        let problem = format!("`{}` is given twice", twice.quantity);
        return Err(Refusal::new("--measured", problem, "give one value for each number, the mean of several").into());
    }
    Ok(all)
}

/// What a file holds.
enum MeasuredKind {
    Numbers,
    Figures,
    Lines,
    Surface,
}

impl MeasuredKind {
    fn of(path: &Path) -> Result<Self> {
        let kinds = [("quantity", Self::Numbers), ("figure", Self::Figures), ("deviation_um", Self::Lines)];
        // Behind the name of a surface its window may stand.
        if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
            return Ok(Self::Surface);
        }
        let FirstLine::Columns(heads) = FirstLine::of(path, &kinds.each_ref().map(|(name, _)| *name))? else {
            return Ok(Self::Surface);
        };
        let kind = kinds.into_iter().find(|(name, _)| heads.iter().any(|head| head == name));
        Ok(kind.map_or(Self::Surface, |(_, kind)| kind))
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
fn read_numbers(path: &Path) -> Result<Vec<MeasuredNumber>> {
    let table = MeasuredTable::read(path, ["quantity", "value", "uncertainty"], &[])?;
    let rows = table.rows.iter().map(|row| {
        let uncertainty = row.number(2)?;
        if uncertainty < LEAST_UNCERTAINTY {
            return Err(row.wrong(2, &format!("above 0, at least {LEAST_UNCERTAINTY:e}")));
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
