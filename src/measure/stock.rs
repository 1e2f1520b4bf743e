//! Normal stock: what one operation leaves over another one, along the target's normals.
//!
//! Dexels that the earlier operation never reached still have the blank's height; their stock is not a stock of
//! machining. They are counted, and left out of the figures. A stock below zero is a cut into the finished gear, and
//! keeps its sign.

use gearcut_core::dexel::Field;
use gearcut_core::dexel::figures::{FieldColumns, RowHeight};

/// A value and where it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// Value, mm.
    pub value_mm: f64,
    /// Arc along the profile, mm.
    pub arc_mm: f64,
    /// Place along the tooth, mm.
    pub z_mm: f64,
}

/// Stock over one field.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stock {
    /// Smallest.
    pub smallest: Extreme,
    /// Largest.
    pub largest: Extreme,
    /// Mean, mm.
    pub mean_mm: f64,
    /// Dexels with a figure.
    pub dexels: u64,
    /// Dexels that the earlier operation never reached.
    pub untouched: u64,
}

impl Stock {
    /// The same of so many rows that are all alike.
    #[must_use]
    pub fn of_rows(self, copies: u64) -> Self {
        Self { dexels: self.dexels * copies, untouched: self.untouched * copies, ..self }
    }
}

/// Smallest and largest value over some columns of a field, each with its own two; `None` if no dexel has one.
pub fn extremes(field: &Field, ranges: impl IntoIterator<Item = (usize, [RowHeight; 2])>) -> Option<[Extreme; 2]> {
    let mut found: Option<[(usize, RowHeight); 2]> = None;
    for (column, range) in ranges {
        if range[0].height_mm > range[1].height_mm {
            continue;
        }
        let own = range.map(|of| (column, of));
        found = Some(found.map_or(own, |[low, high]| {
            [
                if range[0].height_mm < low.1.height_mm { own[0] } else { low },
                if range[1].height_mm > high.1.height_mm { own[1] } else { high },
            ]
        }));
    }
    let place = |(column, of): (usize, RowHeight)| Extreme {
        value_mm: f64::from(of.height_mm),
        arc_mm: field.columns[column].arc_mm,
        z_mm: field.rows_z_mm[of.row as usize],
    };
    Some(found?.map(place))
}

/// Stock that an operation leaves over the last one on a field's chosen columns; `None` if it reached nothing there.
/// Where the last operation takes nothing because the earlier one has cut below the target, the stock is minus that
/// depth.
pub fn stock(
    field: &Field,
    columns: FieldColumns,
    operation: usize,
    column_counts: impl Fn(usize) -> bool,
) -> Option<Stock> {
    let (mut sum_mm, mut untouched, mut ranges) = (0.0, 0, Vec::new());
    for column in (0..field.columns.len()).filter(|&column| column_counts(column)) {
        let own = columns.stock(operation, column, sum_mm);
        sum_mm = own.sum_mm;
        untouched += u64::from(own.untouched);
        ranges.push((column, own.range));
    }
    let dexels = (ranges.len() * field.rows()) as u64 - untouched;
    let [smallest, largest] = extremes(field, ranges)?;
    Some(Stock { smallest, largest, mean_mm: sum_mm / dexels as f64, dexels, untouched })
}
