//! All strokes of an operation, and what they add to the axis table: one row per stroke; where the axes draw the cutter
//! back, with their positions on the way back.

use crate::findings::quantities::blank::STROKE;
use crate::findings::quantities::cutting::TIME;
use crate::findings::{QuantityRow, Table};
use crate::machine::{Axis, AxisMotion, Motion as _, Order};
use crate::process::shaping::linkage::StrokeState;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::linkage::relief::{self, ReliefRatio};
use crate::process::shaping::linkage::retraction::RetractionLaw;
use crate::process::shaping::motion::returns::motion::axes_of;
use crate::process::shaping::quantities::axes::{
    LEFT_RELIEF, NORMAL_TO_CENTRES, OFFSET_AT, PHI, RETRACTION_LAW, RETURN_POSITION, RIGHT_RELIEF, SCENE_POSITION,
};
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::steps::axes;

/// One stroke: the machine's motion and the clearance of its return.
#[derive(Debug)]
pub(super) struct StrokeRow {
    /// Stroke, from 0.
    pub stroke: usize,
    pub time_s: f64,
    /// Work, cutter, centre distance.
    pub motion: [AxisMotion; 3],
    pub phi_rad: f64,
    pub offset_mm: f64,
    /// Clearance as a share of a circular gear's.
    pub relief: ReliefRatio,
    /// Where the axes stand on the way back, where they draw the cutter back.
    pub returning: Option<[f64; 3]>,
    /// Positions of the scene's own stroke, rad, rad, mm, where `motion` is a program's: none beyond its last one.
    pub scene: Option<[f64; 3]>,
}

/// All strokes of an operation: those of a program under test, if one is cut.
pub(super) fn rows(job: &ShapingJob, operation: &PreparedOperation) -> Vec<StrokeRow> {
    let PreparedOperation { linkage, schedule, program, .. } = operation;
    let row = |stroke: usize| {
        let coordinate = stroke as f64;
        let (phi_rad, offset_mm) = (schedule.phi_rad(coordinate), schedule.offset_mm(coordinate));
        StrokeRow {
            stroke,
            time_s: schedule.time_s(coordinate),
            motion: program.as_ref().map_or_else(|| schedule.at(coordinate), |program| program.motion(coordinate)),
            phi_rad,
            offset_mm,
            relief: relief::relief_ratio(linkage, phi_rad, offset_mm, job.transverse.pressure_angle_rad),
            scene: program
                .as_ref()
                .filter(|_| stroke < schedule.count())
                .map(|_| schedule.at(coordinate).map(|axis| axis.position)),
            returning: operation.retraction.is_in_axes().then(|| return_axes(operation, &schedule.state(coordinate))),
        }
    };
    (0..operation.count()).map(row).collect()
}

/// The table; `stroke` counts from 0, as pass ids do, and angles run on beyond a turn. Under a program the axes are the
/// program's, the scene's own positions are beside them, and what follows from the schedule is the scene's as well.
pub(super) fn table(operation: &PreparedOperation, rows: &[StrokeRow]) -> Table {
    let (plan, under_test) = (&operation.retraction, operation.program.is_some());
    let of_scene = |row: &QuantityRow| {
        let column = row.as_column();
        if under_test { column.keyed(format!("scene_{}", row.key)) } else { column }
    };
    let of_axis = |row: &QuantityRow, axis: &Axis| {
        let key = format!("{}_{}", row.key, axis.key(Order::Position));
        row.as_column().keyed(key).in_unit(axis.kind.unit(Order::Position))
    };
    let table = Table::over("axes", "Axes", rows).column(&STROKE, |row| row.stroke).column(&TIME, |row| row.time_s);
    let table = axes::positions(table, &AXES, |row| &row.motion)
        .column(of_scene(&OFFSET_AT), |row| row.offset_mm)
        .column(of_scene(&PHI), |row| row.phi_rad.to_degrees());
    let mut table = axes::rates(table, &AXES, |row| &row.motion)
        .column(of_scene(&LEFT_RELIEF), |row| row.relief.left)
        .column(of_scene(&RIGHT_RELIEF), |row| row.relief.right)
        .column(of_scene(&NORMAL_TO_CENTRES), |row| row.relief.beta_rad.to_degrees());
    if plan.is_in_axes() {
        table = table.column(of_scene(&RETRACTION_LAW), |row| law_word(plan.law(row.phi_rad)));
        for (index, axis) in AXES.iter().enumerate() {
            let column = of_axis(&RETURN_POSITION, axis);
            let column = if under_test { column.clone().keyed(format!("scene_{}", column.key)) } else { column };
            table = table.column(column, |row| row.returning.map(|axes| axis.kind.shown(axes[index])));
        }
    }
    if under_test {
        for (index, axis) in AXES.iter().enumerate() {
            let column = of_axis(&SCENE_POSITION, axis);
            table = table.column(column, |row| row.scene.map(|axes| axis.kind.shown(axes[index])));
        }
    }
    table.into()
}

/// Where the axes stand on the way back after a stroke, rad, rad, mm.
fn return_axes(operation: &PreparedOperation, state: &StrokeState) -> [f64; 3] {
    let back = operation.retraction.retracted(operation.schedule.linkage(), &state.pose, state.phi_rad);
    axes_of(state, &back)
}

/// The key's word for a law.
fn law_word(law: RetractionLaw) -> &'static str {
    match law {
        RetractionLaw::CenterLine => "center_line",
        RetractionLaw::Normal => "normal",
        RetractionLaw::Tilted(_) => "tilted",
        RetractionLaw::Turned => "turned",
    }
}
