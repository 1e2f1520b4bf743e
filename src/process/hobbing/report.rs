//! The page of a hobbed gear: the same sections as a shaped one's, and what hobbing adds: marks, five curves, six axes,
//! the work of the hob's teeth.

mod facts;
pub mod passes;

use crate::findings::quantities::cutting::{LARGEST_FORCE, LINKAGE, SHORT_OF_DEPTH, THICKEST_CHIP};
use crate::findings::quantities::tool_wear::TOOL_WEAR;
use crate::findings::{self, Entry, Findings, Quantity, QuantityRow};
use crate::measure::verdict::GearVerdict;
use crate::number_text::{from_full_depth, plain, significant};
use crate::output::bar_chart::BarChart;
use crate::output::folder::OutputFolder;
use crate::output::line_chart::LineChart;
use crate::output::report::{Block, Page, PageSection, PageTable, Tone};
use crate::process::hobbing::axes_report::HobbingAxesReport;
use crate::process::hobbing::blank::HobbedBlank;
use crate::process::hobbing::quantities::{
    ACCURACY, ASSUMPTION, AXIAL_FEED, DIFFERENCE, FEED_MARK, FORCE, GENERATING_MARK, KINEMATIC, LAW, LENGTH, LOAD,
    MARKS, PEAK_TO_MEAN, SHIFT, SHIFT_GEARS, SHIFT_GEARS_FROM, SHIFT_GEARS_TO, SHIFT_RETURN, SHIFT_TO, SURFACE,
    TO_AXIS, TO_TRACE,
};
use crate::process::hobbing::{HobCutter, HobbedGear, HobbingJob};
use crate::steps;
use crate::steps::axes;
use crate::steps::report::deviations;
use crate::steps::report::deviations::{Inspection, InspectionWords};
use crate::steps::report::{PageGear, RunWords, blank, files, headline_words, machine_errors, record, texture};
use crate::steps::tool_wear::{self, with_ends};
use crate::steps::view_mesh::ViewMesh;
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use std::f64::consts::PI;

/// Charts that are files of their own as well.
pub struct Charts<'a> {
    /// What an inspector finds.
    pub inspection: &'a Inspection<'a>,
    /// Bars by hob tooth, with the names of their files; none where the run was stopped before the whole blank was cut.
    pub loads: Vec<(String, BarChart)>,
    /// Cutting force over time, with the names of their files; none where the scene does not name the material.
    pub forces: Vec<(String, LineChart)>,
    /// Wear by hob tooth; none where the scene does not say how the hob wears, or nothing was cut.
    pub wear: Option<BarChart>,
    /// What the passes took, for the hob in the gear's view; none where the run was stopped.
    pub blank: Option<&'a HobbedBlank>,
    /// Frequencies of errors of the points on five curves; none where nothing spreads.
    pub points: Option<LineChart>,
}

/// The page of a run.
///
/// # Errors
/// No flank is generated on some tooth; a picture of the folder cannot be read back.
pub fn page(
    cutter: &HobCutter,
    gear: &HobbedGear,
    found: &Findings,
    charts: Charts,
    motion: &[HobbingAxesReport],
    run: &RunWords,
    folder: &OutputFolder,
) -> Result<Page> {
    let job = cutter.job;
    let mut deviations = deviations::section(charts.inspection);
    deviations.blocks.extend(probe_words(job).map(Block::Note));
    let mut sections = vec![deviations];
    sections.extend(load_section(found, charts.loads, charts.forces));
    sections.extend(wear_section(found, charts.wear));
    sections.extend(machine_errors::section(found));
    sections.extend(texture::section(found, folder)?);
    sections.extend(blank::section(found));
    sections.push(axes::section(
        motion,
        found,
        "How the linkage moves the machine over one cycle along the pitch curve, and what it asks of the axes.",
        "Accelerations, feed path",
    ));
    sections.push(facts::section(job, found));
    sections.push(marks_section(found));
    sections.extend(charts.points.map(five_curves));
    sections.push(files::section(folder)?);
    sections.push(record(gear.flanks.len(), &gear.work, run));
    let operation = |operation: &findings::Section| {
        format!(
            "{}: {}, hob {}, {} mm axial feed per revolution",
            operation.key,
            operation.text(&LINKAGE),
            operation.value(&SHORT_OF_DEPTH).map_or_else(|| "–".to_owned(), from_full_depth),
            operation.value(&AXIAL_FEED).map_or_else(|| "–".to_owned(), plain)
        )
    };
    let words = steps::report::facts::gear_words(&cutter.job.scene);
    let page_gear = PageGear { words, mesh: ViewMesh::new(cutter)? };
    let mut page = steps::report::page(cutter, page_gear, found, &gear.maps, operation, sections);
    if let Some((viewer, blank)) = page.viewer.as_mut().zip(charts.blank) {
        viewer.strokes = Some(passes::passes(cutter, blank)?);
    }
    Ok(page)
}

/// What a gear inspector would find on a hobbed gear.
pub fn inspection<'a>(cutter: &HobCutter, gear: &'a HobbedGear, verdict: &'a GearVerdict) -> Inspection<'a> {
    let spec = &cutter.job.scene.gear;
    let standard_mm = 0.5 * PI * spec.transverse_module_mm() + spec.extra_thickness_mm();
    let words = InspectionWords {
        profile_place: "roll from the pitch point, up to the tip",
        lead_place: "in the middle of the profile",
        lead_name: "Helix",
        target: "the surface that the last operation would leave with infinitely many gashes and an infinitely fine \
            feed",
    };
    Inspection::new(&gear.flanks, &gear.inspection, standard_mm, words, verdict)
}

