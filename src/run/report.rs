//! From a cut gear to the page that people open: which numbers, charts and maps stand on it, in which order.
//!
//! In: the job, what was cut and measured, the results. Out: a [`Page`]. Numbers come from the results with their units and definitions; nothing is computed here that is not in a file beside the page.

mod deviations;
mod facts;
pub(super) mod hobbing;
mod maps;
mod stock;
mod texture;

use self::deviations::Inspection;
use super::CutGear;
use crate::axes_report::{self, OperationAxes};
use crate::cut::{CutStats, KERNEL_UM};
use crate::error::Result;
use crate::job::Job;
use crate::output::folder::OutputFolder;
use crate::output::progress::duration_text;
use crate::output::quantity::Quantity;
use crate::output::report::{Block, KeyNumber, Page, Section, Table};
use crate::output::results::{AxisPeak, OperationResults, Results};
use crate::output::text::{plain, significant};

/// What the run says of itself on the page. Times are left out: the same scene gives the same page.
#[derive(Debug, Clone, Copy)]
pub struct RunWords<'a> {
    /// The scene with every value written out.
    pub resolved_scene: &'a str,
    /// Backend with its adapter.
    pub backend: &'a str,
    /// Why it was taken.
    pub backend_why: &'a str,
}

/// The page of a run.
///
/// # Errors
/// No flank is generated on some tooth; a picture of the folder cannot be read back.
pub fn page(job: &Job, cut: &CutGear, results: &Results, run: &RunWords, folder: &OutputFolder) -> Result<Page> {
    let axes = OperationAxes::of_job(job);
    let mut warnings = super::summary::warnings(cut);
    warnings.extend(axes.iter().flat_map(OperationAxes::warnings));
    let mut sections = stock::section(job, cut, results).into_iter().collect::<Vec<_>>();
    let inspection = Inspection::of_shaping(&cut.report, job.scene.gear.module_mm);
    sections.push(deviations::section(&inspection));
    sections.extend(texture::section(&results.texture, folder)?);
    sections.push(motion(job, results));
    sections.push(facts::section(job));
    sections.push(record(cut.report.flanks.len(), &cut.stats, cut.dexels, run));
    Ok(Page {
        title: job.scene.name.clone(),
        subtitle: facts::gear_words(&job.scene.gear),
        operations: results.operations.iter().map(|operation| operation_words(operation, results)).collect(),
        complete: !cut.interrupted,
        program: format!("gearcut {}", env!("CARGO_PKG_VERSION")),
        key_numbers: key_numbers(results, &inspection),
        warnings: with_signs(&warnings),
        viewer: Some(maps::viewer(job, &cut.maps)?),
        sections,
    })
}

fn operation_words(operation: &OperationResults, results: &Results) -> String {
    let number = |quantity: &Quantity| quantity.value().unwrap_or(f64::NAN);
    let offset = match number(&operation.offset) {
        offset if offset.abs() < 1e-12 => "to the finished shape".to_owned(),
        offset => format!("cutter held back by {} mm", plain(offset)),
    };
    format!(
        "{}{}: {}, {offset}, {} strokes, {} mm circular feed per stroke",
        operation.name,
        if results.operations.len() == 1 { " (the only operation)" } else { "" },
        operation.linkage,
        number(&operation.strokes),
        significant(number(&operation.circular_feed), 3),
    )
}

/// Number and unit as they are read best.
fn value_and_unit(quantity: &Quantity) -> (String, String) {
    let Some(value) = quantity.value() else { return ("–".to_owned(), String::new()) };
    let text = |value: f64, digits| significant(value, digits).replace('-', "−");
    match quantity.unit().unwrap_or("") {
        "1" => (format!("{:.1}", 100.0 * value).replace('-', "−"), "%".to_owned()),
        "um" => (text(if value.abs() < KERNEL_UM { 0.0 } else { value }, 3), "µm".to_owned()),
        "s" => (duration_text(value), String::new()),
        "%" => (text(if value < 1e-9 { 0.0 } else { value }, 3), "%".to_owned()),
        unit @ ("flanks" | "teeth" | "strokes") => (plain(value), unit.to_owned()),
        unit => (text(value, 4), unit.to_owned()),
    }
}

fn key_number(name: &str, quantity: &Quantity) -> KeyNumber {
    let (value, unit) = value_and_unit(quantity);
    KeyNumber {
        name: name.to_owned(),
        value,
        unit,
        definition: quantity.definition().to_owned(),
        note: quantity.why().unwrap_or("").to_owned(),
        place: quantity.place().cloned(),
    }
}

