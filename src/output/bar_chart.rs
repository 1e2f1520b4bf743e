//! Grouped bars: several series over the same categories, such as the unevenness of every tooth under two linkages.
//!
//! In: categories, series with a value or none per category, units. Out: bars with their axis, a legend, and each
//! series' mean as a dashed line, where the categories are equals: on a page or as an SVG file.
//!
//! The value axis always contains zero: a bar's length is its message.

use std::path::Path;

use maud::{Markup, html};

use crate::output::axis::{round_range, value_text, widened};
use crate::output::figure::{Figure, LegendEntry, MOST_SERIES, Name, Plot, Sample};
use crate::output::line_chart::Limit;
use crate::output::plot::{BarPlaces, PlotFrame, WIDTH_PX, px};
use gearcut_core::Result;

/// A bar chart.
#[derive(Debug, Clone, PartialEq)]
pub struct BarChart {
    /// What is shown.
    pub title: String,
    /// What the categories are, such as "tooth".
    pub category_name: String,
    /// Label of each category.
    pub categories: Vec<String>,
    /// What the values are.
    pub value_name: String,
    /// Their unit; "–" or "1" for ratios.
    pub unit: String,
    /// Smallest distance of two ticks of the value axis, where less would make noise look like a fault; 0 for none.
    pub least_division: f64,
    /// Whether each series' mean is drawn and named: the categories are equals, such as teeth.
    pub has_mean: bool,
    /// Up to seven series.
    pub series: Vec<BarSeries>,
    /// Values not to be passed.
    pub limits: Vec<Limit>,
}

/// One series of bars.
#[derive(Debug, Clone, PartialEq)]
pub struct BarSeries {
    /// Name in the legend.
    pub name: String,
    /// One value per category; none where there is nothing to show.
    pub values: Vec<Option<f64>>,
}

impl BarSeries {
    fn finite(&self) -> impl Iterator<Item = f64> {
        self.values.iter().flatten().copied().filter(|value| value.is_finite())
    }

    fn mean(&self) -> Option<f64> {
        let count = self.finite().count();
        (count > 0).then(|| self.finite().sum::<f64>() / count as f64)
    }
}

impl BarChart {
    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// Series that do not fit the categories or the palette, and files that cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        self.figure().write_svg(path, self.problem())
    }

    /// Why the chart cannot be drawn, if it cannot.
    fn problem(&self) -> Option<String> {
        if !(1..=MOST_SERIES).contains(&self.series.len()) {
            return Some(format!("a bar chart shows 1 to {MOST_SERIES} series, not {}", self.series.len()));
        }
        let wrong = self.series.iter().find(|series| series.values.len() != self.categories.len())?;
        Some(format!(
            "series {} has {} values for {} categories",
            wrong.name,
            wrong.values.len(),
            self.categories.len()
        ))
    }

    fn entry(&self, index: usize, extent: f64) -> LegendEntry {
        let series = &self.series[index];
        let mean = match series.mean() {
            None => ": no values".to_owned(),
            Some(mean) if self.has_mean => {
                format!(", mean {} {}", value_text(without_rounding(mean, extent)), self.unit)
            }
            Some(_) => String::new(),
        };
        LegendEntry { sample: Sample::Block(index), words: format!("{}{mean}", series.name) }
    }

    /// Means to be drawn, by the place of their series.
    fn means(&self) -> impl Iterator<Item = (usize, f64)> {
        let series = self.series.iter().filter(|_| self.has_mean).enumerate();
        series.filter_map(|(k, series)| Some((k, series.mean()?)))
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let frame = PlotFrame::new(236.0, range(&self.series, self.least_division, &self.limits));
        let slots = BarPlaces { frame: &frame, categories: &self.categories, series: self.series.len() };
        let drawing = html! {
            (frame.value_axis())
            (bars(&slots, &self.series, &self.category_name, &self.unit))
            (frame.across("zero", 0.0))
            @for limit in self.limits.iter().filter(|limit| limit.is_within(frame.range)) {
                (frame.across("limit", limit.value))
            }
            @for (k, mean) in self.means() {
                // Ground below the dashes, so that they show on bars of their own colour.
                (frame.across("mean-ground", mean))
                (frame.across(&format!("mean s{k}"), mean))
            }
            (frame.outline())
            (slots.labels())
        };
        let extent = frame.range.1 - frame.range.0;
        Figure {
            title: &self.title,
            plots: vec![Plot {
                name: Name::new(&self.value_name, frame.ticks().unit_text(&self.unit)),
                legend: (0..self.series.len())
                    .map(|index| self.entry(index, extent))
                    .chain(self.limits.iter().map(|limit| limit.legend(frame.range, &self.unit)))
                    .collect(),
                size_px: (WIDTH_PX, frame.bottom + slots.labels_px()),
                drawing,
            }],
            x_name: Name::new(&self.category_name, String::new()),
        }
    }
}

