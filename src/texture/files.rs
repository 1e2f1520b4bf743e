//! Files and pictures of the windows.

use super::{WindowTexture, chart};
use crate::colormap::ColourScale;
use crate::job::GearJob;
use crate::measure::topography::Surface;
use crate::output::atomic::file_error;
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use crate::output::map_png::{MapPicture, Relief, write_relief_png};
use crate::output::surface_files::{Format, SurfaceFile, write_surface};
use gearcut_core::error::Result;
use gearcut_core::units::UM_PER_MM;
use rayon::prelude::*;

/// What readers of the files need to know about x, y and z.
const FRAME: &str = "x = along the tooth; y = arc length along the target profile of the \
    section in the middle of the face, from its start of the involute towards the tip; z = height over \
    the target flank along its outward normal, positive = material left";

/// Folder of a window's files inside the output, and the stem of their names.
pub fn stem(job: &dyn GearJob, texture: &WindowTexture, index: usize) -> String {
    let operation = job.operations()[texture.operation].0;
    let (tooth, side) = (texture.window.tooth, texture.window.side.name());
    // Windows of a scene may lie on the same flank: their number tells them apart.
    let number = if index == 0 { String::new() } else { format!("_{}", index + 1) };
    format!("texture/{operation}/tooth_{tooth:02}_{side}{number}")
}

/// Stems of all textures, in their order.
pub fn stems(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<String> {
    textures
        .iter()
        .enumerate()
        .map(|(i, texture)| {
            let same = |other: &&WindowTexture| {
                (other.operation, other.window.tooth, other.window.side)
                    == (texture.operation, texture.window.tooth, texture.window.side)
            };
            stem(job, texture, textures[..i].iter().filter(same).count())
        })
        .collect()
}

/// Writes files and pictures of all windows; `notes` are the scene and the run record.
///
/// # Errors
/// Files that cannot be written.
pub fn write(
    job: &dyn GearJob,
    textures: &[WindowTexture],
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    let stems = stems(job, textures);
    textures.par_iter().zip(&stems).try_for_each(|(texture, stem)| write_one(job, texture, stem, folder, notes))
}

fn write_one(
    job: &dyn GearJob,
    texture: &WindowTexture,
    stem: &str,
    folder: &OutputFolder,
    notes: &[(String, String)],
) -> Result<()> {
    let window = &texture.window;
    let operation = job.operations()[texture.operation].0;
    let what = format!("{operation}: tooth {}, {} flank", window.tooth, window.side.name());
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
        ("surface".to_owned(), what.clone()),
    ];
    all.extend_from_slice(notes);
    let file = SurfaceFile { surface: heights.clone(), notes: all };
    for (format, ending) in
        [(Format::X3p, "x3p"), (Format::SdfBinary, "sdf"), (Format::Npy, "npy"), (Format::Csv, "csv")]
    {
        write_surface(&folder.path(format!("{stem}.{ending}"))?, format, &file).map_err(file_error)?;
    }
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
    (grid, surface.centred().heights_um().iter().map(|z| *z as f32).collect())
}
