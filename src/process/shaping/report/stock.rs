//! The stock of earlier operations for the last one: normal stock, the allowances AB and CD, their unevenness.

use crate::findings::quantities::OPERATIONS;
use crate::findings::quantities::flanks::{STOCK_LARGEST, STOCK_MEAN, STOCK_SMALLEST};
use crate::findings::{self, Findings, QuantityRow, unit};
use crate::number_text::significant;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::line_chart::{LineChart, LineSeries, Panel};
use crate::output::range_chart::{RangeChart, RangeSeries};
use crate::output::report::{Block, PageSection, PageTable};
use crate::process::shaping::ShapingJob;
use crate::process::shaping::quantities::{
    AB, ALLOWANCE, CD, MEASURED_ALLOWANCE, SPREAD_MAX, SPREAD_MEAN, SPREADS, STOCK_OF_TEETH, UNEVENNESS,
};
use crate::steps::report::quantities;
use gearcut_core::terms::Side;

/// The section; none if the scene has a single operation.
pub fn section(job: &ShapingJob, found: &Findings) -> Option<PageSection> {
    let finishing = &job.finishing().spec.name;
    let earlier: Vec<&findings::Section> =
        found.parts(&OPERATIONS).iter().filter(|operation| !stock_of_teeth(operation).is_empty()).collect();
    let mut blocks = Vec::new();
    for operation in &earlier {
        if earlier.len() > 1 {
            blocks.push(Block::Heading(format!("After {}", operation.key)));
        }
        blocks.extend(operation_blocks(operation, finishing));
        blocks.extend(operation.group(&MEASURED_ALLOWANCE).map(|found| Block::Table(quantities::table(found))));
    }
    (!blocks.is_empty()).then(|| {
        PageSection::new(
            "stock",
            "Stock and allowance",
            format!(
                "What is left for {finishing}. Stock is measured along the target's normal over whole flanks; AB (left \
            flank) and CD (right flank) are chords on the pitch curve between the two operations."
            ),
            blocks,
        )
    })
}

fn stock_of_teeth(operation: &findings::Section) -> &[findings::Section] {
    operation.group(&STOCK_OF_TEETH).map_or(&[], |teeth| &teeth.sections)
}

/// A column of the table of allowances.
fn allowance(operation: &findings::Section, column: &QuantityRow) -> Vec<Option<f64>> {
    operation.table_of(&ALLOWANCE).map_or_else(Vec::new, |table| table.values(column).collect())
}

fn operation_blocks(operation: &findings::Section, finishing: &str) -> Vec<Block> {
    let teeth = stock_of_teeth(operation);
    let categories: Vec<String> = (1..=teeth.len()).map(|tooth| tooth.to_string()).collect();
    let range = |side: Side| RangeSeries {
        name: format!("{} flanks", side.name()),
        values: teeth
            .iter()
            .map(|tooth| {
                let stock = tooth.side(side)?;
                Some([stock.value(&STOCK_SMALLEST)?, stock.value(&STOCK_MEAN)?, stock.value(&STOCK_LARGEST)?])
            })
            .collect(),
    };
    let chords = |name: &str, column: &QuantityRow| LineSeries {
        name: name.to_owned(),
        points: (1_u32..)
            .map(f64::from)
            .zip(allowance(operation, column).into_iter().map(|chord| chord.unwrap_or(f64::NAN)))
            .collect(),
    };
    let name = &operation.key;
    let period = operation.table_of(&ALLOWANCE).and_then(|table| table.period_rows).unwrap_or(0);
    vec![
        Block::Ranges(RangeChart {
            title: format!("Normal stock after {name} for {finishing}, flank by flank"),
            category_name: "tooth".to_owned(),
            categories: categories.clone(),
            unit: "mm".to_owned(),
            series: vec![range(Side::Left), range(Side::Right)],
        }),
        // From the chords and not from zero: they differ by a few per cent.
        Block::Lines(LineChart {
            title: format!("Allowance on the pitch curve after {name}"),
            x_name: "tooth".to_owned(),
            x_unit: "1".to_owned(),
            panels: vec![Panel {
                value_name: "chord".to_owned(),
                unit: "mm".to_owned(),
                series: vec![chords("AB, left flank", &AB), chords("CD, right flank", &CD)],
                limits: Vec::new(),
                least_division: 1e-3,
            }],
        }),
        Block::Bars(BarChart {
            has_mean: true,
            least_division: 0.0,
            limits: Vec::new(),
            title: format!("Unevenness of the allowance after {name}"),
            category_name: "tooth".to_owned(),
            categories,
            value_name: "|AB − CD| / mean of AB and CD".to_owned(),
            unit: "%".to_owned(),
            series: vec![BarSeries { name: "as cut".to_owned(), values: allowance(operation, &UNEVENNESS) }],
        }),
        Block::Table(spread_table(operation)),
        Block::Folded(
            format!("Allowance tooth by tooth{}", period_words(period, teeth.len())),
            vec![Block::Table(tooth_table(operation))],
        ),
    ]
}

fn period_words(period: u32, teeth: usize) -> String {
    if period as usize == teeth { String::new() } else { format!(" (the pitch curve repeats every {period} teeth)") }
}

fn percent(value: Option<f64>) -> String {
    // Below a billionth of a percent there is only rounding.
    value.map_or_else(|| "–".to_owned(), |value| significant(if value < 1e-9 { 0.0 } else { value }, 4))
}

fn spread_table(operation: &findings::Section) -> PageTable {
    let row = |of: &findings::Section| {
        let number = |row: &QuantityRow| percent(of.value(row));
        vec![unit::sentence_with_signs(&of.title), number(&SPREAD_MAX), number(&SPREAD_MEAN)]
    };
    PageTable {
        caption: "Unevenness by both definitions".to_owned(),
        columns: ["Definition", "Largest [%]", "Mean [%]"].map(str::to_owned).into(),
        rows: operation.group(&SPREADS).map_or_else(Vec::new, |spreads| spreads.sections.iter().map(row).collect()),
    }
}

fn tooth_table(operation: &findings::Section) -> PageTable {
    let mm = |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| format!("{value:.4}"));
    let [ab, cd, unevenness] = [&AB, &CD, &UNEVENNESS].map(|column| allowance(operation, column));
    let rows = stock_of_teeth(operation).iter().enumerate().map(|(row, tooth)| {
        let of = |values: &[Option<f64>]| values.get(row).copied().flatten();
        let stock = |side: Side, row: &QuantityRow| mm(tooth.side(side).and_then(|flank| flank.value(row)));
        vec![
            (row + 1).to_string(),
            stock(Side::Left, &STOCK_SMALLEST),
            stock(Side::Left, &STOCK_LARGEST),
            stock(Side::Right, &STOCK_SMALLEST),
            stock(Side::Right, &STOCK_LARGEST),
            mm(of(&ab)),
            mm(of(&cd)),
            percent(of(&unevenness)),
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
    PageTable {
        caption: "Stock and allowance of each tooth".to_owned(),
        columns: columns.map(str::to_owned).into(),
        rows: rows.collect(),
    }
}
