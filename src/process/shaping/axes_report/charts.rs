//! Axis charts over the work angle: positions, velocities, accelerations, relief clearance.
//!
//! The cutter angle itself is nearly a straight line; what a gear engineer looks for is how far it departs from even
//! rolling, so both are shown.

use super::retraction;
use super::strokes::StrokeRow;
use crate::machine::{Axis, AxisMotion, Order};
use crate::output::line_chart::{LineChart, Panel};
use crate::process::shaping::linkage::dynamics::{self, AXES, CENTER_DISTANCE, CUTTER, WORK};
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::steps::axes::NamedChart;
use crate::steps::axes::charts::{chart, panel, panels};
use gearcut_core::gear::GearKind;
use gearcut_core::units::UM_PER_MM;

/// Ticks of positions are no closer, deg and mm: a micron on a radius of 60 mm.
const LEAST_DIVISION: f64 = 1e-3;

/// All charts of an operation.
pub(super) fn all(job: &ShapingJob, operation: &PreparedOperation, rows: &[StrokeRow]) -> Vec<NamedChart<LineChart>> {
    let limits = dynamics::limits(&job.machine.limits);
    let points: Vec<(f64, [AxisMotion; 3])> = rows.iter().map(|row| (work_angle_deg(row), row.motion)).collect();
    let moving = |order: Order| panels(&AXES, 0..AXES.len(), &limits, order, &points);
    // Under a program the axes are the program's; clearance and retraction follow from the schedule.
    let linkage = operation.linkage.words();
    let under_test = |whose: &str| match operation.program {
        Some(_) => format!("{linkage}; {whose}"),
        None => linkage.to_owned(),
    };
    let [of, of_scene] = [under_test("the program's axes"), under_test("by the scene's own strokes")];
    let chart_of = |of: &str, what: &str, panels: Vec<Panel>| {
        let words = [operation.spec.name.as_str(), &job.scene.name, of];
        chart(words, what, ["work angle ψc", position_sign(&WORK)], panels)
    };
    let over_work_angle = |what: &str, panels: Vec<Panel>| chart_of(&of, what, panels);
    let mut charts = vec![
        ("positions", over_work_angle("axis positions", positions(job, rows))),
        ("velocities", over_work_angle("axis velocities", moving(Order::Speed))),
        ("accelerations", over_work_angle("axis accelerations", moving(Order::Acceleration))),
        ("relief", chart_of(&of_scene, "clearance when the cutter backs off", relief(job, rows))),
    ];
    if operation.retraction.is_in_axes() {
        let travel = chart_of(&of_scene, "travel of the axes to the return stroke", retraction::panels(rows));
        charts.push(("retraction", travel));
    }
    charts
}

fn work_angle_deg(row: &StrokeRow) -> f64 {
    let [work, _, _] = row.motion;
    WORK.kind.shown(work.position)
}

fn position_sign(axis: &Axis) -> &'static str {
    axis.kind.sign(Order::Position)
}

fn positions(job: &ShapingJob, rows: &[StrokeRow]) -> Vec<Panel> {
    // In a ring the cutter turns the other way.
    let ratio = job.blank.kind().tip_sign() * f64::from(job.scene.gear.teeth) / f64::from(job.cutter.teeth);
    // A value from the positions of the axes and the polar angle of the pitch point, read as positions of `axis` are.
    let under_test = rows.iter().any(|row| row.scene.is_some());
    // An axis that follows even rolling departs from it by rounding.
    let at_rest = |panel: Panel| Panel { least_division: LEAST_DIVISION, ..panel };
    let one = |value_name: &str, axis: &Axis, name: &str, value: &dyn Fn([f64; 3], f64) -> f64| {
        let shown = |axes: [f64; 3], row: &StrokeRow| axis.kind.shown(value(axes, row.phi_rad));
        let own = |row: &StrokeRow| (work_angle_deg(row), shown(row.motion.map(|axis| axis.position), row));
        let points = rows.iter().map(own).collect();
        if !under_test {
            return at_rest(panel([value_name, position_sign(axis)], vec![(name, points)], []));
        }
        let scene = rows.iter().filter_map(|row| row.scene.map(|axes| (WORK.kind.shown(axes[0]), shown(axes, row))));
        let series = vec![(name, points), ("the scene's own strokes", scene.collect())];
        at_rest(panel([value_name, position_sign(axis)], series, []))
    };
    let even_rolling = match job.blank.kind() {
        GearKind::External => "cutter angle less even rolling, ψb − (z / z0) ψc",
        GearKind::Internal => "cutter angle less even rolling, ψb + (z / z0) ψc",
    };
    vec![
        one("cutter angle", &CUTTER, "ψb", &|[_, cutter_rad, _], _| cutter_rad),
        one("departure", &CUTTER, even_rolling, &|[work_rad, cutter_rad, _], _| cutter_rad - ratio * work_rad),
        one("centre distance", &CENTER_DISTANCE, "l", &|[_, _, center_distance_mm], _| center_distance_mm),
        one(
            "pitch point",
            &WORK,
            "polar angle of the pitch point less work angle, φ − ψc",
            &|[work_rad, _, _], phi_rad| phi_rad - work_rad,
        ),
    ]
}

fn relief(job: &ShapingJob, rows: &[StrokeRow]) -> Vec<Panel> {
    let circular_um = UM_PER_MM * job.machine.back_off_mm * job.transverse.pressure_angle_rad.sin();
    let pressure_deg = job.transverse.pressure_angle_rad.to_degrees();
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
        panel(
            ["retraction angle", "°"],
            vec![(
                "normal to line of centres, positive where left flanks gain",
                curve(&|row| row.relief.beta_rad.to_degrees()),
            )],
            [("pressure angle", pressure_deg), ("pressure angle", -pressure_deg)],
        ),
    ]
}