/// What feed marks alone make of the runout.
fn probe_words(job: &HobbingJob) -> Option<String> {
    let feed_um = UM_PER_MM * job.feed_mark_mm(job.finishing())?;
    Some(format!(
        "Runout of a perfect machine is feed marks: the probe meets a flank on a crest or in a valley, up to {} µm \
        apart, and goes in by that over sin αn, up to {} µm. A ball of 2 mm on a measuring machine does the same: the \
        valleys of a feed are far wider than it. A finer feed lowers both with its square.",
        significant(feed_um, 3),
        significant(feed_um / job.scene.gear.pressure_angle_rad.sin(), 3)
    ))
}

fn five_curves(chart: LineChart) -> PageSection {
    PageSection::new(
        "curves",
        "Points on five curves",
        "Where five curves beside the pitch curve cross every flank in the middle of the face, as cut less as \
            meant, as Liu et al. (2015) measured their gear. Every point is in tables/offset_curves.csv.",
        vec![Block::Lines(chart)],
    )
    .judged(Tone::Aside, "errors of all points")
}

fn marks_section(found: &Findings) -> PageSection {
    let text = |value: Option<f64>, text: &dyn Fn(f64) -> String| value.map_or_else(|| "–".to_owned(), text);
    let mm = |length: f64| format!("{length:.3}");
    // Rounded first, so that no zero bears a sign.
    let degrees = |deg: f64| format!("{:.2}", (deg * 100.0).round() / 100.0 + 0.0).replace('-', "−");
    let apart = |value: f64| significant(value.abs(), 2);
    let rows = found.group(&MARKS).map_or(&[][..], |marks| &marks.sections).iter().flat_map(|flank| {
        flank.sections.iter().map(move |step| {
            let mut row = vec![format!("{}, {}", flank.title, step.title)];
            for source in [&KINEMATIC, &SURFACE] {
                let number = |row: &QuantityRow| step.group(source).and_then(|of| of.value(row));
                row.push(text(number(&LENGTH), &mm));
                row.extend([&TO_TRACE, &TO_AXIS].map(|of| text(number(of), &degrees)));
            }
            let difference = step.group(&DIFFERENCE);
            row.extend([&LENGTH, &TO_TRACE].map(|of| text(difference.and_then(|step| step.value(of)), &apart)));
            row
        })
    });
    let columns = [
        "Flank",
        "Kinematics [mm]",
        "to the trace [°]",
        "to the axis [°]",
        "Surface [mm]",
        "to the trace [°]",
        "to the axis [°]",
        "Apart [mm]",
        "Apart [°]",
    ];
    PageSection::new(
        "marks",
        "Cutting marks",
        "The shortest two steps from mark to mark on the flank at the pitch line: from the machine's motion, and \
            independently from the autocorrelation of the heights as cut.",
        vec![Block::Table(PageTable {
            caption: "Lattice of cutting marks".to_owned(),
            columns: columns.map(str::to_owned).into(),
            rows: rows.collect(),
        })],
    )
    .judged(Tone::Aside, headline_words(found, &[&FEED_MARK, &GENERATING_MARK]))
}

/// Nothing where the scene does not say how the hob wears.
fn wear_section(found: &Findings, chart: Option<BarChart>) -> Option<PageSection> {
    let wear = found.group(&TOOL_WEAR)?;
    let shift = match wear.value(&SHIFT) {
        Some(mm) => {
            format!("{} mm to the {} end, {}", significant(mm, 4), wear.text(&SHIFT_TO), wear.text(&SHIFT_RETURN))
        }
        None => wear.of(&SHIFT).and_then(Quantity::why).unwrap_or_default().to_owned(),
    };
    let gears = with_ends(wear, &SHIFT_GEARS, [&SHIFT_GEARS_FROM, &SHIFT_GEARS_TO]);
    let title = |row| wear.entry_of(row).map_or_else(String::new, Entry::heading);
    let rows = vec![(title(&SHIFT), shift), (title(&SHIFT_GEARS), gears)];
    tool_wear::page(found, "hob", chart, (rows, "", ", shifts between gears in tables/hob_shift.csv"))
}

/// Nothing where the run was stopped before the whole blank was cut.
fn load_section(
    found: &Findings,
    loads: Vec<(String, BarChart)>,
    forces: Vec<(String, LineChart)>,
) -> Option<PageSection> {
    if loads.is_empty() {
        return None;
    }
    let mut blocks: Vec<Block> = loads.into_iter().map(|(_, chart)| Block::Bars(chart)).collect();
    blocks.extend(forces.into_iter().map(|(_, chart)| Block::Lines(chart)));
    if let Some(force) = found.group(&FORCE) {
        blocks.push(Block::Note(format!("Cutting force: {}. Accuracy {}.", force.text(&LAW), force.text(&ACCURACY))));
    }
    Some(PageSection::new(
        "load",
        "Work of the hob's teeth",
        format!(
            "What each tooth of the hob does in the whole process, approach and overrun included. The load is the {}.",
            found.group(&LOAD).map_or("", |load| load.text(&ASSUMPTION))
        ),
        blocks,
    )
    .judged(Tone::Aside, headline_words(found, &[&THICKEST_CHIP, &LARGEST_FORCE, &PEAK_TO_MEAN])))
}
