//! Pictures of a run: the gear, a tooth, a flank under raking light, as the scene lists them.
//!
//! In: the gear's closed body, which is written as mesh too; flanks as [`flank::shown`] kept them when they were cut.
//! Out: `pictures/`. Where a gear has no closed body, its flanks are drawn all the same.

pub mod flank;

use super::Tools;
use super::attempts::Attempts;
use super::meshes::TOOTH_PITCHES;
use crate::colormap::ColourScale;
use crate::interrupt::Interrupt;
use crate::job::GearJob;
use crate::output::atomic::file_error;
use crate::output::exr_map::{ExrMap, MapChannel, Samples, write_exr_map};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::render_png::{Legend, RenderPicture, write_render_png};
use crate::scene::model::{Picture, PictureColour, PictureView};
use crate::surface::Mesh;
use crate::surface::mesh::ScalarValues;
use crate::surface::render::{Appearance, Bodies, CLAY, Camera, Lights, Rendered, Seen, Shape, render, seen};
use flank::{PicturedFlanks, draw_flank};
use gearcut_core::dexel::NO_PASS;
use gearcut_core::error::{Error, Result};
use glam::DVec3;
use std::f64::consts::PI;

/// Colours run between these quantiles of the values; what lies beyond is marked at the colour bar.
const SHOWN: [f64; 2] = [0.01, 0.98];
/// Draws all pictures of the scene into `pictures/`, those of the gear and of teeth where there is a `solid`; how many
/// were finished, failed, or had nothing to show, before Ctrl-C.
///
/// # Errors
/// A device that failed where the user wants the run to stop.
pub fn draw(
    job: &dyn GearJob,
    solid: Option<&Mesh>,
    (flanks, stock_scale): (&PicturedFlanks, Option<ColourScale>),
    tools: &Tools,
    attempts: &mut Attempts,
) -> Result<usize> {
    let Tools { progress, interrupt, folder, notes, .. } = *tools;
    let pictures = &job.scene().pictures;
    if pictures.is_empty() {
        return Ok(0);
    }
    let step = progress.step("pictures", pictures.len() as u64, "pictures");
    // Made ready for the first picture that shows it, then shared.
    let mut shape: Option<Shape> = None;
    for (index, picture) in pictures.iter().enumerate() {
        let drawn = match (picture.view, solid) {
            (PictureView::Gear | PictureView::Tooth, Some(solid)) => {
                let shape = shape.get_or_insert_with(|| Shape::new(vec![solid]));
                let look = look(picture.colour, solid, stock_scale);
                Some(draw_solid(job, picture, (solid, shape), look, interrupt))
            }
            (PictureView::Gear | PictureView::Tooth, None) => None,
            (PictureView::Flank, _) => {
                flanks.get(&index).map(|grid| draw_flank(job, picture, grid, stock_scale, interrupt))
            }
        };
        let written = match drawn {
            Some(Ok(drawn)) => drawn.write(picture, folder, notes),
            Some(Err(Error::Interrupted)) => return Ok(index),
            Some(Err(other)) => Err(other),
            None => Ok(()),
        };
        attempts.of(&format!("picture {}", picture.name), written)?;
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
    /// For the picture's EXR, where the scene asks for one.
    seen: Option<Seen>,
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
        if let Some(seen) = &self.seen {
            let map = exr(seen, self.legend, pixel_mm, &self.title, notes);
            write_exr_map(&folder.path(format!("pictures/{}.exr", picture.name))?, &map).map_err(file_error)?;
        }
        Ok(())
    }
}

