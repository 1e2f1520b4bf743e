//! The page of a diagnosis: `report.html`; and all that is written.

use super::findings::sized;
use super::{Diagnosis, ErrorModel};
use crate::findings::{Findings, RESULTS_FILE, unit};
use crate::influence::quantities::diagnosis::DIAGNOSIS;
use crate::number_text::significant;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::scene::{LoadedScene, Scene};
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use crate::steps::report::{SCENE, ending, page_of};
use gearcut_core::error::Result;

/// Ticks of the chart stand at least so far apart, %.
const LEAST_PERCENT: f64 = 0.1;

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    loaded: &LoadedScene,
    backend: &str,
    (model, found): (&ErrorModel, &Diagnosis),
    tree: &Findings,
    folder: &OutputFolder,
) -> Result<()> {
    write_tables(tree, folder)?;
    let end = ending(folder, ["Backend", backend], &[(SCENE, &loaded.resolved_toml())])?;
    page(&loaded.scene, model, found, tree, end).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &tree.to_json())
}

fn page(scene: &Scene, model: &ErrorModel, found: &Diagnosis, tree: &Findings, end: [PageSection; 2]) -> Page {
    let mut named = Vec::new();
    if found.named.is_empty() {
        named.push(Block::Note("No error that the scene can name explains more than noise would.".to_owned()));
    } else {
        named.push(Block::Table(sources(model, found)));
        named.push(Block::Bars(chart(model, found)));
    }
    let left = tree.group(&DIAGNOSIS).map(|section| Block::Table(quantities::table(section)));
    Page {
        what: "diagnosis",
        subtitle: format!("{} measured places, {} errors tried", found.residuals_um.len(), model.sources.len()),
        operations: vec![gear_words(scene)],
        done: "all errors tried",
        sections: [
            PageSection::new(
                "sources",
                "Errors that explain the flanks",
                "Fitted to the measured deviations, with 95 % intervals over all sets of errors that explain them \
                 about as well; sure: weight of those sets with this error. Sizes count from those of the scene.",
                named,
            ),
            PageSection::new(
                "left-over",
                "What is left over",
                "What no error explains, against the noise. tables/residuals.csv has it place by place.",
                left.into_iter().collect(),
            ),
        ]
        .into_iter()
        .chain(end)
        .collect(),
        ..page_of(tree)
    }
}

fn sources(model: &ErrorModel, found: &Diagnosis) -> PageTable {
    let mut rows = Vec::new();
    for named in &found.named {
        let source = &model.sources[named.source];
        let same: Vec<String> = named.same_as.iter().map(|&other| model.sources[other].title()).collect();
        for (index, (parameter, fitted)) in source.parameters.iter().zip(&named.fitted).enumerate() {
            // Shares are those of all components together.
            let of_source = |percent: f64| match index {
                0 => format!("{} %", significant(100.0 * percent, 3)),
                _ => "with the one above".to_owned(),
            };
            rows.push(vec![
                parameter.title.clone(),
                "fitted".to_owned(),
                sized(found, *fitted, &unit::signs(parameter.unit)).replace('-', "−"),
                of_source(named.alone),
                if found.intervals_hold() { of_source(named.weight) } else { "–".to_owned() },
                if same.is_empty() { "–".to_owned() } else { same.join("; ") },
            ]);
        }
    }
    PageTable {
        caption: "Named errors".to_owned(),
        columns: ["Error", "", "Size", "Alone", "Sure", "Alternatives"].map(str::to_owned).into(),
        rows,
    }
}

fn chart(model: &ErrorModel, found: &Diagnosis) -> BarChart {
    BarChart {
        has_mean: false,
        title: "Fitted: what each error alone explains of the squared deviations".to_owned(),
        category_name: "error".to_owned(),
        categories: found.named.iter().map(|named| model.sources[named.source].title()).collect(),
        value_name: "share".to_owned(),
        unit: "%".to_owned(),
        least_division: LEAST_PERCENT,
        series: vec![BarSeries {
            name: "explained by it alone".to_owned(),
            values: found.named.iter().map(|named| Some(100.0 * named.alone)).collect(),
        }],
        limits: Vec::new(),
    }
}
