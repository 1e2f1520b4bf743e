//! The columns of the axes in an axis table: positions, and speeds with accelerations, each in the unit of its axis.
//!
//! A process makes the table: its own columns come before, between and after them.

use crate::findings::quantities::cutting::{ACCELERATION, POSITION, SPEED};
use crate::findings::{Columns, QuantityRow};
use crate::machine::{Axis, AxisMotion, Order};

/// With the positions of all axes.
pub fn positions<T, const N: usize>(
    table: Columns<T>,
    axes: &[Axis; N],
    motion: impl Fn(&T) -> &[AxisMotion; N],
) -> Columns<T> {
    of_order(table, axes, Order::Position, &POSITION, &motion)
}

/// With the speeds of all axes, then their accelerations.
pub fn rates<T, const N: usize>(
    table: Columns<T>,
    axes: &[Axis; N],
    motion: impl Fn(&T) -> &[AxisMotion; N],
) -> Columns<T> {
    let table = of_order(table, axes, Order::Speed, &SPEED, &motion);
    of_order(table, axes, Order::Acceleration, &ACCELERATION, &motion)
}

fn of_order<T, const N: usize>(
    table: Columns<T>,
    axes: &[Axis; N],
    order: Order,
    row: &QuantityRow,
    motion: &impl Fn(&T) -> &[AxisMotion; N],
) -> Columns<T> {
    axes.iter().enumerate().filter(|(_, axis)| axis.has(order)).fold(table, |table, (index, axis)| {
        let column = row.as_column().keyed(axis.key(order)).in_unit(axis.kind.unit(order));
        table.column(column, |of| axis.kind.shown(motion(of)[index].of(order)))
    })
}
