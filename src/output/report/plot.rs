//! Charts of the report: SVG whose colours come from the page, so that they are legible on light, dark and paper.
//!
//! In: the same [`LineChart`] and [`BarChart`] that are written as files, and bars from a low to a high value. Out:
//! markup. Titles, names and legends are HTML beside the SVG: they wrap on narrow screens, and readers can select them.
//!
//! Road not taken: the SVG files themselves. Their colours and their 1100 pixels are fixed; on a telephone or in the
//! dark they cannot be read.

use std::fmt::Write as _;

use maud::{Markup, PreEscaped, html};

use crate::output::axis::{Ticks, round_range, value_text};
use crate::output::bar_chart::BarChart;
use crate::output::line_chart::{LineChart, Panel, thinned};

const WIDTH: f64 = 960.0;
const LEFT: f64 = 56.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 8.0;
const AXIS: f64 = 26.0;

/// Bars from a low to a high value, with a mark at their mean: what is found on a flank.
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

/// Rectangle of a plot with its value axis.
struct Frame {
    bottom: f64,
    low: f64,
    high: f64,
}

impl Frame {
    fn new(height: f64, (low, high): (f64, f64)) -> Self {
        Self { bottom: TOP + height, low, high }
    }

    fn y(&self, value: f64) -> f64 {
        self.bottom - (value - self.low) / (self.high - self.low) * (self.bottom - TOP)
    }

    fn ticks(&self) -> Ticks {
        Ticks::over(self.low, self.high, ((self.bottom - TOP) / 30.0) as usize)
    }

    fn value_axis(&self) -> Markup {
        let ticks = self.ticks();
        html! {
            @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
                line class="grid" x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(self.y(value))) y2=(px(self.y(value))) {}
                text class="tick end" x=(LEFT - 7.0) y=(px(self.y(value) + 4.0)) { (label) }
            }
        }
    }

    fn outline(&self) -> Markup {
        html! { rect class="frame" x=(LEFT) y=(TOP) width=(WIDTH - LEFT - RIGHT) height=(px(self.bottom - TOP)) {} }
    }
}

