//! All strokes of an operation, and what they add to the axis table: one row per stroke; where the axes draw the cutter
//! back, with their positions on the way back.

use crate::findings::Datum;
use crate::machine::{AxisMotion, Motion as _};
use crate::process::shaping::linkage::StrokeState;
use crate::process::shaping::linkage::dynamics::AXES;
use crate::process::shaping::linkage::relief::{self, ReliefRatio};
use crate::process::shaping::linkage::retraction::RetractionLaw;
use crate::process::shaping::returns::RetractionPlan;
use crate::process::shaping::returns::motion::axes_of;
use crate::process::shaping::{PreparedOperation, ShapingJob};
use crate::steps::axes;
use gearcut_core::Result;
use std::path::Path;

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
            relief: relief::relief_ratio(linkage, phi_rad, offset_mm, job.scene.gear.pressure_angle_rad),
            scene: program
                .as_ref()
                .filter(|_| stroke < schedule.count())
                .map(|_| schedule.at(coordinate).map(|axis| axis.position)),
            returning: operation.retraction.is_in_axes().then(|| return_axes(operation, &schedule.state(coordinate))),
        }
    };
    (0..operation.count()).map(row).collect()
}

/// Writes the table; `stroke` counts from 0, as pass ids do, and angles run on beyond a turn. Under a program the axes
/// are the program's, and the scene's own positions stand beside them.
pub(super) fn write_table(path: &Path, operation: &PreparedOperation, rows: &[StrokeRow]) -> Result<()> {
    let (plan, under_test) = (&operation.retraction, operation.program.is_some());
    let relief = ["left_relief_share_of_circular", "right_relief_share_of_circular", "normal_to_line_of_centres_deg"];
    let returning = if plan.is_in_axes() { &COLUMNS[..] } else { &[] };
    let scene = if under_test { &SCENE_COLUMNS[..] } else { &[] };
    // What follows from the schedule and not from the axes is the scene's as well.
    let of_scene = |names: &[&str]| -> Vec<String> {
        let of = if under_test { "scene_" } else { "" };
        names.iter().map(|name| format!("{of}{name}")).collect()
    };
    let following = [of_scene(&[&relief[..], returning].concat()), scene.iter().map(|&name| name.to_owned()).collect()];
    let own: [Vec<String>; 3] =
        [["stroke", "time_s"].map(str::to_owned).to_vec(), of_scene(&["offset_mm", "phi_deg"]), following.concat()];
    let row = |row: &StrokeRow| {
        let stroke = Datum::from(row.stroke as u64);
        let own = [
            vec![stroke, row.time_s.into()],
            vec![row.offset_mm.into(), row.phi_rad.to_degrees().into()],
            [
                vec![row.relief.left.into(), row.relief.right.into(), row.relief.beta_rad.to_degrees().into()],
                cells(plan, row),
                if under_test { scene_cells(row) } else { Vec::new() },
            ]
            .concat(),
        ];
        (own, row.motion)
    };
    let own = own.each_ref().map(|names| names.iter().map(String::as_str).collect());
    axes::write_table(path, &AXES, own, rows.iter().map(row))
}

/// Where the axes stand on the way back after a stroke, rad, rad, mm.
fn return_axes(operation: &PreparedOperation, state: &StrokeState) -> [f64; 3] {
    let back = operation.retraction.retracted(operation.schedule.linkage(), &state.pose, state.phi_rad);
    axes_of(state, &back)
}

/// Names of the columns of the way back.
const COLUMNS: [&str; 4] = ["retraction", "return_psi_c_deg", "return_psi_b_deg", "return_center_distance_mm"];

/// Names of the columns of the scene's own positions under a program.
const SCENE_COLUMNS: [&str; 3] = ["scene_psi_c_deg", "scene_psi_b_deg", "scene_center_distance_mm"];

/// Cells of the scene's own positions.
fn scene_cells(row: &StrokeRow) -> Vec<Datum> {
    let shown =
        |index: usize| row.scene.map_or(Datum::Undefined, |scene| Datum::Number(AXES[index].kind.shown(scene[index])));
    (0..AXES.len()).map(shown).collect()
}

/// Cells of the way back.
fn cells(plan: &RetractionPlan, row: &StrokeRow) -> Vec<Datum> {
    let Some(axes) = row.returning else { return Vec::new() };
    let shown = AXES.iter().zip(axes).map(|(axis, position)| Datum::Number(axis.kind.shown(position)));
    std::iter::once(law_word(plan.law(row.phi_rad)).into()).chain(shown).collect()
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
