//! Finished flanks side by side: `tables/flanks.csv`.

use crate::findings::{Datum, Table, TableColumn};
use crate::process::hobbing::measure::flank_report::{HeightSummary, HobbedReport};
use gearcut_core::units::UM_PER_MM;

const STOCK: &str = "the flank was not cut completely";
const HEIGHTS: &str = "a dexel of the evaluated part was reached by no pass";
const TRACE: &str = "a dexel of the trace was reached by no pass";

/// All flanks that were cut; `earlier` are the names of the operations before the last one, `named` whether the scene
/// names where profiles are evaluated.
pub fn flanks<'a>(cut: &[HobbedReport], earlier: impl IntoIterator<Item = &'a str>, named: bool) -> Table {
    let um = |value: Option<f64>| Datum::from(value.map(|v| v * UM_PER_MM));
    let rows = cut.iter().map(|f| {
        let undercut = if f.own.undercut { "yes" } else { "no" };
        let mut row: Vec<Datum> = vec![
            f.tooth.into(),
            f.side.name().into(),
            f.own.form_height_mm.into(),
            undercut.into(),
            f.length_mm.into(),
        ];
        if named {
            row.extend(f.evaluated_mm.map(Datum::from));
        }
        for stock in &f.own.stock {
            let part = |value: fn(&HeightSummary) -> f64| Datum::from(stock.as_ref().map(value));
            row.extend([part(|s| s.lowest_mm), part(|s| s.highest_mm), part(|s| s.mean_mm)]);
        }
        let height = |value: fn(&HeightSummary) -> f64| um(f.own.finished.as_ref().map(value));
        row.extend([height(|h| h.lowest_mm), height(|h| h.highest_mm), height(|h| h.mean_mm), height(|h| h.rms_mm)]);
        for deviation in [&f.profile, &f.lead] {
            row.extend([
                um(deviation.as_ref().map(|d| d.total_mm)),
                um(deviation.as_ref().map(|d| d.form_mm)),
                um(deviation.as_ref().map(|d| d.slope_mm)),
            ]);
        }
        row
    });
    Table::new("flanks", "Finished flanks", columns(earlier, named)).with_rows(rows).in_file("flanks")
}

fn columns<'a>(earlier: impl IntoIterator<Item = &'a str>, named: bool) -> Vec<TableColumn> {
    let mut columns = vec![
        TableColumn::new("tooth", "1", "number of the tooth, from 1"),
        TableColumn::words("flank", "flank: left or right"),
        TableColumn::new(
            "start_of_involute",
            "mm",
            "highest start of the involute in any section, over the pitch curve",
        ),
        TableColumn::words("undercut", "whether the hob's tip corner has undercut the flank in any section: yes or no"),
        TableColumn::new("profile_length", "mm", "length of the profile in the middle of the face"),
    ];
    if named {
        columns.extend([
            TableColumn::new(
                "evaluated_from",
                "mm",
                "arc from the start of the profile at which its evaluated part begins",
            ),
            TableColumn::new(
                "evaluated_to",
                "mm",
                "arc from the start of the profile at which its evaluated part ends",
            ),
        ]);
    }
    for operation in earlier {
        let stock =
            |what: &str, definition| TableColumn::new(format!("{operation}_{what}_stock"), "mm", definition).or(STOCK);
        columns.extend([
            stock("smallest", "smallest stock that the operation left over the finished surface"),
            stock("largest", "largest stock that the operation left over the finished surface"),
            stock("mean", "mean stock that the operation left over the finished surface"),
        ]);
    }
    let um = |key, definition, why| TableColumn::new(key, "um", definition).or(why);
    columns.extend([
        um("lowest", "smallest normal deviation of the finished surface on the evaluated part", HEIGHTS),
        um("highest", "largest normal deviation of the finished surface on the evaluated part", HEIGHTS),
        um("mean", "mean normal deviation of the finished surface", HEIGHTS),
        um("Sq", "root mean square of the normal deviations about their mean", HEIGHTS),
        um("F_alpha", "range of normal deviations along the evaluated profile, middle of the face", TRACE),
        um("f_f_alpha", "range about the profile's mean line", TRACE),
        um("f_H_alpha", "rise of the profile's mean line, positive towards the tip", TRACE),
        um("F_beta", "range of heights along the tooth, middle of the profile", TRACE),
        um("f_f_beta", "range about the helix's mean line", TRACE),
        um("f_H_beta", "rise of the helix's mean line over the face", TRACE),
    ]);
    columns
}
