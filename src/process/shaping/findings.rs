//! What a run finds on a shaped gear: headline, operations, teeth.
//!
//! In: the job, what was measured, the chip ledger. Out: entries and sections of the tree. Nothing is computed here but
//! extremes over flanks.

pub mod answers;
mod chips;
mod cmm;
pub mod deflection;
pub mod foreseen;
mod headline;
pub mod machine_errors;
mod operation;
pub mod program;
pub mod returns;
pub mod ring;
mod strokes;
mod tables;
mod teeth;
pub mod warnings;
pub mod wear;

pub use headline::headline;

use crate::findings::Section;
use crate::findings::quantities::OPERATIONS;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::cut::chips::ChipLedger;
use crate::process::shaping::gear::measure::GearReport;
use crate::process::shaping::quantities::PERIOD_TEETH;
use gearcut_core::error::Refusal;
use operation::operation;

/// Operations, deviations and teeth; errors of the machine.
///
/// # Errors
/// A back-off so large that the retraction leads to no pose.
pub fn sections(
    job: &ShapingJob,
    report: &GearReport,
    ledger: &ChipLedger,
    motion: &[OperationAxes],
) -> Result<Vec<Section>, Refusal> {
    let operations = (0..job.operations.len()).map(|index| operation(job, report, ledger, motion, index));
    let operations: Vec<Section> = operations.collect::<Result<_, _>>()?;
    let other_gear = program::not_of_the_gear(job, motion);
    let tooth = |tooth| teeth::finished_tooth(report, tooth, other_gear.as_deref());
    let teeth: Vec<Section> = (1..=job.scene.gear.teeth).map(tooth).collect();
    let earlier = job.operations.iter().rev().skip(1).rev().map(|operation| operation.spec.name.as_str());
    let sections = [
        OPERATIONS.section([]).parts(operations),
        Section::new("teeth", "Finished teeth")
            .entries([PERIOD_TEETH.of(report.period_teeth)])
            .table(tables::flanks(&report.flanks, earlier, &teeth))
            .table(tables::teeth(&teeth))
            .parts(teeth),
    ];
    Ok(sections.into_iter().chain(machine_errors::errors(job)).collect())
}
