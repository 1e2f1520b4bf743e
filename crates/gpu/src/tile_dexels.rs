//! Rays and dexels of a field in the order of its tiles, as the spatial shader reads them.
//!
//! Some rows of a column make a **group**, the lanes of one thread: four on software adapters, one on GPUs. The groups
//! of a tile follow each other, cell by cell, so that the threads of a wave are in few cells.

use gearcut_core::dexel::{Layer, SpatialField};
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use std::ops::Range;

/// Groups of a tile.
pub fn groups(tile: &SweepTile, of_rows: usize) -> usize {
    tile.columns.len() * tile.rows.len().div_ceil(of_rows)
}

/// Columns of the cells of some tiles: dexels that follow each other in the field, and whose lanes do.
fn runs<'a>(
    field: &'a SpatialField,
    tiles: &'a [SweepTile],
) -> impl Iterator<Item = (&'a SweepTile, Range<usize>)> + 'a {
    tiles.iter().flat_map(move |tile| {
        tile.cells().flat_map(move |[columns, rows]| {
            columns.map(move |column| {
                let first = field.index(column, rows.start);
                (tile, first..first + rows.len())
            })
        })
    })
}

/// Puts dexels in the order of tiles where they belong in the field.
pub fn spread(field: &SpatialField, tiles: &[SweepTile], of_rows: usize, from: &Layer, to: &mut Layer) {
    let mut first = 0;
    for (_, dexels) in runs(field, tiles) {
        let lanes = first..first + dexels.len();
        first += dexels.len().next_multiple_of(of_rows);
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
        let mut rays = vec![0.0; 6 * lanes];
        let (mut heights_mm, mut passes) = (Vec::with_capacity(lanes), Vec::with_capacity(lanes));
        let (origins_mm, normals) = (field.origins_mm(), field.normals());
        for (tile, dexels) in runs(field, tiles) {
            let from_mm = tile.origin_mm.to_array();
            let own = &mut rays[6 * heights_mm.len()..][..6 * dexels.len().next_multiple_of(of_rows)];
            for (group, first) in own.chunks_exact_mut(6 * of_rows).zip(dexels.clone().step_by(of_rows)) {
                for lane in 0..of_rows {
                    // Lanes beyond the last row repeat it.
                    let dexel = (first + lane).min(dexels.end - 1);
                    for axis in 0..3 {
                        group[axis * of_rows + lane] = (origins_mm[axis][dexel] - from_mm[axis]) as f32;
                        group[(3 + axis) * of_rows + lane] = normals[axis][dexel] as f32;
                    }
                }
            }
            heights_mm.extend_from_slice(&layer.heights_mm[dexels.clone()]);
            heights_mm.resize(heights_mm.len().next_multiple_of(of_rows), layer.heights_mm[dexels.end - 1]);
            passes.extend_from_slice(&layer.passes[dexels.clone()]);
            passes.resize(passes.len().next_multiple_of(of_rows), layer.passes[dexels.end - 1]);
        }
        Self { rays, heights_mm, passes }
    }
}
