//! A map as a picture: coloured cells, axes in mm, colour bar, extremes.
//!
//! In: a grid, its values, title, quantity, unit and colour scale. Out: one PNG, v to the right, u upward.
//!
//! Both axes have the same scale unless that would make the map lower than 160 pixels (a relief 480: marks along a long
//! tooth need the height) or higher than 640; a line below the map says by how much one of them is stretched then. The
//! smallest and largest values are marked where they are, so that a single outlying cell is found even where it is
//! smaller than a pixel.
//!
//! Road not taken: a general chart library for the cells. It draws a rectangle per cell, which takes a second per map;
//! a gear has hundreds.

use std::path::Path;

use crate::colormap::{ColourScale, NO_VALUE};
use crate::output::atomic::write_bytes_atomically;
use crate::output::axis::{Ticks, number_text, value_text};
use crate::output::canvas::{Align, Canvas, Drawn, INK, PAPER, Point};
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::heat::{ColourBar, PixelBox, paint_cells, scale_problem, shade_cells, shown_range};
use crate::output::letters::fitting_em_px;
use crate::output::raster::Raster;
pub use crate::output::relief::Relief;
use gearcut_core::{Error, Result};

/// A map to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct MapPicture<'a> {
    /// What and where, such as "Finish, tooth 7, left flank".
    pub title: &'a str,
    /// What the values are, such as "normal deviation".
    pub quantity: &'a str,
    /// Their unit, such as "µm".
    pub unit: &'a str,
    /// Where the values lie.
    pub grid: &'a MapGrid,
    /// The values; NaN where there is none.
    pub values: &'a [f32],
    /// Their colours.
    pub scale: ColourScale,
    /// Why a value is missing, such as "no pass came here".
    pub missing: &'a str,
}

const LEFT_PX: u32 = 84;
const TOP_PX: u32 = 58;
const BELOW_PX: u32 = 108;
const MAP_WIDTH_PX: u32 = 1080;
const BAR_GAP_PX: u32 = 28;
const BAR_WIDTH_PX: u32 = 20;
const TITLE_EM_PX: f64 = 20.0;
const EM_PX: f64 = 15.0;

/// Writes a map as PNG.
///
/// # Errors
/// Values that do not fill the grid, an empty colour scale, and files that cannot be written.
pub fn write_map_png(path: &Path, picture: &MapPicture) -> Result<()> {
    write(path, picture, None)
}

/// Writes a map as PNG, lit from the side so that its relief shows; the exaggeration stands below it.
///
/// # Errors
/// As [`write_map_png`].
pub fn write_relief_png(path: &Path, picture: &MapPicture, relief: &Relief) -> Result<()> {
    write(path, picture, Some(relief))
}

