//! Many small maps on one picture, with one colour scale: all flanks of a gear at a glance.
//!
//! In: labelled maps in reading order ("7 L", "7 R", ...). Out: one PNG with one colour bar and one scale for all
//! lengths.
//!
//! The number of columns is even, so that left and right flank of a tooth stand side by side, and is chosen to bring
//! the picture near the proportions of a screen.

use std::path::Path;

use crate::colormap::{ColourScale, NO_VALUE};
use crate::output::atomic::write_bytes_atomically;
use crate::output::canvas::{Align, Canvas, INK};
use crate::output::grid::MapGrid;
use crate::output::heat::{ColourBar, PixelBox, paint_cells, scale_problem, shown_range};
use crate::output::letters::fitting_em_px;
use crate::output::raster::Raster;
use gearcut_core::{Error, Result};

/// One small map of a sheet.
#[derive(Debug, Clone, Copy)]
pub struct Thumbnail<'a> {
    /// Short label, such as "7 L".
    pub label: &'a str,
    /// Where the values lie.
    pub grid: &'a MapGrid,
    /// The values; NaN where there is none.
    pub values: &'a [f32],
}

/// A sheet to be drawn.
#[derive(Debug, Clone, Copy)]
pub struct ContactSheet<'a> {
    /// What is shown.
    pub title: &'a str,
    /// What the values are, such as "normal deviation".
    pub quantity: &'a str,
    /// Their unit, such as "µm".
    pub unit: &'a str,
    /// The colours of all maps.
    pub scale: ColourScale,
    /// Why a value is missing, such as "no pass came here".
    pub missing: &'a str,
    /// The maps, in reading order.
    pub maps: &'a [Thumbnail<'a>],
}

const MARGIN_PX: u32 = 28;
const TOP_PX: u32 = 60;
const BELOW_PX: u32 = 54;
const MAP_WIDTH_PX: u32 = 216;
const NARROWEST_MAP_PX: u32 = 24;
const LABEL_HEIGHT_PX: u32 = 22;
const GAP_PX: u32 = 12;
const BAR_WIDTH_PX: u32 = 20;
/// Width to height that the number of columns aims at.
const PROPORTION: f64 = 1.4;
const EM_PX: f64 = 15.0;
/// Pairs of columns at most.
const MOST_PAIRS: u32 = 10;

/// Writes a sheet as PNG.
///
/// # Errors
/// No maps, values that do not fill their grid, an empty colour scale, and files that cannot be written.
pub fn write_contact_sheet(path: &Path, sheet: &ContactSheet) -> Result<()> {
    let bytes = contact_sheet_png(sheet, None).map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

/// A sheet that is to be printed: its maps, without the bar of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PrintedSheet {
    /// Largest width, pixels.
    pub width_px: u32,
    /// Width to height that the number of columns aims at.
    pub proportion: f64,
}

