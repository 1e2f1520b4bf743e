//! How the machine has to move: axis tables, charts, peaks against limits, relief on the return stroke.
//!
//! In: a prepared [`Job`]. Out: [`OperationAxes`] with its text for the terminal and its part of `results.json`, and
//! per operation in `axes/`: `<operation>.csv` (one row per stroke), `<operation>_positions`, `_velocities`,
//! `_accelerations` and `_relief` as PNG and SVG.
//!
//! The laws stand in [`crate::process::shaping::linkage::dynamics`] and [`crate::process::shaping::linkage::relief`];
//! here their numbers get degrees and micrometres.

mod charts;
mod quantities;
mod summary;
mod table;

use crate::machine::Peak;
use crate::output::folder::OutputFolder;
use crate::output::line_chart::LineChart;
use crate::process::shaping::linkage::StrokeSchedule;
use crate::process::shaping::linkage::dynamics;
use crate::process::shaping::linkage::dynamics::{MachineMotion, MachinePeaks};
use crate::process::shaping::linkage::relief;
use crate::process::shaping::linkage::relief::{ReliefRatio, SmallestRelief};
use crate::process::shaping::scene::model::{AxisLimits, Linkage, NormalReading, Operation, TraditionalDirection};
use crate::process::shaping::{Job, PreparedOperation};
use crate::units::TURN_RAD;
use crate::{Error, Result};

/// Places per turn at which beta is looked at; its peaks are so flat that nothing is lost.
const BETA_PLACES: u32 = 7200;

/// What one operation asks of the machine.
#[derive(Debug, Clone, PartialEq)]
pub struct OperationAxes {
    /// The operation.
    pub operation: Operation,
    /// Strokes, plunging ones included.
    pub strokes: usize,
    /// Strokes that plunge before the rolling.
    pub plunging_strokes: usize,
    /// N, given or following from the circular feed.
    pub strokes_per_revolution: u32,
    /// Mean arc of pitch curve per double stroke, mm.
    pub circular_feed_mm_per_stroke: f64,
    /// Time of all strokes, s.
    pub cycle_time_s: f64,
    /// Peaks of the axes against their limits.
    pub peaks: MachinePeaks,
    /// Where the return stroke has the least clearance.
    pub relief: SmallestRelief,
    /// How far the cutter backs off, mm.
    pub back_off_mm: f64,
    /// Largest angle between the line of centres and the common normal direction, rad, without its sign.
    pub largest_beta_rad: f64,
    /// Polar angle of the pitch point there, rad.
    pub largest_beta_phi_rad: f64,
    /// Work angles of the peaks in their order, rad.
    peaks_at_rad: [f64; 6],
}

/// One stroke: the machine's motion and the clearance of its return.
struct StrokeRow {
    /// Stroke, from 0.
    stroke: usize,
    motion: MachineMotion,
    phi_rad: f64,
    offset_mm: f64,
    /// Clearance as a share of a circular gear's.
    relief: ReliefRatio,
}

impl OperationAxes {
    /// Peaks, relief and times of operation `index` of a job.
    pub fn new(job: &Job, index: usize) -> Self {
        let PreparedOperation { spec, linkage, schedule, .. } = &job.operations[index];
        let machine = &job.machine;
        let pressure_angle_rad = job.scene.gear.pressure_angle_rad;
        let beta = |phi: f64| {
            let motion = linkage.pose_motion(phi, spec.offset_mm);
            let out = motion.pose.center_mm - motion.instantaneous_center_mm();
            out.perp_dot(motion.pose.center_mm).atan2(out.dot(motion.pose.center_mm)).abs()
        };
        let places = (0..BETA_PLACES).map(|i| TURN_RAD * f64::from(i) / f64::from(BETA_PLACES));
        let (largest_beta_phi_rad, largest_beta_rad) =
            places.map(|phi| (phi, beta(phi))).fold((0.0, 0.0), |best, here| if here.1 > best.1 { here } else { best });
        let peaks = dynamics::peaks(schedule, &machine.limits);
        let peaks_at_rad = in_order(&peaks).map(|peak| schedule.state(peak.stroke).psi_c_rad);
        Self {
            operation: spec.clone(),
            strokes: schedule.count(),
            plunging_strokes: schedule.plunge_count(),
            strokes_per_revolution: schedule.strokes_per_revolution(),
            circular_feed_mm_per_stroke: schedule.circular_feed_mm_per_stroke(),
            cycle_time_s: schedule.time_s(schedule.count() as f64),
            peaks,
            relief: relief::smallest_relief(linkage, spec.offset_mm, pressure_angle_rad),
            back_off_mm: machine.back_off_mm,
            largest_beta_rad,
            largest_beta_phi_rad,
            peaks_at_rad,
        }
    }

