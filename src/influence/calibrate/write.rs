//! A calibration as findings, and all that is written.

use super::{Calibrated, Calibration, MeasuredGear};
use crate::findings::{Datum, Entry, Findings, Notice, Quantity, RESULTS_FILE, Section, Table, TableColumn};
use crate::influence::charts::MeasuredLine;
use crate::influence::notices::{
    AtEnd, CalibrationBeyond, CalibrationStopped, CalibrationUnexplained, CalibrationUnsettled, NoFreedom, OneSurface,
    Unidentified,
};
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::output::text::significant;
use crate::scene::error_parameters::ErrorParameter;
use crate::scene::{LoadedScene, Scene};
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use crate::steps::report::{SCENE, ending};
use gearcut_core::error::Result;

/// Chance that uncertainties alone are called too much to be left over.
const UNEXPLAINED_BY_CHANCE: f64 = 1e-3;

/// The tree.
pub fn findings(scene: &Scene, measured: &MeasuredGear, found: &Calibration) -> Findings {
    let headline = found.fitted.iter().zip(&found.at_end).enumerate().map(|(index, ((parameter, fitted), at_end))| {
        let definition = match (fitted, at_end) {
            (Some([_, half]), _) => format!(
                "fitted: shift of {} beyond the scene; 95 % interval +- {} {}",
                parameter.id,
                significant(*half, 3),
                parameter.unit
            ),
            (None, Some(_)) => {
                format!("fitted: shift of {} beyond the scene, which the end of its range holds", parameter.id)
            }
            (None, None) => format!("fitted: shift of {} beyond the scene", parameter.id),
        };
        let why = "the measured values do not say it: its derivatives are nothing, or those of the others";
        let shift = fitted.map(|[shift, _]| shift).or(*at_end);
        let quantity = Quantity::number_or(shift, parameter.unit, definition, why);
        Entry::headline(&format!("fit_{}", index + 1), &parameter.title, quantity)
    });
    let section = Section::new("calibration", "Calibration")
        .with("chi_square", {
            let what = "fitted: sum of the squared residuals over the uncertainties";
            Quantity::number(found.chi_square, "1", what)
        })
        .with(
            "freedom",
            Quantity::count(found.freedom as u64, "1", "measured values less fitted ones, and one for each line"),
        )
        .with("chance", {
            let what = "fitted: chance of residuals as large from the uncertainties alone: chi-square";
            Quantity::number_or(found.chance, "1", what, "as many numbers are fitted as measured")
        })
        .table(fits(found))
        .table(numbers(measured, found));
    let section = if measured.lines.is_empty() {
        section
    } else {
        section.table(lines(measured, found)).table(places(measured, found))
    };
    Findings {
        program_version: env!("CARGO_PKG_VERSION").to_owned(),
        process: scene.process_name().to_owned(),
        scene: scene.name.clone(),
        complete: found.complete,
        headline: headline.collect(),
        warnings: warnings(measured, found),
        sections: vec![section],
    }
}

fn warnings(measured: &MeasuredGear, found: &Calibration) -> Vec<Notice> {
    let stopped = (!found.complete).then(|| CalibrationStopped {}.notice());
    let parameters = found.fitted.iter().zip(&found.at_end).filter(|((_, fitted), _)| fitted.is_none());
    let lost = parameters.map(|((parameter, _), at_end)| {
        let ErrorParameter { id, unit, .. } = parameter;
        match at_end {
            Some(shift) => AtEnd { parameter: id, shift: significant(*shift, 4), unit }.notice(),
            None => Unidentified { parameter: id }.notice(),
        }
    });
    let moving = (found.complete && !found.settled)
        .then(|| if found.beyond { CalibrationBeyond {}.notice() } else { CalibrationUnsettled {}.notice() });
    let left = found.chance.filter(|chance| *chance < UNEXPLAINED_BY_CHANCE);
    let left = left.map(|chance| CalibrationUnexplained { of_1000: significant(1000.0 * chance, 2) }.notice());
    let bare = (found.freedom == 0).then(|| NoFreedom {}.notice());
    let together = measured.of_one_surface().into_iter().map(|(surface, symbols)| {
        let factor = significant((symbols.len() as f64).sqrt(), 2);
        OneSurface { symbols: symbols.join(", "), surface, factor }.notice()
    });
    let files = measured.notes.iter().cloned();
    stopped.into_iter().chain(lost).chain(moving).chain(left).chain(bare).chain(together).chain(files).collect()
}

