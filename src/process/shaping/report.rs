//! From a cut gear to the page that people open: which numbers, charts and maps stand on it, in which order.
//!
//! In: the job, what was cut, the findings. Out: a [`Page`]. Numbers come from the findings with their units and
//! definitions; nothing is computed here that is not in a file beside the page.

mod chips;
mod facts;
mod returns;
mod ring;
mod stock;
mod strokes;

use crate::findings::{self, Findings, Quantity};
use crate::measure::verdict::GearVerdict;
use crate::output::folder::OutputFolder;
use crate::output::report::{KeyNumber, Page};
use crate::output::text::{from_full_depth, significant};
use crate::process::shaping::CutGear;
use crate::process::shaping::ShapingJob;
use crate::process::shaping::axes_report::OperationAxes;
use crate::process::shaping::measure::GearReport;
use crate::process::shaping::scene::model::Retraction;
use crate::steps;
use crate::steps::axes;
use crate::steps::report::deviations::{Inspection, InspectionWords};
use crate::steps::report::facts::gear_words;
use crate::steps::report::{
    PageGear, RunWords, blank, deviations, files, key_number, machine_errors, record, texture, value_and_unit,
};
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
    inspection: &Inspection,
    motion: &[OperationAxes],
    run: &RunWords,
    folder: &OutputFolder,
) -> Result<Page> {
    let mut sections = stock::section(job, found).into_iter().collect::<Vec<_>>();
    sections.extend(ring::section(job, found));
    sections.push(chips::section(job, &cut.chips, found));
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
    let operations = found.parts("operations").len();
    let gear = PageGear { words: gear_words(&job.scene.gear), mesh: ViewMesh::new(job)? };
    let operation = |of: &_| operation_words(of, operations);
    let mut page = steps::report::page(job, gear, found, &cut.maps, operation, key_numbers(job, found), sections);
    if let Some(viewer) = &mut page.viewer {
        viewer.strokes = Some(strokes::strokes(job, &cut.chips));
    }
    Ok(page)
}

fn operation_words(operation: &findings::Section, count: usize) -> String {
    let strokes = operation.number("strokes").unwrap_or(f64::NAN);
    let name = format!("{}{}", operation.key, if count == 1 { " (the only operation)" } else { "" });
    // Neither is known under a program that is off the scene's own strokes.
    let (Some(offset_mm), Some(feed_mm)) = (operation.number("offset"), operation.number("circular_feed")) else {
        return format!("{name}: by a program off the scene's own strokes, {strokes} strokes");
    };
    format!(
        "{name}: {}, cutter {}, {strokes} strokes, {} mm circular feed per stroke",
        operation.words("linkage"),
        from_full_depth(offset_mm),
        significant(feed_mm, 3),
    )
}

fn key_numbers(job: &ShapingJob, found: &Findings) -> Vec<KeyNumber> {
    let missing = Quantity::undefined("1", "not among the findings of this run", "not among the findings of this run");
    let of = |key: &str| found.headline(key).unwrap_or(&missing);
    let card = |name: &str, key: &str| key_number(name, of(key));
    let with_note = |number: KeyNumber, note: String| KeyNumber { note, ..number };
    let mut numbers = vec![
        card("Smallest normal stock", "smallest_normal_stock"),
        card("Largest normal stock", "largest_normal_stock"),
    ];
    let mean = value_and_unit(of("unevenness_mean"));
    let unevenness = card("Unevenness of the allowance, largest", "unevenness_max");
    numbers.push(if of("unevenness_max").value().is_some() {
        with_note(unevenness, format!("mean over the teeth {} %", mean.0))
    } else {
        unevenness
    });
    numbers.push(card("Highest scallop", "scallop_height"));
    let deviations = [
        ("Profile deviation Fα, largest", "profile_deviation"),
        ("Single pitch deviation fp, largest", "single_pitch_deviation"),
        ("Total pitch deviation Fp", "total_pitch_deviation"),
        ("Runout Fr", "runout"),
    ];
    numbers.extend(deviations.map(|(name, key)| {
        let found = found.find("deviations").and_then(|section| section.quantity(key));
        key_number(name, found.unwrap_or(&missing))
    }));
    let thinnest = card("Thinnest tooth, arc", "smallest_tooth_thickness");
    numbers.push(match (of("smallest_tooth_thickness").value(), of("largest_tooth_thickness").value()) {
        (Some(low), Some(high)) => {
            KeyNumber { value: format!("{low:.4}"), note: format!("thickest {high:.4} mm"), ..thinnest }
        }
        _ => thinnest,
    });
    let relief = match job.machine.retraction {
        Retraction::CenterLine => "of a circular gear's",
        _ => "of a circular gear's, were it along the line of centres; the cutter is drawn back another way",
    };
    numbers.extend([
        card("Highest start of involute", "start_of_involute"),
        card("Undercut flanks", "undercut_flanks"),
        card("Narrowest tip land", "tip_land"),
        card("Pointed teeth", "pointed_teeth"),
        card("Witness mark", "witness_mark"),
        with_note(card("Relief on the return stroke", "relief_ratio"), relief.to_owned()),
        card("Reserve to the tightest axis limit", "axis_margin"),
        card("Time of all strokes", "cycle_time"),
    ]);
    numbers
}

/// What a gear inspector would find on a shaped gear.
pub fn inspection<'a>(job: &ShapingJob, report: &'a GearReport, verdict: &'a GearVerdict) -> Inspection<'a> {
    let words = InspectionWords {
        profile_place: "u from the form point (below) to the tip",
        lead_place: "at the pitch curve",
        lead_name: "Lead",
        target: "the surface that the last operation would leave with infinitely many strokes and no error",
    };
    let gear = &job.scene.gear;
    let standard_mm = 0.5 * PI * gear.module_mm + gear.extra_thickness_mm();
    Inspection::new(&report.flanks, &report.inspection, standard_mm, words, verdict)
}
