//! Rays and dexels of a field in the order of its tiles, as the spatial shader reads them.
//!
//! Some rows of a column make a **group**, the lanes of one thread: four on software adapters, one on GPUs; the groups
//! of a tile follow each other.

use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use std::ops::Range;

/// Groups of a tile.
pub fn groups(tile: &SweepTile, of_rows: usize) -> usize {
    tile.columns.len() * tile.rows.len().div_ceil(of_rows)
}

/// Dexels of every group of some tiles: fewer than lanes where rows end.
fn group_dexels<'a>(
    field: &'a SpatialField,
    tiles: &'a [SweepTile],
    of_rows: usize,
) -> impl Iterator<Item = (&'a SweepTile, Range<usize>)> + 'a {
    tiles.iter().flat_map(move |tile| {
        tile.columns.clone().flat_map(move |column| {
            let end = field.index(column, tile.rows.end - 1) + 1;
            let from = field.index(column, tile.rows.start);
            (from..end).step_by(of_rows).map(move |first| (tile, first..end.min(first + of_rows)))
        })
    })
}

/// Adds the lanes of a group; those beyond the last row repeat it.
fn extend_lanes<T: Copy>(lanes: &mut Vec<T>, own: impl ExactSizeIterator<Item = T>, of_rows: usize) {
    let end = lanes.len() + of_rows;
    lanes.extend(own);
    if let Some(&last) = lanes.last() {
        lanes.resize(end, last);
    }
}

/// Puts dexels in the order of tiles where they belong in the field.
pub fn spread(field: &SpatialField, tiles: &[SweepTile], of_rows: usize, from: &Layer, to: &mut Layer) {
    for (group, (_, dexels)) in group_dexels(field, tiles, of_rows).enumerate() {
        let lanes = group * of_rows..group * of_rows + dexels.len();
        to.heights_mm[dexels.clone()].copy_from_slice(&from.heights_mm[lanes.clone()]);
        to.passes[dexels].copy_from_slice(&from.passes[lanes]);
    }
}

/// Rays and dexels of some tiles, lane after lane.
#[derive(Default)]
pub struct TileDexels {
    /// Six numbers for each row of a group, component by component.
    pub rays: Vec<f32>,
    /// Heights before the first step.
    pub heights_mm: Vec<f32>,
    /// Passes before it.
    pub passes: Vec<u32>,
}

impl TileDexels {
    /// Those of a field with its layer.
    pub fn new(field: &SpatialField, tiles: &[SweepTile], of_rows: usize, layer: &Layer) -> Self {
        let lanes = of_rows * tiles.iter().map(|tile| groups(tile, of_rows)).sum::<usize>();
        let mut rays = Vec::with_capacity(6 * lanes);
        let (mut heights_mm, mut passes) = (Vec::with_capacity(lanes), Vec::with_capacity(lanes));
        for (tile, dexels) in group_dexels(field, tiles, of_rows) {
            for (origins, from_mm) in field.origins_mm().iter().zip(tile.origin_mm.to_array()) {
                let against = origins[dexels.clone()].iter().map(|at_mm| (at_mm - from_mm) as f32);
                extend_lanes(&mut rays, against, of_rows);
            }
            for normals in field.normals() {
                extend_lanes(&mut rays, normals[dexels.clone()].iter().map(|&along| along as f32), of_rows);
            }
            extend_lanes(&mut heights_mm, layer.heights_mm[dexels.clone()].iter().copied(), of_rows);
            extend_lanes(&mut passes, layer.passes[dexels].iter().copied(), of_rows);
        }
        Self { rays, heights_mm, passes }
    }
}