/// A coordinate with one decimal: a tenth of a pixel is not seen.
pub(super) fn px(value: f64) -> String {
    let text = format!("{value:.1}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// Path through points; a pen-up where they are not finite.
pub(super) fn path(points: &[(f64, f64)]) -> String {
    let mut text = String::new();
    let mut down = false;
    for &(x, y) in points {
        if x.is_finite() && y.is_finite() {
            let _ = write!(text, "{}{} {}", if down { 'L' } else { 'M' }, px(x), px(y));
            down = true;
        } else {
            down = false;
        }
    }
    text
}

pub(super) fn svg(width: f64, height: f64, label: &str, content: &Markup) -> Markup {
    // As wide as drawn and a tenth more, so that letters keep their size on every sheet.
    let style = format!("max-width: {}px", px(1.1 * width));
    html! {
        div class="plot" tabindex="0" role="group" aria-label=(label) {
            svg style=(style) viewBox=(format!("0 0 {} {}", px(width), px(height))) role="img" aria-label=(label) { (content) }
        }
    }
}

/// Entries of a legend: class of the sample, words.
pub(super) fn legend(entries: &[(String, String)]) -> Markup {
    html! { ul class="legend" { @for (class, words) in entries { li { i class=(class) {} (words) } } } }
}

fn panel_name(name: &str, unit: &str) -> Markup {
    html! { span class="panel-name" { (name) @if unit != "1" { " " span class="unit" { "[" (unit) "]" } } } }
}

/// Curves over a common axis.
pub fn lines(chart: &LineChart) -> Markup {
    html! {
        figure class="chart" {
            figcaption { (chart.title) }
            @for (index, panel) in chart.panels.iter().enumerate() {
                (line_panel(chart, panel, index + 1 == chart.panels.len()))
            }
        }
    }
}

fn line_panel(chart: &LineChart, panel: &Panel, last: bool) -> Markup {
    let (low, high) = chart.x_range();
    let x = |value: f64| LEFT + (value - low) / (high - low) * (WIDTH - LEFT - RIGHT);
    let x_ticks = Ticks::over(low, high, 12);
    let frame = Frame::new(if chart.panels.len() > 1 { 130.0 } else { 236.0 }, panel.range());
    let shown = |value: f64| (frame.low..=frame.high).contains(&value);
    let curves = panel.series.iter().enumerate().map(|(k, series)| (format!("line s{k}"), series.name.clone()));
    let limits = panel.limits.iter().map(|limit| {
        let place = if shown(limit.value) { "" } else { ", outside the panel" };
        ("dashes".to_owned(), format!("{} {} {}{place}", limit.name, value_text(limit.value), panel.unit))
    });
    let height = frame.bottom + if last { AXIS } else { 8.0 };
    let content = html! {
        @for &value in &x_ticks.values {
            line class="grid" x1=(px(x(value))) x2=(px(x(value))) y1=(TOP) y2=(px(frame.bottom)) {}
        }
        (frame.value_axis())
        @for limit in panel.limits.iter().filter(|limit| shown(limit.value)) {
            line class="limit" x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(frame.y(limit.value))) y2=(px(frame.y(limit.value))) {}
        }
        @for (k, series) in panel.series.iter().enumerate() {
            @let points: Vec<(f64, f64)> = series.points.iter().map(|&(at, value)| (x(at), frame.y(value))).collect();
            path class=(format!("curve s{k}")) d=(curve(&points)) {}
        }
        (frame.outline())
        @if last {
            @for (&value, label) in x_ticks.values.iter().zip(&x_ticks.labels) {
                text class="tick middle" x=(px(x(value))) y=(px(frame.bottom + 17.0)) { (label) }
            }
        }
    };
    html! {
        div class="panel" {
            div class="panel-head" {
                (panel_name(&panel.value_name, &frame.ticks().unit_text(&panel.unit)))
                (legend(&curves.chain(limits).collect::<Vec<_>>()))
            }
            (svg(WIDTH, height, &format!("{}: {}", chart.title, panel.value_name), &content))
            @if last { div class="x-name" { (panel_name(&chart.x_name, &x_ticks.unit_text(&chart.x_unit))) } }
        }
    }
}

/// Path of a curve, thinned to what can be seen.
fn curve(points: &[(f64, f64)]) -> String {
    points.split(|(x, y)| !(x.is_finite() && y.is_finite())).map(|run| path(&thinned(run))).collect()
}

/// Labels under categories: all, or every second, fifth, tenth ... where they would touch.
fn category_labels(categories: &[String], bottom: f64) -> Markup {
    let slot = (WIDTH - LEFT - RIGHT) / categories.len() as f64;
    let widest = categories.iter().map(|label| label.chars().count()).max().unwrap_or(1) as f64 * 7.0 + 5.0;
    let every = [1, 2, 5, 10, 20, 50, 100, 200, 500].into_iter().find(|&n| slot * n as f64 > widest).unwrap_or(1000);
    html! {
        @for (index, label) in categories.iter().enumerate().step_by(every) {
            text class="tick middle" x=(px(LEFT + slot * (index as f64 + 0.5))) y=(px(bottom + 17.0)) { (label) }
        }
    }
}

/// Grouped bars with the mean of each series as a dashed line.
pub fn bars(chart: &BarChart) -> Markup {
    let frame = Frame::new(236.0, chart.range());
    let entries: Vec<(String, String)> = chart
        .series
        .iter()
        .enumerate()
        .map(|(k, series)| {
            let mean = series.mean().map_or_else(
                || ": no values".to_owned(),
                |mean| format!(", mean {} {}", value_text(without_rounding(mean, frame.high - frame.low)), chart.unit),
            );
            (format!("block s{k}"), format!("{}{mean}", series.name))
        })
        .collect();
    let slot = (WIDTH - LEFT - RIGHT) / chart.categories.len().max(1) as f64;
    let width = 0.8 * slot / chart.series.len().max(1) as f64;
    let content = html! {
        (frame.value_axis())
        @for (k, series) in chart.series.iter().enumerate() {
            g class=(format!("bars s{k}")) {
                @for (index, value) in series.values.iter().enumerate() {
                    @if let Some(value) = value.filter(|value| value.is_finite()) {
                        @let left = LEFT + slot * (index as f64 + 0.1) + width * k as f64;
                        rect x=(px(left)) y=(px(frame.y(value.max(0.0)))) width=(px(width))
                            height=(px(frame.y(value.min(0.0)) - frame.y(value.max(0.0)))) {
                            title {
                                (chart.category_name) " " (chart.categories[index]) ", " (series.name) ": "
                                (value_text(value)) " " (chart.unit)
                            }
                        }
                    }
                }
            }
        }
        line class="zero" x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(frame.y(0.0))) y2=(px(frame.y(0.0))) {}
        @for (k, mean) in chart.series.iter().enumerate().filter_map(|(k, s)| Some((k, s.mean()?))) {
            line class="mean-ground" x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(frame.y(mean))) y2=(px(frame.y(mean))) {}
            line class=(format!("mean s{k}")) x1=(LEFT) x2=(WIDTH - RIGHT) y1=(px(frame.y(mean))) y2=(px(frame.y(mean))) {}
        }
        (frame.outline())
        (category_labels(&chart.categories, frame.bottom))
    };
    category_figure(
        &chart.title,
        &chart.value_name,
        &frame.ticks().unit_text(&chart.unit),
        &entries,
        &chart.category_name,
        &svg(WIDTH, frame.bottom + AXIS, &chart.title, &content),
    )
}

