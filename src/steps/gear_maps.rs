//! Maps of all flanks of a gear, with the colours that they share.
//!
//! Sheets, single maps and the page show the same values: their scales are found once, over all flanks.

use crate::colormap::ColourScale;
use crate::output::flank_maps::FlankMaps;
use gearcut_core::units::UM_PER_MM;

/// Deviations whose colours reach the ends of the scale at least, µm: on a finer scale a perfect gear would look
/// faulty.
const LEAST_DEVIATION_UM: f32 = 1.0;

/// Maps of all finished flanks, in order of teeth, left before right.
#[derive(Debug)]
pub struct GearMaps {
    /// The maps; empty where nothing that is written needs them.
    pub flanks: Vec<FlankMaps>,
    /// Colours of the deviations, µm.
    pub deviation_scale: ColourScale,
    /// Colours of the finished surface's heights, highest of each cell, µm.
    pub height_scale: ColourScale,
}

impl GearMaps {
    /// Finds the colours.
    pub fn new(flanks: Vec<FlankMaps>) -> Self {
        let deviation_scale = match ColourScale::diverging_over(flanks.iter().map(FlankMaps::deviation_mm)) {
            ColourScale::Diverging { limit } => {
                ColourScale::Diverging { limit: (limit * UM_PER_MM as f32).max(LEAST_DEVIATION_UM) }
            }
            scale @ ColourScale::Sequential { .. } => scale,
        };
        let heights_um: Vec<Vec<f32>> = flanks.iter().map(finished_heights_um).collect();
        let height_scale = ColourScale::heights_over(heights_um.iter().map(Vec::as_slice));
        Self { flanks, deviation_scale, height_scale }
    }
}

/// Heights of a flank's finished surface, highest of each cell, µm.
pub fn finished_heights_um(map: &FlankMaps) -> Vec<f32> {
    map.highest_mm.last().map_or_else(Vec::new, |heights| um(heights))
}

/// Lengths in mm as µm.
pub fn um(lengths_mm: &[f32]) -> Vec<f32> {
    lengths_mm.iter().map(|length| length * UM_PER_MM as f32).collect()
}
