//! What the teeth of the hob do: bars by hob tooth, and how much one process relieves the hardest working tooth of another.

use std::collections::BTreeSet;

use super::Compared;
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::quantity::Quantity;
use crate::output::results::{HobbedResults, OperationLoadResults, ToothLoadResults};

/// One kind of chart: its file, what it shows and a tooth's value.
type Kind = (&'static str, &'static str, fn(&ToothLoadResults) -> &Quantity);

const KINDS: [Kind; 3] = [
    ("volume", "volume taken", |tooth| &tooth.volume),
    ("thickness", "largest uncut chip thickness", |tooth| &tooth.thickness),
    ("way", "way cut", |tooth| &tooth.way),
];

/// Largest volume of a tooth in the first result over that of `load`, operation by operation.
pub(super) fn peak_load_ratio(
    results: &[Compared<HobbedResults>],
    load: &OperationLoadResults,
) -> Option<(String, Quantity)> {
    let first = load_of(&results.first()?.results, &load.name)?;
    let ratio = first.largest_volume.value()? / load.largest_volume.value()?;
    let definition = "largest volume of a hob tooth in the first result over that in this one: how much less the hardest working tooth does";
    Some(("peak_load_ratio".to_owned(), Quantity::number(ratio, "1", definition)))
}

fn load_of<'a>(results: &'a HobbedResults, operation: &str) -> Option<&'a OperationLoadResults> {
    results.hob_load.as_ref()?.operations.iter().find(|load| load.name == operation)
}

/// Charts of every operation, with their file names; a result without an operation of that name has no bars.
pub(super) fn charts(results: &[Compared<HobbedResults>]) -> Vec<(String, BarChart)> {
    let all = || results.iter().filter_map(|one| one.results.hob_load.as_ref()).flat_map(|load| &load.operations);
    let mut seen = BTreeSet::new();
    let operations = all().map(|load| load.name.as_str()).filter(|&name| seen.insert(name));
    let charts = operations.flat_map(|operation| KINDS.map(|kind| (operation, kind)));
    charts.filter_map(|(operation, kind)| chart(results, operation, kind)).collect()
}

fn chart(
    results: &[Compared<HobbedResults>],
    operation: &str,
    (stem, what, value): Kind,
) -> Option<(String, BarChart)> {
    let teeth: Vec<&[ToothLoadResults]> =
        results.iter().map(|one| load_of(&one.results, operation).map_or(&[][..], |load| &load.teeth)).collect();
    let mut seen = BTreeSet::new();
    let categories: Vec<String> =
        teeth.iter().copied().flatten().map(|t| t.tooth.clone()).filter(|tooth| seen.insert(tooth.clone())).collect();
    let unit = value(teeth.iter().copied().flatten().next()?).unit()?.to_owned();
    let series = results.iter().zip(&teeth).map(|(one, teeth)| BarSeries {
        name: one.name.clone(),
        values: categories
            .iter()
            .map(|label| value(teeth.iter().find(|tooth| tooth.tooth == *label)?).value())
            .collect(),
    });
    let chart = BarChart {
        title: format!("Operation {operation}: {what} by hob tooth"),
        category_name: "hob tooth, from the entering end".to_owned(),
        value_name: what.to_owned(),
        unit,
        series: series.collect(),
        categories,
    };
    Some((format!("load_{operation}_{stem}"), chart))
}
