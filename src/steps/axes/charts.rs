//! Charts of axes: a panel per axis with its limits, over whatever the process finds telling.

use super::STEADY;
use crate::machine::{Axis, AxisMotion, Limits, Order};
use crate::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use std::ops::Range;

/// What a chart is drawn over: name and unit.
pub type Abscissa = [&'static str; 2];

/// A chart of an operation; the title says what it shows, of which scene, under which linkage.
pub fn chart(
    [operation, scene, linkage]: [&str; 3],
    what: &str,
    [x_name, x_unit]: Abscissa,
    panels: Vec<Panel>,
) -> LineChart {
    LineChart {
        title: format!("{operation} of {scene}: {what} ({linkage})"),
        x_name: x_name.to_owned(),
        x_unit: x_unit.to_owned(),
        panels,
    }
}

/// A panel for every axis among those shown that has something to say of an order; points are x, in the chart's unit,
/// and all axes there.
pub fn panels<const N: usize>(
    axes: &[Axis; N],
    shown: Range<usize>,
    limits: &[Limits; N],
    order: Order,
    points: &[(f64, [AxisMotion; N])],
) -> Vec<Panel> {
    let one = |index: usize| {
        let motion = points.iter().map(|(x, motion)| (*x, motion[index].of(order))).collect();
        panel_of(&axes[index], order, limits[index].of(order), motion)
    };
    shown.filter(|&index| axes[index].has(order)).map(one).collect()
}

fn panel_of(axis: &Axis, order: Order, limit: Option<f64>, mut points: Vec<(f64, f64)>) -> Panel {
    for (_, value) in &mut points {
        *value = axis.kind.shown(*value);
        if order != Order::Position {
            // A steady axis shows as a straight line, not as the noise of its last digits.
            *value = (*value / STEADY).round() * STEADY;
        }
    }
    // The limit below zero is of interest to an axis that turns back.
    let turns_back = points.iter().any(|point| point.1 < 0.0);
    let signs = if turns_back { &[1.0, -1.0][..] } else { &[1.0] };
    let limit = limit.map(|limit| axis.kind.shown(limit));
    let limits = limit.into_iter().flat_map(|limit| signs.iter().map(move |sign| ("limit", sign * limit)));
    let value_name = if order == Order::Position { axis.name } else { order.word() };
    panel([value_name, axis.kind.sign(order)], vec![(axis.name, points)], limits)
}

/// A panel of curves and limits by their names; what its values are, and their unit.
pub fn panel<'a>(
    [value_name, unit]: [&str; 2],
    curves: Vec<(&str, Vec<(f64, f64)>)>,
    limits: impl IntoIterator<Item = (&'a str, f64)>,
) -> Panel {
    let series = curves.into_iter().map(|(name, points)| LineSeries { name: name.to_owned(), points });
    let limits = limits.into_iter().map(|(name, value)| Limit { name: name.to_owned(), value });
    Panel {
        least_division: 0.0,
        value_name: value_name.to_owned(),
        unit: unit.to_owned(),
        series: series.collect(),
        limits: limits.collect(),
    }
}
