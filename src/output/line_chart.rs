//! Panels of curves over one common axis, such as position, velocity and acceleration of a machine's axes.
//!
//! In: panels with series of points, units and limits. Out: every panel with its own value axis and legend, on a page
//! or as an SVG file.
//!
//! NaN interrupts a curve. Where many points fall on the same pixel column, the first and last of them are drawn, and
//! the extremes that stand out: the same picture from a tenth of the file.
//!
//! A limit is drawn where it is near the curves; a limit far away is only named, because it would flatten them.

use std::path::Path;

use maud::html;

use crate::output::axis::{Ticks, round_range, value_text, widened};
use crate::output::figure::{Figure, LegendEntry, MOST_SERIES, Name, Plot, Sample};
use crate::output::plot::{LABELS_PX, PlotFrame, WIDTH_PX, path};
use gearcut_core::Result;

/// A chart of one or more panels, one below the other.
#[derive(Debug, Clone, PartialEq)]
pub struct LineChart {
    /// What is shown.
    pub title: String,
    /// What the common axis is, such as "work angle".
    pub x_name: String,
    /// Its unit.
    pub x_unit: String,
    /// The panels, from the top.
    pub panels: Vec<Panel>,
}

/// One panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What the values are.
    pub value_name: String,
    /// Their unit.
    pub unit: String,
    /// Up to seven curves.
    pub series: Vec<LineSeries>,
    /// Values not to be passed.
    pub limits: Vec<Limit>,
    /// Smallest distance of two ticks of the value axis, where less would make noise look like a fault; 0 for none.
    pub least_division: f64,
}

/// One curve.
#[derive(Debug, Clone, PartialEq)]
pub struct LineSeries {
    /// Name in the legend.
    pub name: String,
    /// Points (x, value) in the order they are joined.
    pub points: Vec<(f64, f64)>,
}

/// A horizontal line.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Name in the legend.
    pub name: String,
    /// Where it lies, in the panel's unit.
    pub value: f64,
}

impl LineChart {
    /// The chart as SVG, or why it cannot be drawn.
    ///
    /// # Errors
    /// No panel, or a panel with no curve or more than seven.
    pub fn svg(&self) -> std::result::Result<String, String> {
        self.problem().map_or_else(|| self.figure().svg(), Err)
    }

    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// No panel, or a panel with no curve or more than seven, and files that cannot be written.
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        self.figure().write_svg(path, self.problem())
    }

    /// Why the chart cannot be drawn, if it cannot.
    fn problem(&self) -> Option<String> {
        if self.panels.is_empty() {
            return Some("a chart needs at least one panel".to_owned());
        }
        let wrong = self.panels.iter().find(|panel| !(1..=MOST_SERIES).contains(&panel.series.len()))?;
        Some(format!("panel {} shows 1 to {MOST_SERIES} curves, not {}", wrong.value_name, wrong.series.len()))
    }

    /// Extent of all points along x.
    fn x_range(&self) -> (f64, f64) {
        let points = self.panels.iter().flat_map(|panel| panel.series.iter().flat_map(LineSeries::finite));
        let (low, high) = extent(points.map(|point| point.0));
        if low < high { (low, high) } else { round_range(low, high) }
    }

    /// The chart laid out.
    pub(super) fn figure(&self) -> Figure<'_> {
        let (low, high) = self.x_range();
        let ticks = Ticks::over(low, high, 12);
        let height_px = if self.panels.len() > 1 { 130.0 } else { 236.0 };
        let plots = self.panels.iter().enumerate().map(|(index, panel)| {
            let frame = PlotFrame::new(height_px, panel.range());
            let x = |value: f64| frame.left + (value - low) / (high - low) * (frame.right - frame.left);
            let last = index + 1 == self.panels.len();
            let drawing = html! {
                @for &value in &ticks.values { (frame.upright("grid", x(value))) }
                (frame.value_axis())
                @for limit in panel.limits.iter().filter(|limit| limit.is_within(frame.range)) {
                    (frame.across("limit", limit.value))
                }
                @for (k, series) in panel.series.iter().enumerate() {
                    @let points: Vec<_> = series.points.iter().map(|&(at, value)| (x(at), frame.y(value))).collect();
                    path class=(format!("curve s{k}")) d=(curve(&points)) {}
                }
                (frame.outline())
                @if last {
                    @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
                        (frame.label_below(x(value), label))
                    }
                }
            };
            Plot {
                name: Name::new(&panel.value_name, frame.ticks().unit_text(&panel.unit)),
                legend: panel.legend(&frame),
                size_px: (WIDTH_PX, frame.bottom + if last { LABELS_PX } else { 8.0 }),
                drawing,
            }
        });
        Figure {
            title: &self.title,
            plots: plots.collect(),
            x_name: Name::new(&self.x_name, ticks.unit_text(&self.x_unit)),
        }
    }
}

