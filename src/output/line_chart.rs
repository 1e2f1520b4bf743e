//! Panels of curves over one common axis, such as position, velocity and acceleration of a machine's axes.
//!
//! In: panels with series of points, units and limits. Out: PNG or SVG; every panel with its own value axis and legend.
//!
//! NaN interrupts a curve. Where many points fall on the same pixel column, the first and last of them are drawn, and
//! the extremes that stand out: the same picture from a tenth of the file.
//!
//! A limit is drawn where it is near the curves; a limit far away is only named, because it would flatten them.

use std::path::Path;

use plotters::prelude::DrawingBackend;

use crate::Result;
use crate::colormap::SERIES;
use crate::output::axis::{Ticks, round_range, value_text, widened};
use crate::output::canvas::{Canvas, Drawn, FAINT, INK, Point, Side};
use crate::output::charts::{self, Draw, EM_PX, Frame, Legend, Sample};
use crate::output::heat::fitting_em_px;

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
    /// Writes the chart as PNG.
    ///
    /// # Errors
    /// No panel, or a panel with no curve or more than seven, and files that cannot be written.
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

    /// Extent of all points along x.
    pub(super) fn x_range(&self) -> (f64, f64) {
        let points = self.panels.iter().flat_map(|panel| panel.series.iter().flat_map(LineSeries::finite));
        let (low, high) = extent(points.map(|point| point.0));
        if low < high { (low, high) } else { round_range(low, high) }
    }
}

impl LineSeries {
    pub(super) fn finite(&self) -> impl Iterator<Item = (f64, f64)> {
        self.points.iter().copied().filter(|(x, value)| x.is_finite() && value.is_finite())
    }
}

/// Smallest and largest value; zeros if there is none.
fn extent(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    if low <= high { (low, high) } else { (0.0, 0.0) }
}

impl Panel {
    /// Values at the bottom and the top: the curves, and those limits that at most double their extent.
    pub(super) fn range(&self) -> (f64, f64) {
        let (low, high) = extent(self.series.iter().flat_map(LineSeries::finite).map(|point| point.1));
        let reach = high - low;
        let near =
            self.limits.iter().map(|limit| limit.value).filter(|value| (low - reach..=high + reach).contains(value));
        let (low, high) = near.fold((low, high), |(low, high), value| (low.min(value), high.max(value)));
        widened(round_range(low, high), self.least_division)
    }

    fn legend(&self) -> std::result::Result<Legend, String> {
        let (low, high) = self.range();
        let curves = self.series.iter().zip(SERIES).map(|(series, colour)| (Sample::Line, colour, series.name.clone()));
        let limits = self.limits.iter().map(|limit| {
            let place = if (low..=high).contains(&limit.value) { "" } else { ", outside the panel" };
            (Sample::Dashes, INK, format!("{} {} {}{place}", limit.name, value_text(limit.value), self.unit))
        });
        Legend::within(WIDTH_PX - LEFT_PX - RIGHT_PX, curves.chain(limits))
    }
}

const WIDTH_PX: f64 = 1100.0;
const LEFT_PX: f64 = 96.0;
const RIGHT_PX: f64 = 28.0;
const TOP_PX: f64 = 50.0;
const PANEL_HEIGHT_PX: f64 = 190.0;
const PANEL_GAP_PX: f64 = 16.0;
const BELOW_PX: f64 = 62.0;

impl Draw for LineChart {
    fn problem(&self) -> Option<String> {
        if self.panels.is_empty() {
            return Some("a chart needs at least one panel".to_owned());
        }
        let wrong = self.panels.iter().find(|panel| panel.series.is_empty() || panel.series.len() > SERIES.len())?;
        Some(format!("panel {} shows 1 to {} curves, not {}", wrong.value_name, SERIES.len(), wrong.series.len()))
    }

