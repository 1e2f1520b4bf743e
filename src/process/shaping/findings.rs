//! What a run finds on a shaped gear: headline, operations, deviations, teeth.
//!
//! In: the job, what was measured, the chip ledger. Out: entries and sections of the tree. Nothing is computed here but
//! extremes over flanks.

mod chips;
mod headline;
mod operation;
mod ring;
mod strokes;
mod tables;
mod teeth;

pub use headline::headline;

use crate::findings::{Place, Quantity, Section};
use crate::measure::deviation::{PitchDeviations, Runout};
use crate::measure::stock::Extreme;
use crate::output::text::significant;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::check::ring::RingFacts;
use crate::process::shaping::chips::ChipLedger;
use crate::process::shaping::measure::{FlankReport, GearReport};
use crate::steps::{Work, axes};
use gearcut_core::gear::GearKind;
use gearcut_core::units::UM_PER_MM;
use operation::operation;

/// Why there is no pitch deviation.
const NOT_CROSSED: &str = "a flank was not cut or does not cross the pitch curve";
/// Cuts below the target deeper than this are worth a warning: far above the resolution, below every tolerance on a
/// gear drawing.
const GOUGE_MM: f64 = 1e-4;

/// Operations, deviations and teeth.
pub fn sections(job: &ShapingJob, report: &GearReport, ledger: &ChipLedger, motion: &[OperationAxes]) -> Vec<Section> {
    let operations: Vec<Section> =
        (0..job.operations.len()).map(|index| operation(job, report, ledger, &motion[index], index)).collect();
    let period = "teeth after which the pitch curve repeats: the first period of tables and charts";
    let teeth: Vec<Section> = (1..=job.scene.gear.teeth).map(|tooth| teeth::finished_tooth(report, tooth)).collect();
    let flank_table = tables::flanks(&report.flanks, &operations[..operations.len() - 1], &teeth);
    let ring =
        (job.blank.kind() == GearKind::Internal).then(|| ring::section(&RingFacts::new(job), job.scene.gear.module_mm));
    let sections = [
        Section::new("operations", "Operations").parts(operations),
        deviations(report),
        Section::new("teeth", "Finished teeth")
            .with("period_teeth", Quantity::count(report.period_teeth.into(), "teeth", period))
            .table(flank_table)
            .table(tables::teeth(&teeth))
            .parts(teeth),
    ];
    sections.into_iter().chain(ring).collect()
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

/// What a reader must know before trusting the numbers.
pub fn warnings(report: &GearReport, work: &Work, motion: &[OperationAxes]) -> Vec<String> {
    let mut warnings = Vec::new();
    let below: u64 = report.flanks.iter().map(|f| f.own.below_range).sum();
    if below > 0 {
        warnings.push(format!("{below} dexels were cut deeper than their rays record: heights there are upper bounds"));
    }
    let deepest = report
        .flanks
        .iter()
        .filter_map(|flank| Some((flank, flank.own.undercut?)))
        .min_by(|a, b| a.1.value_mm.total_cmp(&b.1.value_mm))
        .filter(|(_, deepest)| deepest.value_mm < -GOUGE_MM);
    if let Some((flank, deepest)) = deepest {
        let count = report.flanks.iter().filter(|f| f.own.undercut.is_some_and(|u| u.value_mm < -GOUGE_MM)).count();
        warnings.push(format!(
            "{count} flanks are cut below the target, tooth {} {} by {} um, {:.2} mm above the start of the involute",
            flank.tooth,
            flank.side.name(),
            significant(-deepest.value_mm * 1e3, 3),
            deepest.arc_mm
        ));
    }
    let untouched = report.flanks.iter().map(|flank| flank.untouched).sum();
    warnings.extend(work.warnings(untouched, "part of the flanks is still the blank"));
    warnings.extend(axes::warnings(motion));
    warnings
}
