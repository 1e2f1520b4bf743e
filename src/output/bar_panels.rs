//! Bars over the same categories in panels one below the other, each with a scale of its own: what every layer of
//! errors does to numbers of different size.
//!
//! In: categories, and for each panel what its values are, their unit, one or two series with a value or none per
//! category, and values to compare with. Out: the panels with one common axis, on a page or as an SVG file.
//!
//! Road not taken: all numbers in one plot, over their values with all layers. A number that nothing changes would be
//! as high as one that a layer makes, and what is nearly nothing would be blown up.

use std::path::Path;

use maud::html;

use crate::output::bar_chart::{BarSeries, bars, range};
use crate::output::figure::{Figure, LegendEntry, MOST_SERIES, Name, Plot, Sample};
use crate::output::line_chart::Limit;
use crate::output::plot::{BarPlaces, PlotFrame, WIDTH_PX};
use gearcut_core::Result;

/// Height of a panel: some of them shall be seen at once, pixels.
const HEIGHT_PX: f64 = 112.0;

/// Panels of bars.
#[derive(Debug, Clone, PartialEq)]
pub struct BarPanels {
    /// What is shown.
    pub title: String,
    /// What the categories are.
    pub category_name: String,
    /// Label of each category.
    pub categories: Vec<String>,
    /// From the top.
    pub panels: Vec<BarPanel>,
}

/// One of the panels.
#[derive(Debug, Clone, PartialEq)]
pub struct BarPanel {
    /// What the values are.
    pub value_name: String,
    /// Their unit.
    pub unit: String,
    /// Smallest distance of two ticks, where less would make noise look like a finding; 0 for none.
    pub least_division: f64,
    /// Series, of the same names in all panels.
    pub series: Vec<BarSeries>,
    /// Values that bars are compared with.
    pub limits: Vec<Limit>,
}

impl BarPanels {
    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// No panels, series that do not fit the categories or the palette, and files that cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        self.figure().write_svg(path, self.problem())
    }

    /// Why the chart cannot be drawn, if it cannot.
    fn problem(&self) -> Option<String> {
        if self.panels.is_empty() {
            return Some("a chart needs at least one panel".to_owned());
        }
        let fits = |panel: &&BarPanel| {
            let long = |series: &BarSeries| series.values.len() == self.categories.len();
            (1..=MOST_SERIES).contains(&panel.series.len()) && panel.series.iter().all(long)
        };
        let wrong = self.panels.iter().find(|panel| !fits(panel))?;
        let categories = self.categories.len();
        Some(format!("panel {} needs 1 to {MOST_SERIES} series of {categories} values each", wrong.value_name))
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let plots = self.panels.iter().enumerate().map(|(index, panel)| {
            let frame = PlotFrame::new(HEIGHT_PX, range(&panel.series, panel.least_division, &panel.limits));
            let slots = BarPlaces { frame: &frame, categories: &self.categories, series: panel.series.len() };
            let last = index + 1 == self.panels.len();
            let drawing = html! {
                (frame.value_axis())
                (bars(&slots, &panel.series, &self.category_name, &panel.unit))
                (frame.across("zero", 0.0))
                @for limit in panel.limits.iter().filter(|limit| limit.is_within(frame.range)) {
                    (frame.across("limit", limit.value))
                }
                (frame.outline())
                @if last { (slots.labels()) }
            };
            let entry = |(index, series): (usize, &BarSeries)| LegendEntry {
                sample: Sample::Block(index),
                words: series.name.clone(),
            };
            let limits = panel.limits.iter().map(|limit| limit.legend(frame.range, &panel.unit));
            Plot {
                name: Name::new(&panel.value_name, frame.ticks().unit_text(&panel.unit)),
                legend: panel.series.iter().enumerate().map(entry).chain(limits).collect(),
                size_px: (WIDTH_PX, frame.bottom + if last { slots.labels_px() } else { 4.0 }),
                drawing,
            }
        });
        Figure { title: &self.title, plots: plots.collect(), x_name: Name::new(&self.category_name, String::new()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(values: Vec<Option<f64>>) -> BarPanels {
        let panel = |value_name: &str, unit: &str, values: Vec<Option<f64>>| BarPanel {
            value_name: value_name.to_owned(),
            unit: unit.to_owned(),
            least_division: 0.0,
            series: vec![BarSeries { name: "alone".to_owned(), values }],
            limits: vec![Limit { name: "all".to_owned(), value: 2.0 }],
        };
        BarPanels {
            title: "layers".to_owned(),
            category_name: "layer".to_owned(),
            categories: vec!["noise".to_owned(), "edge".to_owned()],
            panels: vec![panel("Sa", "µm", vec![Some(1.0), None]), panel("unevenness", "%", values)],
        }
    }

    #[test]
    fn every_panel_has_its_own_scale_and_all_share_the_categories() {
        let chart = chart(vec![Some(150.0), Some(f64::NAN)]);
        assert_eq!(chart.problem(), None);
        let text = chart.figure().html().into_string();
        assert_eq!(text.matches("<rect").count(), 4, "a bar and the frame in each: {text}");
        assert_eq!(text.matches(">noise<").count(), 1, "labels under the last panel alone");
        // Panels are 112 pixels high: 1 of 2, and 150 of 160.
        assert!(text.contains("height=\"56\"><title>layer noise, alone: 1.00 µm"), "{text}");
        assert!(text.contains("height=\"105\"><title>layer noise, alone: 150 %"), "{text}");
        assert_eq!(text.matches("class=\"limit\"").count(), 2);
    }

    #[test]
    fn series_of_another_length_are_refused() {
        let problem = chart(vec![Some(1.0)]).problem().expect("one value for two categories");
        assert!(problem.contains("unevenness") && problem.contains("2 values"), "{problem}");
    }
}