/// The bars of all series, from zero.
pub(super) fn bars(slots: &BarPlaces, series: &[BarSeries], category_name: &str, unit: &str) -> Markup {
    let (frame, width) = (slots.frame, slots.bar_px());
    html! {
        @for (k, series) in series.iter().enumerate() {
            g class=(format!("bars s{k}")) {
                @for (index, (value, category)) in series.values.iter().zip(slots.categories).enumerate() {
                    @if let Some(value) = value.filter(|value| value.is_finite()) {
                        @let (top, bottom) = (frame.y(value.max(0.0)), frame.y(value.min(0.0)));
                        rect x=(px(slots.left(index, k))) y=(px(top)) width=(px(width)) height=(px(bottom - top)) {
                            title {
                                (category_name) " " (category) ", " (series.name) ": " (value_text(value)) " " (unit)
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Values at the bottom and the top of bars: zero, the bars, and limits that are not too far away.
pub(super) fn range(series: &[BarSeries], least_division: f64, limits: &[Limit]) -> (f64, f64) {
    let values = || series.iter().flat_map(BarSeries::finite);
    let extent = (values().fold(0.0, f64::min), values().fold(0.0, f64::max));
    let (low, high) = Limit::widened_by(widened(extent, least_division), limits);
    widened(round_range(low, high), least_division)
}

/// Zero instead of what adding up numbers of this size leaves of zero.
fn without_rounding(sum: f64, size: f64) -> f64 {
    if sum.abs() < 1e-9 * size { 0.0 } else { sum }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stand_on_zero_and_tell_their_value() {
        let chart = BarChart {
            has_mean: true,
            least_division: 0.0,
            limits: vec![Limit { name: "class 5".into(), value: 2.5 }, Limit { name: "class 11".into(), value: 52.0 }],
            title: "<b>pitch</b>".into(),
            category_name: "tooth".into(),
            categories: vec!["1".into(), "2".into(), "3".into()],
            value_name: "f_p".into(),
            unit: "µm".into(),
            series: vec![BarSeries { name: "left".into(), values: vec![Some(2.0), None, Some(-1.0)] }],
        };
        let text = chart.figure().html().into_string();
        assert_eq!(text.matches("<rect").count(), 3, "two bars and the frame");
        assert!(text.contains("&lt;b&gt;pitch&lt;/b&gt;") && !text.contains("<b>"));
        assert!(text.contains("tooth 3, left: −1.00 µm"), "{text}");
        let names =
            ["period", "turn of A", "2 x turn of A", "3 x turn of A", "4 x turn of A", "turn of B"].map(String::from);
        let values = vec![Some(1.0); 12];
        let named = BarChart {
            categories: names.iter().chain(&names).cloned().collect(),
            series: vec![BarSeries { name: "left".into(), values }],
            ..chart.clone()
        };
        let numbered =
            BarChart { categories: (1000..1012).map(|i| format!("{i} of a long row")).collect(), ..named.clone() };
        let labels = |chart: &BarChart| chart.figure().html().into_string().matches("\"tick middle\"").count();
        assert_eq!([labels(&named), labels(&numbered)], [12, 6], "names have a label each, numbers every second");
        // A limit far away is named alone: drawn, it would flatten the bars.
        assert_eq!(text.matches("class=\"limit\"").count(), 1, "{text}");
        assert!(text.contains("class 5 2.50 µm") && text.contains("class 11 52.0 µm, outside the panel"), "{text}");
    }
}