impl Calibration {
    /// Fitted parameters for people: title, shift with its interval or why it has none, unit.
    pub fn printed(&self) -> Vec<[String; 3]> {
        let value = |fitted: Option<[f64; 2]>, at_end: Option<f64>| match (fitted, at_end) {
            (Some([shift, half]), _) => format!("{} +- {}", significant(shift, 4), significant(half, 2)),
            (None, Some(shift)) => format!("end of its range: {}", significant(shift, 4)),
            (None, None) => "cannot be identified".to_owned(),
        };
        let rows = self.fitted.iter().zip(&self.at_end);
        rows.map(|((parameter, fitted), at_end)| {
            [parameter.title.clone(), value(*fitted, *at_end), parameter.unit.to_owned()]
        })
        .collect()
    }
}

fn fits(found: &Calibration) -> Table {
    let why = "the measured values do not say it";
    let columns = vec![
        TableColumn::words("parameter", "key of the error, and behind @ which part of it"),
        TableColumn::words("kind", "fitted: chosen so that the predicted values come near the measured ones"),
        TableColumn::by_row("shift", "shift beyond the scene").or(why),
        TableColumn::by_row("half_width", "half the width of its 95 % interval")
            .or("the measured values do not say it, or the end of its key's range holds it"),
        TableColumn::words("unit", "unit of both"),
    ];
    let rows = found.fitted.iter().zip(&found.at_end).map(|((parameter, fitted), at_end)| {
        vec![
            parameter.id.as_str().into(),
            "fitted".into(),
            Datum::from(fitted.map(|[shift, _]| shift).or(*at_end)),
            Datum::from(fitted.map(|[_, half]| half)),
            parameter.unit.into(),
        ]
    });
    Table::new("fits", "Fitted parameters", columns).with_rows(rows).in_file("fits")
}

fn numbers(measured: &MeasuredGear, found: &Calibration) -> Table {
    let columns = vec![
        TableColumn::words("quantity", "path in results.json, which says its unit"),
        TableColumn::by_row("value", "measured: value"),
        TableColumn::by_row("uncertainty", "measured: its standard uncertainty"),
        TableColumn::by_row("predicted", "predicted: by the scene as it is"),
        TableColumn::by_row("fitted", "fitted: by the scene with the fitted parameters"),
    ];
    let rows = measured.numbers.iter().zip(&found.values).map(|(number, of)| {
        let quantity = number.quantity.as_str().into();
        vec![quantity, of.measured.into(), number.uncertainty.into(), of.predicted.into(), of.fitted.into()]
    });
    Table::new("numbers", "Measured numbers", columns).with_rows(rows).in_file("numbers")
}

/// Lines with their values.
fn by_line<'a>(
    measured: &'a MeasuredGear,
    found: &'a Calibration,
) -> impl Iterator<Item = (&'a MeasuredLine, &'a [Calibrated])> {
    let mut rest = &found.values[measured.numbers.len()..];
    measured.lines.iter().map(move |line| {
        let (own, others) = rest.split_at(line.points.len());
        rest = others;
        (line, own)
    })
}

/// A row for each line.
fn lines(measured: &MeasuredGear, found: &Calibration) -> Table {
    let columns = vec![
        TableColumn::words("line", "line of a chart"),
        TableColumn::new("places", "1", "measured: places on it"),
        TableColumn::new("measured", "um", "measured: root mean square about the mean of the line, or a turn"),
        TableColumn::new("off_predicted", "um", "predicted: root mean square of what the scene as it is leaves of it"),
        TableColumn::new("off_fitted", "um", "fitted: the same of the scene with the fitted parameters"),
    ];
    let rows = by_line(measured, found).map(|(line, own)| {
        let rms = |of: fn(&Calibrated) -> f64| {
            (own.iter().map(|one| of(one).powi(2)).sum::<f64>() / own.len() as f64).sqrt().into()
        };
        vec![
            Datum::Word(line.title()),
            (own.len() as u64).into(),
            rms(|of| of.measured),
            rms(|of| of.measured - of.predicted),
            rms(|of| of.measured - of.fitted),
        ]
    });
    Table::new("lines", "Measured lines", columns).with_rows(rows).in_file("lines")
}

