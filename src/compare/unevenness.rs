//! Unevenness of the allowance, tooth by tooth: all results in one picture, and each on a scale of its own, since one may
//! be a fiftieth of the other.

use super::{Compared, letters};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::quantity::Quantity;
use crate::output::results::{OperationResults, OperationTooth, Results};

/// The charts with their file names; none where no result has an allowance.
pub(super) fn charts(results: &[Compared<Results>]) -> Vec<(String, BarChart)> {
    let period = results.iter().map(Compared::first_period).max().unwrap_or(0);
    let all = results.iter().map(|one| one.teeth().len()).max().unwrap_or(0);
    if all == 0 {
        return Vec::new();
    }
    let first = format!("teeth 1 to {period}, the first period");
    let mut charts = vec![
        ("unevenness_first_period".to_owned(), chart(&first, period, results)),
        ("unevenness_all_teeth".to_owned(), chart("all teeth", all, results)),
    ];
    for (one, letter) in results.iter().zip(letters()) {
        charts.push((format!("unevenness_{letter}"), chart(&first, period, std::slice::from_ref(one))));
    }
    charts
}

/// Bars of the first `teeth` teeth of some results.
fn chart(what: &str, teeth: usize, results: &[Compared<Results>]) -> BarChart {
    BarChart {
        title: format!("Unevenness of the allowance, {what}"),
        category_name: "tooth".to_owned(),
        categories: (1..=teeth).map(|tooth| tooth.to_string()).collect(),
        value_name: "unevenness, mean denominator".to_owned(),
        unit: results.iter().find_map(|result| result.unit()).unwrap_or("%").to_owned(),
        series: results.iter().map(|result| result.bars(teeth)).collect(),
    }
}

impl Compared<Results> {
    fn operation(&self) -> Option<&OperationResults> {
        self.results.last_with_allowance()
    }

    fn teeth(&self) -> &[OperationTooth] {
        self.operation().map_or(&[], |operation| &operation.teeth)
    }

    fn first_period(&self) -> usize {
        (self.results.period_teeth as usize).min(self.teeth().len())
    }

    fn unit(&self) -> Option<&str> {
        self.teeth().first()?.unevenness_mean_denominator.unit()
    }

    fn bars(&self, teeth: usize) -> BarSeries {
        let value = |tooth: usize| {
            let entry = self.teeth().iter().find(|entry| entry.index as usize == tooth)?;
            Quantity::value(&entry.unevenness_mean_denominator)
        };
        let name = match self.operation() {
            Some(operation) => format!("{} ({})", self.name, operation.linkage),
            None => self.name.clone(),
        };
        BarSeries { name, values: (1..=teeth).map(value).collect() }
    }
}
