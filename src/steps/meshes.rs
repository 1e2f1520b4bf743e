//! Meshes of a run: one PLY per flank as it is finished, and the whole gear as one closed body in STL, PLY and glTF.

use crate::colormap::ColourScale;
use crate::job::{CylindricalGear, GearJob};
use crate::output::folder::OutputFolder;
use crate::output::mesh_file::MeshFile;
use crate::output::mesh_glb::write_glb;
use crate::output::mesh_ply::write_ply;
use crate::output::mesh_stl::write_stl;
use crate::progress::Progress;
use crate::scene::model::{Picture, PictureColour, PictureView};
use crate::steps::gear_surfaces;
use crate::surface::decimated::decimated;
use crate::surface::gear_solid::gear_solid;
use crate::surface::outline::{BODY_MM, Outline, flank_name};
use crate::surface::{BlankMesh, Mesh, SurfaceGrid};
use gearcut_core::cut::Backend;
use gearcut_core::cut::CutBlank;
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use std::f64::consts::PI;

/// Heights shown beside each other on meshes of gears that were cut in one operation, µm: what a good cut leaves.
const HEIGHT_COLOURS_UM: f32 = 5.0;

/// Rows of a body are drawn where leaving them out moves its surface by more than this share of a pixel.
const PIXEL_SHARE: f64 = 0.1;
/// Width that a picture of a tooth shows, in transverse pitches.
pub const TOOTH_PITCHES: f64 = 3.5;

/// Colours of the stock that the last operation found. Flanks are written as they are cut, before the stock of all is
/// known: on a straight rack a cutter drawn back by d has d sin(alpha) of stock on both flanks, and the colours go from
/// nothing to twice that.
fn stock_scale(job: &dyn GearJob) -> ColourScale {
    let [.., (_, before_mm), (_, last_mm)] = &job.operations()[..] else {
        return ColourScale::Sequential { low: 0.0, high: 1.0 };
    };
    let even_mm = (before_mm - last_mm) * job.scene().gear.transverse_pressure_angle_rad().sin();
    ColourScale::Sequential { low: 0.0, high: 2.0 * even_mm.max(1e-3) as f32 }
}

/// Quantity that vertices are coloured by: the stock where there is one, else the normal deviation; on bodies from rays
/// through the blank the pass.
fn colour(job: &dyn GearJob, mesh: &Mesh) -> (&'static str, ColourScale) {
    if mesh.scalar("height_um").is_none() {
        ("pass_id", ColourScale::Sequential { low: 0.0, high: job.passes() as f32 })
    } else if job.operations().len() > 1 {
        ("stock_mm", stock_scale(job))
    } else {
        ("height_um", ColourScale::Sequential { low: 0.0, high: HEIGHT_COLOURS_UM })
    }
}

/// Writes `mesh/flanks/tooth_07_left.ply`.
///
/// # Errors
/// The file cannot be written.
pub fn write_flank(
    job: &dyn GearJob,
    surface: &SurfaceGrid,
    tooth: u32,
    side: Side,
    folder: &OutputFolder,
) -> Result<()> {
    let name = flank_name(tooth, side);
    let title = format!("{}: tooth {tooth}, {} flank", job.scene().name, side.name());
    let mesh = decimated(&surface.mesh(&name), BODY_MM);
    let file = MeshFile { mesh: &mesh, title: &title, colour: colour(job, &mesh), notes: &[] };
    write_ply(&folder.path(format!("mesh/flanks/{name}.ply"))?, &file)
}

/// How far the rows of a body may be from its surface so that no picture of the gear or of a tooth shows it, mm;
/// nothing where one shows how far the surface is from the target, or the pass that left it, or keeps the numbers
/// behind pixels.
fn rows_within_mm(job: &dyn GearJob) -> Option<f64> {
    let gear = &job.scene().gear;
    let bodies = job.scene().pictures.iter().filter(|picture| picture.view != PictureView::Flank);
    let within_mm = |picture: &Picture| {
        let shows_numbers = picture.exr || matches!(picture.colour, PictureColour::Height | PictureColour::Pass);
        let width_mm = picture.extent_mm.unwrap_or(match picture.view {
            PictureView::Tooth => TOOTH_PITCHES * PI * gear.transverse_module_mm(),
            _ => gear.transverse_module_mm() * f64::from(gear.teeth),
        });
        (!shows_numbers).then(|| PIXEL_SHARE * width_mm / f64::from(picture.size_px.0))
    };
    bodies.map(within_mm).reduce(|a, b| Some(a?.min(b?))).flatten()
}

/// A gear as closed bodies.
pub struct ClosedBodies {
    /// As it is written.
    pub whole: Mesh,
    /// With those rows along the tooth alone that the scene's pictures can show, where these are fewer.
    pub pictured: Option<Mesh>,
}

/// A cylindrical gear as closed bodies; tips are cut here.
///
/// # Errors
/// The backend's; a bore or a rim that reaches the teeth.
pub fn gear(
    job: &dyn CylindricalGear,
    backend: &dyn Backend,
    flanks: Vec<SurfaceGrid>,
    roots: Vec<SurfaceGrid>,
    progress: &Progress,
) -> Result<ClosedBodies> {
    let step = progress.step("tips", u64::from(job.scene().gear.teeth), "teeth");
    let surfaces = gear_surfaces::complete(job, backend, flanks, roots, &|| step.advance(1))?;
    let outline = Outline::new(&surfaces, job.blank(), BODY_MM);
    let whole = gear_solid(&outline, &job.blank().back)?;
    let shown = rows_within_mm(job).map(|within_mm| Outline::new(&surfaces, job.blank(), within_mm));
    let fewer = shown.filter(|shown| shown.rows() < outline.rows());
    let pictured = fewer.map(|shown| gear_solid(&shown, &job.blank().back)).transpose()?;
    step.finish();
    Ok(ClosedBodies { whole, pictured })
}

/// Writes `mesh/blank.ply`: the gear as the rays through the blank have it, whatever its shape, with the pass that left
/// every place.
///
/// # Errors
/// The file cannot be written.
pub fn write_blank(job: &dyn GearJob, cut: &CutBlank, folder: &OutputFolder) -> Result<()> {
    let title = format!("gear of {}, from rays through the blank", job.scene().name);
    let mesh = decimated(&BlankMesh::new(&cut.field, None).mesh, BODY_MM);
    let file = MeshFile { mesh: &mesh, title: &title, colour: colour(job, &mesh), notes: &[] };
    write_ply(&folder.path("mesh/blank.ply")?, &file)
}

/// Writes `mesh/gear.{stl,ply,glb}`; `notes` go into the glTF.
///
/// # Errors
/// Files that cannot be written.
pub fn write_gear(
    job: &dyn GearJob,
    mesh: &Mesh,
    folder: &OutputFolder,
    notes: &[(String, String)],
    progress: &Progress,
) -> Result<()> {
    let step = progress.step("meshes", 3, "files");
    let title = format!("gear of {}", job.scene().name);
    let mesh = &decimated(mesh, BODY_MM);
    let file = MeshFile { mesh, title: &title, colour: colour(job, mesh), notes };
    write_stl(&folder.path("mesh/gear.stl")?, &file)?;
    step.advance(1);
    write_ply(&folder.path("mesh/gear.ply")?, &file)?;
    step.advance(1);
    write_glb(&folder.path("mesh/gear.glb")?, &file)?;
    step.advance(1);
    step.finish();
    Ok(())
}
