//! Difference maps: deviations and allowances of a later result less those of the first, all flanks on one sheet.
//!
//! In: `deviation/*.exr` and `allowance/*.exr` of two folders. Out: `difference_<map>_<letter>_minus_a.png`. Flanks
//! that only one of them has, or that lie on other grids, have no difference and are left out; without any there is
//! no sheet. One scale for all flanks, whose ends are a micrometre at least: on a finer one equal gears would look
//! apart. What shows no colour on it is said in a sentence instead: two linkages leave the same flanks and another
//! allowance.

use super::{Comparison, letters};
use crate::colormap::ColourScale;
use crate::findings::unit::sentence_with_signs;
use crate::number_text::significant;
use crate::output::atomic::file_error;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::folder::OutputFolder;
use crate::output::grid::MapGrid;
use crate::output::surface_files::read_surface;
use crate::overlay::grid_of;
use gearcut_core::error::{Error, Result};
use std::collections::BTreeSet;
use std::path::Path;

/// Folders of the maps in a result, and what their values are.
const FOLDERS: [(&str, &str); 2] =
    [("deviation", "mean normal deviations of cells"), ("allowance", "normal stock before the last operation")];
/// Ends of the scale, um, where differences are smaller.
const LEAST_UM: f32 = 1.0;
/// Differences up to this are no matter, um: a twentieth of the finest scale has no colour that anybody sees.
const EQUAL_UM: f32 = 0.05 * LEAST_UM;

/// Difference of a flank.
struct DifferenceMap {
    label: String,
    grid: MapGrid,
    values_um: Vec<f32>,
}

/// A sheet as it was written.
pub(super) struct MapSheet {
    /// What it shows.
    pub title: String,
    /// The picture; none where there is nothing to see.
    pub png: Option<Vec<u8>>,
}

impl Comparison {
    /// Writes a sheet for every result after the first, and gives it back for the page.
    ///
    /// # Errors
    /// Maps that cannot be read, and sheets that cannot be written.
    pub(super) fn write_maps(&self, folder: &OutputFolder) -> Result<Vec<MapSheet>> {
        let mut sheets = Vec::new();
        let (first, others) = self.results.split_first().expect("two or more");
        let of_others = others.iter().zip(letters().skip(1));
        for ((other, letter), (name, values)) in of_others.flat_map(|of| FOLDERS.map(|folder| (of, folder))) {
            let maps = differences(&first.folder.join(name), &other.folder.join(name))?;
            if maps.is_empty() {
                continue;
            }
            let title = format!("{name} of {} less that of {}, all flanks", other.name, first.name);
            let all_um = maps.iter().flat_map(|map| &map.values_um).filter(|um| um.is_finite());
            let largest_um = all_um.fold(0.0, |most: f32, um| most.max(um.abs()));
            if largest_um <= EQUAL_UM {
                let equal = if largest_um > 0.0 {
                    format!("{title}: nothing above {} um", significant(largest_um.into(), 2))
                } else {
                    format!("{title}: none")
                };
                sheets.push(MapSheet { title: sentence_with_signs(&equal), png: None });
                continue;
            }
            let scale = match ColourScale::diverging_over(maps.iter().map(|map| map.values_um.as_slice())) {
                ColourScale::Diverging { limit } => ColourScale::Diverging { limit: limit.max(LEAST_UM) },
                scale @ ColourScale::Sequential { .. } => scale,
            };
            let thumbnails: Vec<Thumbnail> = maps
                .iter()
                .map(|map| Thumbnail { label: &map.label, grid: &map.grid, values: &map.values_um })
                .collect();
            let sheet = ContactSheet {
                title: &title,
                quantity: &format!("difference of {values}"),
                unit: "µm",
                scale,
                missing: "no pass came here in one of them",
                maps: &thumbnails,
            };
            let path = folder.path(format!("difference_{name}_{letter}_minus_a.png"))?;
            write_contact_sheet(&path, &sheet)?;
            let png = std::fs::read(&path).map_err(Error::reading(&path))?;
            sheets.push(MapSheet { title, png: Some(png) });
        }
        Ok(sheets)
    }
}

/// Flanks that both folders have on one grid.
fn differences(first: &Path, other: &Path) -> Result<Vec<DifferenceMap>> {
    let names = names(first)?;
    let shared = names.intersection(&self::names(other)?).cloned().collect::<Vec<_>>();
    let mut maps = Vec::new();
    for name in shared {
        let read = |folder: &Path| read_surface(&folder.join(&name), None).map_err(file_error);
        let [a, b] = [read(first)?.surface, read(other)?.surface];
        let of = |surface: &gearcut_texture::Surface| (surface.nx(), surface.ny(), surface.dx_um(), surface.dy_um());
        if of(&a) != of(&b) {
            continue;
        }
        maps.push(DifferenceMap {
            label: name.trim_end_matches(".exr").trim_start_matches("tooth_").replace('_', " "),
            grid: grid_of(&a, [("u", "along the profile from the form point"), ("v", "along the tooth")]),
            values_um: a.heights_um().iter().zip(b.heights_um()).map(|(a, b)| (b - a) as f32).collect(),
        });
    }
    Ok(maps)
}

/// Names of the maps in a folder; none where it has no such folder.
fn names(folder: &Path) -> Result<BTreeSet<String>> {
    let entries = match std::fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(reason) if reason.kind() == std::io::ErrorKind::NotFound => return Ok(BTreeSet::new()),
        Err(reason) => return Err(Error::reading(folder)(reason)),
    };
    let names = entries.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()));
    let names: std::io::Result<BTreeSet<String>> = names.collect();
    let mut names = names.map_err(Error::reading(folder))?;
    names.retain(|name| Path::new(name).extension().is_some_and(|extension| extension == "exr"));
    Ok(names)
}
