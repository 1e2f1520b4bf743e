//! What all drawings of charts are made of: coordinates, paths, frames with a value axis, places of bars.
//!
//! In: values and the rectangle that they are drawn in. Out: SVG markup; classes give it its looks
//! (`assets/report/chart.css`).

use std::fmt::Write as _;

use maud::{Markup, html};

use crate::output::axis::Ticks;

/// Width of a chart, pixels.
pub(super) const WIDTH_PX: f64 = 960.0;
/// Room below a frame for the labels of the common axis, pixels.
pub(super) const LABELS_PX: f64 = 26.0;
/// Distance of rows of such labels, pixels, and most rows: with more nobody finds the bar of a label.
const ROW_PX: f64 = 14.0;
const MOST_ROWS: usize = 3;

/// Rectangle of a plot with its value axis.
#[derive(Debug, Clone, Copy)]
pub(super) struct PlotFrame {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    /// Values at the bottom and at the top.
    pub range: (f64, f64),
}

impl PlotFrame {
    /// Frame of a chart's full width.
    pub(super) fn new(height_px: f64, range: (f64, f64)) -> Self {
        Self { left: 56.0, right: WIDTH_PX - 10.0, top: 8.0, bottom: 8.0 + height_px, range }
    }

    /// Place of a value, pixels from the top.
    pub(super) fn y(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        self.bottom - (value - low) / (high - low) * (self.bottom - self.top)
    }

    /// Ticks of the value axis.
    pub(super) fn ticks(&self) -> Ticks {
        Ticks::over(self.range.0, self.range.1, ((self.bottom - self.top) / 30.0) as usize)
    }

    /// Grid lines and labels of the value axis.
    pub(super) fn value_axis(&self) -> Markup {
        let ticks = self.ticks();
        html! {
            @for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
                (self.across("grid", value))
                text class="tick end" x=(self.left - 7.0) y=(px(self.y(value) + 4.0)) { (label) }
            }
        }
    }

    /// Line across the frame at a value.
    pub(super) fn across(&self, class: &str, value: f64) -> Markup {
        let y = px(self.y(value));
        html! { line class=(class) x1=(self.left) x2=(self.right) y1=(y) y2=(y) {} }
    }

    /// Line from the top to the bottom of the frame.
    pub(super) fn upright(&self, class: &str, x: f64) -> Markup {
        html! { line class=(class) x1=(px(x)) x2=(px(x)) y1=(self.top) y2=(px(self.bottom)) {} }
    }

    /// Label of the common axis.
    pub(super) fn label_below(&self, x: f64, label: &str) -> Markup {
        self.label_in_row(x, 0, label)
    }

    fn label_in_row(&self, x: f64, row: usize, label: &str) -> Markup {
        let y = self.bottom + 17.0 + ROW_PX * row as f64;
        html! { text class="tick middle" x=(px(x)) y=(px(y)) { (label) } }
    }

    /// The frame itself, over what is inside.
    pub(super) fn outline(&self) -> Markup {
        html! {
            rect class="frame" x=(self.left) y=(self.top) width=(self.right - self.left)
                height=(px(self.bottom - self.top)) {}
        }
    }
}

/// Places of bars: a slot for each category, in it a bar for each series.
pub(super) struct BarPlaces<'a> {
    pub frame: &'a PlotFrame,
    pub categories: &'a [String],
    pub series: usize,
}

impl BarPlaces<'_> {
    fn slot_px(&self) -> f64 {
        (self.frame.right - self.frame.left) / self.categories.len().max(1) as f64
    }

    /// Width of a bar. A fifth of each slot stays empty, so that groups keep apart.
    pub(super) fn bar_px(&self) -> f64 {
        0.8 * self.slot_px() / self.series.max(1) as f64
    }

    /// Left end of a bar.
    pub(super) fn left(&self, category: usize, series: usize) -> f64 {
        self.frame.left + self.slot_px() * (category as f64 + 0.1) + self.bar_px() * series as f64
    }

    /// Every how many categories have labels side by side that do not touch.
    fn every(&self) -> usize {
        let slot_px = self.slot_px();
        let longest = self.categories.iter().map(|label| label.chars().count()).max().unwrap_or(1);
        let widest_px = longest as f64 * 7.0 + 5.0;
        let fits = |n: &usize| slot_px * *n as f64 > widest_px;
        [1, 2, 5, 10, 20, 50, 100, 200, 500].into_iter().find(fits).unwrap_or(1000)
    }

    /// Rows of labels: numbers follow from those of the bars beside them, names do not.
    fn rows(&self) -> usize {
        let are_names = self.categories.iter().any(|label| !label.starts_with(|first: char| first.is_ascii_digit()));
        let every = self.every();
        if are_names && every <= MOST_ROWS { every } else { 1 }
    }

    /// Room for the labels below the frame, pixels.
    pub(super) fn labels_px(&self) -> f64 {
        LABELS_PX + ROW_PX * (self.rows() - 1) as f64
    }

    /// Labels under categories: numbers under all of them, or under every second, fifth, tenth ... where they would
    /// touch; names in as many rows as it takes, if those are few.
    pub(super) fn labels(&self) -> Markup {
        let (rows, every) = (self.rows(), self.every());
        let step = if rows > 1 { 1 } else { every };
        html! {
            @for (index, label) in self.categories.iter().enumerate().step_by(step) {
                @let x = self.frame.left + self.slot_px() * (index as f64 + 0.5);
                (self.frame.label_in_row(x, index % rows, label))
            }
        }
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
