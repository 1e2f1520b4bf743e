//! Shaping with a pinion cutter.
//!
//! From the scene to the page, in the order of the data; each module uses only those above it:
//!
//! - `notices`: what shaping warns of
//! - [`quantities`]: what only it finds
//! - `round_mesh`: how the depth of the cutter goes with the thickness of round gears' teeth
//! - [`scene`]: what its scenes may say
//! - [`linkage`]: from a parameter to axes and poses
//! - [`tool`]: the cutter and its edges
//! - [`target`]: flanks, roots and tips as continuous motion leaves them
//! - [`motion`]: return strokes, programs, axes with their errors
//! - `swing`: where the strokes of a sector begin and end
//! - [`helix`]: the guide of helical gears
//! - [`job`]: the scene made ready
//! - [`sections`]: the target at any height
//! - [`cut`]: what all operations leave, with chips, marks and the whole blank
//! - [`gear`]: the gear cut and measured
//! - [`axes_report`]: tables, charts and programs of the axes
//! - [`findings`]: what a run finds, and what is known before it
//! - `report`: the page
//! - `stage_costs`: what the stages take
//! - [`check`]: what a scene means, in the order of the page
//! - `run`: a cut, in the order of its steps
//! - `prepared`: the job behind the commands

pub mod axes_report;
pub mod check;
pub mod cut;
pub mod findings;
pub mod gear;
pub mod helix;
pub mod job;
pub mod linkage;
pub mod motion;
pub(crate) mod notices;
mod prepared;
pub mod quantities;
mod report;
mod round_mesh;
mod run;
pub mod scene;
pub mod sections;
mod stage_costs;
mod swing;
pub mod target;
pub mod tool;

use super::Process;
use crate::steps::axes;
use axes_report::OperationAxes;

pub use gear::CutGear;
#[cfg(feature = "testing")]
pub use gear::cut_gear;
pub use job::{PreparedOperation, ShapingJob};
pub use tool::cutter::ShaperCutter;

/// The process.
pub static PROCESS: Process = Process {
    scene: &scene::SCENE,
    notices: notices::NOTICES,
    quantities: quantities::QUANTITIES,
    prepare: |scene| Ok(Box::new(prepared::PreparedShaping::new(ShapingJob::new(scene.clone())?))),
    axis_peaks: |scene| Ok(axes::found(scene, &OperationAxes::of_job(&ShapingJob::of_axes(scene.clone())?))),
};