/// Colours of a mesh and what they show.
type Look = (Appearance, Option<Legend<'static>>);

/// What colours show on a mesh, the stock in the colours of its maps; nothing where it has no such quantity.
fn look(colour: PictureColour, mesh: &Mesh, stock_scale: Option<ColourScale>) -> Look {
    let (name, quantity, unit) = match colour {
        PictureColour::Clay => return (CLAY, None),
        PictureColour::Stock => ("stock_mm", "normal stock before the last operation", "mm"),
        PictureColour::Height => ("height_um", "normal deviation", "µm"),
        PictureColour::Pass => ("pass_id", "pass that left the surface, counted in time", "1"),
    };
    let Some(scalar) = mesh.scalar(name) else { return (CLAY, None) };
    let scale = match (colour, &scalar.values) {
        (PictureColour::Stock, _) => match stock_scale {
            Some(scale) => scale,
            None => return (CLAY, None),
        },
        (_, ScalarValues::F32(values)) => ColourScale::between_quantiles([values.as_slice()], SHOWN),
        (_, ScalarValues::U32(values)) => {
            let cut: Vec<f32> = values.iter().filter(|&&v| v != NO_PASS).map(|&v| v as f32).collect();
            ColourScale::sequential_over([cut.as_slice()])
        }
    };
    (Appearance::Scalar { name, scale }, Some(Legend { quantity, unit, scale }))
}

fn draw_solid(
    job: &dyn GearJob,
    picture: &Picture,
    (solid, shape): (&Mesh, &Shape),
    (look, legend): Look,
    interrupt: &Interrupt,
) -> Result<DrawnPicture> {
    let (mut camera, title) = match picture.view {
        PictureView::Tooth => {
            let pitch_mm = PI * job.scene().gear.transverse_module_mm();
            let frame = job.tooth_frame(picture.tooth);
            let towards = Camera::direction(frame.front, frame.left, picture.azimuth_rad, picture.elevation_rad);
            // The near end of the tooth is what the viewer looks at.
            let near_mm = 0.5 * job.scene().gear.face_width_mm * picture.elevation_rad.signum();
            let target_mm = frame.place_mm + (near_mm - pitch_mm * picture.elevation_rad.signum()) * frame.along;
            let camera = Camera::new(target_mm, towards, frame.along, TOOTH_PITCHES * pitch_mm, picture.size_px);
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
    let seen = picture.exr.then(|| seen(&bodies, &camera, interrupt)).transpose()?;
    Ok(DrawnPicture { title, note: String::new(), camera, rendered, seen, legend })
}

fn exr(seen: &Seen, legend: Option<Legend>, pixel_mm: f64, title: &str, notes: &[(String, String)]) -> ExrMap {
    let axis = |name: &str, meaning: &str, count: u32| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm: -0.5 * pixel_mm * f64::from(count - 1),
        step_mm: pixel_mm,
        count: count as usize,
    };
    let (width, height) = seen.size_px;
    let channel = |name: &str, unit: &str, definition: &str, samples: Samples| MapChannel {
        name: name.to_owned(),
        unit: unit.to_owned(),
        definition: definition.to_owned(),
        samples,
    };
    let normal = |k: usize| Samples::F32(seen.normal.iter().map(|n| n[k]).collect());
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
                "distance behind the plane through the picture's target; infinite where there is no surface",
                Samples::F32(seen.depth_mm.clone()),
            ),
            channel("normal_x", "1", "unit normal towards the viewer; zero where there is no surface", normal(0)),
            channel("normal_y", "1", "unit normal towards the viewer; zero where there is no surface", normal(1)),
            channel("normal_z", "1", "unit normal towards the viewer; zero where there is no surface", normal(2)),
            channel(
                "pass_id",
                "1",
                "pass that left the surface; 4294967295 where none is known",
                Samples::U32(seen.pass.clone()),
            ),
            channel("value", value_unit, value_words, Samples::F32(seen.value.clone())),
        ],
        notes,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::surface::mesh::Scalar;

    /// A fillet 1.4 mm deep beside flanks with 0.2 mm of stock takes no colours from these.
    #[test]
    fn stock_is_drawn_in_the_colours_of_its_maps() {
        let values = ScalarValues::F32(vec![0.19, 0.21, 1.4]);
        let stock = Scalar { name: "stock_mm", unit: "mm", definition: String::new(), values };
        let mesh = Mesh { scalars: vec![stock], ..Mesh::default() };
        let of_maps = ColourScale::Sequential { low: 0.19, high: 0.21 };
        let (look, legend) = look(PictureColour::Stock, &mesh, Some(of_maps));
        assert_eq!(legend.map(|legend| legend.scale), Some(of_maps));
        assert!(matches!(look, Appearance::Scalar { scale, .. } if scale == of_maps));
    }
}
