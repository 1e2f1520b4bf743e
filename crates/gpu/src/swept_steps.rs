//! What plans of sweeps need over the tiles of fields, composed and put together for a device.
//!
//! In: plans with their fields, or parts of these. Out: steps of a submission, each over the tiles of all its fields.
//! Every tile says where its groups, records and cells lie among those of all.

use super::context::Gpu;
use super::edge_cells::EdgeCells;
use super::launches::{ROUND_RECORDS, TileVisit, launches};
use super::readback::{Input, ReadbackStep};
use super::sweep_compose::compose;
use super::sweep_records::{SpatialPass, SpatialTile};
use super::tile_dexels::groups;
use gearcut_core::dexel::SpatialField;
use gearcut_core::passes::SweepPlan;
use gearcut_shaders::WORKGROUP_THREADS;
use std::ops::Range;

/// (Dexel, pass) pairs of a launch at most: as for planar fields; a pair costs a few times as much.
const LAUNCH_PAIRS: u64 = 1 << 27;

/// What a plan needs over some tiles, composed; places count from the first tile's.
pub struct SweptStep {
    cells: Vec<[f32; 4]>,
    records: Vec<SpatialPass>,
    visits: Vec<TileVisit<SpatialTile>>,
}

impl SweptStep {
    /// Composed.
    pub fn compose(gpu: &Gpu, field: &SpatialField, plan: &SweepPlan, tiles: Range<usize>) -> Self {
        let of_rows = gpu.rows.lanes();
        let cells = EdgeCells::new(&plan.segments);
        let (mut records, mut visits) = (Vec::new(), Vec::new());
        let mut first_group = 0;
        for tile in &plan.tiles[tiles] {
            let [column, row] = tile.middle();
            let middle = field.ray(column, row).normal.as_vec3();
            let group_count = groups(tile, of_rows) as u32;
            for (round, some) in plan.records[tile.records.clone()].chunks(ROUND_RECORDS).enumerate() {
                visits.push(TileVisit {
                    tile: SpatialTile {
                        middle: middle.extend(field.low_mm as f32).to_array(),
                        first_group,
                        group_count,
                        first_record: records.len() as u32,
                        record_count: some.len() as u32,
                        first_cell: 0,
                        field: 0,
                        unused: [0; 2],
                    },
                    round,
                    variant: usize::from(some.iter().any(|record| record.twist_rad_per_mm != 0.0)),
                    workgroups: group_count.div_ceil(WORKGROUP_THREADS),
                    pairs: u64::from(group_count) * (of_rows * some.len()) as u64,
                });
                records.extend(
                    some.iter().map(|record| {
                        compose(&cells, record, &plan.segments[record.segment as usize], middle.as_dvec3())
                    }),
                );
            }
            first_group += group_count;
        }
        Self { cells: cells.cells, records, visits }
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
    let (mut records, mut cells) = (Vec::new(), Vec::new());
    let [mut first_record, mut first_cell] = [0; 2];
    let mut visits = Vec::new();
    for (field, (first_group, own)) in fields.iter().enumerate() {
        let Some(own) = own.get(index) else { continue };
        visits.extend(own.visits.iter().map(|visit| {
            let mut visit = *visit;
            let tile = &mut visit.tile;
            tile.first_group += first_group;
            tile.first_record += first_record;
            tile.first_cell = first_cell;
            tile.field = field as u32;
            visit
        }));
        first_record += own.records.len() as u32;
        first_cell += own.cells.len() as u32;
        records.push(bytemuck::cast_slice(&own.records));
        cells.push(bytemuck::cast_slice(&own.cells));
    }
    ReadbackStep {
        inputs: vec![Input::Tiles, Input::Shared("records", records), Input::Shared("cells", cells), Input::Rays],
        launches: launches(&gpu.spatial_flank, visits, LAUNCH_PAIRS),
    }
}
