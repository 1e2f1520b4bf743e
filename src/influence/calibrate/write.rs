//! A calibration as findings, and all that is written.

use super::Calibration;
use crate::findings::{Datum, Entry, Findings, Quantity, RESULTS_FILE, Section, Table, TableColumn, Warning};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::output::text::significant;
use crate::scene::Scene;
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use gearcut_core::error::Result;

/// Chance that uncertainties alone are called too much to be left over.
const UNEXPLAINED_BY_CHANCE: f64 = 1e-3;

/// The tree.
pub fn findings(scene: &Scene, found: &Calibration) -> Findings {
    let headline = found.fitted.iter().enumerate().map(|(index, (parameter, fitted))| {
        let definition = match fitted {
            Some([_, half]) => format!(
                "fitted: shift of {} beyond the scene; 95 % interval +- {} {}",
                parameter.id,
                significant(*half, 3),
                parameter.unit
            ),
            None => format!("fitted: shift of {} beyond the scene", parameter.id),
        };
        let why = "the measured numbers do not say it: its derivatives are nothing, or those of the others";
        let quantity = Quantity::number_or(fitted.map(|[shift, _]| shift), parameter.unit, definition, why);
        Entry::headline(&format!("fit_{}", index + 1), &parameter.title, quantity)
    });
    let section = Section::new("calibration", "Calibration")
        .with("chi_square", {
            let what = "fitted: sum of the squared residuals over the uncertainties";
            Quantity::number(found.chi_square, "1", what)
        })
        .with("freedom", Quantity::count(found.freedom as u64, "1", "measured numbers less fitted ones"))
        .with("chance", {
            let what = "chance of residuals as large from the uncertainties alone: chi-square";
            Quantity::number_or(found.chance, "1", what, "as many numbers are fitted as measured")
        })
        .table(fits(found))
        .table(numbers(found));
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: scene.process_name().to_owned(),
        scene: scene.name.clone(),
        complete: true,
        headline: headline.collect(),
        warnings: warnings(found),
        sections: vec![section],
    }
}

fn warnings(found: &Calibration) -> Vec<Warning> {
    let lost = found.fitted.iter().filter(|(_, fitted)| fitted.is_none()).map(|(parameter, _)| {
        Warning::warn(format!(
            "{} cannot be identified: the measured numbers say nothing of it, or no more than of the others together",
            parameter.id
        ))
    });
    let moving = (!found.settled).then(|| Warning::warn("the fit has not settled: its numbers are no least squares"));
    let left = found.chance.filter(|chance| *chance < UNEXPLAINED_BY_CHANCE).map(|chance| {
        Warning::warn(format!(
            "unexplained: uncertainties alone leave residuals as large in {} of 1000 cases; something else is wrong",
            significant(1000.0 * chance, 2)
        ))
    });
    let bare = (found.freedom == 0)
        .then(|| Warning::note("as many numbers are fitted as measured: that they agree says nothing about the model"));
    lost.chain(moving).chain(left).chain(bare).collect()
}

fn fits(found: &Calibration) -> Table {
    let why = "the measured numbers do not say it";
    let columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("kind", "fitted: chosen so that the predicted numbers come near the measured ones"),
        TableColumn::by_row("shift", "shift beyond the scene").or(why),
        TableColumn::by_row("half_width", "half the width of its 95 % interval").or(why),
        TableColumn::words("unit", "unit of both"),
    ];
    let rows = found.fitted.iter().map(|(parameter, fitted)| {
        vec![
            parameter.id.as_str().into(),
            "fitted".into(),
            Datum::from(fitted.map(|[shift, _]| shift)),
            Datum::from(fitted.map(|[_, half]| half)),
            parameter.unit.into(),
        ]
    });
    Table::new("fits", "Fitted parameters", columns).with_rows(rows).in_file("fits")
}

fn numbers(found: &Calibration) -> Table {
    let columns = vec![
        TableColumn::words("quantity", "path in results.json, which says its unit"),
        TableColumn::by_row("measured", "measured value"),
        TableColumn::by_row("uncertainty", "its standard uncertainty"),
        TableColumn::by_row("scene", "predicted: by the scene as it is"),
        TableColumn::by_row("fitted", "fitted: by the scene with the fitted parameters"),
    ];
    let rows = found.numbers.iter().map(|(measured, [before, after])| {
        vec![
            measured.quantity.as_str().into(),
            measured.value.into(),
            measured.uncertainty.into(),
            (*before).into(),
            (*after).into(),
        ]
    });
    Table::new("numbers", "Measured numbers", columns).with_rows(rows).in_file("numbers")
}

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(scene: &Scene, found: &Calibration, tree: &Findings, folder: &OutputFolder) -> Result<()> {
    write_tables(tree, folder)?;
    page(scene, found, tree).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &tree.to_json())
}

fn page(scene: &Scene, found: &Calibration, tree: &Findings) -> Page {
    let shown = |value: f64| significant(value, 4).replace('-', "−");
    let rows = found.numbers.iter().map(|(measured, [before, after])| {
        let both = format!("{} ± {}", shown(measured.value), shown(measured.uncertainty));
        vec![measured.quantity.clone(), both, shown(*before), shown(*after)]
    });
    let numbers = PageTable {
        caption: "Measured numbers".to_owned(),
        columns: ["Quantity", "Measured", "Predicted by the scene", "Fitted"].map(str::to_owned).into(),
        rows: rows.collect(),
    };
    let mut blocks = vec![Block::Table(numbers)];
    blocks.extend(tree.find("calibration").map(|section| Block::Table(quantities::table(section))));
    if !found.settings.is_empty() {
        let settings: Vec<String> = found.settings.iter().map(|setting| format!("--set '{setting}'")).collect();
        blocks.push(Block::Note("Fitted: these arguments make the scene the fitted one.".to_owned()));
        blocks.push(Block::Verbatim(settings.join("\n")));
    }
    Page {
        what: "calibration",
        title: tree.scene.clone(),
        subtitle: format!("{} parameters fitted to {} measured numbers", found.fitted.len(), found.numbers.len()),
        operations: vec![gear_words(&scene.gear)],
        complete: true,
        done: "fitted",
        program: format!("gearcut {}", tree.program_version),
        key_numbers: tree.headline.iter().map(quantities::key_number).collect(),
        warnings: tree.warnings.iter().map(Warning::with_signs).collect(),
        viewer: None,
        sections: vec![PageSection::new(
            "numbers",
            "Measured and fitted",
            "Fitted numbers were made to agree; they are no evidence for the model beyond what is left over.",
            blocks,
        )],
    }
}
