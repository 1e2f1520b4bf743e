//! Influence maps of the dearest errors as pictures: what a unit of each adds to whole flanks.
//!
//! In: a budget. Out: a sheet for each of the first errors, with one scale of colours that is as long below 0 as above,
//! um for one unit of the error; and the same for the page. Errors that do nothing have none.

use super::findings::{FIRST, LEAST_UM, per};
use super::{Budget, BudgetLine};
use crate::colormap::ColourScale;
use crate::findings::unit;
use crate::influence::gear_grid::FlankGrid;
use crate::output::contact_sheet::{ContactSheet, Thumbnail, write_contact_sheet};
use crate::output::folder::OutputFolder;
use crate::output::grid::{MapAxis, MapGrid};
use gearcut_core::error::{Error, Result};
use gearcut_core::terms::Side;

/// A sheet as it was written.
pub(super) struct InfluenceSheet {
    /// What it shows.
    pub title: String,
    /// The picture.
    pub png: Vec<u8>,
}

/// Writes the sheets.
///
/// # Errors
/// Files that cannot be written.
pub(super) fn write(budget: &Budget, folder: &OutputFolder) -> Result<Vec<InfluenceSheet>> {
    let first = budget.lines.iter().take(FIRST).enumerate();
    let drawn = first.filter(|(_, line)| line.largest_per_step_um() >= LEAST_UM);
    drawn.filter_map(|(place, line)| write_sheet(budget, place + 1, line, folder).transpose()).collect()
}

/// `None` where no flank is looked at as a whole.
fn write_sheet(
    budget: &Budget,
    rank: usize,
    line: &BudgetLine,
    folder: &OutputFolder,
) -> Result<Option<InfluenceSheet>> {
    let whole = budget.grid.split(&line.influence.um_per_unit).filter(|(flank, _)| !flank.is_point());
    let maps: Vec<(String, MapGrid, Vec<f32>)> =
        whole.map(|(flank, um)| (label(flank), grid(flank), um.iter().map(|&um| um as f32).collect())).collect();
    if maps.is_empty() {
        return Ok(None);
    }
    let maps: Vec<Thumbnail> = maps.iter().map(|(label, grid, values)| Thumbnail { label, grid, values }).collect();
    let unit = unit::signs(&per(line.influence.parameter.unit));
    let title = format!("{rank}: {}, {unit}", line.influence.parameter.title);
    let sheet = ContactSheet {
        title: &title,
        quantity: "predicted normal deviation for a unit of it",
        unit: &unit,
        scale: ColourScale::diverging_over(maps.iter().map(|map| map.values)),
        missing: "no pass came here",
        maps: &maps,
    };
    let path = folder.path(format!("pictures/influence_{rank}.png"))?;
    write_contact_sheet(&path, &sheet)?;
    let png = std::fs::read(&path).map_err(Error::reading(&path))?;
    Ok(Some(InfluenceSheet { title, png }))
}

fn label(flank: &FlankGrid) -> String {
    format!("{} {}", flank.tooth, if flank.side == Side::Left { "L" } else { "R" })
}

/// The places of a flank, which lie evenly.
fn grid(flank: &FlankGrid) -> MapGrid {
    let axis = |name: &str, meaning: &str, places_mm: &[f64]| MapAxis {
        name: name.to_owned(),
        meaning: meaning.to_owned(),
        start_mm: places_mm[0],
        step_mm: (places_mm[places_mm.len() - 1] - places_mm[0]) / (places_mm.len() - 1) as f64,
        count: places_mm.len(),
    };
    MapGrid {
        u: axis("u", "along the profile from the form point", &flank.arcs_mm),
        v: axis("v", "along the tooth", &flank.faces_mm),
    }
}
