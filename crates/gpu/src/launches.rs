//! Launches of a step, each over as many tiles as a device takes at once.
//!
//! In: tiles with the records that one launch visits, of all fields of a submission. Out: launches in order. Dexels
//! stay on the device through them, so that a tile with more records than one launch may have is cut like any other:
//! its records come in **rounds**, in their order, and what is left does not depend on how they are split.

use super::readback::StageLaunch;
use bytemuck::Pod;

/// Workgroups in one dimension: what every WebGPU device has.
pub const WORKGROUPS: usize = 65_535;

/// A tile with the records that one launch visits.
#[derive(Debug, Clone, Copy)]
pub struct TileVisit<T> {
    /// The tile as the shader reads it.
    pub tile: T,
    /// Rounds of the tile before this one.
    pub round: usize,
    /// Variant of the stage that serves.
    pub variant: usize,
    /// Workgroups.
    pub workgroups: u32,
    /// (Dexel, pass) pairs.
    pub pairs: u64,
}

/// Launches of so many pairs at most, or of one tile: first rounds of all tiles, then second ones, and so on, variant
/// by variant.
pub fn launches<T: Pod>(
    variants: &[wgpu::ComputePipeline],
    mut visits: Vec<TileVisit<T>>,
    most_pairs: u64,
) -> Vec<StageLaunch<'_>> {
    let kind = |visit: &TileVisit<T>| (visit.round, visit.variant);
    visits.sort_by_key(kind);
    let mut launches = Vec::new();
    for mut rest in visits.chunk_by(|a, b| kind(a) == kind(b)) {
        while !rest.is_empty() {
            let mut pairs = 0;
            let has_room = |visit: &&TileVisit<T>| {
                pairs += visit.pairs;
                pairs <= most_pairs
            };
            let (now, later) = rest.split_at(rest.iter().take(WORKGROUPS).take_while(has_room).count().max(1));
            let tiles: Vec<T> = now.iter().map(|visit| visit.tile).collect();
            launches.push(StageLaunch {
                pipeline: &variants[now[0].variant],
                workgroups: [now.iter().map(|visit| visit.workgroups).max().unwrap_or(0), now.len() as u32],
                tiles: bytemuck::cast_slice(&tiles).to_vec(),
            });
            rest = later;
        }
    }
    launches
}
