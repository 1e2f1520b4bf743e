//! What earlier operations leave for the last one: normal stock, the allowances AB and CD, their unevenness.

use crate::job::Job;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::quantity::Quantity;
use crate::output::report::plot::{RangeChart, RangeSeries};
use crate::output::report::{Block, Section, Table};
use crate::output::results::{OperationResults, OperationTooth, Results, Spread, StockRange};
use crate::output::text::significant;
use crate::run::CutGear;

/// The section; none if the scene has a single operation.
pub fn section(job: &Job, cut: &CutGear, results: &Results) -> Option<Section> {
    let finishing = &job.finishing().spec.name;
    let earlier: Vec<&OperationResults> = results.operations.iter().filter(|o| !o.teeth.is_empty()).collect();
    let mut blocks = Vec::new();
    for operation in &earlier {
        if earlier.len() > 1 {
            blocks.push(Block::Heading(format!("After {}", operation.name)));
        }
        blocks.extend(operation_blocks(operation, finishing, cut));
    }
    (!blocks.is_empty()).then(|| Section {
        id: "stock",
        title: "Stock and allowance".to_owned(),
        lead: format!(
            "What is left for {finishing}. Stock stands along the target's normal over whole flanks; AB (left flank) and CD (right flank) are chords on the pitch curve between the two operations."
        ),
        blocks,
    })
}

fn operation_blocks(operation: &OperationResults, finishing: &str, cut: &CutGear) -> Vec<Block> {
    let teeth = &operation.teeth;
    let categories: Vec<String> = teeth.iter().map(|tooth| tooth.index.to_string()).collect();
    let range = |name: &str, pick: fn(&OperationTooth) -> &StockRange| RangeSeries {
        name: name.to_owned(),
        values: teeth
            .iter()
            .map(|tooth| {
                let stock = pick(tooth);
                Some([stock.smallest.value()?, stock.mean.value()?, stock.largest.value()?])
            })
            .collect(),
    };
    let series = |name: &str, pick: fn(&OperationTooth) -> &Quantity| BarSeries {
        name: name.to_owned(),
        values: teeth.iter().map(|tooth| pick(tooth).value()).collect(),
    };
    let bars = |title: String, value_name: &str, unit: &str, series: Vec<BarSeries>| {
        Block::Bars(BarChart {
            title,
            category_name: "tooth".to_owned(),
            categories: categories.clone(),
            value_name: value_name.to_owned(),
            unit: unit.to_owned(),
            series,
        })
    };
    let name = &operation.name;
    vec![
        Block::Ranges(RangeChart {
            title: format!("Normal stock that {name} leaves for {finishing}, flank by flank"),
            category_name: "tooth".to_owned(),
            categories: categories.clone(),
            unit: "mm".to_owned(),
            series: vec![range("left flanks", |t| &t.left), range("right flanks", |t| &t.right)],
        }),
        bars(
            format!("Allowance on the pitch curve after {name}"),
            "chord",
            "mm",
            vec![series("AB, left flank", |t| &t.ab), series("CD, right flank", |t| &t.cd)],
        ),
        bars(
            format!("Unevenness of the allowance after {name}"),
            "|AB − CD| / mean of AB and CD",
            "%",
            vec![series("as cut", |t| &t.unevenness_mean_denominator)],
        ),
        Block::Table(spread_table(operation)),
        Block::Folded(
            format!("Allowance tooth by tooth{}", period_words(cut.report.period_teeth, teeth.len())),
            vec![Block::Table(tooth_table(teeth))],
        ),
    ]
}

fn period_words(period: u32, teeth: usize) -> String {
    if period as usize == teeth { String::new() } else { format!(" (the pitch curve repeats every {period} teeth)") }
}

fn percent(quantity: &Quantity) -> String {
    // Below a billionth of a percent stands rounding.
    quantity.value().map_or_else(|| "–".to_owned(), |value| significant(if value < 1e-9 { 0.0 } else { value }, 4))
}

fn spread_table(operation: &OperationResults) -> Table {
    let u = &operation.unevenness;
    let row = |name: &str, spread: &Spread| vec![name.to_owned(), percent(&spread.max), percent(&spread.mean)];
    Table {
        caption: "Unevenness by both definitions".to_owned(),
        columns: ["Definition", "Largest [%]", "Mean [%]"].map(str::to_owned).into(),
        rows: vec![
            row("|AB − CD| / mean of AB and CD, as cut", &u.mean_denominator),
            row("|AB − CD| / mean of AB and CD, limit of many strokes", &u.envelope_mean_denominator),
            row("|AB − CD| / (δd tan α), as cut", &u.rack_denominator),
            row("|AB − CD| / (δd tan α), limit of many strokes", &u.envelope_rack_denominator),
        ],
    }
}

fn tooth_table(teeth: &[OperationTooth]) -> Table {
    let mm = |quantity: &Quantity| quantity.value().map_or_else(|| "–".to_owned(), |value| format!("{value:.4}"));
    let rows = teeth.iter().map(|tooth| {
        vec![
            tooth.index.to_string(),
            mm(&tooth.left.smallest),
            mm(&tooth.left.largest),
            mm(&tooth.right.smallest),
            mm(&tooth.right.largest),
            mm(&tooth.ab),
            mm(&tooth.cd),
            percent(&tooth.unevenness_mean_denominator),
        ]
    });
    let columns = [
        "Tooth",
        "Left, smallest [mm]",
        "Left, largest [mm]",
        "Right, smallest [mm]",
        "Right, largest [mm]",
        "AB [mm]",
        "CD [mm]",
        "Unevenness [%]",
    ];
    Table {
        caption: "Stock and allowance of each tooth".to_owned(),
        columns: columns.map(str::to_owned).into(),
        rows: rows.collect(),
    }
}
