//! Grouped bars: several series over the same categories, such as the unevenness of every tooth under two linkages.
//!
//! In: categories, series with a value or none per category, units. Out: PNG or SVG with axes, legend and each series'
//! mean as a dashed line.
//!
//! The value axis always contains zero: a bar's length is its message.

use std::path::Path;

use plotters::prelude::DrawingBackend;

use crate::Result;
use crate::colormap::SERIES;
use crate::output::axis::{round_range, value_text, widened};
use crate::output::canvas::{Canvas, Drawn, INK, PAPER, Side, text_width_px};
use crate::output::charts::{self, Draw, EM_PX, Frame, Legend, Sample};
use crate::output::heat::fitting_em_px;

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
    /// Up to seven series.
    pub series: Vec<BarSeries>,
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
    pub(super) fn finite(&self) -> impl Iterator<Item = f64> {
        self.values.iter().flatten().copied().filter(|value| value.is_finite())
    }

    pub(super) fn mean(&self) -> Option<f64> {
        let count = self.finite().count();
        (count > 0).then(|| self.finite().sum::<f64>() / count as f64)
    }
}

impl BarChart {
    /// Writes the chart as PNG.
    ///
    /// # Errors
    /// Series that do not fit the categories or the palette, and files that cannot be written.
    pub fn write_png(&self, path: &Path) -> Result<()> {
        charts::write_png(path, self)
    }

    /// Writes the chart as SVG.
    ///
    /// # Errors
    /// As [`write_png`](Self::write_png).
    pub fn write_svg(&self, path: &Path) -> Result<()> {
        charts::write_svg(path, self)
    }

    /// Values at the bottom and the top.
    pub(super) fn range(&self) -> (f64, f64) {
        let values = || self.series.iter().flat_map(BarSeries::finite);
        let range = round_range(values().fold(0.0, f64::min), values().fold(0.0, f64::max));
        widened(range, self.least_division)
    }

    fn legend(&self) -> std::result::Result<Legend, String> {
        let entries = self.series.iter().zip(SERIES).map(|(series, colour)| {
            let mean = series
                .mean()
                .map_or_else(|| ": no values".to_owned(), |mean| format!(", mean {} {}", value_text(mean), self.unit));
            (Sample::Block, colour, format!("{}{mean}", series.name))
        });
        Legend::within(WIDTH_PX - LEFT_PX - RIGHT_PX, entries)
    }
}

const WIDTH_PX: f64 = 1100.0;
const LEFT_PX: f64 = 96.0;
const RIGHT_PX: f64 = 28.0;
const LEGEND_TOP_PX: f64 = 50.0;
const PLOT_HEIGHT_PX: f64 = 330.0;
const BELOW_PX: f64 = 66.0;

impl Draw for BarChart {
    fn problem(&self) -> Option<String> {
        if self.series.is_empty() || self.series.len() > SERIES.len() {
            return Some(format!("a bar chart shows 1 to {} series, not {}", SERIES.len(), self.series.len()));
        }
        let wrong = self.series.iter().find(|series| series.values.len() != self.categories.len())?;
        Some(format!(
            "series {} has {} values for {} categories",
            wrong.name,
            wrong.values.len(),
            self.categories.len()
        ))
    }

    fn size_px(&self) -> std::result::Result<(u32, u32), String> {
        let height_px = LEGEND_TOP_PX + self.legend()?.height_px() + 8.0 + PLOT_HEIGHT_PX + BELOW_PX;
        Ok((WIDTH_PX as u32, height_px as u32))
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>) -> Drawn {
        let legend = self.legend()?;
        canvas.text(&self.title, (LEFT_PX, 28.0), fitting_em_px(&self.title, 20.0, WIDTH_PX - 130.0)?, Side::Start)?;
        legend.draw(canvas, (LEFT_PX, LEGEND_TOP_PX))?;
        let top = LEGEND_TOP_PX + legend.height_px() + 8.0;
        let frame =
            Frame { left: LEFT_PX, right: WIDTH_PX - RIGHT_PX, top, bottom: top + PLOT_HEIGHT_PX, range: self.range() };
        frame.draw_value_axis(canvas, &self.value_name, &self.unit, 24.0)?;
        self.draw_bars(canvas, &frame)?;
        self.draw_means(canvas, &frame)?;
        self.draw_categories(canvas, &frame)?;
        frame.draw_outline(canvas)
    }
}

impl BarChart {
    fn slot_px(&self, frame: &Frame) -> f64 {
        (frame.right - frame.left) / self.categories.len() as f64
    }

    fn draw_bars<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>, frame: &Frame) -> Drawn {
        let slot_px = self.slot_px(frame);
        // A fifth of each slot stays empty, so that groups keep apart.
        let bar_px = 0.8 * slot_px / self.series.len() as f64;
        for (k, (series, colour)) in self.series.iter().zip(SERIES).enumerate() {
            for (slot, value) in series.values.iter().enumerate() {
                let Some(value) = value.filter(|value| value.is_finite()) else { continue };
                let x = frame.left + slot_px * (slot as f64 + 0.1) + bar_px * k as f64;
                let (high, low) = (frame.y(value.max(0.0)), frame.y(value.min(0.0)));
                canvas.fill((x, high), (x + bar_px, low), colour)?;
            }
        }
        canvas.line(&[(frame.left, frame.y(0.0)), (frame.right, frame.y(0.0))], INK, 1.0)
    }

    fn draw_means<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>, frame: &Frame) -> Drawn {
        for (series, colour) in self.series.iter().zip(SERIES) {
            let Some(mean) = series.mean() else { continue };
            let (from, to) = ((frame.left, frame.y(mean)), (frame.right, frame.y(mean)));
            // Paper below the dashes, so that they show on bars of their own colour.
            canvas.line(&[from, to], PAPER, 3.5)?;
            canvas.dashed(from, to, colour, 2.0)?;
        }
        Ok(())
    }

    /// Labels every category, or every second, fifth, tenth ... where they would touch.
    fn draw_categories<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>, frame: &Frame) -> Drawn {
        let slot_px = self.slot_px(frame);
        let mut widest_px: f64 = 0.0;
        for label in &self.categories {
            widest_px = widest_px.max(text_width_px(label, EM_PX)?);
        }
        let every =
            [1, 2, 5, 10, 20, 50, 100, 200, 500].into_iter().find(|&every| slot_px * every as f64 > widest_px + 6.0);
        for (slot, label) in self.categories.iter().enumerate().step_by(every.unwrap_or(1000)) {
            let x = frame.left + slot_px * (slot as f64 + 0.5);
            canvas.text(label, (x, frame.bottom + 16.0), EM_PX, Side::Middle)?;
        }
        let middle = 0.5 * (frame.left + frame.right);
        canvas.text(&self.category_name, (middle, frame.bottom + 42.0), EM_PX, Side::Middle)
    }
}