/// A row for each place of the lines.
fn places(measured: &MeasuredGear, found: &Calibration) -> Table {
    let columns = vec![
        TableColumn::words("chart", "profile, helix, pitch; places: loose ones"),
        TableColumn::new("tooth", "1", "tooth, from 1"),
        TableColumn::words("flank", "left or right"),
        TableColumn::new("u", "mm", "arc along the profile from the form point")
            .or("pitch is taken on the pitch curve"),
        TableColumn::new("v", "mm", "place along the tooth from the middle of the face").or("pitch is taken there"),
        TableColumn::new("measured", "um", "measured: deviation from the mean of its line, or but for a turn"),
        TableColumn::new("predicted", "um", "predicted: the same by the scene as it is"),
        TableColumn::new("fitted", "um", "fitted: the same by the scene with the fitted parameters"),
    ];
    let rows = by_line(measured, found).flat_map(|(line, own)| {
        line.points.iter().zip(own).map(|(point, of)| {
            let known = |mm: f64| Datum::from(Some(mm).filter(|mm| mm.is_finite()));
            vec![
                line.chart.name().into(),
                point.tooth.into(),
                point.side.name().into(),
                known(point.u_mm),
                known(point.v_mm),
                of.measured.into(),
                of.predicted.into(),
                of.fitted.into(),
            ]
        })
    });
    Table::new("places", "Places of the measured lines", columns).with_rows(rows).rows_in_file("places")
}

/// Writes everything but the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    loaded: &LoadedScene,
    backend: &str,
    measured: &MeasuredGear,
    found: &Calibration,
    tree: &Findings,
    folder: &OutputFolder,
) -> Result<()> {
    write_tables(tree, folder)?;
    let end = ending(folder, ["Backend", backend], &[(SCENE, &loaded.resolved_toml())])?;
    page(&loaded.scene, found, measured, tree, end).write(&folder.path(REPORT_FILE)?)?;
    folder.write_json(RESULTS_FILE, &tree.to_json())
}

fn page(scene: &Scene, found: &Calibration, measured: &MeasuredGear, tree: &Findings, end: [PageSection; 2]) -> Page {
    let shown = |value: f64| significant(value, 4).replace('-', "−");
    let fits = found
        .printed()
        .into_iter()
        .map(|[title, value, unit]| vec![title, value.replace("+-", "±").replace('-', "−"), unit]);
    let mut blocks = vec![Block::Table(PageTable {
        caption: "Fitted parameters, shifts beyond the scene with 95 % intervals".to_owned(),
        columns: ["Parameter", "Fitted", "Unit"].map(str::to_owned).into(),
        rows: fits.collect(),
    })];
    if !measured.numbers.is_empty() {
        let rows = measured.numbers.iter().zip(&found.values).map(|(number, of)| {
            let both = format!("{} ± {}", shown(of.measured), shown(number.uncertainty));
            vec![number.quantity.clone(), both, shown(of.predicted), shown(of.fitted)]
        });
        blocks.push(Block::Table(PageTable {
            caption: "Measured numbers".to_owned(),
            columns: ["Quantity", "Measured", "Predicted by the scene", "Fitted"].map(str::to_owned).into(),
            rows: rows.collect(),
        }));
    }
    if let Some(table) = tree.find("calibration").and_then(|section| section.table_of("lines")) {
        let rows = table.rows.iter().map(|row| {
            let um = |cell: &Datum| cell.number().map_or_else(String::new, shown);
            std::iter::once(row[0].name()).chain(row[2..].iter().map(um)).collect()
        });
        let columns = ["Line", "Measured [µm]", "Left by the scene, predicted [µm]", "Left, fitted [µm]"];
        blocks.push(Block::Table(PageTable {
            caption: "Measured lines, root mean squares about their means".to_owned(),
            columns: columns.map(str::to_owned).into(),
            rows: rows.collect(),
        }));
    }
    blocks.extend(tree.find("calibration").map(|section| Block::Table(quantities::table(section))));
    if !found.settings.is_empty() {
        let settings: Vec<String> = found.settings.iter().map(|setting| format!("--set '{setting}'")).collect();
        blocks.push(Block::Note("Fitted: these arguments make the scene the fitted one.".to_owned()));
        blocks.push(Block::Verbatim(settings.join("\n")));
    }
    Page {
        what: "calibration",
        title: tree.scene.clone(),
        subtitle: format!("{} parameters fitted to {} measured values", found.fitted.len(), found.values.len()),
        operations: vec![gear_words(&scene.gear)],
        complete: found.complete,
        done: "fitted",
        program: format!("gearcut {}", tree.program_version),
        key_numbers: tree.headline.iter().map(quantities::key_number).collect(),
        warnings: tree.warnings.iter().map(Notice::with_signs).collect(),
        viewer: None,
        sections: std::iter::once(PageSection::new(
            "numbers",
            "Measured and fitted",
            "Fitted numbers were made to agree; they are no evidence for the model beyond what is left over.",
            blocks,
        ))
        .chain(end)
        .collect(),
    }
}
