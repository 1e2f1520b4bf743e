//! A calibration as findings, and all that is written.

use super::{Calibrated, Calibration, MeasuredGear};
use crate::findings::quantities::inspection::{CHART, CHART_U, CHART_V};
use crate::findings::quantities::teeth::{FLANK, TOOTH};
use crate::findings::{Findings, Notice, RESULTS_FILE, Table};
use crate::influence::charts::MeasuredLine;
use crate::influence::notices::{
    AtEnd, CalibrationBeyond, CalibrationStopped, CalibrationUnexplained, CalibrationUnsettled, NoFreedom, OneSurface,
    Unidentified,
};
use crate::influence::quantities::calibration::{
    AS_MANY, CALIBRATION, CHANCE, CHI_SQUARE, COUNT, DEVIATION, DEVIATION_FITTED, DEVIATION_PREDICTED, FITS, FITTED,
    FITTED_SHIFT, FREEDOM, HALF_WIDTH, LINE, MEASURED_LINES, MEASURED_NUMBERS, MEASURED_PLACES, OFF_FITTED,
    OFF_PREDICTED, PREDICTED, QUANTITY, RMS, SHIFT, UNCERTAINTY, UNIDENTIFIED, VALUE,
};
use crate::influence::quantities::{KIND, PARAMETER, UNIT};
use crate::number_text::significant;
use crate::output::folder::OutputFolder;
use crate::output::report::{Block, Page, PageSection, PageTable, REPORT_FILE};
use crate::output::table::write_tables;
use crate::scene::error_parameters::ErrorParameter;
use crate::scene::{LoadedScene, Scene};
use crate::steps::report::facts::gear_words;
use crate::steps::report::quantities;
use crate::steps::report::{SCENE, ending, page_of};
use gearcut_core::error::Result;

/// Chance that uncertainties alone are called too much to be left over.
const UNEXPLAINED_BY_CHANCE: f64 = 1e-3;

/// The tree.
pub fn findings(scene: &Scene, measured: &MeasuredGear, found: &Calibration) -> Findings {
    let headline = found.fitted.iter().zip(&found.at_end).enumerate().map(|(index, ((parameter, fitted), at_end))| {
        let ErrorParameter { id, title, unit, .. } = parameter;
        let remark = match (fitted, at_end) {
            (Some([_, half]), _) => format!(": {id}; 95 % interval +- {} {unit}", significant(*half, 3)),
            (None, Some(_)) => format!(": {id}, which the end of its range holds"),
            (None, None) => format!(": {id}"),
        };
        let entry = FITTED_SHIFT.of_or(fitted.map(|[shift, _]| shift).or(*at_end), UNIDENTIFIED).remarked(&remark);
        entry.keyed(format!("{}_{}", FITTED_SHIFT.key, index + 1)).titled(title.as_str()).in_unit(*unit)
    });
    let section = CALIBRATION
        .section([CHI_SQUARE.of(found.chi_square), FREEDOM.of(found.freedom), CHANCE.of_or(found.chance, AS_MANY)])
        .table(fits(found))
        .table(numbers(measured, found));
    let section = if measured.lines.is_empty() {
        section
    } else {
        section.table(lines(measured, found)).table(places(measured, found))
    };
    let warnings = warnings(measured, found);
    Findings::new(scene.process_name(), &scene.name, found.complete, headline, warnings, vec![section])
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
    FITS.table(found.fitted.iter().zip(&found.at_end))
        .column(&PARAMETER, |((parameter, _), _)| parameter.id.as_str())
        .column(&KIND, |_| "fitted")
        .column(&SHIFT, |((_, fitted), at_end)| fitted.map(|[shift, _]| shift).or(**at_end))
        .column(&HALF_WIDTH, |((_, fitted), _)| fitted.map(|[_, half]| half))
        .column(&UNIT, |((parameter, _), _)| parameter.unit)
        .in_file("fits")
}

