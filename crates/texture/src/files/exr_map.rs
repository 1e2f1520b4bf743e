//! Maps as 32-bit OpenEXR: lengths to a nanometre, named channels, and a header that explains them.
//!
//! In: a grid, channels of f32 or u32 with unit and definition, the frame, and notes such as the scene and the run
//! record. Out: one scan-line EXR with lossless ZIP compression, row = u (first row = first u), column = v; and back
//! again.
//!
//! Header attributes: `program`, `frame`; per axis `u.name`, `u.meaning`, `u.start_mm`, `u.step_mm` and the same for v;
//! per channel `channel.<name>.unit` and `.definition`; every note under its own name. Texts are UTF-8. The same map
//! gives the same bytes.
//!
//! Road not taken: one EXR with a layer per surface. A viewer would open 84 layers to show one, and a run could not
//! write one and forget it before the next.

#[cfg_attr(target_family = "wasm", path = "exr_map/absent.rs")]
mod codec;

use super::kind::FileKind;
use std::path::Path;

use super::bounds::{self, MOST_BYTES_OF_MAPS, unreadable};
use super::grid::MapGrid;
use crate::atomic::write_bytes_atomically;
use crate::{Error, Result};
pub(super) use codec::decode;

/// Values of one channel, in the grid's order.
#[derive(Debug, Clone, PartialEq)]
pub enum Samples {
    /// Measured values; NaN where there is none.
    F32(Vec<f32>),
    /// Identifiers and counts.
    U32(Vec<u32>),
}

/// One named channel of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapChannel {
    /// Name with the unit as suffix where there is one, such as `height_mm`.
    pub name: String,
    /// Unit, such as `mm`; `1` for identifiers and counts.
    pub unit: String,
    /// What the values are, in a sentence.
    pub definition: String,
    /// The values.
    pub samples: Samples,
}

impl MapChannel {
    /// Lengths in mm; NaN where there is none. Below 16 mm they are rounded to whole 2^-20 mm (0.95 nm): f32 has
    /// further digits there, which mean nothing and are two thirds of a packed file.
    pub fn lengths_mm(name: &str, definition: &str, values: &[f32]) -> Self {
        Self::rounded_mm(name, definition, values, (1 << 20) as f32)
    }

    /// Lengths in mm that are not known to a nanometre, such as the thickness of a chip: as [`Self::lengths_mm`], in
    /// whole 2^-17 mm (7.6 nm).
    pub fn coarse_lengths_mm(name: &str, definition: &str, values: &[f32]) -> Self {
        Self::rounded_mm(name, definition, values, (1 << 17) as f32)
    }

    fn rounded_mm(name: &str, definition: &str, values: &[f32], per_mm: f32) -> Self {
        let rounded = |&mm: &f32| if mm.abs() < 16.0 { (mm * per_mm).round_ties_even() / per_mm } else { mm };
        Self {
            name: name.to_owned(),
            unit: "mm".to_owned(),
            definition: definition.to_owned(),
            samples: Samples::F32(values.iter().map(rounded).collect()),
        }
    }
}

/// A map with everything needed to understand it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExrMap {
    /// Where the values lie.
    pub grid: MapGrid,
    /// Frame that u and v are measured in, in a sentence.
    pub frame: String,
    /// Channels, sorted by name (the format asks for it).
    pub channels: Vec<MapChannel>,
    /// Further header texts by name, sorted by name: `scene`, `run` and the like.
    pub notes: Vec<(String, String)>,
}

/// Writes a map.
///
/// # Errors
/// Values that do not fill the grid, no channels, header names used twice, and files that cannot be written.
pub fn write_exr_map(path: &Path, map: &ExrMap) -> Result<()> {
    let bytes = codec::encode(map).map_err(|fault| Error::Unwritable { path: path.to_owned(), fault })?;
    write_bytes_atomically(path, &bytes)
}

/// Reads a map that [`write_exr_map`] wrote.
///
/// # Errors
/// Files that cannot be read, are damaged, or were written by another program.
pub fn read_exr_map(path: &Path) -> Result<ExrMap> {
    let ((), bytes) = bounds::read(path, |_| Ok(((), MOST_BYTES_OF_MAPS)))?;
    decode(&bytes).map_err(unreadable(path, Some(FileKind::Exr.name())))
}
