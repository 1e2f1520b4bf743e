//! Pictures of single flanks: rolled out flat, heights exaggerated, under light from the tip.
//!
//! In: the scene's pictures; a flank as it was cut. Out: the rows of the flank that a picture shows ([`shown`]), kept
//! when the flank's dexels are dropped (in full they are as large as a thousand pictures), and the picture. Rolled out,
//! the normal deviation is all that is left of a flank's shape, and light from the tip grazes every feed mark alike.
//! The factor on its heights stands in the picture. Heights are means over two pixels: single dexels would fall on a
//! pixel or between two.

use super::{DrawnPicture, look};
use crate::colormap::ColourScale;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::scene::model::{Picture, PictureView};
use crate::steps::parts::{Part, Parts};
use crate::surface::render::{Bodies, Camera, Lights, Shape, render, seen};
use crate::surface::{Mesh, SurfaceGrid};
use gearcut_core::dexel::{Layer, RayGrid};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use std::collections::BTreeMap;
use std::ops::Range;

/// Flanks as pictures show them, by the picture's index in the scene.
pub type PicturedFlanks = BTreeMap<usize, SurfaceGrid>;

/// Exaggerated feed marks lean about this much: steep enough for raking light to tell their sides apart, flat enough to
/// hide nothing.
const MARK_SLOPE: f64 = 0.12;
/// The lamp over a rolled-out flank stands this high, rad: marks that lean by [`MARK_SLOPE`] stay in its light.
const RAKING_RAD: f64 = 0.28;
/// Share of that lamp in the light; the rest comes from the sky.
const RAKING_SHARE: f64 = 0.85;
/// How far marks take the sky from each other, as a share of the flank: hardly, or every valley would be dark.
const RAKING_SKY_REACH: f64 = 0.02;
/// Light that it throws on a white surface without marks: a little more than a studio's, so that both sides of a mark
/// show.
const RAKING_LIGHT: f64 = 1.08;

/// Heights of a flank are averaged over so many pixels: what is narrower would fall on a ray or between two.
const SHOWN_PX: f64 = 2.0;

/// Width that a picture of a flank shows, mm: as the scene says, or more than half of the profile's length.
fn extent_mm(job: &dyn GearJob, picture: &Picture) -> Result<f64> {
    match picture.extent_mm {
        Some(extent_mm) => Ok(extent_mm),
        None => Ok(0.6 * job.profile_length_mm(picture.tooth, picture.side)?),
    }
}

/// What the scene's pictures show of a flank, with all its columns: its rows in the middle of the face. Nothing where
/// pictures are no part of the run.
///
/// # Errors
/// The tool generates no flank there.
pub fn shown(
    job: &dyn GearJob,
    (tooth, side): (u32, Side),
    parts: Parts,
    rays: &impl RayGrid,
    layers: &[Layer],
) -> Result<PicturedFlanks> {
    let pictures = if parts.has(Part::Pictures) { job.scene().pictures.as_slice() } else { &[] };
    let of_flank =
        |picture: &Picture| picture.view == PictureView::Flank && (picture.tooth, picture.side) == (tooth, side);
    let wanted = pictures.iter().enumerate().filter(|(_, picture)| of_flank(picture));
    let spacing_mm = job.scene().fields.profile_spacing_mm;
    let grid = |picture| -> Result<SurfaceGrid> {
        let reach_mm = 0.5 * extent_mm(job, picture)?;
        Ok(SurfaceGrid::of_rows(rays, layers, rows_within(rays.rows_mm(), reach_mm), spacing_mm))
    };
    wanted.map(|(index, picture)| Ok((index, grid(picture)?))).collect()
}

/// Rows nearer to the middle of the face than `reach_mm`, and one more at either end where there is one; two at least.
fn rows_within(rows_mm: &[f64], reach_mm: f64) -> Range<usize> {
    let first = rows_mm.partition_point(|&row_mm| row_mm <= -reach_mm).saturating_sub(1);
    let last = rows_mm.partition_point(|&row_mm| row_mm < reach_mm).min(rows_mm.len() - 1);
    first..last + 1
}

/// Draws a picture of the flank `grid`.
///
/// # Errors
/// The tool generates no flank there; Ctrl-C.
pub(super) fn draw_flank(
    job: &dyn GearJob,
    picture: &Picture,
    grid: &SurfaceGrid,
    stock_scale: Option<ColourScale>,
    interrupt: &Interrupt,
) -> Result<DrawnPicture> {
    let profile_mm = job.profile_length_mm(picture.tooth, picture.side)?;
    let extent_mm = extent_mm(job, picture)?;
    let exaggeration = picture.exaggeration.unwrap_or_else(|| exaggeration(grid));
    let pixel_mm = 1.04 * extent_mm / f64::from(picture.size_px.0);
    let flat = rolled_out(grid, exaggeration, SHOWN_PX * pixel_mm);
    let (look, legend) = look(picture.colour, &flat, stock_scale);
    let towards = Camera::direction(DVec3::NEG_Y, DVec3::X, picture.azimuth_rad, picture.elevation_rad);
    let middle_mm = DVec3::new(0.0, 0.5 * profile_mm, 0.0);
    let camera = Camera::new(middle_mm, towards, DVec3::Y, 1.04 * extent_mm, picture.size_px);
    let shape = Shape::new(vec![&flat]);
    let bodies = Bodies::new(&shape, vec![look]);
    let lamp = DVec3::new(0.0, RAKING_RAD.cos(), RAKING_RAD.sin());
    let gain = RAKING_LIGHT / RAKING_RAD.sin();
    let lights = Lights { lamp, lamp_share: RAKING_SHARE, sky_reach: RAKING_SKY_REACH, gain };
    let rendered = render(&bodies, &camera, &lights, interrupt)?;
    let seen = picture.exr.then(|| seen(&bodies, &camera, interrupt)).transpose()?;
    let side = if picture.side == Side::Left { "left" } else { "right" };
    let finishing = job.operations().last().map_or("", |(name, _)| *name);
    let title = format!("{}: tooth {}, {side} flank after {finishing}", job.scene().name, picture.tooth);
    let note = format!(
        "profile rolled out, root below, tip above; heights \u{d7} {exaggeration}, means over two pixels; light from \
        the tip"
    );
    Ok(DrawnPicture { title, note, camera, rendered, seen, legend })
}

