//! Axis charts over the work angle: positions, velocities, accelerations, relief clearance.
//!
//! The cutter angle itself is nearly a straight line; what a gear engineer looks for is how far it departs from even
//! rolling, so both are shown.

use super::{StrokeRow, acceleration_limits, linkage_words, speed_limits};
use crate::output::line_chart::{Limit, LineChart, LineSeries, Panel};
use crate::process::shaping::linkage::dynamics::{AxisMotion, MachineMotion};
use crate::process::shaping::{Job, PreparedOperation};
use crate::units::UM_PER_MM;

/// Speeds and accelerations are drawn in whole multiples of this, deg or mm per s or s^2.
const STEADY: f64 = 1e-9;

/// Picks an axis.
type AxisOf = fn(&MachineMotion) -> AxisMotion;

/// All charts of an operation, each with the word that ends its file name.
pub(super) fn all(job: &Job, operation: &PreparedOperation, rows: &[StrokeRow]) -> [(&'static str, LineChart); 4] {
    let limits = &job.machine.limits;
    let words = linkage_words(operation.spec.linkage);
    let chart = |what: &str, panels: Vec<Panel>| LineChart {
        title: format!("{} of {}: {what} ({words})", operation.spec.name, job.scene.name),
        x_name: "work angle ψc".to_owned(),
        x_unit: "°".to_owned(),
        panels,
    };
    let velocity = |axis: AxisMotion| axis.velocity;
    let acceleration = |axis: AxisMotion| axis.acceleration;
    [
        ("positions", chart("axis positions", positions(job, rows))),
        ("velocities", chart("axis velocities", moving(rows, "speed", "/s", velocity, speed_limits(limits)))),
        (
            "accelerations",
            chart("axis accelerations", moving(rows, "acceleration", "/s²", acceleration, acceleration_limits(limits))),
        ),
        ("relief", chart("clearance when the cutter backs off", relief(job, rows))),
    ]
}

fn positions(job: &Job, rows: &[StrokeRow]) -> Vec<Panel> {
    let ratio = f64::from(job.scene.gear.teeth) / f64::from(job.cutter.teeth);
    let one = |value_name: &str, unit: &str, name: &str, value: &dyn Fn(&StrokeRow) -> f64| {
        panel(value_name, unit, vec![series(rows, name, value)], vec![])
    };
    vec![
        one("cutter angle", "°", "ψb", &|row| row.motion.cutter.position.to_degrees()),
        one("departure", "°", "cutter angle less even rolling, ψb − (z / z0) ψc", &|row| {
            (row.motion.cutter.position - ratio * row.motion.work.position).to_degrees()
        }),
        one("centre distance", "mm", "l", &|row| row.motion.center_distance.position),
        one("pitch point", "°", "polar angle of the pitch point less work angle, φ − ψc", &|row| {
            (row.phi_rad - row.motion.work.position).to_degrees()
        }),
    ]
}

/// Panels of work, cutter and centre distance.
fn moving(
    rows: &[StrokeRow],
    what: &str,
    per: &str,
    value: impl Fn(AxisMotion) -> f64,
    limits: [Option<f64>; 3],
) -> Vec<Panel> {
    let axes: [(&str, &str, AxisOf); 3] = [
        ("work spindle", "°", |motion| motion.work),
        ("cutter spindle", "°", |motion| motion.cutter),
        ("centre distance", "mm", |motion| motion.center_distance),
    ];
    axes.into_iter()
        .zip(limits)
        .map(|((name, unit, axis), limit)| {
            let shown = |number: f64| if unit == "°" { number.to_degrees() } else { number };
            let curve = series(rows, name, &|row| without_rounding(shown(value(axis(&row.motion)))));
            // The limit below zero is of interest to an axis that turns back.
            let turns_back = curve.points.iter().any(|point| point.1 < 0.0);
            let signs = if turns_back { &[1.0, -1.0][..] } else { &[1.0] };
            let at = |limit: f64| signs.iter().map(move |sign| Limit { name: "limit".to_owned(), value: sign * limit });
            let limits = limit.into_iter().flat_map(|limit| at(shown(limit)));
            panel(what, &format!("{unit}{per}"), vec![curve], limits.collect())
        })
        .collect()
}

/// A steady axis shows as a straight line, not as the noise of its last digits.
fn without_rounding(value: f64) -> f64 {
    (value / STEADY).round() * STEADY
}

fn relief(job: &Job, rows: &[StrokeRow]) -> Vec<Panel> {
    let circular_um = UM_PER_MM * job.machine.back_off_mm * job.scene.gear.pressure_angle_rad.sin();
    let limit = |name: &str, value: f64| Limit { name: name.to_owned(), value };
    let flanks = |scale: f64| {
        vec![
            series(rows, "left flanks", &|row| scale * row.relief.left),
            series(rows, "right flanks", &|row| scale * row.relief.right),
        ]
    };
    vec![
        panel(
            "clearance",
            "µm",
            flanks(circular_um),
            vec![limit("circular gear", circular_um), limit("rubs below", 0.0)],
        ),
        panel("share of circular gear", "%", flanks(100.0), vec![limit("rubs below", 0.0)]),
    ]
}

fn panel(value_name: &str, unit: &str, series: Vec<LineSeries>, limits: Vec<Limit>) -> Panel {
    Panel { least_division: 0.0, value_name: value_name.to_owned(), unit: unit.to_owned(), series, limits }
}

fn series(rows: &[StrokeRow], name: &str, value: &dyn Fn(&StrokeRow) -> f64) -> LineSeries {
    let points = rows.iter().map(|row| (row.motion.work.position.to_degrees(), value(row))).collect();
    LineSeries { name: name.to_owned(), points }
}