impl Limit {
    /// Whether it lies between the values at the bottom and the top of a plot.
    pub(super) fn is_within(&self, (low, high): (f64, f64)) -> bool {
        (low..=high).contains(&self.value)
    }

    /// Lowest and highest value, and those of limits that are no further out than these are apart.
    pub(super) fn widened_by((low, high): (f64, f64), limits: &[Self]) -> (f64, f64) {
        let reach = high - low;
        let near = limits.iter().filter(|limit| limit.is_within((low - reach, high + reach)));
        near.fold((low, high), |(low, high), limit| (low.min(limit.value), high.max(limit.value)))
    }

    /// Its entry in the legend of a plot with these values at the bottom and the top.
    pub(super) fn legend(&self, range: (f64, f64), unit: &str) -> LegendEntry {
        let place = if self.is_within(range) { "" } else { ", outside the panel" };
        let words = format!("{} {} {unit}{place}", self.name, value_text(self.value));
        LegendEntry { sample: Sample::Limit, words }
    }
}

/// Path of a curve, thinned to what can be seen.
fn curve(points: &[(f64, f64)]) -> String {
    points.split(|(x, y)| !(x.is_finite() && y.is_finite())).map(|run| path(&thinned(run))).collect()
}

impl LineSeries {
    fn finite(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().copied().filter(|(x, value)| x.is_finite() && value.is_finite())
    }
}

/// Smallest and largest value; zeros if there is none.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

impl Panel {
    /// Values at the bottom and the top: the curves with the least divisions, and those limits that at most triple
    /// that.
    fn range(&self) -> (f64, f64) {
        let (low, high) = extent(self.series.iter().flat_map(LineSeries::finite).map(|point| point.1));
        let (low, high) = Limit::widened_by(widened((low, high), self.least_division), &self.limits);
        widened(round_range(low, high), self.least_division)
    }

    fn legend(&self, frame: &PlotFrame) -> Vec<LegendEntry> {
        let curves = self.series.iter().enumerate();
        let curves = curves.map(|(k, series)| LegendEntry { sample: Sample::Line(k), words: series.name.clone() });
        let limits = self.limits.iter().map(|limit| limit.legend(frame.range, &self.unit));
        curves.chain(limits).collect()
    }
}

/// First and last point of each half pixel column, and between them its lowest and highest where they stand out.
fn thinned(places: &[(f64, f64)]) -> Vec<(f64, f64)> {
    /// Less than this cannot be seen; joining such points would only make the line ragged.
    const VISIBLE_PX: f64 = 0.5;
    let column = |place: &(f64, f64)| (2.0 * place.0).floor();
    let mut kept = Vec::new();
    for group in places.chunk_by(|a, b| column(a) == column(b)) {
        let last = group.len() - 1;
        let (low, high) = (group[0].1.min(group[last].1), group[0].1.max(group[last].1));
        let lowest = (0..=last).reduce(|best, next| if group[next].1 < group[best].1 { next } else { best });
        let highest = (0..=last).reduce(|best, next| if group[next].1 > group[best].1 { next } else { best });
        let mut indices = vec![0, last];
        indices.extend(lowest.filter(|&index| group[index].1 < low - VISIBLE_PX));
        indices.extend(highest.filter(|&index| group[index].1 > high + VISIBLE_PX));
        indices.sort_unstable();
        indices.dedup();
        kept.extend(indices.into_iter().map(|index| group[index]));
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn thinning_keeps_ends_and_extremes_in_order() {
        let dense: Vec<(f64, f64)> = (0..1000).map(|k| (f64::from(k) * 1e-4, f64::from((k * 37) % 101))).collect();
        let kept = thinned(&dense);
        assert_eq!((kept[0], kept.last()), (dense[0], dense.last()));
        assert!(kept.len() <= 4 && kept.iter().any(|p| p.1 == 100.0) && kept.iter().any(|p| p.1 == 0.0));
        let sparse = [(0.0, 1.0), (1.0, 2.0), (2.0, 0.0)];
        assert_eq!(thinned(&sparse), sparse);
    }
    #[test]
    fn curves_are_interrupted_where_values_are_missing() {
        assert_eq!(curve(&[(0.0, 1.0), (10.0, 2.0), (20.0, f64::NAN), (30.0, 4.04)]), "M0 1L10 2M30 4");
    }
}
