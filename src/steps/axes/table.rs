//! The axis table: positions, speeds and accelerations of all axes, for controllers, spreadsheets and scripts.

use crate::findings::Datum;
use crate::machine::{Axis, AxisMotion, Order};
use crate::output::table;
use gearcut_core::error::Result;
use std::path::Path;

/// What a process adds to a row or to the names of the columns: before the positions, after them, at the end.
pub type Own<T> = [Vec<T>; 3];

/// Writes a table; columns are named after the axes, with their units.
///
/// # Errors
/// A row that says more or less of its own than there are columns for it, and files that cannot be written.
pub fn write_table<const N: usize>(
    path: &Path,
    axes: &[Axis; N],
    own: Own<&str>,
    rows: impl IntoIterator<Item = (Own<Datum>, [AxisMotion; N])>,
) -> Result<()> {
    let columns = columns(axes, own);
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    table::write_table(path, &columns, rows.into_iter().map(|(own, motion)| cells(axes, own, &motion)))
}

/// Names of the columns.
pub(super) fn columns<const N: usize>(axes: &[Axis; N], own: Own<&str>) -> Vec<String> {
    let [before, between, after] = own.map(|names| names.into_iter().map(str::to_owned));
    let of = |order: Order| axes.iter().filter(move |axis| axis.has(order)).map(move |axis| axis.column(order));
    let rates = of(Order::Speed).chain(of(Order::Acceleration));
    before.chain(of(Order::Position)).chain(between).chain(rates).chain(after).collect()
}

/// A row in the units of the columns.
pub(super) fn cells<const N: usize>(axes: &[Axis; N], own: Own<Datum>, motion: &[AxisMotion; N]) -> Vec<Datum> {
    let [before, between, after] = own;
    let of = |order: Order| {
        let axes = axes.iter().zip(motion).filter(move |(axis, _)| axis.has(order));
        axes.map(move |(axis, motion)| Datum::Number(axis.kind.shown(motion.of(order))))
    };
    let rates = of(Order::Speed).chain(of(Order::Acceleration));
    before.into_iter().chain(of(Order::Position)).chain(between).chain(rates).chain(after).collect()
}