    fn size_px(&self) -> std::result::Result<(u32, u32), String> {
        let mut height_px = TOP_PX + BELOW_PX - PANEL_GAP_PX;
        for panel in &self.panels {
            height_px += panel.legend()?.height_px() + PANEL_HEIGHT_PX + PANEL_GAP_PX;
        }
        Ok((WIDTH_PX as u32, height_px as u32))
    }

    fn draw<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>) -> Drawn {
        canvas.text(&self.title, (LEFT_PX, 28.0), fitting_em_px(&self.title, 20.0, WIDTH_PX - 130.0)?, Side::Start)?;
        let (low, high) = self.x_range();
        let ticks = Ticks::over(low, high, 12);
        let x_px = |x: f64| LEFT_PX + (x - low) / (high - low) * (WIDTH_PX - LEFT_PX - RIGHT_PX);
        let mut y = TOP_PX;
        for panel in &self.panels {
            let legend = panel.legend()?;
            legend.draw(canvas, (LEFT_PX, y))?;
            let top = y + legend.height_px();
            let (right, bottom) = (WIDTH_PX - RIGHT_PX, top + PANEL_HEIGHT_PX);
            let frame = Frame { left: LEFT_PX, right, top, bottom, range: panel.range() };
            for &value in &ticks.values {
                canvas.line(&[(x_px(value), top), (x_px(value), bottom)], FAINT, 1.0)?;
            }
            frame.draw_value_axis(canvas, &panel.value_name, &panel.unit, 24.0)?;
            panel.draw_curves(canvas, &frame, x_px)?;
            frame.draw_outline(canvas)?;
            y = bottom + PANEL_GAP_PX;
        }
        let bottom = y - PANEL_GAP_PX;
        for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
            canvas.text(label, (x_px(value), bottom + 16.0), EM_PX, Side::Middle)?;
        }
        let words = format!("{} [{}]", self.x_name, ticks.unit_text(&self.x_unit));
        canvas.text(&words, (0.5 * (LEFT_PX + WIDTH_PX - RIGHT_PX), bottom + 42.0), EM_PX, Side::Middle)
    }
}

impl Panel {
    fn draw_curves<DB: DrawingBackend>(
        &self,
        canvas: &mut Canvas<DB>,
        frame: &Frame,
        x_px: impl Fn(f64) -> f64,
    ) -> Drawn {
        for limit in self.limits.iter().filter(|limit| (frame.range.0..=frame.range.1).contains(&limit.value)) {
            let y = frame.y(limit.value);
            canvas.dashed((frame.left, y), (frame.right, y), INK, 1.5)?;
        }
        for (series, colour) in self.series.iter().zip(SERIES) {
            for run in series.points.split(|(x, value)| !(x.is_finite() && value.is_finite())) {
                let places: Vec<Point> = run.iter().map(|&(x, value)| (x_px(x), frame.y(value))).collect();
                if !places.is_empty() {
                    canvas.line(&thinned(&places), colour, 1.8)?;
                }
            }
        }
        Ok(())
    }
}

/// First and last point of each half pixel column, and between them its lowest and highest where they stand out.
pub(super) fn thinned(places: &[Point]) -> Vec<Point> {
    /// Less than this cannot be seen; joining such points would only make the line ragged.
    const VISIBLE_PX: f64 = 0.5;
    let column = |place: &Point| (2.0 * place.0).floor();
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
        let dense: Vec<Point> = (0..1000).map(|k| (f64::from(k) * 1e-4, f64::from((k * 37) % 101))).collect();
        let kept = thinned(&dense);
        assert_eq!((kept[0], kept.last()), (dense[0], dense.last()));
        assert!(kept.len() <= 4 && kept.iter().any(|p| p.1 == 100.0) && kept.iter().any(|p| p.1 == 0.0));
        let sparse = [(0.0, 1.0), (1.0, 2.0), (2.0, 0.0)];
        assert_eq!(thinned(&sparse), sparse);
    }
}
