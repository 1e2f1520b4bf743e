//! Our EXR maps as surfaces: x = v along the tooth, y = u along the profile.
//!
//! Of several channels the one called `height_mm`, else `height_um`, else the first in mm or um is the surface.

use std::path::Path;

use super::SurfaceFile;
use crate::measure::topography::Surface;
use crate::output::exr_map::{MapChannel, Samples, read_exr_map};
use crate::units::UM_PER_MM;

pub(super) fn decode(path: &Path) -> Result<SurfaceFile, String> {
    let map = read_exr_map(path).map_err(|error| error.to_string())?;
    let is_length = |c: &&MapChannel| ["mm", "um"].contains(&c.unit.as_str());
    let channel = ["height_mm", "height_um"]
        .iter()
        .find_map(|name| map.channels.iter().find(|c| c.name == *name))
        .or_else(|| map.channels.iter().find(is_length))
        .ok_or("no channel of the map is a length in mm or um")?;
    let factor = if channel.unit == "mm" { UM_PER_MM } else { 1.0 };
    let Samples::F32(values) = &channel.samples else {
        return Err(format!("channel {} holds whole numbers, not heights", channel.name));
    };
    let heights = values.iter().map(|z| f64::from(*z) * factor).collect();
    let (u, v) = (&map.grid.u, &map.grid.v);
    let surface = Surface::new(v.count, u.count, v.step_mm * UM_PER_MM, u.step_mm * UM_PER_MM, heights)?;
    let mut notes = vec![
        ("frame".to_owned(), map.frame.clone()),
        ("quantity".to_owned(), format!("{}: {}", channel.name, channel.definition)),
    ];
    notes.extend(map.notes);
    Ok(SurfaceFile { surface, notes })
}