    /// Of all operations of a job, in order.
    pub fn of_job(job: &Job) -> Vec<Self> {
        (0..job.operations.len()).map(|index| Self::new(job, index)).collect()
    }

    /// What is left of the tightest limit, as a share of it; `None` without limits.
    pub fn smallest_margin(&self) -> Option<f64> {
        in_order(&self.peaks).into_iter().filter_map(Peak::margin).min_by(f64::total_cmp)
    }
}

/// Speed and acceleration of work, cutter and centre distance.
fn in_order(peaks: &MachinePeaks) -> [&Peak; 6] {
    let MachinePeaks { work, cutter, center_distance: distance } = peaks;
    [&work.speed, &work.acceleration, &cutter.speed, &cutter.acceleration, &distance.speed, &distance.acceleration]
}

/// The linkage in words.
pub fn linkage_words(linkage: Linkage) -> &'static str {
    match linkage {
        Linkage::ShapingNormal { reading: NormalReading::Corrected } => "normal linkage",
        Linkage::ShapingNormal { reading: NormalReading::AsPrinted } => "normal linkage, Eq. 12 as printed",
        Linkage::ShapingTraditional { direction: TraditionalDirection::CenterLine } => "traditional linkage",
        Linkage::ShapingTraditional { direction: TraditionalDirection::PolarRadius } => {
            "traditional linkage along the polar radius"
        }
    }
}

/// Writes tables and charts of all operations into the folder's `axes/`.
///
/// # Errors
/// Files that cannot be written.
pub fn write(job: &Job, folder: &OutputFolder) -> Result<()> {
    for operation in &job.operations {
        write_operation(job, operation, folder)?;
    }
    Ok(())
}

/// The charts of operation `index`: positions, velocities, accelerations, relief.
pub fn charts(job: &Job, index: usize) -> Vec<LineChart> {
    let operation = &job.operations[index];
    charts::all(job, operation, &rows(job, operation)).into_iter().map(|(_, chart)| chart).collect()
}

fn write_operation(job: &Job, operation: &PreparedOperation, folder: &OutputFolder) -> Result<(), Error> {
    let name = &operation.spec.name;
    let rows = rows(job, operation);
    table::write(&folder.path(format!("axes/{name}.csv"))?, &rows)?;
    for (what, chart) in charts::all(job, operation, &rows) {
        chart.write_png(&folder.path(format!("axes/{name}_{what}.png"))?)?;
        chart.write_svg(&folder.path(format!("axes/{name}_{what}.svg"))?)?;
    }
    Ok(())
}

/// All strokes of an operation.
fn rows(job: &Job, operation: &PreparedOperation) -> Vec<StrokeRow> {
    let PreparedOperation { linkage, schedule, .. } = operation;
    let pressure_angle_rad = job.scene.gear.pressure_angle_rad;
    let row = |stroke: usize, schedule: &StrokeSchedule| {
        let coordinate = stroke as f64;
        let (phi_rad, offset_mm) = (schedule.phi_rad(coordinate), schedule.offset_mm(coordinate));
        let motion = dynamics::motion(schedule, coordinate);
        let relief = relief::relief_ratio(linkage, phi_rad, offset_mm, pressure_angle_rad);
        StrokeRow { stroke, motion, phi_rad, offset_mm, relief }
    };
    (0..schedule.count()).map(|stroke| row(stroke, schedule)).collect()
}

/// Limits in the order of the axes, speeds: rad/s, rad/s, mm/s.
fn speed_limits(limits: &AxisLimits) -> [Option<f64>; 3] {
    [limits.work_speed_rad_per_s, limits.cutter_speed_rad_per_s, limits.center_distance_speed_mm_per_s]
}

/// Limits in the order of the axes, accelerations: rad/s^2, rad/s^2, mm/s^2.
fn acceleration_limits(limits: &AxisLimits) -> [Option<f64>; 3] {
    [
        limits.work_acceleration_rad_per_s2,
        limits.cutter_acceleration_rad_per_s2,
        limits.center_distance_acceleration_mm_per_s2,
    ]
}
