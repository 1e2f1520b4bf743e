//! Pictures of a run: the gear, a tooth, a flank under raking light, as the scene lists them.
//!
//! Gear and teeth are drawn from the closed body that is written as mesh. A flank is cut again, at the spacing of its
//! dexels and only as wide as the picture, whose edges lie between the rows of the flank's own field; that field is
//! gone by then, and as large as a thousand pictures. The flank is rolled out flat, so that the normal deviation
//! is all that is left of its shape, and light from the tip grazes every feed mark alike. The factor on its heights
//! stands in the picture.

use super::meshes::stock_scale;
use crate::colormap::ColourScale;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::atomic::file_error;
use crate::output::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::progress::Progress;
use crate::output::render_png::{Legend, RenderPicture, write_render_png};
use crate::scene::model::{Picture, PictureColour, PictureView};
use crate::surface::mesh::ScalarValues;
use crate::surface::render::{Bodies, CLAY, Camera, Lights, Look, Rendered, Shape, render};
use crate::surface::{Mesh, SurfaceGrid};
use gearcut_core::cut::Backend;
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use glam::DVec3;
use std::f64::consts::PI;

/// Colours run between these quantiles of the values; what lies beyond is marked at the colour bar.
const SHOWN: [f64; 2] = [0.01, 0.98];
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

