//! Values as coloured cells, and the bar that explains the colours.
//!
//! In: a grid's values and a colour scale. Out: pixels, u upward and v to the right.
//!
//! A cell larger than a pixel stays a rectangle of one colour: nothing is smoothed into existence. Where several cells
//! share a pixel, it shows the mean of those that have a value; extremes that this hides are marked by the caller.

use crate::colormap::ColourScale;
use crate::output::axis::{Ticks, value_text};
use crate::output::canvas::{Align, Canvas, Drawn, INK};
use crate::output::grid::MapGrid;
use crate::output::letters::fitting_em_px;
use crate::output::raster::Raster;

/// Rectangle of pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct PixelBox {
    pub left: u32,
    pub top: u32,
    pub width: u32,
    pub height: u32,
}

impl PixelBox {
    /// Upper left and lower right corner.
    pub(super) fn corners(self) -> ((f64, f64), (f64, f64)) {
        let (left, top) = (f64::from(self.left), f64::from(self.top));
        ((left, top), (left + f64::from(self.width), top + f64::from(self.height)))
    }
}

/// Paints the values of a grid into a box.
pub(super) fn paint_cells(raster: &mut Raster, area: PixelBox, grid: &MapGrid, values: &[f32], scale: ColourScale) {
    let columns = ranges(area.width, grid.v.count);
    let mut painted = None;
    for (row, cells) in ranges(area.height, grid.u.count).into_iter().enumerate() {
        // Rows of pixels within one row of cells are equal: they are coloured once.
        let colours = match painted.take() {
            Some((same, colours)) if same == cells => colours,
            _ => row_colours(grid, values, scale, cells, &columns),
        };
        let y = area.top + area.height - 1 - row as u32;
        for (x, &colour) in (area.left..).zip(&colours) {
            raster.set(x, y, colour);
        }
        painted = Some((cells, colours));
    }
}

/// Darkens and lightens what was painted: 1 leaves a colour, 0 makes it black, 2 white.
pub(super) fn shade_cells(raster: &mut Raster, area: PixelBox, grid: &MapGrid, brightness: &[f32]) {
    let (columns, rows) = (ranges(area.width, grid.v.count), ranges(area.height, grid.u.count));
    for (row, &(u_first, u_end)) in rows.iter().enumerate() {
        let y = area.top + area.height - 1 - row as u32;
        for (x, &(v_first, v_end)) in (area.left..).zip(&columns) {
            let cells =
                (u_first..u_end).flat_map(|u| &brightness[u * grid.v.count + v_first..u * grid.v.count + v_end]);
            let light = mean(cells);
            if !light.is_nan() {
                raster.shade(x, y, light);
            }
        }
    }
}

fn row_colours(
    grid: &MapGrid,
    values: &[f32],
    scale: ColourScale,
    (u_first, u_end): (usize, usize),
    columns: &[(usize, usize)],
) -> Vec<[u8; 3]> {
    let row = |u: usize| &values[u * grid.v.count..(u + 1) * grid.v.count];
    let pixel = |&(v_first, v_end): &(usize, usize)| mean((u_first..u_end).flat_map(|u| &row(u)[v_first..v_end]));
    // Pixels within one cell are equal too.
    let mut painted: Option<(&(usize, usize), [u8; 3])> = None;
    let colour = |cells| {
        let colour = painted.filter(|(same, _)| *same == cells).map_or_else(|| scale.colour(pixel(cells)), |p| p.1);
        painted = Some((cells, colour));
        colour
    };
    columns.iter().map(colour).collect()
}

/// Cells under each pixel of a side: one where cells are larger than pixels, several where they are smaller.
fn ranges(pixels: u32, cells: usize) -> Vec<(usize, usize)> {
    let pixels = pixels as usize;
    (0..pixels)
        .map(|pixel| {
            let first = pixel * cells / pixels;
            (first, ((pixel + 1) * cells / pixels).max(first + 1))
        })
        .collect()
}

/// Mean of the values that are not NaN; NaN if there is none.
fn mean<'a>(cells: impl Iterator<Item = &'a f32>) -> f32 {
    let (sum, count) = cells
        .filter(|value| !value.is_nan())
        .fold((0.0, 0_u32), |(sum, count), &value| (sum + f64::from(value), count + 1));
    (sum / f64::from(count)) as f32
}

/// Vertical bar of all colours with ticks and the name of the quantity.
pub(super) struct ColourBar<'a> {
    pub area: PixelBox,
    pub scale: ColourScale,
    pub quantity: &'a str,
    pub unit: &'a str,
    /// Smallest and largest value shown; beyond the scale's ends, the bar gets points.
    pub shown: (f32, f32),
}

impl ColourBar<'_> {
    /// Room right of the bar that ticks and name need, pixels.
    pub(super) const LABEL_WIDTH_PX: u32 = 108;
    const EM_PX: f64 = 15.0;

    /// Paints the colours.
    pub(super) fn paint(&self, raster: &mut Raster) {
        let (low, high) = self.scale.ends();
        for row in 0..self.area.height {
            let place = (row as f32 + 0.5) / self.area.height as f32;
            let colour = self.scale.colour(low + place * (high - low));
            for x in self.area.left..self.area.left + self.area.width {
                raster.set(x, self.area.top + self.area.height - 1 - row, colour);
            }
        }
    }

    /// Draws frame, ticks and name; the name may be as long as `room_px`.
    pub(super) fn annotate(&self, canvas: &mut Canvas, room_px: f64) -> Drawn {
        let ((left, top), (right, bottom)) = self.area.corners();
        canvas.frame((left, top), (right, bottom), INK);
        let (low, high) = self.scale.ends();
        let middle = 0.5 * (left + right);
        if self.shown.1 > high {
            canvas.triangle([(left, top - 3.0), (right, top - 3.0), (middle, top - 13.0)], INK);
        }
        if self.shown.0 < low {
            canvas.triangle([(left, bottom + 3.0), (right, bottom + 3.0), (middle, bottom + 13.0)], INK);
        }
        let mut unit = self.unit.to_owned();
        if high > low {
            let (low, high) = (f64::from(low), f64::from(high));
            let ticks = Ticks::over(low, high, self.area.height as usize / 36);
            unit = ticks.unit_text(self.unit);
            for (value, label) in ticks.values.iter().zip(&ticks.labels) {
                let y = bottom - (value - low) / (high - low) * (bottom - top);
                canvas.fill((right, y), (right + 5.0, y), INK);
                canvas.text(label, (right + 9.0, y), Self::EM_PX, Align::Start)?;
            }
        } else {
            canvas.text(&value_text(low.into()), (right + 9.0, 0.5 * (top + bottom)), Self::EM_PX, Align::Start)?;
        }
        let name = if unit == "1" { self.quantity.to_owned() } else { format!("{} [{unit}]", self.quantity) };
        let at = (right + f64::from(Self::LABEL_WIDTH_PX) - 24.0, 0.5 * (top + bottom));
        canvas.text_upward(&name, at, fitting_em_px(&name, Self::EM_PX, room_px)?, Align::Middle)
    }
}

/// Values that a picture shows, without NaN.
pub(super) fn shown_range<'a>(values: impl IntoIterator<Item = &'a f32>) -> (f32, f32) {
    values.into_iter().fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

/// Why a scale cannot be drawn, if it cannot.
pub(super) fn scale_problem(scale: ColourScale) -> Option<String> {
    let (low, high) = scale.ends();
    (!(low.is_finite() && high.is_finite() && low <= high))
        .then(|| format!("the colour scale from {low} to {high} is empty"))
}
