//! A drawn stage as PNG: title, the picture, a bar that explains the colours, a scale bar, and what was done to the
//! shape.
//!
//! Colours of the bar are those of the scale; on bodies light makes them brighter or darker.

use crate::colormap::ColourScale;
use crate::output::apng::AnimationFrame;
use crate::output::atomic::write_bytes_atomically;
use crate::output::canvas::{Align, Canvas, INK};
use crate::output::contact_sheet::scale_bar_mm;
use crate::output::heat::{ColourBar, PixelBox, scale_problem};
use crate::output::letters::fitting_em_px;
use crate::output::raster::Raster;
use crate::surface::render::{Rendered, bare_srgb};
use gearcut_core::{Error, Result};
use std::path::Path;

/// What colours mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Legend<'a> {
    /// Quantity, such as "normal stock".
    pub quantity: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Its colours.
    pub scale: ColourScale,
}

/// A picture on its way to a file.
#[derive(Debug, Clone, Copy)]
pub struct RenderPicture<'a> {
    /// What is shown.
    pub title: &'a str,
    /// What was done to the shape, if anything: "heights x 1000, profile rolled out".
    pub note: &'a str,
    /// The pixels.
    pub rendered: &'a Rendered,
    /// mm per pixel.
    pub pixel_mm: f64,
    /// What colours mean; `None` where they mean nothing.
    pub legend: Option<Legend<'a>>,
}

const TOP_PX: u32 = 56;
const BELOW_PX: u32 = 52;
const MARGIN_PX: u32 = 24;
const BAR_GAP_PX: u32 = 20;
const BAR_WIDTH_PX: u32 = 20;
const EM_PX: f64 = 15.0;
/// Legend of places without a value under the colour bar and its mark of lower values.
const BARE_BELOW_PX: f64 = 30.0;
/// Narrowest picture that title and scale bar find room on.
const LEAST_WIDTH_PX: u32 = 360;

/// Writes a picture as PNG.
///
/// # Errors
/// An empty colour scale, and files that cannot be written.
pub fn write_render_png(path: &Path, picture: &RenderPicture) -> Result<()> {
    let bytes = draw(picture)
        .and_then(|raster| raster.png())
        .map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

/// Draws a picture as a frame of several.
///
/// # Errors
/// An empty colour scale.
pub fn draw_frame(picture: &RenderPicture) -> Result<AnimationFrame> {
    draw(picture).map(AnimationFrame).map_err(|reason| Error::Output { path: "frame".into(), reason })
}

/// Writes a frame as PNG.
///
/// # Errors
/// Files that cannot be written.
pub fn write_frame(path: &Path, AnimationFrame(raster): &AnimationFrame) -> Result<()> {
    let bytes = raster.png().map_err(|reason| Error::Output { path: path.to_owned(), reason })?;
    write_bytes_atomically(path, &bytes)
}

fn draw(picture: &RenderPicture) -> std::result::Result<Raster, String> {
    if let Some(problem) = picture.legend.and_then(|legend| scale_problem(legend.scale)) {
        return Err(problem);
    }
    let (width, height) = picture.rendered.size_px;
    let legend_px = picture.legend.map_or(0, |_| BAR_GAP_PX + BAR_WIDTH_PX + ColourBar::LABEL_WIDTH_PX);
    let total_px = (width.max(LEAST_WIDTH_PX) + legend_px + MARGIN_PX, TOP_PX + height + BELOW_PX);
    let mut raster = Raster::white(total_px);
    for (i, &colour) in (0..).zip(&picture.rendered.rgb) {
        raster.set(i % width, TOP_PX + i / width, colour);
    }
    let bar = picture.legend.map(|legend| ColourBar {
        area: PixelBox {
            left: width.max(LEAST_WIDTH_PX) + BAR_GAP_PX,
            top: TOP_PX + height / 8,
            width: BAR_WIDTH_PX,
            height: (3 * height / 4).max(40),
        },
        scale: legend.scale,
        quantity: legend.quantity,
        unit: legend.unit,
        shown: picture.rendered.shown,
    });
    if let Some(bar) = &bar {
        bar.paint(&mut raster);
    }
    let mut canvas = Canvas(&mut raster);
    let left = f64::from(MARGIN_PX);
    let room_px = f64::from(total_px.0) - 2.0 * left;
    canvas.text(picture.title, (left, 28.0), fitting_em_px(picture.title, 20.0, room_px)?, Align::Start)?;
    if let Some(bar) = &bar {
        bar.annotate(&mut canvas, f64::from(height))?;
        if picture.rendered.bare {
            let ((x, _), (_, bottom)) = bar.area.corners();
            let y = bottom + BARE_BELOW_PX;
            canvas.fill((x, y - 7.0), (x + 14.0, y + 7.0), bare_srgb());
            canvas.text("no value", (x + 20.0, y), EM_PX, Align::Start)?;
        }
    }
    let y = f64::from(TOP_PX + height) + 26.0;
    let bar_mm = scale_bar_mm(0.6 * picture.pixel_mm * f64::from(width));
    let end = left + bar_mm / picture.pixel_mm;
    canvas.fill((left, y - 1.0), (end, y + 1.0), INK);
    canvas.text(&format!("{bar_mm} mm"), (end + 10.0, y), EM_PX, Align::Start)?;
    let note_left = end + 90.0;
    let note_em_px = fitting_em_px(picture.note, EM_PX, f64::from(total_px.0) - left - note_left)?;
    canvas.text(picture.note, (f64::from(total_px.0) - left, y), note_em_px, Align::End)?;
    Ok(raster)
}
