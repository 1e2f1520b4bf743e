//! What plans of sweeps need over the tiles of fields, composed and put together for a device.
//!
//! In: plans with their fields, or parts of these. Out: steps of a submission, each over the tiles of all its fields.
//! Every tile says where its groups and records lie among those of all.

use super::context::Gpu;
use super::launches::{ROUND_RECORDS, TileVisit, launches};
use super::readback::{Input, ReadbackStep};
use super::sweep_compose::{compose, pieces};
use super::sweep_records::{SpatialPass, SpatialTile};
use super::tile_dexels::groups;
use gearcut_core::dexel::SpatialField;
use gearcut_core::passes::SweepPlan;
use gearcut_shaders::{WORKGROUP_THREADS, spatial_variant};
use std::ops::Range;

/// (Dexel, pass) pairs of a launch at most: as for planar fields; a pair costs a few times as much.
const LAUNCH_PAIRS: u64 = 1 << 27;

/// What a plan needs over some tiles, composed; places count from the first tile's.
pub struct SweptStep {
    records: Vec<SpatialPass>,
    visits: Vec<TileVisit<SpatialTile>>,
}

impl SweptStep {
    /// Composed.
    pub fn compose(gpu: &Gpu, field: &SpatialField, plan: &SweepPlan, tiles: Range<usize>) -> Self {
        let of_rows = gpu.rows.lanes();
        let pieces: Vec<_> = plan.segments.iter().map(pieces).collect();
        let (mut records, mut visits) = (Vec::new(), Vec::new());
        let mut first_group = 0;
        for tile in &plan.tiles[tiles] {
            let [column, row] = tile.middle();
            let middle = field.ray(column, row).normal.as_vec3();
            let group_count = groups(tile, of_rows) as u32;
            let first_record = records.len();
            for record in &plan.records[tile.records.clone()] {
                let segment = record.segment as usize;
                compose(record, &plan.segments[segment], &pieces[segment], middle.as_dvec3(), &mut records);
            }
            for (round, some) in records[first_record..].chunks(ROUND_RECORDS).enumerate() {
                visits.push(TileVisit {
                    tile: SpatialTile {
                        middle: middle.extend(field.low_mm as f32).to_array(),
                        first_group,
                        group_count,
                        first_record: (first_record + round * ROUND_RECORDS) as u32,
                        record_count: some.len() as u32,
                        ..bytemuck::Zeroable::zeroed()
                    },
                    round,
                    variant: spatial_variant(
                        some.iter().any(|record| record.twist_rad_per_mm != 0.0),
                        some.iter().any(|record| record.is_arc == 1),
                    ),
                    workgroups: group_count.div_ceil(WORKGROUP_THREADS),
                    pairs: u64::from(group_count) * (of_rows * some.len()) as u64,
                });
            }
            first_group += group_count;
        }
        Self { records, visits }
    }

    /// Bytes of the records.
    pub fn record_bytes(&self) -> usize {
        size_of_val(self.records.as_slice())
    }
}

/// Steps of some fields, each with its first group among those of all.
pub fn steps<'a>(gpu: &'a Gpu, fields: &[(u32, &'a [SweptStep])]) -> Vec<ReadbackStep<'a>> {
    let most = fields.iter().map(|(_, own)| own.len()).max().unwrap_or(0);
    (0..most).map(|index| step(gpu, fields, index)).collect()
}

fn step<'a>(gpu: &'a Gpu, fields: &[(u32, &'a [SweptStep])], index: usize) -> ReadbackStep<'a> {
    let (mut records, mut first_record) = (Vec::new(), 0);
    let mut visits = Vec::new();
    for (field, (first_group, own)) in fields.iter().enumerate() {
        let Some(own) = own.get(index) else { continue };
        visits.extend(own.visits.iter().map(|visit| {
            let mut visit = *visit;
            let tile = &mut visit.tile;
            tile.first_group += first_group;
            tile.first_record += first_record;
            tile.field = field as u32;
            visit
        }));
        first_record += own.records.len() as u32;
        records.push(bytemuck::cast_slice(&own.records));
    }
    ReadbackStep {
        inputs: vec![Input::Tiles, Input::Shared("records", records), Input::Rays],
        launches: launches(&gpu.spatial_flank, visits, LAUNCH_PAIRS),
    }
}