fn write(path: &Path, picture: &MapPicture, relief: Option<&Relief>) -> Result<()> {
    let bytes = draw(picture, relief).map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

fn draw(picture: &MapPicture, relief: Option<&Relief>) -> std::result::Result<Vec<u8>, String> {
    if let Some(problem) = picture.grid.mismatch(picture.values.len()).or_else(|| scale_problem(picture.scale)) {
        return Err(problem);
    }
    let true_height_px = f64::from(MAP_WIDTH_PX) * picture.grid.u.length_mm() / picture.grid.v.length_mm();
    let lowest_px = if relief.is_some() { 480.0 } else { 160.0 };
    let height_px = true_height_px.round().clamp(lowest_px, 640.0) as u32;
    let map = PixelBox { left: LEFT_PX, top: TOP_PX, width: MAP_WIDTH_PX, height: height_px };
    let bar = ColourBar {
        area: PixelBox { left: LEFT_PX + MAP_WIDTH_PX + BAR_GAP_PX, width: BAR_WIDTH_PX, ..map },
        scale: picture.scale,
        quantity: picture.quantity,
        unit: picture.unit,
        shown: shown_range(picture.values),
    };
    let width_px = bar.area.left + BAR_WIDTH_PX + ColourBar::LABEL_WIDTH_PX;
    let below_px = BELOW_PX + if relief.is_some() { 22 } else { 0 };
    let mut raster = Raster::white((width_px, TOP_PX + height_px + below_px));
    paint_cells(&mut raster, map, picture.grid, picture.values, picture.scale);
    if let Some(relief) = relief {
        shade_cells(&mut raster, map, picture.grid, &relief.brightness);
    }
    bar.paint(&mut raster);

    let mut canvas = Canvas(&mut raster);
    let title_em_px = fitting_em_px(picture.title, TITLE_EM_PX, f64::from(MAP_WIDTH_PX))?;
    canvas.text(picture.title, (f64::from(LEFT_PX), 28.0), title_em_px, Align::Start)?;
    draw_axes(&mut canvas, map, picture.grid)?;
    bar.annotate(&mut canvas, f64::from(height_px + TOP_PX + BELOW_PX) - 60.0)?;
    draw_notes(&mut canvas, map, picture, f64::from(height_px) / true_height_px)?;
    if let Some(relief) = relief {
        let at = (f64::from(LEFT_PX), f64::from(TOP_PX + height_px) + 100.0);
        canvas.text(&relief.words(), at, EM_PX, Align::Start)?;
    }
    raster.png()
}

fn draw_axes(canvas: &mut Canvas, map: PixelBox, grid: &MapGrid) -> Drawn {
    let ((left, top), (right, bottom)) = map.corners();
    canvas.frame((left, top), (right, bottom), INK);
    let v_ticks = axis_ticks(&grid.v, map.width / 90);
    for (value, label) in v_ticks.values.iter().zip(&v_ticks.labels) {
        let x = left + (value - grid.v.low_edge_mm()) / grid.v.length_mm() * (right - left);
        canvas.fill((x, bottom), (x, bottom + 5.0), INK);
        canvas.text(label, (x, bottom + 16.0), EM_PX, Align::Middle)?;
    }
    let u_ticks = axis_ticks(&grid.u, map.height / 40);
    for (value, label) in u_ticks.values.iter().zip(&u_ticks.labels) {
        let y = bottom - (value - grid.u.low_edge_mm()) / grid.u.length_mm() * (bottom - top);
        canvas.fill((left - 5.0, y), (left, y), INK);
        canvas.text(label, (left - 9.0, y), EM_PX, Align::End)?;
    }
    let v_name = axis_name(&grid.v, &v_ticks);
    canvas.text(&v_name, (0.5 * (left + right), bottom + 40.0), EM_PX, Align::Middle)?;
    let u_name = axis_name(&grid.u, &u_ticks);
    let em_px = fitting_em_px(&u_name, EM_PX, bottom - top + 90.0)?;
    canvas.text_upward(&u_name, (22.0, 0.5 * (top + bottom)), em_px, Align::Middle)
}

fn axis_ticks(axis: &MapAxis, most: u32) -> Ticks {
    Ticks::over(axis.low_edge_mm(), axis.low_edge_mm() + axis.length_mm(), most as usize)
}

fn axis_name(axis: &MapAxis, ticks: &Ticks) -> String {
    format!("{}: {} [{}]", axis.name, axis.meaning, ticks.unit_text("mm"))
}

/// Marks the extremes in the map and explains marks, grey cells and a stretched u below it.
fn draw_notes(canvas: &mut Canvas, map: PixelBox, picture: &MapPicture, u_stretch: f64) -> Drawn {
    let ((left, top), (right, bottom)) = map.corners();
    let y = bottom + 78.0;
    let mut column_x = left;
    let column_px = (right - left) / 3.0;
    let [u_name, v_name] = [&picture.grid.u.name, &picture.grid.v.name];
    let finite = || picture.values.iter().enumerate().filter(|(_, value)| value.is_finite());
    // On equal values the first place wins, so that the same map is always marked at the same place.
    let largest = finite().reduce(|best, next| if next.1 > best.1 { next } else { best });
    let smallest = finite().reduce(|best, next| if next.1 < best.1 { next } else { best });
    for (word, upward, extreme) in [("largest", true, largest), ("smallest", false, smallest)] {
        let Some((index, &value)) = extreme else { continue };
        let (u_mm, v_mm) = picture.grid.place_mm(index);
        let across = (v_mm - picture.grid.v.low_edge_mm()) / picture.grid.v.length_mm();
        let along = (u_mm - picture.grid.u.low_edge_mm()) / picture.grid.u.length_mm();
        draw_mark(canvas, (left + across * (right - left), bottom - along * (bottom - top)), upward);
        draw_mark(canvas, (column_x + 7.0, y), upward);
        let unit = if picture.unit == "1" { String::new() } else { format!(" {}", picture.unit) };
        let (u, v) = (number_text(u_mm, 2), number_text(v_mm, 2));
        let words = format!("{word} {}{unit} at {v_name} {v}, {u_name} {u} mm", value_text(value.into()));
        let em_px = fitting_em_px(&words, EM_PX, column_px - 30.0)?;
        canvas.text(&words, (column_x + 20.0, y), em_px, Align::Start)?;
        column_x += column_px;
    }
    let missing = picture.values.iter().filter(|value| value.is_nan()).count();
    if missing > 0 {
        canvas.fill((column_x, y - 7.0), (column_x + 14.0, y + 7.0), NO_VALUE);
        let words = format!("{}: {missing} of {} cells", picture.missing, picture.values.len());
        let em_px = fitting_em_px(&words, EM_PX, column_px - 30.0)?;
        canvas.text(&words, (column_x + 20.0, y), em_px, Align::Start)?;
    }
    let scale_note = if (u_stretch - 1.0).abs() < 0.01 {
        format!("{u_name} and {v_name} to the same scale")
    } else if u_stretch > 1.0 {
        format!("{u_name} drawn {} times as large as {v_name}", value_text(u_stretch))
    } else {
        format!("{v_name} drawn {} times as large as {u_name}", value_text(1.0 / u_stretch))
    };
    canvas.text(&scale_note, (right, bottom + 40.0), EM_PX, Align::End)
}

/// Triangle around the place it marks, light around dark so that it shows on every colour.
fn draw_mark(canvas: &mut Canvas, at: Point, upward: bool) {
    let side = if upward { 1.0 } else { -1.0 };
    let triangle = |size: f64| {
        [(0.0, -1.1 * side), (0.95, 0.7 * side), (-0.95, 0.7 * side)]
            .map(|(x, y): Point| (at.0 + size * x, at.1 + size * y))
    };
    canvas.triangle(triangle(9.0), PAPER);
    canvas.triangle(triangle(6.0), INK);
}