fn key_numbers(results: &Results, inspection: &Inspection) -> Vec<KeyNumber> {
    let h = &results.headline;
    let with_note = |number: KeyNumber, note: String| KeyNumber { note, ..number };
    let mut numbers = vec![
        key_number("Smallest normal stock", &h.smallest_normal_stock),
        key_number("Largest normal stock", &h.largest_normal_stock),
    ];
    let mean = value_and_unit(&h.unevenness_mean);
    let unevenness = key_number("Unevenness of the allowance, largest", &h.unevenness_max);
    numbers.push(if h.unevenness_max.value().is_some() {
        with_note(unevenness, format!("mean over the teeth {} %", mean.0))
    } else {
        unevenness
    });
    numbers.push(key_number("Highest scallop", &h.scallop_height));
    numbers.extend(deviations::key_numbers(inspection));
    let thinnest = key_number("Thinnest tooth, arc", &h.smallest_tooth_thickness);
    numbers.push(match (h.smallest_tooth_thickness.value(), h.largest_tooth_thickness.value()) {
        (Some(low), Some(high)) => {
            KeyNumber { value: format!("{low:.4}"), note: format!("thickest {high:.4} mm"), ..thinnest }
        }
        _ => thinnest,
    });
    numbers.extend([
        key_number("Highest start of involute", &h.start_of_involute),
        key_number("Undercut flanks", &h.undercut_flanks),
        key_number("Narrowest tip land", &h.tip_land),
        key_number("Pointed teeth", &h.pointed_teeth),
        key_number("Witness mark", &h.witness_mark),
        with_note(key_number("Relief on the return stroke", &h.relief_ratio), "of a circular gear's".to_owned()),
        key_number("Reserve to the tightest axis limit", &h.axis_margin),
        key_number("Time of all strokes", &h.cycle_time),
    ]);
    known_first(numbers)
}

/// What does not exist here goes to the end.
fn known_first(numbers: Vec<KeyNumber>) -> Vec<KeyNumber> {
    let (mut known, unknown): (Vec<_>, Vec<_>) = numbers.into_iter().partition(|number| number.value != "–");
    known.extend(unknown);
    known
}

/// The terminal's plain letters become signs.
fn with_signs(warnings: &[String]) -> Vec<String> {
    warnings.iter().map(|text| text.replace(" um", " µm").replace(" deg ", "° ")).collect()
}

fn motion(job: &Job, results: &Results) -> Section {
    let mut blocks = Vec::new();
    for (index, operation) in results.operations.iter().enumerate() {
        blocks.push(Block::Heading(format!("{}: {}", operation.name, operation.linkage)));
        blocks.push(Block::Table(peak_table(operation)));
        let mut charts = axes_report::charts(job, index).into_iter();
        blocks.extend(charts.next().map(Block::Lines));
        blocks.push(Block::Folded("Velocities, accelerations, relief".to_owned(), charts.map(Block::Lines).collect()));
    }
    Section {
        id: "motion",
        title: "Axis motion".to_owned(),
        lead: "How the linkage moves the machine over one turn of the work, and what it asks of the axes.".to_owned(),
        blocks,
    }
}

fn peak_table(operation: &OperationResults) -> Table {
    let axes = &operation.axes;
    let peaks: [(&str, &AxisPeak); 6] = [
        ("Work spindle, speed", &axes.work_speed),
        ("Work spindle, acceleration", &axes.work_acceleration),
        ("Cutter spindle, speed", &axes.cutter_speed),
        ("Cutter spindle, acceleration", &axes.cutter_acceleration),
        ("Centre distance, speed", &axes.center_distance_speed),
        ("Centre distance, acceleration", &axes.center_distance_acceleration),
    ];
    let number = |value: f64| significant(if value.abs() < 1e-9 { 0.0 } else { value }, 4);
    let rows = peaks.into_iter().map(|(name, peak)| {
        let unit = peak.peak.unit().unwrap_or("").replace("deg", "°").replace("^2", "²");
        let limit = peak.limit.value().map_or_else(|| "–".to_owned(), number);
        let left = peak.margin.value().map_or_else(|| "–".to_owned(), |share| format!("{:.0} %", 100.0 * share));
        let at = peak.work_angle.value().map_or_else(|| "–".to_owned(), |angle| format!("{angle:.1}"));
        vec![name.to_owned(), number(peak.peak.value().unwrap_or(f64::NAN)), unit, at, limit, left]
    });
    Table {
        caption: "Peaks of the axes".to_owned(),
        columns: ["Axis", "Largest", "Unit", "At work angle [°]", "Limit", "Reserve"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

/// What is needed to repeat the run.
fn record(flanks: usize, stats: &CutStats, dexels: u64, run: &RunWords) -> Section {
    let row = |name: &str, value: String| vec![name.to_owned(), value];
    let per_dexel = stats.dexel_passes as f64 / dexels.max(1) as f64;
    let table = Table {
        caption: "Run".to_owned(),
        columns: Vec::new(),
        rows: vec![
            row("Program", format!("gearcut {}", env!("CARGO_PKG_VERSION"))),
            row("Backend", format!("{} ({})", run.backend, run.backend_why)),
            row("Flanks cut", flanks.to_string()),
            row("Dexels", format!("{:.2} million, {} passes each", dexels as f64 / 1e6, significant(per_dexel, 3))),
        ],
    };
    Section {
        id: "record",
        title: "Run record".to_owned(),
        lead:
            "What is needed to repeat the run. Times and the SHA-256 of every file stand in run.json beside this page."
                .to_owned(),
        blocks: vec![
            Block::Table(table),
            Block::Folded(
                "The scene, every value written out".to_owned(),
                vec![Block::Verbatim(run.resolved_scene.to_owned())],
            ),
        ],
    }
}
