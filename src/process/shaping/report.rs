//! From a cut gear to the page that people open: which numbers, charts and maps stand on it, in which order.
//!
//! In: the job, what was cut, the findings. Out: a [`Page`]. Numbers come from the findings with their units and
//! definitions; nothing is computed here that is not in a file beside the page.

pub(super) mod chip_charts;
mod chips;
mod facts;
mod returns;
mod ring;
mod stock;
mod strokes;

use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::cutting::{LINKAGE, SHORT_OF_DEPTH};
use crate::findings::{self, Findings};
use crate::measure::verdict::GearVerdict;
use crate::number_text::{from_full_depth, significant};
use crate::output::bar_chart::BarChart;
use crate::output::folder::OutputFolder;
use crate::output::report::Page;
use crate::process::shaping::CutGear;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::gear::measure::GearReport;
use crate::process::shaping::quantities::{CIRCULAR_FEED, STROKES};
use crate::steps;
use crate::steps::axes;
use crate::steps::report::deviations::{Inspection, InspectionWords};
use crate::steps::report::facts::gear_words;
use crate::steps::report::{PageGear, RunWords, blank, deviations, files, machine_errors, record, texture};
use crate::steps::tool_wear;
use crate::steps::view_mesh::ViewMesh;
use gearcut_core::error::Result;
use std::f64::consts::PI;

/// The page of a run.
///
/// # Errors
/// No flank is generated on some tooth; a picture of the folder cannot be read back.
pub fn page(
    job: &ShapingJob,
    cut: &CutGear,
    found: &Findings,
    (inspection, wear): (&Inspection, Option<BarChart>),
    motion: &[OperationAxes],
    run: &RunWords,
    folder: &OutputFolder,
) -> Result<Page> {
    let mut sections = stock::section(job, found).into_iter().collect::<Vec<_>>();
    sections.extend(ring::section(job, found));
    sections.push(chips::section(job, &cut.chips, found));
    sections.extend(tool_wear::page(
        found,
        "cutter",
        wear,
        (Vec::new(), ", the cutter set on by one after every gear", ""),
    ));
    sections.extend(blank::section(found));
    sections.extend(returns::section(job, found));
    sections.push(deviations::section(inspection));
    sections.extend(machine_errors::section(found));
    sections.extend(texture::section(found, folder)?);
    sections.push(axes::section(
        motion,
        found,
        "How the linkage moves the machine over one turn of the work, and what it asks of the axes.",
        "Velocities, accelerations, relief",
    ));
    sections.push(facts::section(job, found));
    sections.push(files::section(folder)?);
    sections.push(record(cut.report.flanks.len(), &cut.work, run));
    let operations = found.parts(&OPERATIONS).len();
    let gear = PageGear { words: gear_words(&job.scene), mesh: ViewMesh::new(job)? };
    let operation = |of: &_| operation_words(of, operations);
    let mut page = steps::report::page(job, gear, found, &cut.maps, operation, sections);
    if let Some(viewer) = &mut page.viewer {
        viewer.strokes = Some(strokes::strokes(job, &cut.chips)?);
    }
    Ok(page)
}

fn operation_words(operation: &findings::Section, count: usize) -> String {
    let strokes = operation.value(&STROKES).unwrap_or(f64::NAN);
    let name = format!("{}{}", operation.key, if count == 1 { " (the only operation)" } else { "" });
    // Neither is known under a program that is off the scene's own strokes.
    let (Some(offset_mm), Some(feed_mm)) = (operation.value(&SHORT_OF_DEPTH), operation.value(&CIRCULAR_FEED)) else {
        return format!("{name}: by a program off the scene's own strokes, {strokes} strokes");
    };
    format!(
        "{name}: {}, cutter {}, {strokes} strokes, {} mm circular feed per stroke",
        operation.text(&LINKAGE),
        from_full_depth(offset_mm),
        significant(feed_mm, 3),
    )
}

/// What a gear inspector would find on a shaped gear.
pub fn inspection<'a>(job: &ShapingJob, report: &'a GearReport, verdict: &'a GearVerdict) -> Inspection<'a> {
    let words = InspectionWords {
        profile_place: "roll from the pitch point, up to the tip",
        lead_place: "at the pitch curve",
        lead_name: "Lead",
        target: "the surface that the last operation would leave with infinitely many strokes and no error",
    };
    let gear = &job.transverse;
    let standard_mm = 0.5 * PI * gear.module_mm + gear.extra_thickness_mm();
    Inspection::new(&report.flanks, &report.inspection, standard_mm, words, verdict)
}