fn numbers(measured: &MeasuredGear, found: &Calibration) -> Table {
    MEASURED_NUMBERS
        .table(measured.numbers.iter().zip(&found.values))
        .column(&QUANTITY, |(number, _)| number.quantity.as_str())
        .column(&VALUE, |(_, of)| of.measured)
        .column(&UNCERTAINTY, |(number, _)| number.uncertainty)
        .column(&PREDICTED, |(_, of)| of.predicted)
        .column(&FITTED, |(_, of)| of.fitted)
        .in_file("numbers")
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
    let rms = |own: &[Calibrated], of: fn(&Calibrated) -> f64| {
        (own.iter().map(|one| of(one).powi(2)).sum::<f64>() / own.len() as f64).sqrt()
    };
    MEASURED_LINES
        .table(by_line(measured, found))
        .column(&LINE, |(line, _)| line.title())
        .column(&COUNT, |(_, own)| own.len())
        .column(&RMS, |(_, own)| rms(own, |of| of.measured))
        .column(&OFF_PREDICTED, |(_, own)| rms(own, |of| of.measured - of.predicted))
        .column(&OFF_FITTED, |(_, own)| rms(own, |of| of.measured - of.fitted))
        .in_file("lines")
}

/// A row for each place of the lines.
fn places(measured: &MeasuredGear, found: &Calibration) -> Table {
    let rows = by_line(measured, found)
        .flat_map(|(line, own)| line.points.iter().zip(own).map(move |(point, of)| (line, point, of)));
    MEASURED_PLACES
        .table(rows)
        .column(&CHART, |(line, ..)| line.chart.name())
        .column(&TOOTH, |(_, point, _)| point.tooth)
        .column(&FLANK, |(_, point, _)| point.side.name())
        .column(&CHART_U, |(_, point, _)| point.u_mm)
        .column(&CHART_V, |(_, point, _)| point.v_mm)
        .column(&DEVIATION, |(.., of)| of.measured)
        .column(&DEVIATION_PREDICTED, |(.., of)| of.predicted)
        .column(&DEVIATION_FITTED, |(.., of)| of.fitted)
        .rows_in_file("places")
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
    let section = tree.group(&CALIBRATION);
    if let Some(table) = section.and_then(|section| section.table_of(&MEASURED_LINES)) {
        let um = |row| table.values(row).map(|um| um.map_or_else(String::new, shown));
        let values = um(&RMS).zip(um(&OFF_PREDICTED)).zip(um(&OFF_FITTED));
        let rows =
            table.names().zip(values).map(|(name, ((own, predicted), fitted))| vec![name, own, predicted, fitted]);
        let columns = ["Line", "Measured [µm]", "Left by the scene, predicted [µm]", "Left, fitted [µm]"];
        blocks.push(Block::Table(PageTable {
            caption: "Measured lines, root mean squares about their means".to_owned(),
            columns: columns.map(str::to_owned).into(),
            rows: rows.collect(),
        }));
    }
    blocks.extend(section.map(|section| Block::Table(quantities::table(section))));
    if !found.settings.is_empty() {
        let settings: Vec<String> = found.settings.iter().map(|setting| format!("--set '{setting}'")).collect();
        blocks.push(Block::Note("Fitted: these arguments make the scene the fitted one.".to_owned()));
        blocks.push(Block::Verbatim(settings.join("\n")));
    }
    Page {
        what: "calibration",
        subtitle: format!("{} parameters fitted to {} measured values", found.fitted.len(), found.values.len()),
        operations: vec![gear_words(scene)],
        done: "fitted",
        sections: std::iter::once(PageSection::new(
            "numbers",
            "Measured and fitted",
            "Fitted numbers were made to agree; they are no evidence for the model beyond what is left over.",
            blocks,
        ))
        .chain(end)
        .collect(),
        ..page_of(tree)
    }
}