/// Draws all pictures of the scene into `pictures/`; how many were finished before Ctrl-C.
///
/// # Errors
/// The backend's; files that cannot be written.
pub fn draw(
    job: &dyn GearJob,
    backend: &dyn Backend,
    solid: &Mesh,
    progress: &Progress,
    interrupt: &Interrupt,
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<usize> {
    let pictures = &job.scene().pictures;
    if pictures.is_empty() {
        return Ok(0);
    }
    let step = progress.step("pictures", pictures.len() as u64, "pictures");
    // Made ready for the first picture that shows it, then shared.
    let mut shape: Option<Shape> = None;
    for (done, picture) in pictures.iter().enumerate() {
        let drawn = match picture.view {
            PictureView::Gear | PictureView::Tooth => {
                let shape = shape.get_or_insert_with(|| Shape::new(vec![solid]));
                draw_solid(job, picture, (solid, shape), interrupt)
            }
            PictureView::Flank => draw_flank(job, backend, picture, interrupt),
        };
        match drawn {
            Ok(drawn) => drawn.write(picture, folder, notes)?,
            Err(Error::Interrupted) => return Ok(done),
            Err(other) => return Err(other),
        }
        step.advance(1);
    }
    step.finish();
    Ok(pictures.len())
}

/// A picture, drawn.
struct DrawnPicture {
    title: String,
    note: String,
    camera: Camera,
    rendered: Rendered,
    legend: Option<Legend<'static>>,
}

impl DrawnPicture {
    fn write(&self, picture: &Picture, folder: &OutputFolder, notes: &[(String, String)]) -> Result<()> {
        let pixel_mm = self.camera.pixel_mm();
        let page = RenderPicture {
            title: &self.title,
            note: &self.note,
            rendered: &self.rendered,
            pixel_mm,
            legend: self.legend,
        };
        write_render_png(&folder.path(format!("pictures/{}.png", picture.name))?, &page)?;
        if picture.exr {
            let map = exr(&self.rendered, self.legend, pixel_mm, &self.title, notes);
            write_exr_map(&folder.path(format!("pictures/{}.exr", picture.name))?, &map).map_err(file_error)?;
        }
        Ok(())
    }
}

/// What colours show on a mesh.
fn look(job: &dyn GearJob, colour: PictureColour, mesh: &Mesh) -> (Look, Option<Legend<'static>>) {
    let (name, quantity, unit) = match colour {
        PictureColour::Clay => return (CLAY, None),
        PictureColour::Stock => ("stock_mm", "normal stock before the last operation", "mm"),
        PictureColour::Height => ("height_um", "normal deviation", "µm"),
        PictureColour::Pass => ("pass_id", "pass that left the surface, counted in time", "1"),
    };
    let scale = match (colour, mesh.scalar(name).map(|scalar| &scalar.values)) {
        (PictureColour::Stock, _) => stock_scale(job),
        (_, Some(ScalarValues::F32(values))) => ColourScale::between_quantiles([values.as_slice()], SHOWN),
        (_, Some(ScalarValues::U32(values))) => {
            let cut: Vec<f32> = values.iter().filter(|&&v| v != NO_PASS).map(|&v| v as f32).collect();
            ColourScale::sequential_over([cut.as_slice()])
        }
        (_, None) => ColourScale::Sequential { low: 0.0, high: 1.0 },
    };
    (Look::Scalar { name, scale }, Some(Legend { quantity, unit, scale }))
}

fn draw_solid(
    job: &dyn GearJob,
    picture: &Picture,
    (solid, shape): (&Mesh, &Shape),
    interrupt: &Interrupt,
) -> Result<DrawnPicture> {
    let (look, legend) = look(job, picture.colour, solid);
    let (mut camera, title) = match picture.view {
        PictureView::Tooth => {
            let pitch_mm = PI * job.scene().gear.transverse_module_mm();
            let frame = job.tooth_frame(picture.tooth);
            let towards = Camera::direction(frame.front, frame.left, picture.azimuth_rad, picture.elevation_rad);
            // The near end of the tooth is what the viewer looks at.
            let near_mm = 0.5 * job.scene().gear.face_width_mm * picture.elevation_rad.signum();
            let target_mm = frame.place_mm + (near_mm - pitch_mm * picture.elevation_rad.signum()) * frame.along;
            let camera = Camera::new(target_mm, towards, frame.along, 3.5 * pitch_mm, picture.size_px);
            (camera, format!("{}: tooth {}", job.scene().name, picture.tooth))
        }
        _ => {
            let towards = Camera::direction(DVec3::X, DVec3::Y, picture.azimuth_rad, picture.elevation_rad);
            let camera = Camera::new(DVec3::ZERO, towards, DVec3::Z, 1.0, picture.size_px).fitted(&solid.positions_mm);
            (
                camera,
                format!(
                    "{}: gear of {} teeth, module {} mm",
                    job.scene().name,
                    job.scene().gear.teeth,
                    job.scene().gear.module_mm
                ),
            )
        }
    };
    if let Some(extent_mm) = picture.extent_mm {
        camera.extent_mm = extent_mm;
    }
    let bodies = Bodies::new(shape, vec![look]);
    let rendered = render(&bodies, &camera, &Lights::studio(&camera), interrupt)?;
    Ok(DrawnPicture { title, note: String::new(), camera, rendered, legend })
}

fn draw_flank(
    job: &dyn GearJob,
    backend: &dyn Backend,
    picture: &Picture,
    interrupt: &Interrupt,
) -> Result<DrawnPicture> {
    let profile_mm = job.profile_length_mm(picture.tooth, picture.side)?;
    let extent_mm = picture.extent_mm.unwrap_or(0.6 * profile_mm);
    let reach_mm = (0.5 * extent_mm).min(0.5 * job.scene().gear.face_width_mm);
    let grid = job.flank_surface(backend, picture.tooth, picture.side, reach_mm)?;
    let exaggeration = picture.exaggeration.unwrap_or_else(|| exaggeration(&grid));
    let pixel_mm = 1.04 * extent_mm / f64::from(picture.size_px.0);
    let flat = rolled_out(&grid, exaggeration, SHOWN_PX * pixel_mm);
    let (look, legend) = look(job, picture.colour, &flat);
    let towards = Camera::direction(DVec3::NEG_Y, DVec3::X, picture.azimuth_rad, picture.elevation_rad);
    let middle_mm = DVec3::new(0.0, 0.5 * profile_mm, 0.0);
    let camera = Camera::new(middle_mm, towards, DVec3::Y, 1.04 * extent_mm, picture.size_px);
    let shape = Shape::new(vec![&flat]);
    let bodies = Bodies::new(&shape, vec![look]);
    let lamp = DVec3::new(0.0, RAKING_RAD.cos(), RAKING_RAD.sin());
    let gain = RAKING_LIGHT / RAKING_RAD.sin();
    let lights = Lights { lamp, lamp_share: RAKING_SHARE, sky_reach: RAKING_SKY_REACH, gain };
    let rendered = render(&bodies, &camera, &lights, interrupt)?;
    let side = if picture.side == Side::Left { "left" } else { "right" };
    let finishing = job.operations().last().map_or("", |(name, _)| *name);
    let title = format!("{}: tooth {}, {side} flank after {finishing}", job.scene().name, picture.tooth);
    let note = format!(
        "profile rolled out, root below, tip above; heights \u{d7} {exaggeration}, means over two pixels; light from \
        the tip"
    );
    Ok(DrawnPicture { title, note, camera, rendered, legend })
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

fn exr(rendered: &Rendered, legend: Option<Legend>, pixel_mm: f64, title: &str, notes: &[(String, String)]) -> ExrMap {
    let axis = |name: &str, meaning: &str, count: u32| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm: -0.5 * pixel_mm * f64::from(count - 1),
        step_mm: pixel_mm,
        count: count as usize,
    };
    let (width, height) = rendered.size_px;
    let channel = |name: &str, unit: &str, definition: &str, samples: Samples| MapChannel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        definition: definition.to_owned(),
        samples,
    };
    let normal = |k: usize| Samples::F32(rendered.normal.iter().map(|n| n[k]).collect());
    let (value_unit, value_words) = legend.map_or(("1", "nothing"), |l| (l.unit, l.quantity));
    let mut notes = notes.to_vec();
    notes.push(("title".to_owned(), title.to_owned()));
    notes.sort();
    ExrMap {
        grid: MapGrid { u: axis("y", "down the picture from its middle", height), v: axis("x", "to the right", width) },
        frame: "picture plane of a parallel projection, mm at the object; normals in the frame of what is drawn"
            .to_owned(),
        channels: vec![
            channel(
                "depth_mm",
                "mm",
                "distance behind the plane through the picture's target; infinite where nothing stands",
                Samples::F32(rendered.depth_mm.clone()),
            ),
            channel("normal_x", "1", "unit normal towards the viewer; zero where nothing stands", normal(0)),
            channel("normal_y", "1", "unit normal towards the viewer; zero where nothing stands", normal(1)),
            channel("normal_z", "1", "unit normal towards the viewer; zero where nothing stands", normal(2)),
            channel(
                "pass_id",
                "1",
                "pass that left the surface; 4294967295 where none is known",
                Samples::U32(rendered.pass.clone()),
            ),
            channel("value", value_unit, value_words, Samples::F32(rendered.value.clone())),
        ],
        notes,
    }
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
