//! Our EXR maps as surfaces: x = v, the fast axis; y = u.
//!
//! Of several channels the one called `height_mm`, else `height_um`, else the first in mm or um is the surface.

use super::bounds::points;
use super::content::{MeasuredContent, MeasuredFile};
use super::exr_map::{self, MapChannel, Samples};
use crate::error::FileFault;
use crate::surface::Surface;
use crate::text::quoted;

/// Micrometres in a millimetre.
const UM_PER_MM: f64 = 1e3;

pub(super) fn decode(bytes: &[u8]) -> Result<MeasuredFile, FileFault> {
    let map = exr_map::decode(bytes)?;
    points(map.grid.v.count, map.grid.u.count)?;
    let is_length = |c: &&MapChannel| ["mm", "um"].contains(&c.unit.as_str());
    let channel = ["height_mm", "height_um"]
        .iter()
        .find_map(|name| map.channels.iter().find(|c| c.name == *name))
        .or_else(|| map.channels.iter().find(is_length))
        .ok_or("no channel of the map is a length in mm or um")?;
    let factor = if channel.unit == "mm" { UM_PER_MM } else { 1.0 };
    let Samples::F32(values) = &channel.samples else {
        return Err(format!("channel {} holds whole numbers, not heights", quoted(&channel.name)).into());
    };
    let heights = values.iter().map(|z| f64::from(*z) * factor).collect();
    let (u, v) = (&map.grid.u, &map.grid.v);
    let surface = Surface::new(v.count, u.count, v.step_mm * UM_PER_MM, u.step_mm * UM_PER_MM, heights)?;
    let mut notes = vec![
        ("frame".to_owned(), map.frame.clone()),
        ("quantity".to_owned(), format!("{}: {}", channel.name, channel.definition)),
    ];
    notes.extend(map.notes);
    Ok(MeasuredFile::new(MeasuredContent::Surface(surface), notes))
}