/// Zero instead of what adding up numbers of this size leaves of zero.
fn without_rounding(sum: f64, size: f64) -> f64 {
    if sum.abs() < 1e-9 * size { 0.0 } else { sum }
}

/// Floating bars.
pub fn ranges(chart: &RangeChart) -> Markup {
    let values = || chart.series.iter().flat_map(|series| series.values.iter().flatten().flatten().copied());
    let frame = Frame::new(236.0, round_range(values().fold(0.0, f64::min), values().fold(0.0, f64::max)));
    let slot = (WIDTH - LEFT - RIGHT) / chart.categories.len().max(1) as f64;
    let width = 0.8 * slot / chart.series.len().max(1) as f64;
    let entries: Vec<(String, String)> =
        chart.series.iter().enumerate().map(|(k, series)| (format!("block s{k}"), series.name.clone())).collect();
    let content = html! {
        (frame.value_axis())
        @for (k, series) in chart.series.iter().enumerate() {
            g class=(format!("bars s{k}")) {
                @for (index, value) in series.values.iter().enumerate() {
                    @if let Some([low, mean, high]) = *value {
                        @let left = LEFT + slot * (index as f64 + 0.1) + width * k as f64;
                        rect x=(px(left)) y=(px(frame.y(high))) width=(px(0.86 * width))
                            height=(px((frame.y(low) - frame.y(high)).max(1.0))) {
                            title {
                                (chart.category_name) " " (chart.categories[index]) ", " (series.name) ": "
                                (value_text(low)) " to " (value_text(high)) ", mean " (value_text(mean)) " " (chart.unit)
                            }
                        }
                        line class="inner-mean" x1=(px(left)) x2=(px(left + 0.86 * width))
                            y1=(px(frame.y(mean))) y2=(px(frame.y(mean))) {}
                    }
                }
            }
        }
        (frame.outline())
        (category_labels(&chart.categories, frame.bottom))
    };
    category_figure(
        &chart.title,
        "smallest to largest, mean marked",
        &frame.ticks().unit_text(&chart.unit),
        &entries,
        &chart.category_name,
        &svg(WIDTH, frame.bottom + AXIS, &chart.title, &content),
    )
}

fn category_figure(
    title: &str,
    value_name: &str,
    unit: &str,
    entries: &[(String, String)],
    category_name: &str,
    plot: &Markup,
) -> Markup {
    html! {
        figure class="chart" {
            figcaption { (title) }
            div class="panel-head" { (panel_name(value_name, unit)) (legend(entries)) }
            (plot)
            div class="x-name" { (category_name) }
        }
    }
}

/// Markup that is written by this program and holds no text from outside, such as style sheets and scripts.
pub(super) fn own(text: impl Into<String>) -> PreEscaped<String> {
    PreEscaped(text.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::bar_chart::BarSeries;

    #[test]
    fn bars_stand_on_zero_and_tell_their_value() {
        let chart = BarChart {
            least_division: 0.0,
            title: "<b>pitch</b>".into(),
            category_name: "tooth".into(),
            categories: vec!["1".into(), "2".into(), "3".into()],
            value_name: "f_p".into(),
            unit: "µm".into(),
            series: vec![BarSeries { name: "left".into(), values: vec![Some(2.0), None, Some(-1.0)] }],
        };
        let text = bars(&chart).into_string();
        assert_eq!(text.matches("<rect").count(), 3, "two bars and the frame");
        assert!(text.contains("&lt;b&gt;pitch&lt;/b&gt;") && !text.contains("<b>"));
        assert!(text.contains("tooth 3, left: −1.00 µm"), "{text}");
    }

    #[test]
    fn curves_are_interrupted_where_values_are_missing() {
        assert_eq!(curve(&[(0.0, 1.0), (10.0, 2.0), (20.0, f64::NAN), (30.0, 4.04)]), "M0 1L10 2M30 4");
    }
}
