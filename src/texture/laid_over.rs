//! A measured surface laid over what was cut in its window.
//!
//! In: a window's heights and its [`MeasuredSurface`]. Out: [`Overlaid`], with what was cut as the first surface:
//! findings, warnings, and maps beside those of the window. x of the file runs along the tooth and y along the profile
//! towards the tip, as in the window's own files; a mirrored one is found, one that is turned has a poor correlation
//! and is warned of.
//!
//! | file | what |
//! | --- | --- |
//! | `tooth_03_left_first.png`, `_second.png` | cut and measured heights on shared points, to one scale |
//! | `tooth_03_left_difference.png`, `.x3p` | measured less cut, levelled |

use super::files::{stems, words};
use super::measured::MeasuredSurface;
use super::{Window, WindowTexture};
use crate::findings::notices::NotLaidOver;
use crate::findings::quantities::surfaces::{CORRELATION, OVERLAY};
use crate::findings::{Notice, Section};
use crate::job::GearJob;
use crate::measure::topography::{Surface, TextureError};
use crate::output::folder::OutputFolder;
use crate::overlay::SurfaceComparison;

/// A measured surface laid over what was cut, or why that cannot be.
pub type Overlaid = Result<SurfaceComparison, TextureError>;

/// `measured` laid over the heights that were cut in its window.
pub(super) fn laid_over(
    job: &dyn GearJob,
    window: &Window,
    measured: &MeasuredSurface,
    cut: Option<&Surface>,
) -> Overlaid {
    let cut = cut.ok_or(TextureError::NothingMeasured)?;
    let path = &measured.path;
    let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
    SurfaceComparison::new([words(job, window), name], [cut, &measured.surface], &window.chain)
}

/// Findings of a window's measured surface.
pub(super) fn section(overlaid: &Overlaid) -> Section {
    match overlaid {
        Ok(comparison) => comparison.section(),
        Err(why) => OVERLAY.section([CORRELATION.none(why.to_string())]),
    }
}

/// What is hardly right about measured surfaces and their windows.
pub(super) fn doubted(job: &dyn GearJob, textures: &[WindowTexture]) -> Vec<Notice> {
    let of_window = |(texture, stem): (&WindowTexture, String)| {
        let name = words(job, &texture.window);
        let section = format!("{}.{}", stem.replace('/', "."), OVERLAY.key);
        let of = format!("measured surface of {name}: ");
        let doubts = match &texture.overlaid {
            None => Vec::new(),
            Some(Ok(comparison)) => comparison.doubts(&of),
            Some(Err(why)) => vec![NotLaidOver { of, why }.notice()],
        };
        doubts.into_iter().map(|doubt| doubt.about(&section)).collect::<Vec<_>>()
    };
    textures.iter().zip(stems(job, textures)).flat_map(of_window).collect()
}

/// Writes the maps of all measured surfaces.
///
/// # Errors
/// Files that cannot be written.
pub(super) fn write(
    job: &dyn GearJob,
    textures: &[WindowTexture],
    folder: &OutputFolder,
) -> gearcut_core::error::Result<()> {
    for (texture, stem) in textures.iter().zip(stems(job, textures)) {
        if let Some(Ok(comparison)) = &texture.overlaid {
            comparison.write_maps(folder, &format!("{stem}_"))?;
        }
    }
    Ok(())
}
