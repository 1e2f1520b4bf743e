//! What bar charts and line charts share: files, legends, value axes.
//!
//! In: a chart that can draw itself on any canvas. Out: PNG and SVG with the same picture, from the same drawing.
//!
//! PNG files are drawn at twice their size and averaged, which smooths lines; SVG files are drawn on quarter pixels.

use std::path::Path;

use plotters::prelude::DrawingBackend;
use plotters::style::RGBColor;

use crate::output::atomic::write_bytes_atomically;
use crate::output::axis::Ticks;
use crate::output::canvas::{Canvas, Drawn, FAINT, INK, Point, Side, text_width_px};
use crate::output::heat::fitting_em_px;
use crate::output::raster::Raster;
use crate::{Error, Result};

/// Size of words on charts, pixels per em.
pub(super) const EM_PX: f64 = 15.0;
/// Height of one row of a legend, pixels.
pub(super) const LEGEND_ROW_PX: f64 = 24.0;

/// A picture that can draw itself.
pub(super) trait Draw {
    /// Why the chart cannot be drawn, if it cannot.
    fn problem(&self) -> Option<String>;
    /// Width and height, pixels.
    fn size_px(&self) -> std::result::Result<(u32, u32), String>;
    /// Draws everything.
    fn draw<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>) -> Drawn;
}

/// Writes a chart as PNG.
pub(super) fn write_png(path: &Path, chart: &impl Draw) -> Result<()> {
    const FINER: u32 = 2;
    let bytes = || {
        let size_px = checked_size(chart)?;
        let mut raster = Raster::white((size_px.0 * FINER, size_px.1 * FINER));
        let mut canvas = Canvas::bitmap(&mut raster.rgb, size_px, FINER)?;
        chart.draw(&mut canvas)?;
        canvas.finish()?;
        raster.halved().png()
    };
    write_bytes_atomically(path, &bytes().map_err(|reason| Error::Output { path: path.to_owned(), reason })?)
}

/// Writes a chart as SVG.
pub(super) fn write_svg(path: &Path, chart: &impl Draw) -> Result<()> {
    const FINER: u32 = 4;
    let text = || {
        let (width, height) = checked_size(chart)?;
        let mut text = String::new();
        let mut canvas = Canvas::svg(&mut text, (width, height), FINER)?;
        canvas.fill((0.0, 0.0), (f64::from(width), f64::from(height)), RGBColor(255, 255, 255))?;
        chart.draw(&mut canvas)?;
        canvas.finish()?;
        // plotters gives the page the size of its coordinates; the view box keeps those, the page gets its own.
        let fine = format!("width=\"{}\" height=\"{}\"", width * FINER, height * FINER);
        Ok(text.replacen(&fine, &format!("width=\"{width}\" height=\"{height}\""), 1))
    };
    let text = text().map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, text.as_bytes())
}

fn checked_size(chart: &impl Draw) -> std::result::Result<(u32, u32), String> {
    chart.problem().map_or_else(|| chart.size_px(), Err)
}

/// How an entry of a legend looks.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sample {
    Block,
    Line,
    Dashes,
}

/// Entries of a legend, in rows as wide as the chart.
pub(super) struct Legend {
    rows: Vec<Vec<(f64, Sample, RGBColor, String)>>,
}

impl Legend {
    const SAMPLE_PX: f64 = 26.0;
    const GAP_PX: f64 = 24.0;

    /// Distributes entries over rows of at most `width_px`.
    pub(super) fn within(
        width_px: f64,
        entries: impl IntoIterator<Item = (Sample, RGBColor, String)>,
    ) -> std::result::Result<Self, String> {
        let mut rows: Vec<Vec<_>> = Vec::new();
        let mut x = 0.0;
        for (sample, colour, words) in entries {
            let entry_px = Self::SAMPLE_PX + 8.0 + text_width_px(&words, EM_PX)? + Self::GAP_PX;
            if rows.is_empty() || x + entry_px > width_px + Self::GAP_PX {
                rows.push(Vec::new());
                x = 0.0;
            }
            if let Some(row) = rows.last_mut() {
                row.push((x, sample, colour, words));
            }
            x += entry_px;
        }
        Ok(Self { rows })
    }

    /// Height of all rows, pixels.
    pub(super) fn height_px(&self) -> f64 {
        LEGEND_ROW_PX * self.rows.len() as f64
    }

    /// Draws the rows with their upper left corner at `corner`.
    pub(super) fn draw<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>, corner: Point) -> Drawn {
        for (row, entries) in self.rows.iter().enumerate() {
            let y = corner.1 + LEGEND_ROW_PX * (row as f64 + 0.5);
            for (x, sample, colour, words) in entries {
                let (from, to) = ((corner.0 + x, y), (corner.0 + x + Self::SAMPLE_PX, y));
                match sample {
                    Sample::Block => canvas.fill((from.0, y - 6.0), (to.0, y + 6.0), *colour)?,
                    Sample::Line => canvas.line(&[from, to], *colour, 2.5)?,
                    Sample::Dashes => canvas.dashed(from, to, *colour, 1.5)?,
                }
                canvas.text(words, (to.0 + 8.0, y), EM_PX, Side::Start)?;
            }
        }
        Ok(())
    }
}

/// Rectangle that curves or bars are drawn in, with the values at its edges.
#[derive(Debug, Clone, Copy)]
pub(super) struct Frame {
    pub left: f64,
    pub right: f64,
    pub top: f64,
    pub bottom: f64,
    /// Values at the bottom and at the top.
    pub range: (f64, f64),
}

impl Frame {
    /// Height on the picture of a value, pixels from the top.
    pub(super) fn y(&self, value: f64) -> f64 {
        self.bottom - (value - self.range.0) / (self.range.1 - self.range.0) * (self.bottom - self.top)
    }

    /// Ticks of the value axis.
    pub(super) fn ticks(&self) -> Ticks {
        Ticks::over(self.range.0, self.range.1, ((self.bottom - self.top) / 36.0) as usize)
    }

    /// Draws grid lines, labels and the name of the value axis, whose middle is at `name_x`.
    pub(super) fn draw_value_axis<DB: DrawingBackend>(
        &self,
        canvas: &mut Canvas<DB>,
        name: &str,
        unit: &str,
        name_x: f64,
    ) -> Drawn {
        let ticks = self.ticks();
        for (&value, label) in ticks.values.iter().zip(&ticks.labels) {
            let y = self.y(value);
            canvas.line(&[(self.left, y), (self.right, y)], FAINT, 1.0)?;
            canvas.text(label, (self.left - 9.0, y), EM_PX, Side::End)?;
        }
        let words = format!("{name} [{}]", ticks.unit_text(unit));
        let em_px = fitting_em_px(&words, EM_PX, self.bottom - self.top + 40.0)?;
        canvas.text_upward(&words, (name_x, 0.5 * (self.top + self.bottom)), em_px, Side::Middle)
    }

    /// Draws the frame itself, over what is inside.
    pub(super) fn draw_outline<DB: DrawingBackend>(&self, canvas: &mut Canvas<DB>) -> Drawn {
        canvas.frame((self.left, self.top), (self.right, self.bottom), INK)
    }
}
