//! Inspection figures of a map of heights: what an inspector writes down of a gear that deviates so.
//!
//! In: places on the flanks and a height at each. Out: [`Figures`]. Profile and helix figures are those of ISO 1328-1
//! ([`Trace::deviation`]), the largest over the flanks that are looked at as a whole; pitch is taken where every flank
//! crosses the pitch curve, along it. All of them grow in proportion to the heights, so that figures of an
//! influence map are what a unit of the error alone makes of an ideal gear.

use super::derivative::largest;
use super::gear_grid::{FlankGrid, GearGrid};
use crate::measure::deviation::{PitchDeviations, Trace, TraceDeviation};
use gearcut_core::terms::Side;

/// Figures, in the unit of the heights; NaN where they need flanks that are not looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// Largest height anywhere, without its sign.
    pub largest: f64,
    /// F_alpha, largest.
    pub profile: f64,
    /// f_H_alpha, the one of the largest size.
    pub profile_slope: f64,
    /// F_beta, largest.
    pub helix: f64,
    /// f_H_beta, the one of the largest size.
    pub helix_slope: f64,
    /// f_p, largest size, the worse side.
    pub single_pitch: f64,
    /// F_p, the worse side.
    pub total_pitch: f64,
    /// What the mean tooth becomes thicker.
    pub thickness: f64,
}

impl Figures {
    /// Figures of heights at the places of a grid. Flanks with places that were not cut are left out.
    pub fn new(grid: &GearGrid, heights: &[f64]) -> Self {
        let whole = || grid.split(heights).filter(|(flank, _)| !flank.is_point());
        let profiles: Vec<TraceDeviation> = whole().filter_map(|(flank, of)| profile(flank, of)).collect();
        let helices: Vec<TraceDeviation> = whole().filter_map(|(flank, of)| helix(flank, of)).collect();
        let sides = [Side::Left, Side::Right].map(|side| around(grid, heights, side));
        // Pitch and thickness are those of all teeth.
        let all = sides.iter().all(|around| around.len() == grid.teeth as usize);
        let pitch = sides.each_ref().map(|around| PitchDeviations::of_places(around));
        let of_pitch = |of: fn(&PitchDeviations) -> f64| if all { largest(pitch.iter().map(of)) } else { f64::NAN };
        let thicker: Vec<f64> = sides[0].iter().zip(&sides[1]).map(|(left, right)| left - right).collect();
        Self {
            largest: largest(heights.iter().copied()),
            profile: largest(profiles.iter().map(|of| of.total_mm)),
            profile_slope: of_largest_size(profiles.iter().map(|of| of.slope_mm)),
            helix: largest(helices.iter().map(|of| of.total_mm)),
            helix_slope: of_largest_size(helices.iter().map(|of| of.slope_mm)),
            single_pitch: of_pitch(PitchDeviations::largest_single_mm),
            total_pitch: of_pitch(PitchDeviations::total_mm),
            thickness: if all { thicker.iter().sum::<f64>() / thicker.len() as f64 } else { f64::NAN },
        }
    }
}

/// The profile in the middle of the face; its unit is that of the heights.
fn profile(flank: &FlankGrid, heights: &[f64]) -> Option<TraceDeviation> {
    let middle = flank.faces_mm.len() / 2;
    let heights = (0..flank.arcs_mm.len()).map(|column| heights[flank.index(column, middle)]).collect();
    whole(flank.rolls_mm.clone(), heights)
}

/// The line along the tooth in the middle of the profile.
fn helix(flank: &FlankGrid, heights: &[f64]) -> Option<TraceDeviation> {
    let middle = flank.arcs_mm.len() / 2;
    let heights = (0..flank.faces_mm.len()).map(|row| heights[flank.index(middle, row)]).collect();
    whole(flank.faces_mm.clone(), heights)
}

fn whole(places_mm: Vec<f64>, heights_mm: Vec<f64>) -> Option<TraceDeviation> {
    let ends_mm = [*places_mm.first()?, *places_mm.last()?];
    Trace { places_mm, heights_mm }.deviation(ends_mm)
}

/// How far each flank of a side has moved counter-clockwise where pitch is taken.
fn around(grid: &GearGrid, heights: &[f64], side: Side) -> Vec<f64> {
    let of_side = grid.split(heights).filter(|(flank, _)| flank.side == side && flank.is_point());
    of_side.map(|(flank, of)| of[0] * flank.along_per_height).collect()
}

fn of_largest_size(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |most: f64, value| if value.abs() > most.abs() { value } else { most })
}
