//! The printed report: the page, with the fields of the scene's `[report]` at its head.
//!
//! In: the page, the scene, the inspector's sheet. Out: `report.pdf`. The drawn gear is the first picture of a whole
//! gear that the folder holds. The date is the scene's own and no clock is read, so that this file has the same bytes
//! for the same scene, as every other has.

use crate::output::report::PAPER_FILE;
use crate::output::report::Page;
use crate::output::report::paper::{PaperHead, PaperParts};
use crate::output::vector_page::{A4_PT, LETTER_PT, VectorPage, write_pdf};
use crate::scene::Scene;
use crate::scene::model::PictureView;
use crate::steps::Tools;
use crate::steps::record::sha256_hex;
use crate::steps::report::read_picture;
use gearcut_core::error::{Error, Result};

/// Writes the file.
///
/// # Errors
/// A picture that cannot be read back, a chart that paper cannot show, a file that cannot be written.
pub fn write(page: &Page, scene: &Scene, sheet: Option<VectorPage>, tools: &Tools) -> Result<()> {
    let folder = tools.folder;
    let fields = &scene.report;
    let field = |value: Option<&str>| value.unwrap_or_default().to_owned();
    let drawn = scene.pictures.iter().find(|picture| picture.view == PictureView::Gear);
    let gear = drawn.map(|picture| read_picture(folder, &format!("pictures/{}.png", picture.name))).transpose()?;
    let parts = PaperParts {
        head: PaperHead {
            part: field(fields.part.as_deref().or(Some(&scene.name))),
            drawing: field(fields.drawing.as_deref()),
            customer: field(fields.customer.as_deref()),
            date: field(fields.date.as_deref()),
            scene_sha256: sha256_hex(tools.resolved.as_bytes()),
            size_pt: if fields.us_letter { LETTER_PT } else { A4_PT },
        },
        gear: gear.flatten(),
        inspection: sheet,
    };
    let path = folder.path(PAPER_FILE)?;
    let pages = page.paper(&parts).map_err(|reason| Error::Output { path: path.clone(), reason })?;
    write_pdf(&path, &pages)
}
