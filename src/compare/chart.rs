//! Unevenness of the allowance, tooth by tooth: both results in one picture, and each on a scale of its own, since one may
//! be a fiftieth of the other.

use super::{Compared, Comparison};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::quantity::Quantity;
use crate::output::results::{OperationResults, OperationTooth};

impl Comparison {
    /// The charts with their file names; none where neither result has an allowance.
    pub(super) fn charts(&self) -> Vec<(&'static str, BarChart)> {
        let period = self.a.first_period().max(self.b.first_period());
        let all = self.a.teeth().len().max(self.b.teeth().len());
        if all == 0 {
            return Vec::new();
        }
        let (a, b) = (&self.a, &self.b);
        let first = format!("teeth 1 to {period}, the first period");
        vec![
            ("unevenness_first_period", chart(&first, period, &[a, b])),
            ("unevenness_all_teeth", chart("all teeth", all, &[a, b])),
            ("unevenness_a", chart(&first, period, &[a])),
            ("unevenness_b", chart(&first, period, &[b])),
        ]
    }
}

/// Bars of the first `teeth` teeth of some results.
fn chart(what: &str, teeth: usize, results: &[&Compared]) -> BarChart {
    BarChart {
        title: format!("Unevenness of the allowance, {what}"),
        category_name: "tooth".to_owned(),
        categories: (1..=teeth).map(|tooth| tooth.to_string()).collect(),
        value_name: "unevenness, mean denominator".to_owned(),
        unit: results.iter().find_map(|result| result.unit()).unwrap_or("%").to_owned(),
        series: results.iter().map(|result| result.bars(teeth)).collect(),
    }
}

impl Compared {
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
