//! Unevenness of the allowance, tooth by tooth, of two results in one picture.

use super::{Compared, Comparison};
use crate::output::bar_chart::{BarChart, BarSeries};
use crate::output::quantity::Quantity;
use crate::output::results::{OperationResults, OperationTooth};

impl Comparison {
    /// Both charts with their file names; none where neither result has an allowance.
    pub(super) fn charts(&self) -> Vec<(&'static str, BarChart)> {
        let period = self.a.first_period().max(self.b.first_period());
        let all = self.a.teeth().len().max(self.b.teeth().len());
        if all == 0 {
            return Vec::new();
        }
        let unit = [&self.a, &self.b].into_iter().find_map(Compared::unit).unwrap_or("1");
        let chart = |what: &str, teeth: usize| BarChart {
            title: format!("Unevenness of the allowance, {what}"),
            category_name: "tooth".to_owned(),
            categories: (1..=teeth).map(|tooth| tooth.to_string()).collect(),
            value_name: "unevenness |AB−CD| : mean(AB, CD)".to_owned(),
            unit: unit.to_owned(),
            series: [&self.a, &self.b].map(|result| result.bars(teeth)).into(),
        };
        vec![
            ("unevenness_first_period", chart(&format!("teeth 1 to {period}, the first period"), period)),
            ("unevenness_all_teeth", chart("all teeth", all)),
        ]
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
