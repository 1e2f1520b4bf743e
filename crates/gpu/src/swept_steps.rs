//! What plans of sweeps need over the tiles of fields, composed and put together for a device.
//!
//! In: plans with their fields, or parts of these. Out: steps of a submission, each over the tiles of all its fields.
//! Every tile says where its groups and records lie among those of all.

use super::context::Gpu;
use super::launches::{TileVisit, launches};
use super::readback::{Input, ReadbackStep};
use super::sweep_compose::{compose, pieces};
use super::sweep_records::{SpatialPass, SpatialTile};
use gearcut_core::dexel::SpatialField;
use gearcut_core::passes::SweepPlan;
use gearcut_core::passes::spatial::sweep_tile::SweepTile;
use gearcut_shaders::{ROUND_RECORDS, Rows, spatial_variant};
use std::ops::Range;

/// (Dexel, pass) pairs of a launch at most: as for planar fields; a pair costs a few times as much.
const LAUNCH_PAIRS: u64 = 1 << 27;

/// What a plan needs over some tiles, composed; places count from the first tile's.
#[derive(Default)]
pub struct SweptStep {
    records: Vec<SpatialPass>,
    /// Records that the parts of tiles visit, from the first one of the tile, where the device does not search them.
    lists: Vec<u32>,
    visits: Vec<TileVisit<SpatialTile>>,
    /// (Dexel, record) pairs; the device counts those that it searches.
    pub dexel_passes: u64,
}

impl SweptStep {
    /// Composed.
    pub fn compose(gpu: &Gpu, field: &SpatialField, plan: &SweepPlan, tiles: Range<usize>) -> Self {
        let of_rows = gpu.rows.lanes();
        let threads = gpu.rows.spatial_threads();
        let pieces: Vec<_> = plan.segments.iter().map(pieces).collect();
        let searched = plan.has_open_cells && gpu.rows == Rows::Few;
        let mut step = Self::default();
        let mut first_group = 0;
        for tile in &plan.tiles[tiles] {
            let [column, row] = tile.middle();
            let middle = field.ray(column, row).normal.as_vec3();
            let first_record = step.records.len();
            let mut cells = Vec::new();
            for record in &plan.records[tile.records.clone()] {
                let segment = record.segment as usize;
                compose(record, &plan.segments[segment], &pieces[segment], middle.as_dvec3(), &mut step.records);
                cells.resize(step.records.len() - first_record, record.cells);
            }
            let own = &step.records[first_record..];
            let twisted = own.iter().any(|record| record.twist_rad_per_mm != 0.0);
            for part in parts(tile, if searched { 0 } else { threads }, of_rows) {
                let is_visited = |record: &u32| cells[*record as usize] & part.cells != 0;
                let first_visit = step.lists.len();
                if !searched {
                    step.lists.extend((0..own.len() as u32).filter(is_visited));
                    step.dexel_passes += (part.dexels * (step.lists.len() - first_visit)) as u64;
                }
                let visits = if searched { own.len() } else { step.lists.len() - first_visit };
                for (round, before) in (0..visits).step_by(ROUND_RECORDS as usize).enumerate() {
                    let visit_count = (ROUND_RECORDS as usize).min(visits - before);
                    let [first_visit, first_record] = if searched {
                        [first_visit, first_record + before]
                    } else {
                        [first_visit + before, first_record]
                    };
                    step.visits.push(TileVisit {
                        tile: SpatialTile {
                            middle: middle.extend(field.low_mm as f32).to_array(),
                            first_group,
                            group_count: part.groups,
                            first_visit: first_visit as u32,
                            visit_count: visit_count as u32,
                            first_record: first_record as u32,
                            rows: part.rows,
                            ..bytemuck::Zeroable::zeroed()
                        },
                        round,
                        variant: spatial_variant(searched, twisted),
                        workgroups: part.groups.div_ceil(threads),
                        pairs: u64::from(part.groups) * (of_rows * visit_count) as u64,
                    });
                }
                first_group += part.groups;
            }
        }
        step
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
    let (mut records, mut lists) = (Vec::new(), Vec::new());
    let [mut first_record, mut first_visit] = [0; 2];
    let mut visits = Vec::new();
    for (field, (first_group, own)) in fields.iter().enumerate() {
        let Some(own) = own.get(index) else { continue };
        visits.extend(own.visits.iter().map(|visit| {
            let mut visit = *visit;
            let tile = &mut visit.tile;
            tile.first_group += first_group;
            tile.first_record += first_record;
            tile.first_visit += first_visit;
            tile.field = field as u32;
            visit
        }));
        first_record += own.records.len() as u32;
        first_visit += own.lists.len() as u32;
        records.push(bytemuck::cast_slice(&own.records));
        lists.push(bytemuck::cast_slice(&own.lists));
    }
    ReadbackStep {
        inputs: vec![Input::Tiles, Input::Shared("visits", lists), Input::Shared("records", records), Input::Rays],
        launches: launches(&gpu.spatial_flank, visits, LAUNCH_PAIRS),
    }
}

/// Dexels of a tile that visit the same records.
struct TilePart {
    groups: u32,
    dexels: usize,
    /// Groups of a column.
    rows: u32,
    /// Its cells, as bits.
    cells: u16,
}

/// A tile cell by cell; neighbours go together up to so many threads.
fn parts(tile: &SweepTile, threads: u32, of_rows: usize) -> Vec<TilePart> {
    let part = |[columns, rows]: [Range<usize>; 2], cells| {
        let of_column = rows.len().div_ceil(of_rows);
        TilePart {
            groups: (columns.len() * of_column) as u32,
            dexels: columns.len() * rows.len(),
            rows: of_column as u32,
            cells,
        }
    };
    let mut parts: Vec<TilePart> = Vec::new();
    for [columns, rows] in tile.cells() {
        let cell = part([columns.clone(), rows.clone()], 1 << tile.cell(columns.start, rows.start));
        match parts.last_mut().filter(|part| part.groups + cell.groups <= threads) {
            Some(part) => {
                part.groups += cell.groups;
                part.dexels += cell.dexels;
                part.cells |= cell.cells;
            }
            None => parts.push(cell),
        }
    }
    parts
}
