//! The page of layers and seeds: `report.html`; and all that is written.

use super::Scatter;
use super::findings::place_of;
use super::layers::{ALL, IDEAL, all_but, alone};
use super::numbers::NUMBERS;
use super::quantities::{
    CASES, GEARS, LAYERS, SA, SHARE, SIDE_SINGLE_PITCH, SIDE_TOTAL_PITCH, SK, SPK, SPREAD, SVK, UNEVENNESS,
};
use crate::findings::quantities::flanks::{F_ALPHA, F_BETA, F_H_ALPHA};
use crate::findings::{Findings, QuantityGroup, QuantityRow, RESULTS_FILE, Table, unit};
use crate::machine_errors::ErrorLayer;
use crate::number_text::{plain, significant};
use crate::output::bar_chart::BarSeries;
use crate::output::bar_panels::{BarPanel, BarPanels};
use crate::output::folder::OutputFolder;
use crate::output::line_chart::Limit;
use crate::output::report::{Block, FileLinks, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::strip_chart::{Strip, StripChart};
use crate::output::table::write_tables;
use crate::scene::Scene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::page_of;
use gearcut_core::error::Result;

/// Charts of layers: name of the file, what it shows, its numbers.
static CHARTS: [(&str, &str, &[&QuantityRow]); 3] = [
    ("layers_texture", "Texture", &[&SA, &SK, &SPK, &SVK]),
    ("layers_form", "Profile and helix", &[&F_ALPHA, &F_H_ALPHA, &F_BETA]),
    ("layers_pitch", "Pitch and stock", &[&SIDE_SINGLE_PITCH, &SIDE_TOTAL_PITCH, &UNEVENNESS]),
];

/// Smallest distance of two ticks: a nanometre, a thousandth of a percent. What is less is rounding.
const LEAST_DIVISION: f64 = 1e-3;
/// Digits in tables.
const DIGITS: u32 = 3;
/// What is smaller is rounding, um and percent.
const ROUNDING: f64 = 1e-6;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(scene: &Scene, scatter: &Scatter, found: &Findings, folder: &OutputFolder) -> Result<()> {
    write_tables(found, folder)?;
    for (file, ..) in &CHARTS {
        if let Some(chart) = layers_chart(scatter, file) {
            chart.write_svg(&folder.path(format!("pictures/{file}.svg"))?)?;
        }
    }
    if let Some(chart) = gears_chart(scatter) {
        chart.write_svg(&folder.path("pictures/scatter.svg")?)?;
    }
    let mut files = folder.written()?;
    files.push(RESULTS_FILE.to_owned());
    page(scene, scatter, found, files).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}

/// The layers of the scene.
fn layers(scatter: &Scatter) -> &[ErrorLayer] {
    scatter.cases.iter().find(|(case, _)| case.name == ALL).map_or(&[], |(case, _)| &case.kept)
}

/// One of [`CHARTS`]: for every layer what it makes alone and what is left without it; none if no gear has its numbers.
fn layers_chart(scatter: &Scatter, file: &str) -> Option<BarPanels> {
    let (_, what, rows) = CHARTS.iter().find(|(name, ..)| *name == file)?;
    let layers = layers(scatter);
    let panel = |row: &&QuantityRow| {
        let number = place_of(row);
        let value = |case: &str| scatter.in_case(case, number).map(without_rounding);
        let series = |name: &str, case: fn(ErrorLayer) -> String| BarSeries {
            name: name.to_owned(),
            values: layers.iter().map(|&layer| value(&case(layer))).collect(),
        };
        let all = [series("alone", alone), series("all but it", all_but)];
        let shown = all.into_iter().filter(|series| series.values.iter().any(Option::is_some)).collect::<Vec<_>>();
        let limit = |case: &str| Some(Limit { name: case.to_owned(), value: value(case)? });
        // What no layer makes is in the table.
        let made = shown.iter().flat_map(|series| &series.values).any(|value| value.is_some_and(|value| value != 0.0));
        made.then(|| BarPanel {
            value_name: row.symbol_or_title(),
            unit: unit::signs(row.unit),
            least_division: LEAST_DIVISION,
            series: shown,
            limits: [ALL, IDEAL].into_iter().filter_map(limit).collect(),
        })
    };
    let panels: Vec<BarPanel> = rows.iter().filter_map(panel).collect();
    (!panels.is_empty()).then(|| BarPanels {
        title: format!("{what}: each layer of errors alone, and all but it"),
        category_name: "layer".to_owned(),
        categories: layers.iter().map(|layer| layer.name().to_owned()).collect(),
        panels,
    })
}

/// Every gear as a dot; none where there are no gears.
fn gears_chart(scatter: &Scatter) -> Option<StripChart> {
    let spreads = scatter.spreads();
    let strip = |row: &&QuantityRow| {
        let number = place_of(row);
        let spread = spreads[number]?;
        let dots: Vec<(u32, f64)> = scatter.values(number).collect();
        dots.iter().any(|dot| without_rounding(dot.1) != 0.0).then(|| Strip {
            name: row.symbol_or_title(),
            unit: unit::signs(row.unit),
            least_division: LEAST_DIVISION,
            dots,
            interval: [spread.low, spread.median, spread.high],
            interval_name: "5 to 95 %".to_owned(),
        })
    };
    let strips: Vec<Strip> = CHARTS.iter().flat_map(|(.., rows)| rows.iter()).filter_map(strip).collect();
    (!strips.is_empty()).then(|| StripChart {
        title: format!("{} gears of the same machine", scatter.gears.unwrap_or(0)),
        dot_name: "seed".to_owned(),
        strips,
    })
}

/// The page.
fn page(scene: &Scene, scatter: &Scatter, found: &Findings, files: Vec<String>) -> Page {
    let charts = CHARTS.iter().filter_map(|(file, ..)| layers_chart(scatter, file)).map(Block::Panels);
    let table = |section: &QuantityGroup, table: &QuantityGroup| found.group(section)?.table_of(table).map(page_table);
    let mut sections = vec![PageSection::new(
        "layers",
        "Layers of errors",
        "Predicted by simulation: the same gear with each layer of errors alone, with all of them, and with all \
            but one. Layers do not add up: a flank keeps what cuts deepest. What is left without a layer shows what \
            working on it would bring.",
        charts.chain(table(&LAYERS, &CASES).map(Block::Table)).collect(),
    )];
    if let Some(chart) = gears_chart(scatter) {
        sections.push(PageSection::new(
            "gears",
            "Gears of many seeds",
            gears_lead(scatter),
            std::iter::once(Block::Strips(chart)).chain(table(&GEARS, &SPREAD).map(Block::Table)).collect(),
        ));
    }
    sections.push(PageSection::new(
        "files",
        "Files",
        "",
        vec![Block::Files(vec![FileLinks { what: "Beside this page".to_owned(), files, more: 0 }])],
    ));
    let gears = scatter.gears.map_or_else(String::new, |gears| format!(", {gears} gears"));
    Page {
        what: "error layers and scatter",
        subtitle: format!(
            "{} layers of errors{gears}; tooth {} {}",
            layers(scatter).len(),
            scatter.flank.tooth,
            scatter.flank.side.name()
        ),
        operations: vec![gear_words(scene)],
        done: "all gears cut",
        sections,
        ..page_of(found)
    }
}

/// What the gears are, and how to cut one of them whole.
fn gears_lead(scatter: &Scatter) -> String {
    let how = "To cut one of them whole, give its seed: gearcut cut with --set machine.errors.seed=...";
    if scatter.tolerances.is_empty() {
        return format!("Predicted by simulation: other gears off the same machine. {how}");
    }
    let limits = scatter.tolerances.iter().map(|of| {
        let [low, high] = of.limits.map(plain);
        format!("{} from {low} to {high}", of.key)
    });
    let limits = limits.collect::<Vec<_>>().join(", ");
    format!(
        "Predicted by simulation: other gears off the same machine, with {limits}, every value as likely. {how}, and \
        its values in drawn.csv"
    )
}

/// Zero for what is less than rounding.
fn without_rounding(value: f64) -> f64 {
    if value.abs() < ROUNDING { 0.0 } else { value }
}

/// A table with numbers in rows: there are more of them than of what is compared.
fn page_table(table: &Table) -> PageTable {
    let cell = |value: Option<f64>| match value {
        None => "–".to_owned(),
        Some(value) => significant(without_rounding(value), DIGITS).replace('-', "−"),
    };
    let shares: Vec<Option<f64>> = table.values(&SHARE).collect();
    let heads =
        table.names().zip(shares).map(|(name, share)| share.map_or(name, |share| format!("{} %", plain(share))));
    let rows = NUMBERS.iter().map(|row| {
        let values = table.values(row).map(cell);
        [row.symbol_or_title(), unit::signs(row.unit)].into_iter().chain(values).collect()
    });
    PageTable {
        caption: table.title.clone(),
        columns: ["Number", "Unit"].map(str::to_owned).into_iter().chain(heads).collect(),
        rows: rows.collect(),
    }
}