/// Factor (1, 2 or 5 times a power of ten) that makes the median slope along the profile at most [`MARK_SLOPE`].
fn exaggeration(grid: &SurfaceGrid) -> f64 {
    let (rows, count) = (grid.rows(), grid.columns());
    let mut slopes: Vec<f64> = (1..count)
        .map(|c| {
            let rise_um = f64::from(grid.height_um[c * rows] - grid.height_um[(c - 1) * rows]);
            (rise_um / UM_PER_MM / (grid.arcs_mm[c] - grid.arcs_mm[c - 1])).abs()
        })
        .collect();
    slopes.sort_unstable_by(f64::total_cmp);
    let median = slopes.get(slopes.len() / 2).copied().unwrap_or(0.0);
    let wanted = (MARK_SLOPE / median.max(1e-12)).clamp(1.0, 1e6);
    let power = 10_f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|factor| factor * power).find(|f| *f <= wanted).unwrap_or(1.0)
}

/// The grid as a plane: x along the tooth, y along the profile, z the height times a factor; heights are means over
/// `window_mm` along the profile and along the tooth.
fn rolled_out(grid: &SurfaceGrid, exaggeration: f64, window_mm: f64) -> Mesh {
    let mut mesh = grid.mesh("flank");
    let (columns, rows) = (grid.columns(), grid.rows());
    let mut heights_mm: Vec<f64> = grid.height_um.iter().map(|&um| f64::from(um) / UM_PER_MM).collect();
    for row in 0..rows {
        let along: Vec<f64> = (0..columns).map(|column| heights_mm[column * rows + row]).collect();
        for (column, mean) in means(&grid.arcs_mm, &along, window_mm).into_iter().enumerate() {
            heights_mm[column * rows + row] = mean;
        }
    }
    for along in heights_mm.chunks_exact_mut(rows) {
        let averaged = means(&grid.rows_mm, along, window_mm);
        along.copy_from_slice(&averaged);
    }
    for (i, position_mm) in mesh.positions_mm.iter_mut().enumerate() {
        let height_mm = heights_mm[i];
        *position_mm = DVec3::new(grid.rows_mm[i % rows], grid.arcs_mm[i / rows], exaggeration * height_mm);
    }
    mesh
}

/// Means of the straight lines through values at rising places, over a window about each place; at the ends over what
/// of the window there is, as much on either side.
fn means(places_mm: &[f64], values: &[f64], window_mm: f64) -> Vec<f64> {
    if places_mm.len() < 2 {
        return values.to_vec();
    }
    // Areas under the lines up to each place.
    let mut areas = vec![0.0; places_mm.len()];
    for i in 1..places_mm.len() {
        areas[i] = areas[i - 1] + 0.5 * (values[i] + values[i - 1]) * (places_mm[i] - places_mm[i - 1]);
    }
    let area = |place_mm: f64| {
        let i = places_mm.partition_point(|&p| p < place_mm).clamp(1, places_mm.len() - 1);
        let (length, along) = (places_mm[i] - places_mm[i - 1], place_mm - places_mm[i - 1]);
        let value = values[i - 1] + (values[i] - values[i - 1]) * along / length;
        areas[i - 1] + 0.5 * (values[i - 1] + value) * along
    };
    let (first, last) = (places_mm[0], places_mm[places_mm.len() - 1]);
    let mean = |(&place, &value): (&f64, &f64)| {
        let half = (0.5 * window_mm).min(place - first).min(last - place);
        if half > 0.0 { (area(place + half) - area(place - half)) / (2.0 * half) } else { value }
    };
    places_mm.iter().zip(values).map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_keep_straight_lines_and_even_out_what_is_narrower_than_the_window() {
        let places: Vec<f64> = (0..101).map(|i| 0.01 * f64::from(i) + 0.001 * f64::from(i % 3)).collect();
        let line: Vec<f64> = places.iter().map(|x| 3.0 * x - 1.0).collect();
        for (mean, value) in means(&places, &line, 0.08).iter().zip(&line) {
            assert!((mean - value).abs() < 1e-12);
        }
        // Teeth of 0.02 mm, 1 high: their mean over whole teeth is a half, wherever the window lies.
        let even: Vec<f64> = (0..101).map(|i| 0.01 * f64::from(i)).collect();
        let teeth: Vec<f64> = (0..101).map(|i| f64::from(i % 2)).collect();
        assert!(means(&even, &teeth, 0.08)[4..97].iter().all(|mean| (mean - 0.5).abs() < 1e-9));
        assert_eq!(means(&even, &teeth, 0.0), teeth);
    }
}
