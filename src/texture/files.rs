//! Files and pictures of the windows.

use super::{Window, WindowTexture, chart, windows};
use crate::colormap::ColourScale;
use crate::job::GearJob;
use crate::measure::topography::Surface;
use crate::output::atomic::file_error;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::map_png::{MapPicture, Relief, write_relief_png};
use crate::output::surface_files::{Format, SurfaceFile, write_surface};
use gearcut_core::error::Result;
use gearcut_core::terms::Side;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;

/// What readers of the files need to know about x, y and z.
const FRAME: &str = "x = along the tooth; y = arc length along the target profile of the \
    section in the middle of the face, from its start of the involute towards the tip; z = height over \
    the target flank along its outward normal, positive = material left";

/// Name of the note that says which surface a file holds.
pub const SURFACE_NOTE: &str = "surface";

/// What of a window names its files and its section: operation, tooth, flank.
pub(super) type Named = (usize, u32, Side);

/// Folders inside the output with the stems of the names of files, of windows after operations in their order.
pub(super) fn stems_of(job: &dyn GearJob, named: &[Named]) -> Vec<String> {
    let operations = job.operations();
    let stem = |(i, (operation, tooth, side)): (usize, &Named)| {
        let index = named[..i].iter().filter(|other| **other == named[i]).count();
        // Windows of a scene may lie on the same flank: their number tells them apart.
        let number = if index == 0 { String::new() } else { format!("_{}", index + 1) };
        format!("texture/{}/tooth_{tooth:02}_{}{number}", operations[*operation].0, side.name())
    };
    named.iter().enumerate().map(stem).collect()
}

/// What names the files of a window.
pub(super) fn named(window: &Window) -> Named {
    (window.operation, window.tooth, window.side)
}

/// Stems of all textures, in their order.
pub fn stems(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<String> {
    stems_of(job, &textures.iter().map(|texture| named(&texture.window)).collect::<Vec<_>>())
}

/// A window by the names that its results have.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedWindow {
    /// The window.
    pub window: Window,
    /// Path of its section in the findings.
    pub path: String,
    /// What its files call it.
    pub words: String,
}

/// All windows, nothing cut.
///
/// # Errors
/// As for [`windows`].
pub fn named_windows(job: &dyn GearJob) -> Result<Vec<NamedWindow>> {
    let windows = windows(job)?;
    let stems = stems_of(job, &windows.iter().map(named).collect::<Vec<_>>());
    let named = windows.into_iter().zip(stems).map(|(window, stem)| NamedWindow {
        path: stem.replace('/', "."),
        words: words(job, &window),
        window,
    });
    Ok(named.collect())
}

/// What files say of their surface.
pub(super) fn words(job: &dyn GearJob, window: &Window) -> String {
    format!("{}: tooth {}, {} flank", job.operations()[window.operation].0, window.tooth, window.side.name())
}

/// Writes files and pictures of all windows; `notes` are the scene and the run record.
///
/// # Errors
/// Files that cannot be written.
pub(super) fn write(
    job: &dyn GearJob,
    textures: &[WindowTexture],
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    let stems = stems(job, textures);
    textures.par_iter().zip(&stems).try_for_each(|(texture, stem)| write_one(job, texture, stem, folder, notes))?;
    (0..job.operations().len()).try_for_each(|index| write_tiles(job, textures, index, folder))
}

/// Name of the picture that has all windows of an operation.
pub fn sheet_file(operation: &str) -> String {
    format!("texture/{operation}_windows.png")
}

/// All windows of an operation as tiles of one sheet, on one scale; nothing where none was evaluated.
fn write_tiles(job: &dyn GearJob, textures: &[WindowTexture], index: usize, folder: &OutputFolder) -> Result<()> {
    let operation = job.operations()[index].0;
    let evaluated = textures.iter().filter(|texture| texture.window.operation == index).filter_map(|texture| {
        let surface = &texture.evaluated.as_ref().ok()?.surface;
        let label = format!("{} {}", texture.window.tooth, texture.window.side.name());
        Some((label, picture_of(texture, surface)))
    });
    let tiles: Vec<(String, (MapGrid, Vec<f32>))> = evaluated.collect();
    let maps: Vec<Thumbnail> = tiles.iter().map(|(label, (grid, values))| Thumbnail { label, grid, values }).collect();
    if maps.is_empty() {
        return Ok(());
    }
    let sheet = ContactSheet {
        title: &format!("{}: texture windows after {operation}, after their chain", job.scene().name),
        quantity: "height about the mean",
        unit: "µm",
        scale: ColourScale::sequential_over(maps.iter().map(|map| map.values)),
        missing: "no surface here",
        maps: &maps,
    };
    write_contact_sheet(&folder.path(sheet_file(operation))?, &sheet)
}

fn write_one(
    job: &dyn GearJob,
    texture: &WindowTexture,
    stem: &str,
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    let window = &texture.window;
    let what = words(job, window);
    let Some(heights) = &texture.heights else { return Ok(()) };
    let [x, y] = window.start_mm;
    let mut all = vec![
        (
            "frame".to_owned(),
            format!(
                "{FRAME}; first point at x = {x} mm from the middle of the face, y = {y} mm from the start of the \
                involute"
            ),
        ),
        (SURFACE_NOTE.to_owned(), what.clone()),
    ];
    all.extend_from_slice(notes);
    let file = SurfaceFile { surface: heights.clone(), notes: all };
    // One file for all programs; `gearcut texture ... --save` makes the other formats of it.
    write_surface(&folder.path(format!("{stem}.x3p"))?, Format::X3p, &file).map_err(file_error)?;
    let Ok(evaluated) = &texture.evaluated else { return Ok(()) };
    let title = format!("{what}, {}", evaluated.chain.join(", "));
    let (grid, values) = picture_of(texture, &evaluated.surface);
    let picture = MapPicture {
        missing: "no surface here",
        title: &title,
        quantity: "height after the chain",
        unit: "µm",
        grid: &grid,
        values: &values,
        scale: ColourScale::sequential_over([values.as_slice()]),
    };
    let relief = Relief::of(&grid, &values, 1.0 / UM_PER_MM);
    write_relief_png(&folder.path(format!("{stem}_relief.png"))?, &picture, &relief)?;
    let chart =
        chart::abbott(format!("Material ratio of {what}"), &evaluated.evaluation.curve, &evaluated.evaluation.core);
    chart.write_svg(&folder.path(format!("{stem}_abbott.svg"))?)
}

/// Grid and values of a window's picture.
fn picture_of(texture: &WindowTexture, surface: &Surface) -> (MapGrid, Vec<f32>) {
    let window = &texture.window;
    let axis = |name: &str, meaning: &str, k: usize, count: usize| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm: window.start_mm[k],
        step_mm: window.spacing_mm()[k],
        count,
    };
    let grid = MapGrid {
        u: axis("u", "along the profile from the form point", 1, surface.ny()),
        v: axis("v", "along the tooth from the middle of the face", 0, surface.nx()),
    };
    let mean_um = surface.mean_um();
    (grid, surface.heights_um().iter().map(|z| (z - mean_um) as f32).collect())
}
