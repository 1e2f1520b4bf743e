//! Shaping with a pinion cutter.

pub mod actual;
pub mod axes_report;
pub mod blank;
mod built_up_edge;
pub mod check;
mod chip_charts;
pub mod chips;
mod cut;
pub mod cutter;
pub mod edge_polygon;
pub mod edge_roughness;
mod edge_rounding;
pub mod fillet;
pub mod findings;
pub mod foreseen;
pub mod gcode;
pub mod gear;
pub mod generation;
pub mod job;
pub mod linkage;
pub mod measure;
pub(crate) mod notices;
mod prepared;
pub mod programs;
pub mod quantities;
mod report;
pub mod returns;
pub mod ring;
mod run;
pub mod scene;
pub mod section;
mod stage_costs;
mod stroke_noise;
mod surfaces;
pub mod target;
mod tearing;
pub mod tip_relief;
pub mod tooth_facts;
pub mod tooth_target;
pub mod undercut;
pub mod warnings;

use super::Process;
use crate::steps::axes;
use axes_report::OperationAxes;

pub use cutter::ShaperCutter;
pub use gear::{CutGear, cut_gear};
pub use job::{PreparedOperation, ShapingJob};

/// The process.
pub static PROCESS: Process = Process {
    scene: &scene::SCENE,
    notices: notices::NOTICES,
    quantities: quantities::QUANTITIES,
    prepare: |scene| Ok(Box::new(prepared::PreparedShaping::new(ShapingJob::new(scene.clone())?))),
    axis_peaks: |scene| Ok(axes::found(scene, &OperationAxes::of_job(&ShapingJob::without_targets(scene.clone())?))),
};
