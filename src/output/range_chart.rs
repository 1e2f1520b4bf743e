//! Bars from a low to a high value, with a mark at their mean: what is found on a flank.
//!
//! In: categories, series with low, mean and high per category. Out: bars with their axis and a legend, on a page.

use maud::html;

use crate::output::axis::{round_range, value_text};
use crate::output::figure::{Figure, LegendEntry, Name, Plot, Sample};
use crate::output::plot::{BarPlaces, PlotFrame, WIDTH_PX, px};

/// A chart of ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeChart {
    /// What is shown.
    pub title: String,
    /// What the categories are, such as "tooth".
    pub category_name: String,
    /// Label of each category.
    pub categories: Vec<String>,
    /// Unit of the values.
    pub unit: String,
    /// Up to seven series.
    pub series: Vec<RangeSeries>,
}

/// One series of ranges.
#[derive(Debug, Clone, PartialEq)]
pub struct RangeSeries {
    /// Name in the legend.
    pub name: String,
    /// Low, mean and high of each category, where there are any.
    pub values: Vec<Option<[f64; 3]>>,
}

impl RangeChart {
    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let values = || self.series.iter().flat_map(|series| series.values.iter().flatten().flatten().copied());
        let ends = (values().fold(f64::INFINITY, f64::min), values().fold(f64::NEG_INFINITY, f64::max));
        let range = if ends.0 <= ends.1 { round_range(ends.0, ends.1) } else { (0.0, 1.0) };
        let frame = PlotFrame::new(236.0, range);
        let slots = BarPlaces { frame: &frame, categories: &self.categories, series: self.series.len() };
        // Bars of neighbouring series keep apart: both their ends are read.
        let width = 0.86 * slots.bar_px();
        let drawing = html! {
            (frame.value_axis())
            @for (k, series) in self.series.iter().enumerate() {
                g class=(format!("bars s{k}")) {
                    @for (index, (value, category)) in series.values.iter().zip(&self.categories).enumerate() {
                        @if let Some([low, mean, high]) = *value {
                            @let (left, y) = (slots.left(index, k), px(frame.y(mean)));
                            rect x=(px(left)) y=(px(frame.y(high))) width=(px(width))
                                height=(px((frame.y(low) - frame.y(high)).max(1.0))) {
                                title {
                                    (self.category_name) " " (category) ", " (series.name) ": "
                                    (value_text(low)) " to " (value_text(high)) ", mean " (value_text(mean)) " "
                                    (self.unit)
                                }
                            }
                            line class="inner-mean" x1=(px(left)) x2=(px(left + width)) y1=(y) y2=(y) {}
                        }
                    }
                }
            }
            (frame.outline())
            (slots.labels())
        };
        let entry = |(index, series): (usize, &RangeSeries)| LegendEntry {
            sample: Sample::Block(index),
            words: series.name.clone(),
        };
        Figure {
            title: &self.title,
            plots: vec![Plot {
                name: Name::new("smallest to largest, mean marked", frame.ticks().unit_text(&self.unit)),
                legend: self.series.iter().enumerate().map(entry).collect(),
                size_px: (WIDTH_PX, frame.bottom + slots.labels_px()),
                drawing,
            }],
            x_name: Name::new(&self.category_name, String::new()),
        }
    }
}