/// A sheet as PNG, at its usual size or as it is printed.
///
/// # Errors
/// No maps, values that do not fill their grid, an empty colour scale.
pub fn contact_sheet_png(sheet: &ContactSheet, printed: Option<PrintedSheet>) -> std::result::Result<Vec<u8>, String> {
    let mismatch = |map: &Thumbnail| map.grid.mismatch(map.values.len()).map(|why| format!("map {}: {why}", map.label));
    if let Some(problem) = sheet.maps.iter().find_map(mismatch).or_else(|| scale_problem(sheet.scale)) {
        return Err(problem);
    }
    if sheet.maps.is_empty() {
        return Err("a sheet needs at least one map".to_owned());
    }
    let longest_mm = sheet.maps.iter().map(|map| map.grid.v.length_mm()).fold(0.0, f64::max);
    let highest_mm = sheet.maps.iter().map(|map| map.grid.u.length_mm()).fold(0.0, f64::max);
    let proportion = printed.map_or(PROPORTION, |printed| printed.proportion);
    let of_width = |map_px: u32| {
        let height_px = (highest_mm * f64::from(map_px) / longest_mm).round().clamp(36.0, 216.0);
        let pitch_px = (map_px + GAP_PX, height_px as u32 + LABEL_HEIGHT_PX + GAP_PX);
        (height_px, pitch_px, columns_for(sheet.maps.len() as u32, pitch_px, proportion))
    };
    // Smaller step by step: with other proportions other columns fit.
    let narrow = |map_px: &u32| {
        let (_, pitch_px, columns) = of_width(*map_px);
        printed.is_none_or(|printed| columns * pitch_px.0 <= printed.width_px)
    };
    let map_px = (NARROWEST_MAP_PX..=MAP_WIDTH_PX).rev().step_by(4).find(narrow).unwrap_or(NARROWEST_MAP_PX);
    let (cell_height_px, pitch_px, columns) = of_width(map_px);
    let v_px_per_mm = f64::from(map_px) / longest_mm;
    let u_px_per_mm = cell_height_px / highest_mm;
    let rows = (sheet.maps.len() as u32).div_ceil(columns);
    let field_px = (columns * pitch_px.0 - GAP_PX, rows * pitch_px.1 - GAP_PX);
    // A sheet of few maps still needs room for a bar that can be read.
    let bar_height_px = (field_px.1 - LABEL_HEIGHT_PX).clamp(200, 480);
    let bar = ColourBar {
        area: PixelBox {
            left: MARGIN_PX + field_px.0 + MARGIN_PX,
            top: TOP_PX + LABEL_HEIGHT_PX,
            width: BAR_WIDTH_PX,
            height: bar_height_px,
        },
        scale: sheet.scale,
        quantity: sheet.quantity,
        unit: sheet.unit,
        shown: shown_range(sheet.maps.iter().flat_map(|map| map.values)),
    };
    let body_px = field_px.1.max(bar_height_px + LABEL_HEIGHT_PX);
    let width_px = bar.area.left + BAR_WIDTH_PX + ColourBar::LABEL_WIDTH_PX;
    let mut raster = Raster::white((width_px, TOP_PX + body_px + BELOW_PX));

    let mut areas = Vec::with_capacity(sheet.maps.len());
    for (index, map) in (0_u32..).zip(sheet.maps) {
        let area = PixelBox {
            left: MARGIN_PX + index % columns * pitch_px.0,
            top: TOP_PX + index / columns * pitch_px.1 + LABEL_HEIGHT_PX,
            width: ((map.grid.v.length_mm() * v_px_per_mm).round() as u32).max(1),
            height: ((map.grid.u.length_mm() * u_px_per_mm).round() as u32).max(1),
        };
        paint_cells(&mut raster, area, map.grid, map.values, sheet.scale);
        areas.push(area);
    }
    bar.paint(&mut raster);

    let mut canvas = Canvas(&mut raster);
    let left = f64::from(MARGIN_PX);
    let title_em_px = fitting_em_px(sheet.title, 20.0, f64::from(width_px) - 2.0 * left)?;
    canvas.text(sheet.title, (left, 28.0), title_em_px, Align::Start)?;
    for (area, map) in areas.iter().zip(sheet.maps) {
        let (upper_left, lower_right) = area.corners();
        canvas.frame(upper_left, lower_right, INK);
        canvas.text(map.label, (upper_left.0, upper_left.1 - 10.0), EM_PX, Align::Start)?;
    }
    bar.annotate(&mut canvas, f64::from(bar_height_px + TOP_PX))?;

    // Below the maps: a scale for each axis, and what grey means.
    let y = f64::from(TOP_PX + body_px) + 28.0;
    let (v_bar_mm, u_bar_mm) = (scale_bar_mm(longest_mm), scale_bar_mm(highest_mm));
    let v_end = left + v_bar_mm * v_px_per_mm;
    canvas.fill((left, y - 1.0), (v_end, y + 1.0), INK);
    let axes = &sheet.maps[0].grid;
    canvas.text(&format!("{}: {v_bar_mm} mm", axes.v.name), (v_end + 10.0, y), EM_PX, Align::Start)?;
    let u_x = v_end + 120.0;
    let u_half = 0.5 * u_bar_mm * u_px_per_mm;
    canvas.fill((u_x - 1.0, y - u_half), (u_x + 1.0, y + u_half), INK);
    canvas.text(&format!("{}: {u_bar_mm} mm", axes.u.name), (u_x + 10.0, y), EM_PX, Align::Start)?;
    if sheet.maps.iter().flat_map(|map| map.values).any(|value| value.is_nan()) {
        let x = u_x + 120.0;
        canvas.fill((x, y - 7.0), (x + 14.0, y + 7.0), NO_VALUE);
        canvas.text(sheet.missing, (x + 22.0, y), EM_PX, Align::Start)?;
    }
    raster.png()
}

/// Even number of columns whose sheet comes nearest to a proportion of width to height.
fn columns_for(maps: u32, pitch_px: (u32, u32), proportion: f64) -> u32 {
    let distance = |columns: u32| {
        let (width, height) = (columns * pitch_px.0, maps.div_ceil(columns) * pitch_px.1);
        (f64::from(width) / f64::from(height) / proportion).ln().abs()
    };
    let even = (1..=maps.div_ceil(2).min(MOST_PAIRS)).map(|half| 2 * half);
    even.min_by(|&a, &b| distance(a).total_cmp(&distance(b))).unwrap_or(2)
}

/// Length of a scale bar, mm: 1, 2 or 5 times a power of ten, at most a third of the length.
pub(super) fn scale_bar_mm(length_mm: f64) -> f64 {
    let power = 10_f64.powf((length_mm / 3.0).log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|factor| factor * power).find(|bar| *bar <= length_mm / 3.0).unwrap_or(power)
}
