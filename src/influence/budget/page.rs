//! The page of a budget: `report.html`; and all that is written.

use super::Budget;
use super::maps::{self, InfluenceSheet};
use crate::findings::{Findings, RESULTS_FILE, unit};
use crate::number_text::{plain, significant};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::scene::{LoadedScene, Scene};
use crate::steps::report::facts::gear_words;
use crate::steps::report::{SCENE, ending, page_of};
use gearcut_core::error::Result;

/// Parameters in the chart: as many as can be read.
const CHARTED: usize = 12;
/// Ticks of the chart stand at least so far apart, um.
const LEAST_UM: f64 = 0.02;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    loaded: &LoadedScene,
    backend: &str,
    budget: &Budget,
    found: &Findings,
    folder: &OutputFolder,
) -> Result<()> {
    write_tables(found, folder)?;
    if !budget.lines.is_empty() {
        chart(budget).write_svg(&folder.path("pictures/budget.svg")?)?;
    }
    let maps = maps::write(budget, folder)?;
    let end = ending(folder, ["Backend", backend], &[(SCENE, &loaded.resolved_toml())])?;
    page(&loaded.scene, budget, found, maps, end).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &found.to_json())
}

/// What a natural step of the dearest errors makes.
fn chart(budget: &Budget) -> BarChart {
    let lines = &budget.lines[..budget.lines.len().min(CHARTED)];
    let series = |name: &str, of: fn(&super::Figures) -> f64| BarSeries {
        name: name.to_owned(),
        values: lines
            .iter()
            .map(|line| Some(of(&line.per_unit) * line.influence.parameter.step).filter(|um| um.is_finite()))
            .collect(),
    };
    BarChart {
        has_mean: false,
        title: "Predicted: what a natural step of each error alone makes of an ideal gear".to_owned(),
        category_name: "rank".to_owned(),
        categories: (1..=lines.len()).map(|rank| rank.to_string()).collect(),
        value_name: "deviation".to_owned(),
        unit: "µm".to_owned(),
        least_division: LEAST_UM,
        series: vec![
            series("profile F_α", |of| of.profile),
            series("helix F_β", |of| of.helix),
            series("cumulative pitch F_p", |of| of.total_pitch),
        ],
        limits: Vec::new(),
    }
}

/// The page.
fn page(scene: &Scene, budget: &Budget, found: &Findings, maps: Vec<InfluenceSheet>, end: [PageSection; 2]) -> Page {
    let mut costs = Vec::new();
    if !budget.lines.is_empty() {
        costs.push(Block::Bars(chart(budget)));
    }
    costs.push(Block::Table(per_step(budget)));
    let mut sections = vec![
        PageSection::new(
            "costs",
            "What costs what",
            "Predicted by simulation: what a natural step of each error alone makes of an otherwise ideal gear, \
                dearest first.",
            costs,
        ),
        PageSection::new(
            "per-unit",
            "Per unit",
            "The same for one unit of each error. Where the course is bent, the influence holds for the step \
                alone: backlash, for one, has a kink at 0.",
            vec![Block::Table(per_unit(budget))],
        ),
    ];
    if !maps.is_empty() {
        let lead = "Predicted by simulation: what one unit of each of the dearest errors adds to whole flanks. Blue \
                    takes away, red adds. tables/influence_maps.csv has it place by place.";
        let pictures = maps.into_iter().map(|map| Block::Picture(map.title, map.png)).collect();
        sections.push(PageSection::new("maps", "Influence maps", lead, pictures));
    }
    sections.extend(end);
    Page {
        what: "error budget",
        subtitle: format!(
            "{} errors, each shifted to both sides; heights on {} places",
            budget.lines.len(),
            budget.grid.places()
        ),
        operations: vec![gear_words(scene)],
        done: "all errors tried",
        sections,
        ..page_of(found)
    }
}

/// What is below a tenth of a nanometre is rounding.
const LEAST_SHOWN_UM: f64 = 1e-4;

fn number(value: f64) -> String {
    if value.is_nan() {
        return "–".to_owned();
    }
    if value.abs() < LEAST_SHOWN_UM { "0".to_owned() } else { significant(value, 3).replace('-', "−") }
}

fn per_step(budget: &Budget) -> PageTable {
    let rows = budget.lines.iter().enumerate().map(|(rank, line)| {
        let parameter = &line.influence.parameter;
        let per = line.per_unit;
        let mut cells = vec![
            (rank + 1).to_string(),
            parameter.title.clone(),
            format!("{} {}", plain(parameter.step), unit::signs(parameter.unit)),
        ];
        let figures = [per.largest, per.profile, per.helix, per.single_pitch, per.total_pitch, per.thickness];
        cells.extend(figures.map(|um| super::findings::shown_um(um * parameter.step)));
        cells
    });
    PageTable {
        caption: "A natural step of each error, µm".to_owned(),
        columns: ["", "Error", "Step", "Largest", "F_α", "F_β", "f_p", "F_p", "Thickness"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}

fn per_unit(budget: &Budget) -> PageTable {
    let rows = budget.lines.iter().map(|line| {
        let parameter = &line.influence.parameter;
        let per = line.per_unit;
        let mut cells = vec![parameter.id.clone(), format!("µm per {}", unit::signs(parameter.unit))];
        cells.extend([per.largest, per.profile_slope, per.helix_slope].map(number));
        cells.push(if line.influence.is_linear() { "linear" } else { "bent" }.to_owned());
        cells
    });
    PageTable {
        caption: "One unit of each error".to_owned(),
        columns: ["Key", "Unit", "Largest", "f_Hα", "f_Hβ", "Course"].map(str::to_owned).into(),
        rows: rows.collect(),
    }
}
