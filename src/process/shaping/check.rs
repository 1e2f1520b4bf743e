//! What a shaping scene means: teeth, axes, return strokes, cost.

mod along;
mod cost;
mod returns;
mod ring;
mod teeth;

use crate::findings::Notice;
use crate::output::text::Sheet;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::tooth_facts::ToothFacts;
use crate::process::shaping::{findings, foreseen};
use crate::steps::axes;
use crate::steps::check_curve::{self, gear_words};
use crate::steps::inspection;
use crate::steps::parts::Stages;
use gearcut_core::error::Result;

/// Prints everything; what must be known before cutting.
///
/// # Errors
/// Geometry that cannot be cut.
pub fn print(sheet: &mut Sheet, job: &ShapingJob) -> Result<Vec<Notice>> {
    let facts = ToothFacts::of_job(job);
    let operations = OperationAxes::of_job(job);

    sheet.heading(&format!("{}: {}", job.scene.name, gear_words(&job.scene.gear)));
    check_curve::print(sheet, &job.curve, &job.scene.gear, Some(job.cutter.pitch_radius_mm));
    inspection::print(sheet, job)?;
    let other_gear = findings::program::not_of_the_gear(job, &operations);
    teeth::print(sheet, job, &facts, other_gear.is_some());
    let ring = findings::ring::of_job(job, other_gear.as_deref());
    if let Some(ring) = &ring {
        ring::print(sheet, ring, job.blank.addendum_mm);
    }
    for operation in &operations {
        axes::print(operation, sheet);
    }
    returns::print(sheet, job, &operations)?;
    // Before the cost: a cut does it as well.
    let foreseen = foreseen::foresee(job, &operations, Stages::ALL)?;
    cost::print(sheet, job, &facts)?;
    foreseen::print(sheet, job);
    Ok(foreseen.warnings)
}
