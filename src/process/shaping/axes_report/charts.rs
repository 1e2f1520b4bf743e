//! Axis charts over the work angle: positions, velocities, accelerations, relief clearance.
//!
//! The cutter angle itself is nearly a straight line; what a gear engineer looks for is how far it departs from even
//! rolling, so both are shown.

use super::strokes::StrokeRow;
use crate::machine::{AxisMotion, Order};
use crate::output::line_chart::{LineChart, Panel};
use crate::process::shaping::linkage::dynamics::{self, AXES};
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::steps::axes::NamedChart;
use crate::steps::axes::charts::{chart, panel, panels};
use crate::units::UM_PER_MM;

/// All charts of an operation.
pub(super) fn all(job: &ShapingJob, operation: &PreparedOperation, rows: &[StrokeRow]) -> [NamedChart<LineChart>; 4] {
    let limits = dynamics::limits(&job.machine.limits);
    let points: Vec<(f64, [AxisMotion; 3])> = rows.iter().map(|row| (work_angle_deg(row), row.motion)).collect();
    let moving = |order: Order| panels(&AXES, 0..AXES.len(), &limits, order, &points);
    let words = [operation.spec.name.as_str(), &job.scene.name, operation.linkage.words()];
    let over_work_angle = |what: &str, panels: Vec<Panel>| chart(words, what, ["work angle ψc", "°"], panels);
    [
        ("positions", over_work_angle("axis positions", positions(job, rows))),
        ("velocities", over_work_angle("axis velocities", moving(Order::Speed))),
        ("accelerations", over_work_angle("axis accelerations", moving(Order::Acceleration))),
        ("relief", over_work_angle("clearance when the cutter backs off", relief(job, rows))),
    ]
}

fn work_angle_deg(row: &StrokeRow) -> f64 {
    row.motion[0].position.to_degrees()
}

fn positions(job: &ShapingJob, rows: &[StrokeRow]) -> Vec<Panel> {
    // In a ring the cutter turns the other way.
    let ratio = job.blank.kind().tip_sign() * f64::from(job.scene.gear.teeth) / f64::from(job.cutter.teeth);
    let one = |value_name: &str, unit: &str, name: &str, value: &dyn Fn(f64, &StrokeRow) -> f64| {
        let points = rows.iter().map(|row| (work_angle_deg(row), value(row.motion[0].position, row))).collect();
        panel([value_name, unit], vec![(name, points)], [])
    };
    vec![
        one("cutter angle", "°", "ψb", &|_, row| row.motion[1].position.to_degrees()),
        one("departure", "°", "cutter angle less even rolling, ψb − (z / z0) ψc", &|work_rad, row| {
            (row.motion[1].position - ratio * work_rad).to_degrees()
        }),
        one("centre distance", "mm", "l", &|_, row| row.motion[2].position),
        one("pitch point", "°", "polar angle of the pitch point less work angle, φ − ψc", &|work_rad, row| {
            (row.phi_rad - work_rad).to_degrees()
        }),
    ]
}

fn relief(job: &ShapingJob, rows: &[StrokeRow]) -> Vec<Panel> {
    let circular_um = UM_PER_MM * job.machine.back_off_mm * job.scene.gear.pressure_angle_rad.sin();
    let curve = |value: &dyn Fn(&StrokeRow) -> f64| rows.iter().map(|row| (work_angle_deg(row), value(row))).collect();
    let flanks = |scale: f64| {
        vec![
            ("left flanks", curve(&|row| scale * row.relief.left)),
            ("right flanks", curve(&|row| scale * row.relief.right)),
        ]
    };
    vec![
        panel(["clearance", "µm"], flanks(circular_um), [("circular gear", circular_um), ("rubs below", 0.0)]),
        panel(["share of circular gear", "%"], flanks(100.0), [("rubs below", 0.0)]),
    ]
}
