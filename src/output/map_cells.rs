//! Cells of a map: which dexels are theirs, and what is shown of these.
//!
//! In: places of dexels and of the map, layers of dexels. Out: for each cell the dexels that are nearer to its place
//! than to another one, their highest and mean height and their latest pass.
//! One look at every dexel gives all of it: a gear has a hundred million.

use super::grid::MapAxis;
use gearcut_core::dexel::{Layer, NO_PASS};
use std::ops::Range;

/// Dexels of each cell of an axis, and the nearest one: those nearer to its place than to the next one, at least the
/// nearest. In: the axis, and where the dexels stand along it, mm.
pub fn cells_along(axis: &MapAxis, places: &[f64]) -> Vec<(usize, Range<usize>)> {
    (0..axis.count)
        .map(|i| {
            let place_mm = axis.place_mm(i);
            let after = places.partition_point(|&p| p < place_mm);
            let nearest = [after.saturating_sub(1), after.min(places.len() - 1)]
                .into_iter()
                .min_by(|&a, &b| (places[a] - place_mm).abs().total_cmp(&(places[b] - place_mm).abs()))
                .unwrap_or(0);
            let from = places.partition_point(|&p| p < place_mm - 0.5 * axis.step_mm);
            let to = places.partition_point(|&p| p < place_mm + 0.5 * axis.step_mm);
            (nearest, from.min(nearest)..to.max(nearest + 1))
        })
        .collect()
}

/// What a cell of a layer shows, of those of its dexels that a pass has touched; NaN where there is none.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    /// Mean height.
    pub mean_mm: f32,
    /// Largest height.
    pub highest_mm: f32,
    /// Last pass in the order of time. As f32, ids are exact up to 16 million.
    pub latest_pass: f32,
}

impl Cell {
    /// The dexels of some columns, `rows` long each, between two of their rows.
    pub fn of(layer: &Layer, rows: usize, across: &Range<usize>, along: &Range<usize>) -> Self {
        let (mut sum_mm, mut count) = (0.0, 0_u32);
        let (mut highest_mm, mut latest_pass) = (f32::NAN, f32::NAN);
        for column in across.clone() {
            let dexels = column * rows + along.start..column * rows + along.end;
            for (&height_mm, &pass) in layer.heights_mm[dexels.clone()].iter().zip(&layer.passes[dexels]) {
                if pass == NO_PASS {
                    continue;
                }
                sum_mm += f64::from(height_mm);
                count += 1;
                highest_mm = highest_mm.max(height_mm);
                latest_pass = latest_pass.max(pass as f32);
            }
        }
        Self { mean_mm: (sum_mm / f64::from(count)) as f32, highest_mm, latest_pass }
    }
}
