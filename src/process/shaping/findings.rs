//! What a run finds on a shaped gear: headline, operations, deviations, teeth.
//!
//! In: the job, what was measured, the chip ledger. Out: entries and sections of the tree. Nothing is computed here but
//! extremes over flanks.

pub mod answers;
mod chips;
pub mod deflection;
mod headline;
pub mod machine_errors;
mod operation;
pub mod program;
pub mod returns;
pub mod ring;
mod strokes;
mod tables;
mod teeth;

pub use headline::headline;

use crate::findings::{Place, Quantity, Section};
use crate::measure::deviation::{PitchDeviations, Runout};
use crate::measure::stock::Extreme;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::chips::ChipLedger;
use crate::process::shaping::measure::{FlankReport, GearReport};
use gearcut_core::error::Refusal;
use gearcut_core::units::UM_PER_MM;
use operation::operation;

/// Why there is no pitch deviation.
const NOT_CROSSED: &str = "a flank was not cut, is cut away, or does not cross the pitch curve";

/// Operations, deviations and teeth; errors of the machine, and what was known of a ring before cutting.
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
    let period = "teeth after which the pitch curve repeats: the first period of tables and charts";
    let other_gear = program::not_of_the_gear(job, motion);
    let tooth = |tooth| teeth::finished_tooth(report, tooth, other_gear.as_deref());
    let teeth: Vec<Section> = (1..=job.scene.gear.teeth).map(tooth).collect();
    let flank_table = tables::flanks(&report.flanks, &operations[..operations.len() - 1], &teeth);
    let sections = [
        Section::new("operations", "Operations").parts(operations),
        deviations(report),
        Section::new("teeth", "Finished teeth")
            .with("period_teeth", Quantity::count(report.period_teeth.into(), "teeth", period))
            .table(flank_table)
            .table(tables::teeth(&teeth))
            .parts(teeth),
    ];
    Ok(sections
        .into_iter()
        .chain(machine_errors::errors(job))
        .chain(ring::of_job(job, other_gear.as_deref()))
        .collect())
}

/// What a gear inspector states of the whole gear.
fn deviations(report: &GearReport) -> Section {
    let um = |mm: Option<f64>, definition: &'static str| {
        Quantity::number_or(mm.map(|mm| mm * UM_PER_MM), "um", definition, NOT_CROSSED)
    };
    let worst = report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.profile?)))
        .reduce(|best, next| if next.1.total_mm > best.1.total_mm { next } else { best });
    let profile = um(
        worst.map(|(_, profile)| profile.total_mm),
        "largest range of normal deviations along an evaluated profile, middle of the face",
    );
    let profile = match worst {
        Some((flank, of)) => {
            let middle_mm = 0.5 * (of.between_mm[0] + of.between_mm[1]);
            profile.at(Place::on_flank(flank.tooth, flank.side.name(), middle_mm, 0.0))
        }
        None => profile,
    };
    let pitch = |pick: fn(&PitchDeviations) -> f64, definition: &'static str| {
        um(report.inspection.pitch.iter().flatten().map(pick).reduce(f64::max), definition)
    };
    Section::new("deviations", "Deviations of the finished gear")
        .shown("profile_deviation", "profile deviation F_alpha", profile)
        .shown(
            "single_pitch_deviation",
            "single pitch deviation f_p",
            pitch(
                PitchDeviations::largest_single_mm,
                "largest single pitch deviation of either flank, arc on the pitch curve",
            ),
        )
        .shown(
            "total_pitch_deviation",
            "total pitch deviation F_p",
            pitch(PitchDeviations::total_mm, "range of the cumulative pitch deviations, larger of both flanks"),
        )
        .shown(
            "runout",
            "runout F_r",
            um(
                report.inspection.runout.as_ref().map(Runout::total_mm),
                "range of a probe's place along the pitch curve's normal over all spaces",
            ),
        )
}

/// Place of an extreme on a flank.
pub fn place(flank: &FlankReport, at: &Extreme) -> Place {
    Place::on_flank(flank.tooth, flank.side.name(), at.arc_mm, at.z_mm)
}
